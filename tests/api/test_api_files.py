"""Data sets that are replaced, written to or unreadable while the service sends them."""

import asyncio
import hashlib
import os

import pytest
from rocking_api.app import create_app
from rocking_api.settings import Settings

from tests.api.conftest import NAMES, assert_problem, client_of
from tests.datasets.test_lookup_files import UNREADABLE, folder_forbidden, folder_loop, replaced

NAME = "spectra/sine/eta-0.85"
URL = f"/v1/datasets/{NAME}.nc"
POINT = {"pulse": "sine", "slenderness": 0.6, "frequency_ratio": 6.0, "restitution": 0.85}


@pytest.fixture
def path(own_results):
    return own_results / f"{NAME}.nc"


def other_of(path):
    """The bytes of another data set."""
    return (path.parents[1] / "cosine" / "eta-0.90.nc").read_bytes()


def download(results, change, **headers):
    """Status, headers and body of a download during which something changes after the head."""

    async def scenario():
        app = create_app(Settings(results=results))
        scope = {
            "type": "http",
            "method": "GET",
            "path": URL,
            "raw_path": URL.encode(),
            "query_string": b"",
            "http_version": "1.1",
            "headers": [(name.encode(), value.encode()) for name, value in {"host": "a", **headers}.items()],
        }
        status, received, body = 0, {}, b""

        async def receive():
            await asyncio.sleep(3600)

        async def send(message):
            nonlocal status, received, body
            if message["type"] == "http.response.start":
                status, received = message["status"], dict(message["headers"])
                change()
            else:
                body += message.get("body", b"")

        try:
            await app(scope, receive, send)
        except RuntimeError as error:
            return status, received, body, str(error)
        return status, received, body, None

    return asyncio.run(scenario())


def test_what_is_sent_is_what_was_hashed(path, own_results):
    content, other = path.read_bytes(), other_of(path)
    status, headers, body, broken = download(own_results, lambda: replaced(path, other))
    assert (status, broken) == (200, None)
    assert body == content
    assert headers[b"etag"] == f'"{hashlib.sha256(content).hexdigest()}"'.encode()


def test_ranges_are_of_what_was_hashed(path, own_results):
    content, other = path.read_bytes(), other_of(path)
    status, _, body, broken = download(own_results, lambda: replaced(path, other), range="bytes=100-70000")
    assert (status, broken) == (206, None)
    assert body == content[100:70001]


def test_the_download_of_a_file_that_is_written_to_is_aborted(path, own_results):
    content = path.read_bytes()
    changed = bytes(len(content))
    _, _, body, broken = download(own_results, lambda: path.write_bytes(changed))
    assert "was written to while it was sent" in broken
    assert len(body) < len(content)
    assert content.startswith(body)


def test_renaming_or_linking_a_file_does_not_abort_its_download(path, own_results):
    content = path.read_bytes()
    _, _, body, broken = download(own_results, lambda: path.with_name("link").hardlink_to(path))
    assert (body, broken) == (content, None)


def test_a_url_with_a_digest_yields_these_bytes_or_none(path, own_results):
    content = path.read_bytes()
    digest = hashlib.sha256(content).hexdigest()
    status = path.stat()
    with client_of(own_results) as client:
        assert client.get(URL, params={"sha256": digest}).content == content
        with path.open("r+b") as file:
            file.write(bytes(100))
        os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))
        assert path.stat().st_size == status.st_size
        assert_problem(client.get(URL, params={"sha256": digest}), 503)  # damaged, which is detected too
        path.write_bytes(other_of(path))
        # a whole file, but of another version
        assert_problem(client.get(URL, params={"sha256": digest}), 503)
        path.write_bytes(content)
        assert client.get(URL, params={"sha256": digest}).content == content
        curves = own_results / "overturning" / "sine" / "eta-0.85.nc"
        digest = hashlib.sha256(curves.read_bytes()).hexdigest()
        curves.write_bytes(content)
        assert_problem(client.get("/v1/datasets/overturning/sine/eta-0.85.nc", params={"sha256": digest}), 404)


def test_a_date_is_no_condition_for_a_range(client):
    whole = client.get(URL)
    dated = client.get(URL, headers={"range": "bytes=0-3", "if-range": whole.headers["last-modified"]})
    assert (dated.status_code, dated.content) == (200, whole.content)


def degraded_health(client):
    """`/health` once all data sets are checked; some are damaged or cannot be read."""
    for _ in range(100):
        health = client.get("/health")
        if health.json()["problems"] and not health.json()["unchecked"]:
            break
    assert health.json()["status"] == "degraded"
    return health


@pytest.mark.parametrize("make", UNREADABLE)
def test_an_unreadable_file_is_reported_and_others_are_served(path, own_results, monkeypatch, make):
    path.unlink()
    make(path, monkeypatch)
    with client_of(own_results) as client:
        health = degraded_health(client)
        assert "cannot be read" in health.json()["problems"][NAME]
        assert str(own_results) not in health.text
        assert client.get("/v1/response", params=POINT).json()["source"] == "solver"
        names = [entry["name"] for entry in client.get("/v1/datasets").json()["datasets"]]
        assert names == sorted(NAMES - {NAME})
        for suffix in ("", ".nc", ".zarr/.zmetadata"):
            problem = assert_problem(client.get(f"/v1/datasets/{NAME}{suffix}"), 503)
            assert str(own_results) not in str(problem)
        assert_problem(client.get("/v1/response", params=POINT | {"method": "cube"}), 503)


@pytest.mark.parametrize("make", [folder_loop, folder_forbidden])
def test_an_unreadable_folder_is_reported_and_others_are_served(path, own_results, monkeypatch, make):
    path.unlink()
    path.parent.rmdir()
    make(path.parent, monkeypatch)
    with client_of(own_results) as client:
        assert "cannot be read" in degraded_health(client).json()["problems"]["spectra/sine"]
        assert len(client.get("/v1/datasets").json()["datasets"]) == len(NAMES - {NAME})
        assert client.get("/v1/response", params=POINT).json()["source"] == "solver"


def test_boundary_curves_that_cannot_be_read_are_traced(own_results):
    path = own_results / "overturning" / "sine" / "eta-0.85.nc"
    path.unlink()
    path.symlink_to(path)
    with client_of(own_results) as client:
        response = client.get("/v1/overturning", params={"pulse": "sine", "restitution": 0.85})
        assert response.json()["source"] == "solver"


def test_health_shows_no_path(tmp_path, own_results, path):
    path.write_bytes(b"damaged")
    for results in (tmp_path / "none", own_results):
        with client_of(results) as client:
            health = degraded_health(client)
            assert str(tmp_path) not in health.text
