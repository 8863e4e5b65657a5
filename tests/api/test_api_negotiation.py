"""The format of a response by the header Accept, and what caches must know of it."""

import pytest
from fastapi import Request
from rocking_api.http.encoding import negotiated_form

from tests.api.conftest import assert_problem

SUITE = ("json", "csv", "nrml")
BROWSER = "text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8"


def form_of(accept, offered=SUITE, default=None):
    scope = {"type": "http", "headers": [(b"accept", accept.encode())]}
    return negotiated_form(Request(scope), None, offered, default)


@pytest.mark.parametrize(
    ("accept", "form"),
    [
        ("", "json"),
        (BROWSER, "json"),
        ("*/*", "json"),
        ("image/png", "json"),
        ("application/*", "json"),
        ("text/*", "csv"),
        ("text/csv", "csv"),
        ("TEXT/CSV ; Q=0.5", "csv"),
        ("text/csv;q=0.1, application/json", "json"),
        ("application/json;q=0.2, text/csv;charset=utf-8;q=0.30", "csv"),
        ("text/csv, application/json", "csv"),
        ("*/*, text/csv", "csv"),
        ("application/json;q=0.1, */*", "csv"),
        ("application/json;q=0", "csv"),
        ("application/json;q=0.000, */*;q=0.1", "csv"),
        ("text/csv;q=0, */*", "json"),
        ("*/*;q=0", "json"),
        ("text/html;q=0, text/csv;q=0.1", "csv"),
        ("text/html, text/csv", "json"),
        ("text/html;q=0.5, text/csv", "csv"),
        ("text/html, application/json;q=0.5, */*;q=0.8", "json"),
        ("application/xml", "nrml"),
        ("application/xml, */*;q=0.8", "nrml"),
        ("application/xml;q=0.1, application/json", "json"),
        ("application/xml, text/html;q=0.5", "json"),
        ("text/csv;q=2, application/json;q=nan", "csv"),
    ],
)
def test_the_preferred_form_is_chosen(accept, form):
    assert form_of(accept) == form


def test_a_browser_gets_the_default():
    assert form_of(BROWSER, ("json", "csv", "nc"), "csv") == "csv"
    assert form_of("text/csv;q=0.5, */*;q=0.1", ("json", "csv", "nc"), "nc") == "csv"


def test_a_suite_opened_in_a_browser_is_no_download(client):
    response = client.get("/v1/suites/demonstration", headers={"accept": BROWSER})
    assert response.headers["content-type"] == "application/json"
    assert "content-disposition" not in response.headers


@pytest.mark.parametrize(
    "path",
    [
        "/v1/suites/demonstration",
        "/v1/spectrum?pulse=sine&slenderness=0.6&restitution=0.85",
        "/v1/datasets/spectra/sine/eta-0.85/subset?slenderness_max=0.1",
    ],
)
def test_caches_are_told_what_depends_on_the_header(client, path):
    def vary(**headers):
        return [name.strip() for name in client.get(address, headers=headers).headers.get("vary", "").split(",")]

    address = path
    etag = client.get(path).headers["etag"]
    assert "Accept" in vary()
    assert "Accept" in vary(accept="text/csv")
    assert "Accept" in vary(**{"if-none-match": etag})
    address += "&format=csv" if "?" in path else "?format=csv"
    assert "Accept" not in vary()


def test_caches_are_told_that_errors_are_pages_or_problems(client):
    for path, status in (("/nowhere", 404), ("/v1/response", 422)):
        problem = client.get(path)
        assert_problem(problem, status)
        page = client.get(path, headers={"accept": BROWSER})
        assert page.headers["content-type"].startswith("text/html")
        assert problem.headers["vary"] == page.headers["vary"].partition(", Accept-Encoding")[0] == "Accept"
