"""The guide under /guide/: the files of the built folder, and a hint where it is not built."""

from tests.api.conftest import assert_problem, client_of


def test_pages_of_the_built_guide(results, tmp_path):
    folder = tmp_path / "docs"
    client = client_of(results, guide=folder)
    assert "make docs" in assert_problem(client.get("/guide/"), 404)["detail"]
    page = client.get("/guide/", headers={"accept": "text/html"}).text
    assert "<code>make docs</code>" in page
    assert "`" not in page
    assert '"/guide/"' not in client.get("/").text  # a menu leads only where something is
    (folder / "howto").mkdir(parents=True)
    (folder / "index.html").write_text("<title>rocking</title>")
    (folder / "howto" / "block.html").write_text("<title>My block</title>")
    (tmp_path / "secret").write_text("not published")
    assert '"/guide/"' in client.get("/").text
    home = client.get("/guide")
    assert str(home.url).endswith("/guide/")
    assert "<title>rocking</title>" in home.text
    assert "default-src 'self'" in home.headers["content-security-policy"]
    assert "<title>My block</title>" in client.get("/guide/howto/block.html").text
    assert_problem(client.get("/guide/none.html"), 404)
    assert_problem(client.get("/guide/%2e%2e/secret"), 404)
    assert not [path for path in client.get("/openapi.json").json()["paths"] if "guide" in path]
