"""Labelled arguments: broadcast by name, equal bits, units; lazy with dask."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from distributed import Client

import rocking
from rocking import InvalidArgumentError
from tests.suites.motions import noise

S = xr.DataArray([0.3, 0.5, 0.8], dims="site", coords={"site": ["a", "b", "c"]})
OMEGA = xr.DataArray([2.0, 5.0], dims="period")
RECORD = noise(1)


def test_dimensions_broadcast_by_name_and_give_the_bits_of_arrays():
    found = rocking.peak_response("sine", slenderness=S, frequency_ratio=OMEGA, restitution=0.9, alpha=0.2)
    plain = rocking.peak_response(
        "sine", slenderness=S.values[:, None], frequency_ratio=OMEGA.values, restitution=0.9, alpha=0.2
    )
    assert isinstance(found, xr.Dataset)
    assert found.peak_rotation.dims == ("site", "period")
    for name in ("peak_rotation", "outcome", "impacts", "overturned", "residual_energy"):
        np.testing.assert_array_equal(found[name].values, getattr(plain, name))
    assert found.peak_rotation.attrs["units"] == "1"
    assert found.site.values.tolist() == ["a", "b", "c"]
    assert float(found.restitution) == 0.9
    other = rocking.peak_response("sine", slenderness=S, frequency_ratio=OMEGA, restitution=0.9, alpha=0.2)
    xr.testing.assert_identical(found, other)


def test_a_record_takes_them_too():
    found = rocking.peak_response(RECORD, slenderness=S, frequency_parameter=OMEGA, restitution=0.9)
    plain = rocking.peak_response(
        RECORD, slenderness=S.values[:, None], frequency_parameter=OMEGA.values, restitution=0.9
    )
    np.testing.assert_array_equal(found.outcome.values, plain.outcome)
    assert plain.to_xarray().frequency_parameter.attrs["units"] == "rad/s"
    assert RECORD.name in repr(plain)


@pytest.mark.parametrize(
    ("others", "text"),
    [
        ({"frequency_ratio": S.assign_coords(site=["a", "b", "d"])}, "equal indexes of a dimension"),
        ({"frequency_ratio": np.array([2.0, 3.0, 4.0])}, "a number or an xarray.DataArray"),
        ({"frequency_ratio": -OMEGA}, "frequency_ratio"),
        ({}, "`frequency_ratio` = None"),
    ],
)
def test_what_does_not_fit_is_refused(others, text):
    with pytest.raises(InvalidArgumentError, match=text):
        rocking.peak_response("sine", slenderness=S, restitution=0.9, **others)


def test_dask_arrays_stay_lazy_and_give_the_same_bits():
    found = rocking.peak_response(
        "sine", slenderness=S.chunk(site=1), frequency_ratio=OMEGA.chunk(period=1), restitution=0.9
    )
    assert found.peak_rotation.chunks == ((1, 1, 1), (1, 1))
    plain = rocking.peak_response("sine", slenderness=S, frequency_ratio=OMEGA, restitution=0.9)
    xr.testing.assert_identical(found.compute(), plain)


@pytest.mark.parametrize("chunks", [{}, {"site": 1}], ids=["eager", "lazy"])
def test_an_error_names_a_value_without_its_place_in_a_chunk(chunks):
    wrong = S.where(S.site != S.site[2], -1.0).chunk(chunks) if chunks else S.where(S.site != S.site[2], -1.0)
    with pytest.raises(InvalidArgumentError) as raised:
        rocking.peak_response("sine", slenderness=wrong, frequency_ratio=OMEGA, restitution=0.9).compute()
    assert raised.value.value == -1.0
    assert "index" not in str(raised.value)


@pytest.mark.long
def test_workers_of_a_cluster_give_the_same_bits():
    slenderness = xr.DataArray(np.linspace(0.2, 0.9, 40), dims="block").chunk(block=10)
    groups = {"frequency_ratio": OMEGA, "restitution": 0.9, "alpha": 0.2}
    lazy = rocking.RigidBody.from_size(slenderness.rename("width"), 2.0)
    suite = {"records": [noise(0), noise(1)], "intensity": [2.0, 8.0]}
    with Client(n_workers=2, threads_per_worker=1, dashboard_address=None):
        found = rocking.peak_response("sine", slenderness=slenderness, **groups).compute()
        fragility = rocking.fragility(blocks=lazy, **suite).compute()
    plain = rocking.peak_response("sine", slenderness=slenderness.compute(), **groups)
    xr.testing.assert_identical(found, plain)
    eager = rocking.RigidBody.from_size(slenderness.compute(), 2.0)
    xr.testing.assert_allclose(fragility, rocking.fragility(blocks=eager, **suite), rtol=1e-11)  # other lanes of steps


def test_series_of_pandas_keep_their_index():
    index = pd.Index(["vase", "bust"], name="item")
    slenderness = pd.Series([0.3, 0.5], index=index)
    groups = {"restitution": 0.9, "frequency_ratio": 5.0}
    found = rocking.peak_response("sine", slenderness=slenderness, **groups)
    plain = rocking.peak_response("sine", slenderness=slenderness.to_numpy(), **groups)
    assert found == plain
    pd.testing.assert_index_equal(found.to_pandas().index, index)
    np.testing.assert_array_equal(found.to_xarray()["slenderness"], slenderness)
    record = rocking.peak_response(RECORD, slenderness=slenderness, frequency_parameter=3.0, restitution=0.9)
    pd.testing.assert_index_equal(record.to_pandas().index, index)
    rows = rocking.peak_response("sine", slenderness=slenderness, frequency_ratio=[[4.0], [5.0]], restitution=0.9)
    assert rows.to_xarray().peak_rotation.dims == ("frequency_ratio", "item")


def test_bodies_from_series_of_pandas_keep_their_index():
    widths = pd.Series(["40 cm", "50 cm"], index=pd.MultiIndex.from_tuples([("a", 1), ("b", 2)]))
    bodies = rocking.RigidBody.from_size(widths, 1.6)
    for found in (
        bodies.response("sine", peak_acceleration=4.0, period=1.0),
        rocking.RigidBody(0.2, 0.2, 0.8).response(
            "sine", peak_acceleration=pd.Series([3.0, 4.0], widths.index), period=1.0
        ),
    ):
        assert found.to_pandas().index.tolist() == [("a", 1), ("b", 2)]
    rows = bodies.thresholds("sine", period=1.0).to_pandas()
    assert rows.index.get_level_values("index").unique().tolist() == [("a", 1), ("b", 2)]
    fragility = rocking.fragility([RECORD], bodies, intensity=[2.0, 4.0])
    assert fragility.fraction.dims == ("index", "intensity")
