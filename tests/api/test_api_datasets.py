"""Catalogue, description, download and zarr keys of the data sets."""

import base64
import hashlib
import io
import zipfile

import pytest

from tests.api.conftest import NAMES, assert_problem, client_of

NAME = "spectra/sine/eta-0.85"
URL = f"/v1/datasets/{NAME}.nc"


@pytest.fixture
def content(results):
    return (results / f"{NAME}.nc").read_bytes()


def test_catalogue_lists_every_file_with_its_digest(client, results):
    listed = client.get("/v1/datasets").json()["datasets"]
    assert {entry["name"] for entry in listed} == NAMES
    for entry in listed:
        stored = (results / f"{entry['name']}.nc").read_bytes()
        assert entry["sha256"] == hashlib.sha256(stored).hexdigest()
        assert entry["size"] == len(stored)
        assert client.get(entry["netcdf"]).content == stored
        assert client.get(entry["metadata"]).json()["name"] == entry["name"]
        assert client.get(entry["zarr"] + "/.zmetadata").status_code == 200


@pytest.mark.parametrize(("path", "key"), [("datasets", "datasets"), ("suites", "suites"), ("pulses", "pulses")])
def test_lists_are_served_in_parts(client, path, key):
    whole = client.get(f"/v1/{path}").json()
    assert whole["next_cursor"] is None
    found, cursor = [], None
    while cursor or not found:
        query = {"limit": 2} | ({"cursor": cursor} if cursor else {})
        part = client.get(f"/v1/{path}", params=query).json()
        assert len(part[key]) <= 2
        found += part[key]
        cursor = part["next_cursor"]
    assert found == whole[key]
    assert_problem(client.get(f"/v1/{path}", params={"limit": 0}), 422, "limit")


def test_catalogue_tells_pulse_restitution_extent_and_links(client, own_results):
    listed = {entry["name"]: entry for entry in client.get("/v1/datasets").json()["datasets"]}
    cube = listed[NAME]
    assert (cube["pulse"], cube["restitution"]) == ("sine", 0.85)
    assert "sine" in cube["title"]
    assert cube["extent"]["slenderness"] == pytest.approx([0.05, 0.95])
    assert cube["extent"]["frequency_ratio"] == pytest.approx([0.5, 12.0])
    assert [link["rel"] for link in cube["links"]] == ["self", "data", "version", "zarr", "subset"]
    for link in cube["links"]:
        path = link["href"] + ("/.zgroup" if link["rel"] == "zarr" else "")
        assert client.get(path).status_code == 200, link
    assert "subset" not in [link["rel"] for link in listed["overturning/sine/eta-0.85"]["links"]]
    (own_results / f"{NAME}.nc").write_bytes(b"no netCDF")
    with client_of(own_results) as other:  # a damaged file is listed by its name alone
        damaged = next(one for one in other.get("/v1/datasets").json()["datasets"] if one["name"] == NAME)
    assert (damaged["title"], damaged["pulse"], damaged["extent"]) == (NAME, None, {})


def test_description_lists_dimensions_variables_and_attributes(client):
    described = client.get(f"/v1/datasets/{NAME}").json()
    assert described["dimensions"] == {"alpha": 1, "slenderness": 91, "frequency_ratio": 91}
    assert described["variables"]["peak_rotation"]["dimensions"] == ["alpha", "slenderness", "frequency_ratio"]
    assert described["variables"]["outcome"]["attributes"]["flag_values"] == [0, 1, 2, 3]
    assert described["coordinates"]["restitution"]["shape"] == []
    assert "CF-1.11" in described["attributes"]["Conventions"]


def test_the_archive_holds_every_sound_file_and_its_checksum(own_results):
    (own_results / "overturning/sine/eta-0.85.nc").write_bytes(b"no netCDF")
    sound = NAMES - {"overturning/sine/eta-0.85"}
    with client_of(own_results) as client:
        response = client.get("/v1/datasets.zip", headers={"accept-encoding": "gzip"})
        assert client.get("/v1/datasets.zip").content == response.content
    assert response.headers["content-type"] == "application/zip"
    assert "content-encoding" not in response.headers
    with zipfile.ZipFile(io.BytesIO(response.content)) as found:
        assert found.testzip() is None
        lines = found.read("SHA256SUMS").decode().splitlines()
        listed = {name: digest for digest, name in (line.split("  ", 1) for line in lines)}
        assert set(found.namelist()) - {"SHA256SUMS"} == set(listed) == {f"{name}.nc" for name in sound}
        for name, digest in listed.items():
            stored = (own_results / name).read_bytes()
            assert found.read(name) == stored
            assert digest == hashlib.sha256(stored).hexdigest()


def test_download_carries_its_digest(client, content):
    response = client.get(URL)
    digest = hashlib.sha256(content)
    assert response.content == content
    assert response.headers["etag"] == f'"{digest.hexdigest()}"'
    assert response.headers["repr-digest"] == f"sha-256=:{base64.b64encode(digest.digest()).decode()}:"
    assert response.headers["accept-ranges"] == "bytes"
    assert response.headers["content-type"] == "application/x-netcdf"
    assert "spectra-sine-eta-0.85.nc" in response.headers["content-disposition"]
    assert "content-encoding" not in response.headers


def test_head_has_the_headers_and_no_body(client, content):
    response = client.head(URL)
    assert response.status_code == 200
    assert response.content == b""
    assert int(response.headers["content-length"]) == len(content)
    assert response.headers["etag"] == client.get(URL).headers["etag"]


@pytest.mark.parametrize("form", ["{}", "W/{}", '"other", {}', "*"])
def test_unchanged_is_304(client, form):
    etag = client.get(URL).headers["etag"]
    response = client.get(URL, headers={"if-none-match": form.format(etag)})
    assert response.status_code == 304
    assert response.content == b""
    assert response.headers["etag"] == etag


def test_changed_is_sent(client, content):
    assert client.get(URL, headers={"if-none-match": '"other"'}).content == content


@pytest.mark.parametrize(
    ("requested", "part"),
    [("bytes=0-3", slice(0, 4)), ("bytes=100-199", slice(100, 200)), ("bytes=-7", slice(-7, None)),
     ("bytes=90000-", slice(90000, None))],
)  # fmt: skip
def test_range_is_206(client, content, requested, part):
    response = client.get(URL, headers={"range": requested})
    assert response.status_code == 206
    assert response.content == content[part]
    start = part.indices(len(content))[0]
    assert response.headers["content-range"] == f"bytes {start}-{start + len(response.content) - 1}/{len(content)}"


def test_several_ranges_come_as_parts(client, content):
    response = client.get(URL, headers={"range": "bytes=0-3,100-109"})
    assert response.status_code == 206
    assert response.headers["content-type"].startswith("multipart/byteranges")
    assert content[100:110] in response.content


def test_range_of_another_version_sends_the_whole(client, content):
    etag = client.get(URL).headers["etag"]
    assert client.get(URL, headers={"range": "bytes=0-3", "if-range": etag}).status_code == 206
    assert client.get(URL, headers={"range": "bytes=0-3", "if-range": '"other"'}).content == content


def test_range_outside_is_416(client, content):
    response = client.get(URL, headers={"range": f"bytes={len(content)}-"})
    assert_problem(response, 416, "Range")
    assert response.headers["content-range"] == f"bytes */{len(content)}"


@pytest.mark.parametrize("requested", ["bytes=9-3", "lines=1-2", "nonsense"])
def test_malformed_range_is_400(client, requested):
    assert_problem(client.get(URL, headers={"range": requested}), 400, "Range")


def test_zarr_keys_are_cached_by_the_same_etag(client):
    response = client.get(f"/v1/datasets/{NAME}.zarr/peak_rotation/0.0.0")
    assert response.headers["content-type"] == "application/octet-stream"
    again = client.get(
        f"/v1/datasets/{NAME}.zarr/peak_rotation/0.0.0", headers={"if-none-match": response.headers["etag"]}
    )
    assert again.status_code == 304


def test_a_damaged_file_is_refused(own_results):
    path = own_results / f"{NAME}.nc"
    content = bytearray(path.read_bytes())
    content[len(content) // 2 :] = bytes(len(content) - len(content) // 2)
    path.write_bytes(content)
    with client_of(own_results) as client:
        for suffix in ("", ".nc", ".zarr/.zmetadata"):
            problem = assert_problem(client.get(f"/v1/datasets/{NAME}{suffix}"), 503)
            assert "damaged" in problem["detail"]


def test_a_replaced_file_is_served_as_a_new_version(own_results):
    with client_of(own_results) as client:
        curves = own_results / "overturning" / "sine" / "eta-0.85.nc"
        old = client.get("/v1/datasets/overturning/sine/eta-0.85.nc").headers["etag"]
        curves.write_bytes((own_results / f"{NAME}.nc").read_bytes())
        again = client.get("/v1/datasets/overturning/sine/eta-0.85.nc", headers={"if-none-match": old})
        assert again.content == curves.read_bytes()
