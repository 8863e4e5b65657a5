"""GET /v1/map: values, formats, limits and caching."""

import csv
import io

import numpy as np
import pytest
import xarray as xr

from rocking._model.response import Outcome
from rocking._solver.peak_response import peak_response
from tests.api.conftest import assert_problem, client_of

WINDOW = {"frequency_ratio_min": 0.7, "frequency_ratio_max": 9.0, "slenderness_min": 0.1, "slenderness_max": 1.1}
QUERY = {"pulse": "cosine", "restitution": 0.9, "alpha_deg": 14.0, "columns": 21, "rows": 12} | WINDOW


@pytest.fixture(scope="module")
def expected():
    return peak_response(
        "cosine",
        slenderness=np.linspace(0.1, 1.1, 12)[:, None],
        frequency_ratio=np.geomspace(0.7, 9.0, 21),
        restitution=0.9,
        alpha=np.radians(14.0),
    )


def test_rows_equal_peak_response(client, expected):
    result = client.get("/v1/map", params=QUERY).json()
    assert {Outcome.NO_UPLIFT, Outcome.RECOVERS, Outcome.OVERTURNED_DIRECTLY} <= set(expected.outcome.ravel().tolist())
    assert [Outcome[result["outcomes"][code]] for code in result["outcome"]] == expected.outcome.ravel().tolist()
    peaks = np.array([np.nan if peak is None else peak for peak in result["peak_rotation"]])
    np.testing.assert_allclose(peaks, expected.peak_rotation.ravel(), rtol=0, atol=0.5001e-4)
    assert len(result["frequency_ratio"]) == 21
    assert (result["slenderness"][0], result["slenderness"][-1]) == (0.1, 1.1)


def test_csv_and_netcdf_hold_every_digit(client, expected):
    rows = list(csv.DictReader(io.StringIO(client.get("/v1/map", params=QUERY | {"format": "csv"}).text)))
    written = [float(row["peak_rotation"]) if row["peak_rotation"] else np.nan for row in rows]
    np.testing.assert_array_equal(written, expected.peak_rotation.ravel())
    assert [int(row["impacts"]) for row in rows] == expected.impacts.ravel().tolist()
    content = client.get("/v1/map", params=QUERY | {"format": "nc"}).content
    stored = xr.open_dataset(io.BytesIO(content), engine="scipy").load()
    assert stored["peak_rotation"].dims == ("slenderness", "frequency_ratio")
    np.testing.assert_array_equal(stored["peak_rotation"], expected.peak_rotation)
    np.testing.assert_array_equal(stored["outcome"], expected.outcome)
    assert float(stored["slenderness"][3]) == float(rows[3 * 21]["slenderness"])
    assert stored.attrs["restitution"] == 0.9


def test_an_unchanged_map_is_304(client):
    first = client.get("/v1/map", params=QUERY)
    assert "max-age" in first.headers["cache-control"]
    known = {"if-none-match": first.headers["etag"]}
    again = client.get("/v1/map", params=QUERY, headers=known)
    assert (again.status_code, again.content, again.headers["etag"]) == (304, b"", first.headers["etag"])
    other = client.get("/v1/map", params=QUERY | {"restitution": 0.8}, headers=known)
    assert other.status_code == 200
    assert other.headers["etag"] != first.headers["etag"]


def test_the_grid_is_bounded(tmp_path):
    with client_of(tmp_path, max_samples=200) as small:
        assert small.get("/v1/map", params=QUERY | {"columns": 20, "rows": 10}).status_code == 200
        assert_problem(small.get("/v1/map", params=QUERY | {"columns": 20, "rows": 11}), 413, "columns")
        assert_problem(small.get("/v1/map", params=QUERY | {"columns": 3, "rows": 90}), 413, "rows")
