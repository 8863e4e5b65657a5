"""Catalogue, description, parts, download and zarr keys of the data sets, also of those that are damaged, unreadable,
replaced or written to while the service sends them.
"""

import asyncio
import base64
import hashlib
import io
import os
import zipfile

import numpy as np
import pytest
import xarray as xr
from rocking_api.app import create_app
from rocking_api.settings import Settings

from rocking._datasets.cube import read_dataset, write_dataset
from tests.api.conftest import NAMES, POINT, assert_problem, client_of, health_of
from tests.api.fuzzer import Sent, exchange
from tests.datasets.test_lookup_files import UNREADABLE, replaced

NAME, CURVES = "spectra/sine/eta-0.85", "overturning/sine/eta-0.85"
URL = f"/v1/datasets/{NAME}.nc"
FORMS = ("", ".nc", ".zarr/.zmetadata")


@pytest.fixture
def content(results):
    return (results / f"{NAME}.nc").read_bytes()


@pytest.fixture
def path(own_results):
    return own_results / f"{NAME}.nc"


def digest_of(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def other_of(path):
    """The bytes of another data set."""
    return (path.parents[1] / "cosine" / "eta-0.90.nc").read_bytes()


def test_catalogue_tells_digest_size_pulse_restitution_extent_and_links(client, results):
    listed = {entry["name"]: entry for entry in client.get("/v1/datasets").json()["datasets"]}
    assert {*listed} == NAMES
    for name, entry in listed.items():
        stored = (results / f"{name}.nc").read_bytes()
        assert (entry["sha256"], entry["size"]) == (digest_of(results / f"{name}.nc"), len(stored))
        assert client.get(entry["netcdf"]).content == stored
        assert client.get(entry["metadata"]).json()["name"] == name
        assert client.get(entry["zarr"] + "/.zmetadata").status_code == 200
    cube = listed[NAME]
    assert (cube["pulse"], cube["restitution"]) == ("sine", 0.85)
    assert "sine" in cube["title"]
    assert cube["extent"]["slenderness"] == pytest.approx([0.05, 0.95])
    assert cube["extent"]["frequency_ratio"] == pytest.approx([0.5, 12.0])
    assert [link["rel"] for link in cube["links"]] == ["self", "data", "version", "zarr", "subset"]
    for link in cube["links"]:
        address = link["href"] + ("/.zgroup" if link["rel"] == "zarr" else "")
        assert client.get(address).status_code == 200, link
    assert "subset" not in [link["rel"] for link in listed[CURVES]["links"]]
    described = client.get(f"/v1/datasets/{NAME}").json()
    assert described["dimensions"] == {"alpha": 1, "slenderness": 91, "frequency_ratio": 91}
    assert described["variables"]["peak_rotation"]["dimensions"] == ["alpha", "slenderness", "frequency_ratio"]
    assert described["variables"]["outcome"]["attributes"]["flag_values"] == [0, 1, 2, 3]
    assert described["coordinates"]["restitution"]["shape"] == []
    assert "CF-1.11" in described["attributes"]["Conventions"]


@pytest.mark.parametrize("key", ["datasets", "suites", "pulses"])
def test_lists_are_served_in_parts(client, key):
    whole = client.get(f"/v1/{key}").json()
    assert whole["next_cursor"] is None
    found, cursor = [], None
    while cursor or not found:
        query = {"limit": 2} | ({"cursor": cursor} if cursor else {})
        part = client.get(f"/v1/{key}", params=query).json()
        assert len(part[key]) <= 2
        found += part[key]
        cursor = part["next_cursor"]
    assert found == whole[key]


def test_the_archive_holds_every_sound_file_and_its_checksum(own_results):
    (own_results / f"{CURVES}.nc").write_bytes(b"no netCDF")
    with client_of(own_results) as client:
        response = client.get("/v1/datasets.zip", headers={"accept-encoding": "gzip"})
        assert client.get("/v1/datasets.zip").content == response.content
        damaged = next(one for one in client.get("/v1/datasets").json()["datasets"] if one["name"] == CURVES)
    assert (damaged["title"], damaged["pulse"], damaged["extent"]) == (CURVES, None, {})  # listed by its name alone
    assert response.headers["content-type"] == "application/zip"
    assert "content-encoding" not in response.headers
    with zipfile.ZipFile(io.BytesIO(response.content)) as found:
        assert found.testzip() is None
        lines = found.read("SHA256SUMS").decode().splitlines()
        listed = {name: digest for digest, name in (line.split("  ", 1) for line in lines)}
        assert {*found.namelist()} - {"SHA256SUMS"} == {*listed} == {f"{name}.nc" for name in NAMES - {CURVES}}
        for name, digest in listed.items():
            assert found.read(name) == (own_results / name).read_bytes()
            assert digest == digest_of(own_results / name)


def test_a_download_carries_its_digest_and_its_head_no_body(client, content):
    response, head = client.get(URL), client.head(URL)
    digest = hashlib.sha256(content)
    assert (response.content, head.content) == (content, b"")
    assert int(head.headers["content-length"]) == len(content)
    for headers in (response.headers, head.headers):
        assert headers["etag"] == f'"{digest.hexdigest()}"'
        assert headers["repr-digest"] == f"sha-256=:{base64.b64encode(digest.digest()).decode()}:"
        assert headers["accept-ranges"] == "bytes"
        assert headers["content-type"] == "application/x-netcdf"
        assert "spectra-sine-eta-0.85.nc" in headers["content-disposition"]
        assert "content-encoding" not in headers


def test_what_is_unchanged_is_not_sent_again(client, content):
    etag = client.get(URL).headers["etag"]
    for form in ("{}", "W/{}", '"other", {}', "*"):
        response = client.get(URL, headers={"if-none-match": form.format(etag)})
        assert (response.status_code, response.content, response.headers["etag"]) == (304, b"", etag)
    assert client.get(URL, headers={"if-none-match": '"other"'}).content == content


def test_ranges(client, content):
    for requested, part in (
        ("bytes=0-3", slice(0, 4)),
        ("bytes=100-199", slice(100, 200)),
        ("bytes=-7", slice(-7, None)),
        ("bytes=90000-", slice(90000, None)),
    ):
        response = client.get(URL, headers={"range": requested})
        assert (response.status_code, response.content) == (206, content[part])
        start = part.indices(len(content))[0]
        end = start + len(response.content) - 1
        assert response.headers["content-range"] == f"bytes {start}-{end}/{len(content)}"
    several = client.get(URL, headers={"range": "bytes=0-3,100-109"})
    assert several.status_code == 206
    assert several.headers["content-type"].startswith("multipart/byteranges")
    assert content[100:110] in several.content
    whole = client.get(URL)
    for condition, status in ((whole.headers["etag"], 206), ('"other"', 200), (whole.headers["last-modified"], 200)):
        response = client.get(URL, headers={"range": "bytes=0-3", "if-range": condition})
        assert (response.status_code, len(response.content)) == (status, 4 if status == 206 else len(content))
    outside = client.get(URL, headers={"range": f"bytes={len(content)}-"})
    assert assert_problem(outside, 416, "Range")["allowed"] == f"bytes 0 to {len(content) - 1}"
    assert outside.headers["content-range"] == f"bytes */{len(content)}"
    for requested in ("bytes=9-3", "lines=1-2", "nonsense"):
        assert assert_problem(client.get(URL, headers={"range": requested}), 400, "Range")["value"] == requested


def download(results, change, body=None, **headers):
    """The response to a download during which something changes after the head."""
    app = create_app(Settings(results=results))
    return asyncio.run(exchange(app, Sent("GET", URL, "", [*headers.items()], b"", False), change, body))


def test_what_is_sent_is_what_was_hashed(path, own_results):
    content, other, digest = path.read_bytes(), other_of(path), digest_of(path)
    assert download(own_results, lambda: path.with_name("link").hardlink_to(path)).body == content
    for part, ranges in ((slice(None), {}), (slice(100, 70001), {"range": "bytes=100-70000"})):
        got = download(own_results, lambda: replaced(path, other), **ranges)
        assert (got.status, got.body) == (206 if ranges else 200, content[part])
        assert got.headers["etag"] == f'"{digest}"'
        replaced(path, content)
    begun = io.BytesIO()
    with pytest.raises(RuntimeError, match="was written to while it was sent"):
        download(own_results, lambda: path.write_bytes(bytes(len(content))), begun)
    assert len(begun.getvalue()) < len(content)
    assert content.startswith(begun.getvalue())


def test_a_url_with_a_digest_yields_these_bytes_or_none(path, own_results):
    content, digest, status = path.read_bytes(), digest_of(path), path.stat()
    curves = own_results / f"{CURVES}.nc"
    with client_of(own_results) as client:
        listed = {one["name"]: one for one in client.get("/v1/datasets").json()["datasets"]}
        kept = client.get(listed[NAME]["version_url"])
        assert listed[NAME]["version_url"].endswith(f"?sha256={digest}")
        assert (kept.content, kept.headers["etag"]) == (content, f'"{digest}"')
        assert "immutable" in kept.headers["cache-control"]
        assert client.get(URL).headers["cache-control"] == "no-cache"
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
        old = client.get(f"/v1/datasets/{CURVES}.nc").headers["etag"]
        curves.write_bytes(content)
        gone = client.get(f"/v1/datasets/{CURVES}.nc", params={"sha256": old.strip('"')})
        assert digest in assert_problem(gone, 404)["detail"]
        assert client.get(f"/v1/datasets/{CURVES}.nc", headers={"if-none-match": old}).content == content


@pytest.mark.parametrize("make", UNREADABLE)
def test_an_unreadable_file_is_reported_and_others_are_served(path, own_results, monkeypatch, make):
    path.unlink()
    make(path, monkeypatch)
    with client_of(own_results) as client:
        health = health_of(client)
        assert "cannot be read" in health["problems"][NAME]
        assert str(own_results) not in str(health)
        assert client.get("/v1/response", params=POINT).json()["source"] == "solver"
        names = [entry["name"] for entry in client.get("/v1/datasets").json()["datasets"]]
        assert names == sorted(NAMES - {NAME})
        for form in FORMS:
            problem = assert_problem(client.get(f"/v1/datasets/{NAME}{form}"), 503)
            assert str(own_results) not in str(problem)
        assert_problem(client.get("/v1/response", params=POINT | {"method": "cube"}), 503)


SUBSET = f"/v1/datasets/{NAME}/subset"
RANGES = {"slenderness_min": 0.5, "slenderness_max": 0.6, "frequency_ratio_min": 2.0, "frequency_ratio_max": 3.0}


@pytest.fixture(scope="module")
def expected(results):
    cube = read_dataset(results / f"{NAME}.nc")
    return cube.sel(slenderness=slice(0.5 - 1e-9, 0.6 + 1e-9), frequency_ratio=slice(2.0, 3.0))


def test_netcdf_holds_the_nodes_within_the_ranges(client, expected):
    response = client.get(SUBSET, params=RANGES | {"variables": "peak_rotation,outcome"})
    assert response.headers["content-type"] == "application/x-netcdf"
    with xr.open_dataset(io.BytesIO(response.content)) as part:
        assert set(part.data_vars) == {"peak_rotation", "outcome"}
        for name in ("slenderness", "frequency_ratio", "alpha", "peak_rotation", "outcome"):
            np.testing.assert_array_equal(part[name], expected[name])
        assert part.attrs["source_sha256"] == client.get(f"/v1/datasets/{NAME}").json()["sha256"]
        assert part["peak_rotation"].attrs["long_name"] == expected["peak_rotation"].attrs["long_name"]


@pytest.mark.parametrize(
    ("params", "name", "value", "allowed"),
    [
        ({"alpha_deg_min": 30.5}, "alpha_deg_min", 30.5, "a range with nodes; they span 0 to 30 deg"),
        ({"alpha_deg_max": -1}, "alpha_deg_max", -1.0, "a range with nodes; they span 0 to 30 deg"),
        ({"alpha_deg_min": 12, "alpha_deg_max": 7}, "alpha_deg_max", 7.0, "at least alpha_deg_min, 12"),
        ({"slenderness_min": "inf"}, "slenderness_min", "inf", "a range with nodes; they span 0.05 to 0.95"),
        ({"slenderness_min": 0.501, "slenderness_max": 0.502}, "slenderness_min", 0.501,
         "a range with nodes up to slenderness_max, 0.502; they span 0.05 to 0.95"),
    ],
)  # fmt: skip
def test_a_range_without_nodes_is_named_by_its_parameter_in_its_unit(own_results, params, name, value, allowed):
    path = own_results / f"{NAME}.nc"
    cube = read_dataset(path)
    parts = [cube.assign_coords(alpha=[np.radians(degrees)]) for degrees in (0.0, 10.0, 30.0)]
    path.unlink()
    write_dataset(xr.concat(parts, "alpha", data_vars="minimal"), path)
    with client_of(own_results) as client:
        problem = assert_problem(client.get(SUBSET, params=params), 422, name)
        part = client.get(SUBSET, params=RANGES | {"alpha_deg_min": 30, "format": "csv"}).text
    assert (problem["value"], problem["allowed"]) == (value, allowed)
    assert part.count(f"\n{np.radians(30.0)},") == part.count("\n") - 1 > 0
