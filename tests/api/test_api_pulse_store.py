"""Data sets, and the cubes of a pulse as one zarr store over the restitution, read over HTTP from a real server."""

import re
import shutil

import httpx2
import numpy as np
import pytest
import xarray as xr

from rocking._datasets.cube import read_dataset, write_dataset
from rocking._spectra.cubes import spectra, spectrum
from tests.api.conftest import POINT, assert_problem, client_of
from tests.api.servers import serving

ETAS = [0.80, 0.85, 0.90]
GRID = {"slenderness": np.linspace(0.2, 0.9, 12), "frequency_ratio": np.geomspace(1.0, 8.0, 10), "alpha": [0.0, 0.2]}
URL = "/v1/datasets/spectra/sine.zarr"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Cubes of the sine on one grid, and two that do not belong to them: one on another grid, one damaged."""
    folder = tmp_path_factory.mktemp("pulse-store")
    for eta, cube in zip(ETAS, spectra("sine", restitution=ETAS, **GRID), strict=True):
        write_dataset(cube, folder / f"spectra/sine/eta-{eta:.2f}.nc", chunks={"alpha": 1})
    other = spectrum("sine", restitution=0.70, **GRID | {"slenderness": np.linspace(0.3, 0.9, 12)})
    write_dataset(other, folder / "spectra/sine/eta-0.70.nc")
    content = (folder / "spectra/sine/eta-0.80.nc").read_bytes()
    (folder / "spectra/sine/eta-0.95.nc").write_bytes(content[:2000] + bytes(100) + content[2100:])
    return folder


@pytest.fixture(scope="module")
def server(folder, tmp_path_factory):
    """Two separate processes, which end well: the netCDF library holds the interpreter while it reads from a URL."""
    with serving(folder, tmp_path_factory.mktemp("serve") / "log", workers=2) as server:
        yield server
        assert server.stop(120) == 0
        assert "Traceback" not in server.log.read_text()


@pytest.fixture(scope="module")
def cubes(folder):
    return [read_dataset(folder / f"spectra/sine/eta-{eta:.2f}.nc") for eta in ETAS]


@pytest.mark.parametrize(("suffix", "engine"), [(".nc#mode=bytes", "netcdf4"), (".nc", "h5netcdf"), (".zarr", "zarr")])
def test_xarray_opens_a_data_set_over_http(server, folder, suffix, engine):
    """The bits are those of the file."""
    name, corner = "spectra/sine/eta-0.85", {"slenderness": slice(3, 9), "frequency_ratio": slice(4, 6)}
    stored = read_dataset(folder / f"{name}.nc")
    with xr.open_dataset(f"{server.address}/v1/datasets/{name}{suffix}", engine=engine) as remote:
        # JSON, in which zarr keeps attributes, has no nan
        without = {name for name, value in stored.attrs.items() if engine == "zarr" and np.any(value != value)}
        assert set(remote.attrs) == set(stored.attrs) - without
        part = remote.isel(corner).load()
        for name in stored.variables:
            ours = stored.isel(corner)[name].values
            assert part[name].dtype == ours.dtype
            assert part[name].values.tobytes() == ours.tobytes(), name
        whole = remote["peak_rotation"].values
    np.testing.assert_array_equal(whole, stored["peak_rotation"].values)


def test_the_store_holds_every_value_of_the_cubes(server, cubes):
    with xr.open_zarr(server.address + URL) as store:
        assert store.sizes == {"restitution": 3, "alpha": 2, "slenderness": 12, "frequency_ratio": 10}
        assert store.restitution.values.tolist() == ETAS
        assert set(store.attrs["left_out"].split()) == {"spectra/sine/eta-0.70", "spectra/sine/eta-0.95"}
        assert store.attrs["Conventions"] == cubes[0].attrs["Conventions"]
        assert set(store.variables) == set(cubes[0].variables)
        for eta, cube in zip(ETAS, cubes, strict=True):
            part = store.sel(restitution=eta).load()
            for name, values in cube.variables.items():
                assert part[name].dtype == values.dtype
                assert part[name].dims == values.dims
                np.testing.assert_array_equal(part[name].values, values.values, err_msg=f"{name} {eta}")
            assert part.peak_rotation.attrs["units"] == "1"


def test_several_workers_are_one_service(server):
    found = httpx2.get(f"{server.address}/v1/response", params=POINT | {"method": "solver"}, timeout=120)
    assert found.json()["outcome"]
    for _ in range(9):  # whichever of them answers
        metrics = httpx2.get(f"{server.address}/metrics", timeout=120).text
        assert 'rocking_points_total{source="solver"} 1.0' in metrics


def test_one_restitution_downloads_its_chunks_only(server, cubes):
    with xr.open_zarr(server.address + URL) as store:
        before = server.log.read_text()
        found = store.peak_rotation.sel(restitution=0.85, alpha=0.2).load()
    np.testing.assert_array_equal(found.values, cubes[1].peak_rotation.sel(alpha=0.2).values)
    asked = re.findall(rf"{URL}/(\w+/\d+\.[.\d]*)", server.log.read_text().removeprefix(before))
    assert asked == ["peak_rotation/1.1.0.0"]


def test_a_chunk_has_the_version_of_its_cube(own_pulse):
    with client_of(own_pulse) as client:
        chunk, metadata = (client.get(f"{URL}/{key}") for key in ("peak_rotation/0.0.0.0", ".zmetadata"))
        file = client.get("/v1/datasets/spectra/sine/eta-0.80.nc")
        assert chunk.headers["etag"] == file.headers["etag"]
        assert chunk.headers["cache-control"] == metadata.headers["cache-control"] == "no-cache"
        (own_pulse / "spectra/sine/eta-0.90.nc").unlink()
        for key, old, status in (("peak_rotation/0.0.0.0", chunk, 304), (".zmetadata", metadata, 200)):
            again = client.get(f"{URL}/{key}", headers={"if-none-match": old.headers["etag"]})
            assert again.status_code == status, key
        assert_problem(client.get(f"{URL}/peak_rotation/2.0.0.0"), 404)
        write_dataset(spectrum("sine", restitution=0.80, **GRID).assign(impacts=lambda cube: cube.impacts + 1),
                      own_pulse / "spectra/sine/eta-0.80.nc")  # fmt: skip
        replaced = client.get(f"{URL}/impacts/0.0.0.0")
        assert replaced.headers["etag"] != chunk.headers["etag"]


@pytest.fixture
def own_pulse(folder, tmp_path):
    """A copy that a test may change."""
    return shutil.copytree(folder, tmp_path / "own")


OTHER_KEYS = [
    *("", "peak_rotation", "none/0.0.0.0", "alpha/1", "restitution/9"),
    *(f"peak_rotation/{key}" for key in ("", "0.0.0", "3.0.0.0", "0.2.0.0", "-1.0.0.0", "\u0661.0.0.0", ".zarray/0")),
    "peak_rotation/" + "9" * 5000 + ".0.0.0",
]


def test_without_a_sound_cube_there_is_no_store(own_pulse):
    with client_of(own_pulse) as client:
        assert_problem(client.get("/v1/datasets/spectra/none.zarr/.zmetadata"), 404)
        for path in (own_pulse / "spectra/sine").iterdir():
            path.write_bytes(b"damaged")
        assert "no cube can be read" in assert_problem(client.get(f"{URL}/.zmetadata"), 503)["detail"]


def test_the_catalogue_lists_the_stores_and_other_keys_are_404(folder):
    with client_of(folder) as client:
        for key in OTHER_KEYS:
            assert_problem(client.get(f"{URL}/{key}"), 404)
        (listed,) = client.get("/v1/datasets").json()["pulses"]
    assert listed == {"name": "spectra/sine", "restitution": [0.70, *ETAS], "zarr": URL}
