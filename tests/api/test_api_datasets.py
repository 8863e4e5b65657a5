"""Catalogue, description, parts, download and zarr stores of the data sets, also of those that are damaged or
unreadable.
"""

import hashlib
import io

import numpy as np
import pytest
import xarray as xr
import zarr

from rocking._datasets.cube import read_dataset, write_dataset
from tests.api.conftest import NAMES, POINT, assert_problem, client_of, health_of
from tests.datasets.test_lookup_files import UNREADABLE

NAME, CURVES = "spectra/sine/eta-0.85", "overturning/sine/eta-0.85"
URL = f"/v1/datasets/{NAME}.nc"
STORE = "/v1/datasets/spectra/sine.zarr"
FORMS = ("", ".nc")


@pytest.fixture
def content(results):
    return (results / f"{NAME}.nc").read_bytes()


@pytest.fixture
def path(own_results):
    return own_results / f"{NAME}.nc"


def test_catalogue_tells_digest_size_pulse_restitution_extent_and_links(client, results):
    health_of(client)  # every file is read by now
    catalogue = client.get("/v1/datasets").json()
    listed = {entry["name"]: entry for entry in catalogue["datasets"]}
    assert {*listed} == NAMES
    for name, entry in listed.items():
        stored = (results / f"{name}.nc").read_bytes()
        assert (entry["sha256"], entry["size"]) == (hashlib.sha256(stored).hexdigest(), len(stored))
        assert client.get(entry["netcdf"]).content == stored
        assert client.get(entry["metadata"]).json()["name"] == name
    cube = listed[NAME]
    assert (cube["pulse"], cube["restitution"]) == ("sine", 0.85)
    assert "sine" in cube["title"]
    assert cube["extent"]["slenderness"] == pytest.approx([0.05, 0.95])
    assert cube["extent"]["frequency_ratio"] == pytest.approx([0.5, 12.0])
    assert [link["rel"] for link in cube["links"]] == ["self", "data", "subset"]
    for link in cube["links"]:
        assert client.get(link["href"]).status_code == 200, link
    assert "subset" not in [link["rel"] for link in listed[CURVES]["links"]]
    assert catalogue["pulses"] == [{"name": "sine", "zarr": STORE}]
    described = client.get(f"/v1/datasets/{NAME}").json()
    assert described["dimensions"] == {"alpha": 1, "slenderness": 91, "frequency_ratio": 91}
    assert described["variables"]["peak_rotation"]["dimensions"] == ["alpha", "slenderness", "frequency_ratio"]
    assert described["variables"]["outcome"]["attributes"]["flag_values"] == [0, 1, 2, 3]
    assert described["coordinates"]["restitution"]["shape"] == []
    assert "CF-1.11" in described["attributes"]["Conventions"]


def test_no_checksum_is_made_for_the_catalogue(own_results):
    with client_of(own_results) as client:
        health_of(client)  # ends the check of all files, which makes checksums
        client.app.state.service.cubes.catalogue._products.forget(NAME)
        listed = {entry["name"]: entry for entry in client.get("/v1/datasets").json()["datasets"]}
    assert listed[NAME]["sha256"] is None


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


def test_a_download_has_the_time_of_its_file_and_its_head_no_body(client, content):
    response, head = client.get(URL), client.head(URL)
    assert (response.content, head.content) == (content, b"")
    for headers in (response.headers, head.headers):
        assert int(headers["content-length"]) == len(content)
        assert headers["accept-ranges"] == "bytes"
        assert headers["content-type"] == "application/x-netcdf"
        assert "content-encoding" not in headers
        assert "1970" not in headers["last-modified"]
    unchanged = client.get(URL, headers={"if-none-match": response.headers["etag"]})
    assert (unchanged.status_code, unchanged.content) == (304, b"")
    assert client.get(URL, headers={"if-none-match": '"other"'}).content == content


def test_ranges(client, content):
    for requested, part in (
        ("bytes=0-3", slice(0, 4)),
        ("bytes=100-199", slice(100, 200)),
        ("bytes=-7", slice(-7, None)),
    ):
        response = client.get(URL, headers={"range": requested})
        assert (response.status_code, response.content) == (206, content[part])
    for other in ("items=0-1", "lines=1-2"):  # a unit that is not known is ignored (RFC 9110, 14.2)
        response = client.get(URL, headers={"range": other})
        assert (response.status_code, response.content) == (200, content)
    outside = client.get(URL, headers={"range": f"bytes={len(content)}-"})
    assert (outside.status_code, outside.headers["content-range"]) == (416, f"bytes */{len(content)}")


@pytest.mark.parametrize("name", ["spectra/sine/eta-0.86", "spectra/../secret", "spectra/.hidden", "manifest"])
def test_what_is_no_data_set_is_not_found(client, name):
    assert_problem(client.get(f"/v1/datasets/{name}.nc"), 404)
    assert_problem(client.get(f"/v1/datasets/{name}"), 404)


def test_the_zarr_store_of_a_pulse_is_served_as_it_is(client, results):
    whole = client.get(f"{STORE}/.zmetadata").json()["metadata"]
    assert "peak_rotation/.zarray" in whole
    keys = {key: client.get(f"{STORE}/{key}").content for key in (*whole, ".zmetadata", "peak_rotation/0.0.0.0")}
    assert all(value == (results / "zarr" / "sine.zarr" / key).read_bytes() for key, value in keys.items())
    assert client.get(f"{STORE}/peak_rotation/0.0.0.0").headers["etag"]
    for key in ("none", "%2e%2e/%2e%2e/spectra/sine/eta-0.85.nc", "..%2f..%2fmanifest.json"):
        assert_problem(client.get(f"{STORE}/{key}"), 404)
    assert zarr.open_group(str(results / "zarr" / "sine.zarr"), mode="r")["restitution"][:].tolist() == [0.85]


def test_a_damaged_file_is_listed_by_its_name_alone(own_results):
    (own_results / f"{CURVES}.nc").write_bytes(b"no netCDF")
    with client_of(own_results) as client:
        damaged = next(one for one in client.get("/v1/datasets").json()["datasets"] if one["name"] == CURVES)
    assert (damaged["title"], damaged["pulse"], damaged["extent"]["slenderness"]) == (CURVES, None, None)


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
