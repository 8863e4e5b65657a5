"""The guide under /guide/; docs/service*.md: curls succeed, all routes and settings with defaults are documented."""

import json
import re
from pathlib import Path

import pytest
from rocking_api.settings import Settings

from tests.api.conftest import assert_problem, client_of

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "service.md").read_text(encoding="utf-8")
OPERATION = (DOCS / "service-operation.md").read_text(encoding="utf-8")
URLS = re.findall(r"curl (?:-O )?'http://127\.0\.0\.1:8000([^']+)'\n", PAGE)
ROWS = dict(re.findall(r"^\| ROCKING_(\w+) \| ([^|]+?) \|", OPERATION, flags=re.MULTILINE))

ANSWERS = re.findall(r"```bash\ncurl 'http://127\.0\.0\.1:8000([^']+)'([^`]*)```\n[^`]*\n```json\n([^`]*)```", PAGE)
"""Address, other options and answer of the examples with an answer."""


def test_documented_requests_succeed(client):
    assert len(URLS) >= 7
    for url in URLS:
        assert client.get(url).status_code == (422 if "frequency_ratio=40" in url else 200), url


@pytest.mark.parametrize("place", range(4))
def test_documented_answers_have_the_fields_of_real_ones(client, place):
    url, options, text = ANSWERS[place]
    body = re.search(r"-d '([^']*)'", options)
    json_body = {"content": body[1], "headers": {"Content-Type": "application/json"}} if body else {}
    answer, stated = client.request("POST" if body else "GET", url, **json_body).json(), json.loads(text)
    if "query" in stated:
        assert {*stated} == {*answer}
    for name in ("query", "units", "warnings", "version", "url"):
        assert stated.get(name, answer[name]) == answer[name]
    assert stated.keys() <= answer.keys()


def test_every_route_and_every_setting_with_its_default_is_documented(client):
    for path in client.get("/openapi.json").json()["paths"]:
        assert path.replace("/{key}", "") in PAGE
    assert {name.lower() for name in ROWS} == set(Settings.model_fields)
    for name, documented in ROWS.items():
        default = Settings.model_fields[name.lower()].default
        if isinstance(default, Path):
            assert documented == str(default)
        else:
            assert json.loads(documented) == (list(default) if isinstance(default, tuple) else default)


def test_pages_of_the_built_guide(results, tmp_path):
    folder = tmp_path / "docs"
    client = client_of(results, guide=folder)
    assert '"/guide/"' in client.get("/").text  # the menu leads somewhere in every installation
    first_steps = client.get("/guide/").text
    assert "<code>make docs</code>" in first_steps
    assert "rocking response --pulse sine" in first_steps
    (folder / "howto").mkdir(parents=True)
    (folder / "index.html").write_text("<title>rocking</title>")
    (folder / "howto" / "block.html").write_text("<title>My block</title>")
    (tmp_path / "secret").write_text("not published")
    assert '"/guide/"' in client.get("/").text
    home = client.get("/guide/")
    assert "<title>rocking</title>" in home.text
    assert "default-src 'self'" in home.headers["content-security-policy"]
    assert "<title>My block</title>" in client.get("/guide/howto/block.html").text
    assert_problem(client.get("/guide/none.html"), 404)
    assert_problem(client.get("/guide/%2e%2e/secret"), 404)
    assert not [path for path in client.get("/openapi.json").json()["paths"] if "guide" in path]
