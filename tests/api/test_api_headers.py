"""Methods, caching, origins and error pages: what the headers of requests and answers say."""

import hashlib
import re
from pathlib import Path

import pytest
import rocking_api
from rocking_api.execution.work import BusyError

from tests.api.conftest import POINT, assert_problem, client_of

STATIC = Path(rocking_api.__file__).parent / "static"
BROWSER = "text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8"
DATASET, SUITE = "/v1/datasets/spectra/sine/eta-0.85", "/v1/suites/demonstration"
SPECTRUM = "/v1/spectrum?pulse=sine&slenderness=0.6&restitution=0.85"


def test_errors_are_pages_for_browsers_only(client):
    for path, status in (("/nowhere", 404), ("/v1/response", 422), ("/v1/spectrum?pulse=<script>", 422)):
        problem, page = client.get(path), client.get(path, headers={"accept": BROWSER})
        assert_problem(problem, status)
        assert page.status_code == status
        assert page.headers["content-type"].startswith("text/html")
        assert "Accept" in problem.headers["vary"]
        assert '<nav aria-label="Pages">' in page.text
        assert "unsafe" not in page.headers["content-security-policy"]
    assert "<script>" not in page.text
    assert "&lt;script&gt;" in page.text


def test_a_busy_service_is_a_page_that_says_what_to_do(client, monkeypatch):
    def busy(*_):
        raise BusyError

    monkeypatch.setattr(client.app.state.service.cubes.catalogue, "dataset", busy)
    found = client.get(DATASET, headers={"accept": "text/html"})
    assert (found.status_code, found.headers["retry-after"]) == (503, "2")
    assert f'href="{DATASET}"' in found.text
    assert "Try again" in found.text


def test_head_answers_as_get_without_a_body_on_every_route(client):
    for path in ("/health", "/v1/pulses", SUITE, f"{DATASET}.nc", SPECTRUM, "/", "/static/docs.js", "/metrics"):
        head, whole = client.head(path), client.get(path)
        assert (head.status_code, head.content) == (200, b""), path
        assert head.headers["content-type"] == whole.headers["content-type"], path


def test_other_methods_are_refused(client):
    for method in ("PUT", "DELETE", "PATCH"):
        assert method in assert_problem(client.request(method, "/v1/response"), 405)["detail"]


def test_other_origins_may_read_the_answer_if_they_are_allowed(client, results):
    ours = {"Origin": "https://a.example"}
    assert "access-control-allow-origin" not in client.get("/health", headers=ours).headers
    with client_of(results, cors_origins=("https://a.example",)) as client:
        response = client.get("/v1/response", params=POINT, headers=ours)
        refused = client.get("/v1/response", headers=ours)
    assert response.headers["access-control-allow-origin"] == "https://a.example"
    assert "ETag" in response.headers["access-control-expose-headers"]
    assert_problem(refused, 422)
    assert refused.headers["access-control-allow-origin"] == "https://a.example"


def test_an_unknown_path_is_answered_without_the_description_of_all_routes(results):
    """It takes a second to make."""
    with client_of(results) as client:
        detail = assert_problem(client.get("/v1/nothing"), 404)["detail"]
        assert detail == "there is nothing at /v1/nothing; /docs lists the routes"
        assert client.app.openapi_schema is None


def test_a_map_may_be_stored_and_the_state_must_not(client):
    stored = client.get("/v1/map?pulse=sine&restitution=0.85&columns=2&rows=2").headers["cache-control"]
    assert (stored, client.get("/health").headers["cache-control"]) == ("max-age=600", "no-store")


def test_only_text_is_compressed(client):
    accept = {"accept-encoding": "gzip"}
    assert client.get(SPECTRUM, headers=accept).headers["content-encoding"] == "gzip"
    assert "content-encoding" not in client.get(f"{SPECTRUM}&format=nc", headers=accept).headers


@pytest.mark.parametrize("page", ["/", "/docs"])
def test_pages_load_nothing_from_outside(client, page):
    response = client.get(page)
    assert response.headers["content-type"].startswith("text/html")
    assert "default-src 'self'" in response.headers["content-security-policy"]
    assert page == "/docs" or "unsafe" not in response.headers["content-security-policy"]
    assert not re.search(r"<style|\sstyle=|\son\w+=|<script>", response.text)
    for link in re.findall(r'(?:src|href|action)="([^"]+)"', response.text):
        assert link.startswith("/")
        if link != "/guide/":  # built apart: tests/api/test_service_page.py
            assert client.get(link).status_code in (200, 422)  # 422: the form's action, without its parameters
    assert "http" not in response.text


def test_vendored_libraries_are_what_was_published():
    for folder in (STATIC / "uplot", STATIC / "swagger-ui"):
        listed = (folder / "SHA256SUMS").read_text().split()
        digests = dict(zip(listed[1::2], listed[::2], strict=True))
        assert "LICENSE" in digests
        found = {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.iterdir()}
        assert digests == {name: digest for name, digest in found.items() if name != "SHA256SUMS"}
