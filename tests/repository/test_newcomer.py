"""What a newcomer does with the README and `help()`: each in fewer than ten lines, with public names only."""

import inspect
import re
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr

import rocking

MOTIONS = Path(__file__).parents[2] / "workflow" / "motions"
COLLECTION = Path(__file__).parents[2] / "docs" / "howto" / "collection.csv"


def block_under_a_named_pulse():
    block = rocking.Block(width="40 cm", height="160 cm")
    response = block.response("sine", peak_acceleration="0.6 g", period="0.5 s")
    assert response.overturned
    return response


def block_under_a_triangle():
    triangle = rocking.SampledPulse([0, 1, 0], name="triangle")
    response = rocking.Block("40 cm", "160 cm").response(triangle, peak_acceleration="0.6 g", period="0.5 s")
    assert response.outcome == rocking.Outcome.OVERTURNED_DIRECTLY
    return response


def statue_under_a_record_with_its_vertical_component():
    record = rocking.read_record(MOTIONS / "napa_HNE.csv", vertical=MOTIONS / "napa_HNN.csv")
    statue = rocking.RigidBody.from_size("40 cm", "160 cm", offset="3 cm", mass_height="85 cm")
    response = statue.response(record)
    assert response.sentence == "overturns after one or more impacts"
    assert 0.9 < response.thresholds.lowest < 1.0
    return response


def many_blocks_as_a_labelled_array(chunks=None, blocks=100):
    width = xr.DataArray(np.linspace(0.2, 0.8, blocks), dims="w")
    height = xr.DataArray(np.linspace(1.0, 4.0, blocks), dims="h")
    bodies = rocking.RigidBody.from_size(width if chunks is None else width.chunk(w=chunks), height)
    found = bodies.response("sine", peak_acceleration="0.6 g", period="0.5 s")
    assert found.overturned.dims == ("w", "h")
    return found


def table_from_a_spreadsheet():
    table = rocking.read_objects(COLLECTION)
    found = rocking.assess(table.objects[:3], rocking.Site(pga="0.4 g", pgv="0.5 m/s"), sensitivity=False)
    assert found.to_pandas()["object"].iloc[0] == "Bronze figure"
    return found


def threshold():
    found = rocking.Block("40 cm", "160 cm").thresholds("sine", period="0.5 s")
    assert found.lowest == pytest.approx(4.70006, rel=1e-5)
    return found


def fragility_curve():
    records = [rocking.read_record(path) for path in sorted(MOTIONS.glob("*.csv"))]
    block = rocking.Block("80 cm", "4 m")
    found = rocking.fragility(records, block, intensity=["0.2 g", "0.5 g", "1 g", "2 g"], measure="pga")
    np.testing.assert_allclose(found.intensity, 9.80665 * np.array([0.2, 0.5, 1.0, 2.0]))
    assert 0.0 < found.median_intensity.sel(model="lognormal") < 10.0
    return rocking.plot.fragility(found)


def history_plotted():
    history = rocking.Block("40 cm", "160 cm").history("sine", peak_acceleration="0.45 g", period="0.5 s")
    axes = rocking.plot.history(history)
    assert axes.get_xlabel() == "time [s]"
    return axes


TASKS = (
    block_under_a_named_pulse,
    block_under_a_triangle,
    statue_under_a_record_with_its_vertical_component,
    many_blocks_as_a_labelled_array,
    table_from_a_spreadsheet,
    threshold,
    fragility_curve,
    history_plotted,
)


@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.__name__)
def test_task(task):
    source = inspect.getsource(task)
    assert source.count("\n") < 10
    assert not re.search(r"rocking\._[a-z]", source)
    with mpl.rc_context({"backend": "agg"}):
        result = task()
    text = repr(result)
    if type(result).__module__.startswith("rocking"):
        assert text.startswith("<rocking.")
        assert len(text) < 400


def test_many_blocks_in_chunks_are_the_same():
    lazy = many_blocks_as_a_labelled_array(chunks=30)
    assert lazy.overturned.chunks is not None
    assert sum(array.nbytes for array in lazy.__dask_graph__().values() if isinstance(array, np.ndarray)) < 10_000
    found = lazy.compute(scheduler="synchronous")
    np.testing.assert_array_equal(found.overturned, many_blocks_as_a_labelled_array().overturned)
