"""Methods, formats, caching, origins, request ids and error pages: what the headers of requests and answers say."""

import hashlib
import re
from pathlib import Path
from urllib.parse import urlencode

import pytest
import rocking_api
from fastapi import Request
from rocking_api.execution.executor import BusyError
from rocking_api.http.encoding import negotiated_form
from rocking_api.routers.pages import PAGES
from rocking_assessment.service.object_page import EXAMPLES, SITE

from tests.api.conftest import POINT, assert_problem, client_of

STATIC = Path(rocking_api.__file__).parent / "static"
BROWSER = "text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8"
DATASET, SUITE = "/v1/datasets/spectra/sine/eta-0.85", "/v1/suites/demonstration"
SPECTRUM = "/v1/spectrum?pulse=sine&slenderness=0.6&restitution=0.85"


@pytest.mark.parametrize(
    ("accept", "form"),
    [
        (BROWSER, "json"),
        ("*/*", "json"),
        ("image/png", "json"),
        ("text/*", "csv"),
        ("text/csv", "csv"),
        ("text/csv;q=0.1, application/json", "json"),
        ("application/json;q=0.2, text/csv;charset=utf-8;q=0.30", "csv"),
        ("*/*, text/csv", "csv"),
        ("application/json;q=0.1, */*", "csv"),
        ("application/json;q=0.000, */*;q=0.1", "csv"),
        ("*/*;q=0", "json"),
        ("text/html;q=0, text/csv;q=0.1", "csv"),
        ("text/html;q=0.5, text/csv", "csv"),
        ("text/html, application/json;q=0.5, */*;q=0.8", "json"),
        ("application/xml", "nrml"),
        ("application/xml, text/html;q=0.5", "json"),
        ("text/csv;q=2, application/json;q=nan", "csv"),
    ],
)
def test_the_preferred_form_is_chosen(accept, form):
    assert form_of(accept) == form


def form_of(accept, offered=("json", "csv", "nrml"), default=None):
    scope = {"type": "http", "headers": [(b"accept", accept.encode())]}
    return negotiated_form(Request(scope), None, offered, default)


def test_a_browser_gets_the_default_and_no_download(client):
    assert form_of(BROWSER, ("json", "csv", "nc"), "csv") == "csv"
    assert form_of("text/csv;q=0.5, */*;q=0.1", ("json", "csv", "nc"), "nc") == "csv"
    response = client.get(SUITE, headers={"accept": BROWSER})
    assert response.headers["content-type"] == "application/json"
    assert "content-disposition" not in response.headers
    subset = f"{DATASET}/subset?slenderness_max=0.1"
    assert client.get(subset, headers={"accept": "application/json"}).content.startswith(b"CDF")
    assert client.get(subset, headers={"accept": "application/json, text/csv"}).text.startswith("alpha,")
    assert client.get(f"{subset}&format=json").json()["allowed"] == "one of 'csv' or 'nc'"


def test_caches_are_told_what_depends_on_the_header(client):
    def vary(address, **headers):
        return [name.strip() for name in client.get(address, headers=headers).headers.get("vary", "").split(",")]

    for path in (SUITE, SPECTRUM, f"{DATASET}/subset?slenderness_max=0.1"):
        for headers in ({}, {"accept": "text/csv"}, {"if-none-match": client.get(path).headers["etag"]}):
            assert "Accept" in vary(path, **headers)
        assert "Accept" not in vary(f"{path}{'&' if '?' in path else '?'}format=csv")


def test_errors_are_pages_for_browsers_only(client):
    for path, status in (("/nowhere", 404), ("/v1/response", 422), ("/v1/spectrum?pulse=<script>", 422)):
        problem, page = client.get(path), client.get(path, headers={"accept": BROWSER})
        assert_problem(problem, status)
        assert page.status_code == status
        assert page.headers["content-type"].startswith("text/html")
        assert problem.headers["vary"] == page.headers["vary"].partition(", Accept-Encoding")[0] == "Accept"
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


@pytest.mark.parametrize(
    ("path", "allowed"),
    [
        ("/v1/response", "GET, POST"),
        ("/health", "GET, HEAD"),
        (SUITE, "GET"),
        (f"{DATASET}.nc", "GET, HEAD"),
        ("/static/docs.js", "GET, HEAD"),
    ],
)
def test_all_methods_of_a_path_are_named(client, path, allowed):
    for method in ("PUT", "DELETE", "OPTIONS", *({"HEAD"} - {*allowed.split(", ")})):
        response = client.request(method, path)
        assert response.status_code == 405
        assert response.headers["allow"] == allowed
    problem = assert_problem(client.put(path), 405)
    assert problem["detail"] == f"PUT is not a method of this route; allowed: {allowed}"


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
        assert client.delete("/v1/response").headers["allow"] == "GET, POST"
        assert client.app.openapi_schema is None


OBJECT = f"/object?{urlencode(SITE | EXAMPLES['rectangle'] | {'width': '41'})}"
STORED = {
    "no-cache": [
        *(page.path for page in PAGES if page.path != "/guide/"),
        *(OBJECT, "/static/explorer/main.js", "/v1/datasets", DATASET, f"{DATASET}.zarr/.zgroup", "/v1/suites", SUITE),
    ],
    "max-age=60": [f"/v1/response?{urlencode(POINT)}", SPECTRUM],
    "max-age=600": ["/v1/map?pulse=sine&restitution=0.85&columns=2&rows=2"],
}


@pytest.mark.parametrize("control", STORED)
def test_answers_may_be_stored_and_are_revalidated(client, control):
    tags = set()
    for path in STORED[control]:
        first = client.get(path)
        assert (first.status_code, first.headers["cache-control"]) == (200, control), path
        again = client.get(path, headers={"if-none-match": first.headers["etag"]})
        assert (again.status_code, again.content, again.headers["cache-control"]) == (304, b"", control), path
        assert again.headers["etag"] == first.headers["etag"]
        tags.add(first.headers["etag"])
    assert len(tags) == len(STORED[control])
    for path in ("/v1/response", "/health"):  # an error, and what changes
        assert "etag" not in client.get(path).headers


def test_only_text_is_compressed(client):
    accept = {"accept-encoding": "gzip"}
    assert client.get(SPECTRUM, headers=accept).headers["content-encoding"] == "gzip"
    assert "content-encoding" not in client.get(f"{SPECTRUM}&format=nc", headers=accept).headers


def test_a_request_id_is_sent_back_if_it_is_valid_and_made_otherwise(client):
    def id_of(given):
        return client.get("/health", headers={"X-Request-ID": given}).headers["x-request-id"]

    for sane in ("a", "7f3c-1.B_", "x" * 64):
        assert id_of(sane) == sane
    made = [id_of(odd) for odd in ("", "", "x" * 65, "a b", '"', "a;b")]
    assert len(set(made)) == len(made)
    assert all(re.fullmatch("[0-9a-f]{16}", one) for one in made)
    assert client.get("/nowhere").headers["x-request-id"]


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
