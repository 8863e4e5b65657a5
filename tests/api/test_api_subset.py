"""GET /v1/datasets/{name}/subset: a part of a cube by its axes."""

import io

import numpy as np
import pytest
import xarray as xr

from rocking._datasets.cube import read_dataset, write_dataset
from tests.api.conftest import assert_problem, client_of

NAME = "spectra/sine/eta-0.85"
URL = f"/v1/datasets/{NAME}/subset"
RANGES = {"slenderness_min": 0.5, "slenderness_max": 0.6, "frequency_ratio_min": 2.0, "frequency_ratio_max": 3.0}


@pytest.fixture(scope="module")
def expected(results):
    cube = read_dataset(results / f"{NAME}.nc")
    return cube.sel(slenderness=slice(0.5 - 1e-9, 0.6 + 1e-9), frequency_ratio=slice(2.0, 3.0))


def test_netcdf_holds_the_nodes_within_the_ranges(client, expected):
    response = client.get(URL, params=RANGES | {"variables": "peak_rotation,outcome"})
    assert response.headers["content-type"] == "application/x-netcdf"
    with xr.open_dataset(io.BytesIO(response.content)) as part:
        assert set(part.data_vars) == {"peak_rotation", "outcome"}
        for name in ("slenderness", "frequency_ratio", "alpha", "peak_rotation", "outcome"):
            np.testing.assert_array_equal(part[name], expected[name])
        assert part.attrs["source_sha256"] == client.get(f"/v1/datasets/{NAME}").json()["sha256"]
        assert part["peak_rotation"].attrs["long_name"] == expected["peak_rotation"].attrs["long_name"]


def test_csv_has_a_row_for_each_node(client, expected):
    lines = client.get(URL, params=RANGES | {"format": "csv"}).text.splitlines()
    assert lines[0] == "alpha,slenderness,frequency_ratio,peak_rotation,outcome,impacts,exceeded_alpha"
    assert len(lines) - 1 == expected["outcome"].size
    peaks = [float(line.split(",")[3] or "nan") for line in lines[1:]]
    np.testing.assert_array_equal(peaks, expected["peak_rotation"].values.ravel())


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
        problem = assert_problem(client.get(URL, params=params), 422, name)
        part = client.get(URL, params=RANGES | {"alpha_deg_min": 30, "format": "csv"}).text
    assert (problem["value"], problem["allowed"]) == (value, allowed)
    assert part.count(f"\n{np.radians(30.0)},") == part.count("\n") - 1 > 0
