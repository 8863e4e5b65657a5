"""Files of the explorer: vendored bytes, imports, ids, revalidation."""

import hashlib
import re
from pathlib import Path
from urllib.parse import urlencode

import pytest
import rocking_api
from rocking_api.execution.executor import BusyError
from rocking_api.routers.object_page import EXAMPLES, SHAPES, SITE, fields_of, page_of
from rocking_api.routers.objects_page import DEFAULTS
from rocking_api.routers.pages import PAGES, html

STATIC = Path(rocking_api.__file__).parent / "static"
TEXTS = {one.path: html(one.template, one.title, one.path) for one in PAGES if one.template and one.path != "/docs"}
for shape in SHAPES:
    TEXTS[f"/object?shape={shape}"] = page_of(fields_of({"shape": shape})).body.decode()
TEXTS["/objects"] = html("objects.html", "", "/objects", given=DEFAULTS, table=None, found=None)
SHARED = {"page.js"}  # looks for a form that only one page has
RENDERED = {"ranking", "filter", "verdict", "more", "count"}  # parts of a result, which the service renders later
SCRIPTS = sorted((STATIC / "explorer").glob("*.js"))


@pytest.mark.parametrize("library", ["uplot", "swagger-ui"])
def test_vendored_libraries_are_what_was_published(library):
    folder = STATIC / library
    listed = (folder / "SHA256SUMS").read_text().split()
    digests = dict(zip(listed[1::2], listed[::2], strict=True))
    assert "LICENSE" in digests
    assert set(digests) == {path.name for path in folder.iterdir()} - {"SHA256SUMS"}
    for name, digest in digests.items():
        assert hashlib.sha256((folder / name).read_bytes()).hexdigest() == digest


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.name)
def test_imports_of_scripts_are_exported(path):
    for names, source in re.findall(r"import \{([^}]*)\} from \"\./([\w.]+)\"", path.read_text()):
        text = (STATIC / "explorer" / source).read_text()
        exported = set(re.findall(r"^export (?:async )?(?:function|const|class) (\w+)", text, re.MULTILINE))
        assert {name.strip().partition(" as ")[0] for name in names.split(",") if name.strip()} <= exported


def test_every_script_is_part_of_the_page():
    texts = "".join(path.read_text() for path in SCRIPTS)
    imported = set(re.findall(r"(?:from |import\()\"\./([\w.]+)\"", texts))
    entries = set(re.findall(r"/static/explorer/([\w.]+\.js)", "".join(TEXTS.values())))
    assert {path.name for path in SCRIPTS} == imported | entries


def scripts_of(page):
    """The scripts that a page loads, also those that it loads later."""
    found, open_ = set(), set(re.findall(r"/static/explorer/([\w.]+\.js)", page))
    while open_:
        found |= open_
        texts = "".join((STATIC / "explorer" / name).read_text() for name in open_)
        open_ = set(re.findall(r"(?:from |import\()\"\./([\w.]+)\"", texts)) - found
    return found


@pytest.mark.parametrize("path", TEXTS)
def test_ids_are_there_and_unique(path):
    page = TEXTS[path]
    ids = re.findall(r'\bid="([^"]+)"', page)
    assert len(ids) == len(set(ids))
    texts = [(STATIC / "explorer" / name).read_text() for name in scripts_of(page) if name not in SHARED]
    params = {name for text in texts for name in re.findall(r'getElementById\("([^"]+)"\)', text)}
    named = {
        name
        for names in re.findall(r'\b(?:for|data-field|aria-labelledby|aria-describedby)="([^"]+)"', page)
        for name in names.split()
    }
    assert params | named <= set(ids) | (RENDERED if path == "/objects" else set())


def test_errors_are_pages_for_browsers_only(client):
    asked = {"accept": "text/html,application/xhtml+xml"}
    missing = client.get("/nowhere", headers=asked)
    assert (missing.status_code, missing.headers["vary"]) == (404, "Accept")
    assert '<nav aria-label="Pages">' in missing.text
    assert "unsafe" not in missing.headers["content-security-policy"]
    assert client.get("/nowhere").headers["content-type"] == "application/problem+json"
    wrong = client.get("/v1/spectrum?pulse=<script>", headers=asked)
    assert wrong.status_code == 422
    assert "<script>" not in wrong.text
    assert "&lt;script&gt;" in wrong.text


def test_a_busy_service_is_a_page_that_says_what_to_do(client, monkeypatch):
    def busy(*_):
        raise BusyError

    monkeypatch.setattr(client.app.state.service.cubes.catalogue, "dataset", busy)
    found = client.get("/v1/datasets/spectra/sine/eta-0.85", headers={"accept": "text/html"})
    assert (found.status_code, found.headers["retry-after"]) == (503, "2")
    assert 'href="/v1/datasets/spectra/sine/eta-0.85"' in found.text
    assert "Try again" in found.text


def test_no_style_or_script_inside_the_page(client):
    response = client.get("/")
    assert "unsafe" not in response.headers["content-security-policy"]
    assert not re.search(r"<style|\sstyle=|\son\w+=|<script>", response.text)


def test_files_are_revalidated(client):
    pages = [page.path for page in PAGES if page.path != "/guide/"]
    asked = f"/object?{urlencode(SITE | EXAMPLES['rectangle'])}"
    described = "/v1/datasets/spectra/sine/eta-0.85"
    answers = ["/v1/datasets", described, f"{described}.zarr/.zgroup", "/v1/suites", "/v1/suites/demonstration"]
    for path in (*pages, asked, *answers, "/static/explorer/main.js"):
        first = client.get(path)
        assert (first.status_code, first.headers["cache-control"]) == (200, "no-cache"), path
        again = client.get(path, headers={"if-none-match": first.headers["etag"]})
        assert (again.status_code, again.content, again.headers["cache-control"]) == (304, b"", "no-cache"), path
    assert "etag" not in client.get("/health").headers
