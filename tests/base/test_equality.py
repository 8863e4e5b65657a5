"""Results are equal if all their fields are, survive pickling, and have no hash if they hold arrays."""

import dataclasses
import importlib
import pickle
import pkgutil
import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import rocking_assessment
from scipy import stats

import rocking
from rocking import paper
from rocking._base.equality import EqualByValue
from rocking._boundary.frequency import critical_frequency_ratio
from rocking._datasets.cube import write_dataset
from rocking._lookup.cube import Cube
from rocking._solver.bounded_response import solve_with_bound
from rocking._spectra.cubes import spectrum
from rocking.suites.configuration import suite_configuration
from tests.lookup_grid import GRID

BLOCK = rocking.Block(0.4, 1.6)
ARRAYS = {"slenderness": [0.1, 0.4, 2.0], "frequency_ratio": 5.0, "restitution": 0.85}  # overturns: peaks of nan


def record():
    time = np.arange(0.0, 3.0, 0.01)
    return rocking.Record(3.0 * np.sin(6.0 * time) * np.exp(-time), 0.01, "m/s2", "example")


def configuration():
    suite = {
        "name": "example", "records": {"folder": "motions", "pattern": "*.csv"}, "intensity": [1.0, 2.0],
        "blocks": [{"width": 0.4, "height": 1.6}], "measure": "pga",
        "sensitivity": {"intensity": [1.0], "restitution_step": 0.1},
        "map": {"intensity": 1.0, "half_diagonal": [1.0, 2.0], "alpha_deg": [5.0, 10.0]},
    }  # fmt: skip
    return suite_configuration(suite, Path())


EXAMPLES = {
    "Response": lambda: rocking.peak_response("sine", **ARRAYS),
    "BoundedResponse": lambda: solve_with_bound("sine", **ARRAYS, alpha=None),
    "Thresholds": lambda: rocking.thresholds("sine", frequency_ratio=5.0, restitution=0.85),
    "SavingRestraint": lambda: rocking.saving_restraint(
        "sine", "prestress", slenderness=0.5, frequency_ratio=3.0, restitution=0.85
    ),
    "FrequencyThresholds": lambda: critical_frequency_ratio(
        "sine", slenderness=0.3, restitution=0.85, window=(1.0, 10.0)
    ),
    "PulseFit": lambda: rocking.suites.fit_pulse(record(), family="ricker", blocks=BLOCK),
    "VelocityPulse": lambda: rocking.suites.fit_pulse(record(), family="ricker", blocks=[]).velocity,
    "BodyResponse": lambda: rocking.RigidBody(0.1, 0.2, 0.5).response("sine", peak_acceleration=[3.0, 9.0], period=1.0),
    "BodyThresholds": lambda: rocking.RigidBody(0.1, 0.2, 0.5).thresholds("sine", period=1.0),
    "Assessment": lambda: rocking_assessment.assess(
        rocking_assessment.Object("vase", width=0.2, height=1.0), rocking_assessment.Site(pga=3.0, pgv=0.4)
    ),
    "OverturningProbability": lambda: rocking_assessment.overturning_probability(
        rocking_assessment.Site(pga=3.0, pgv=0.4), width=stats.norm(0.3, 0.01), height=1.2, samples=64
    ),
    "Problem": lambda: paper.Problem(0.2, [2.0, 3.0], 4.0, 8.0),
    "Groups": lambda: paper.Groups([2.0, 3.0], 0.5),
    "SuiteConfiguration": configuration,
    "BlockMap": lambda: configuration().map,
    "Sensitivity": lambda: configuration().sensitivity,
}


def dataclasses_of_the_package():
    modules = [
        *pkgutil.walk_packages(rocking.__path__, "rocking."),
        *pkgutil.walk_packages(rocking_assessment.__path__, "rocking_assessment."),
    ]
    for module in modules:
        if module.name.split(".")[1] not in ("__main__", "_cli", "_commands", "plot", "precompile", "service"):
            for value in vars(importlib.import_module(module.name)).values():
                if (
                    isinstance(value, type)
                    and dataclasses.is_dataclass(value)
                    and getattr(value, "__module__", "") == module.name
                ):
                    yield value


def test_no_dataclass_compares_arrays_as_truth_values():
    kinds = [*dataclasses_of_the_package()]
    arrays = re.compile(r"(NDArray\b.*|\w*Arrays?|Floats|Flags)( \| None)?")
    holding = [kind for kind in kinds if any(arrays.match(str(field.type)) for field in dataclasses.fields(kind))]
    assert len(holding) > 15
    for kind in holding:
        assert not kind.__dataclass_params__.eq or kind.__eq__ is EqualByValue.__eq__, kind


def test_every_kind_of_result_has_an_example():
    kinds = {kind.__name__ for kind in dataclasses_of_the_package() if issubclass(kind, EqualByValue)}
    assert kinds == EXAMPLES.keys()


@cache
def example(name):
    return EXAMPLES[name]()


@pytest.mark.parametrize("name", EXAMPLES)
def test_equal_results_are_equal(name):
    result, other = example(name), EXAMPLES[name]()
    copy = pickle.loads(pickle.dumps(result))
    assert result is not other
    assert result == other == copy
    assert copy is not result
    assert (result != other) is False
    assert result != "something else"
    assert other not in [None]
    with pytest.raises(TypeError, match="unhashable"):
        hash(result)


@pytest.mark.parametrize("name", EXAMPLES)
def test_results_that_differ_in_one_field_differ(name):
    result = example(name)
    for field in dataclasses.fields(result):
        if field.compare:
            changed = pickle.loads(pickle.dumps(result))
            value = getattr(result, field.name)
            if isinstance(value, np.ndarray) and value.dtype.names:
                records = value.copy()
                records["impacts"] += 1
                object.__setattr__(changed, field.name, records)
                assert result != changed, field.name
                continue
            object.__setattr__(changed, field.name, value + 1 if isinstance(value, np.ndarray | float) else "changed")
            same = isinstance(value, np.ndarray | float) and bool(np.all(np.isnan(value)))
            assert (result == changed) == same, field.name


RESULTS = (
    "Response", "BoundedResponse", "Thresholds", "PulseFit", "BodyResponse", "BodyThresholds",
    "Assessment", "OverturningProbability",
)  # fmt: skip
"""What functions and methods that a user calls return; other functions return data sets of xarray."""


@pytest.mark.parametrize("name", RESULTS)
def test_results_are_said_in_words_and_exported_with_units(name):
    result = example(name)
    assert repr(result).startswith(("<rocking.", "<rocking_assessment."))
    assert repr(result).count("\n") < 2
    labelled = result.to_xarray()
    for variable in labelled.data_vars.values():
        assert variable.attrs["long_name"], variable.name
        assert "units" in variable.attrs or variable.dtype.kind not in "fi", variable.name
    table = result.to_pandas()
    numbers = {key for key, variable in labelled.data_vars.items() if variable.dtype.kind == "f" and not variable.dims}
    assert numbers <= set(table.columns if table.ndim == 2 else table.index)


def test_cubes_are_equal_if_their_files_are(tmp_path):
    for eta in (0.85, 0.9):
        write_dataset(spectrum("sine", restitution=eta, **GRID), tmp_path / f"eta-{eta:.2f}.nc")
    cube, other = (rocking.open_cube(tmp_path / "eta-0.85.nc") for _ in range(2))
    points = {"slenderness": [0.3, 0.5], "frequency_ratio": 5.0, "absolute_tolerance": 1.0}
    expected = cube.response(**points)  # fills the tables that hold addresses
    copy = pickle.loads(pickle.dumps(cube))
    assert isinstance(copy, Cube)
    assert cube == other == copy
    assert copy.response(**points) == expected
    assert cube != rocking.open_cube(tmp_path / "eta-0.90.nc")
    assert cube != rocking.open_cube(tmp_path)
    assert rocking.open_cube(tmp_path) == rocking.open_cube(tmp_path)
    with pytest.raises(TypeError, match="unhashable"):
        hash(cube)


@pytest.mark.parametrize(
    "make",
    [lambda: BLOCK, lambda: rocking.EquivalentBlock.rocking_frame(BLOCK, mass_ratio=0.5), record,
     lambda: rocking.pulse("-c1")],
    ids=["Block", "EquivalentBlock", "Record", "pulse"],
)  # fmt: skip
def test_what_holds_no_writable_array_has_a_hash(make):
    value, copy = make(), pickle.loads(pickle.dumps(make()))
    assert value == copy
    assert hash(value) == hash(copy)
    assert value != "something else"
