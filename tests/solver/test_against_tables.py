"""Slender and rigid blocks against multi-precision tables: the reference of random cases, and 1300 cells of our own.

The worst figures are recorded in the test report (`pytest --junit-xml`).
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import rocking
from benchmarks import tables
from benchmarks.tables import rows_of
from rocking._model.fields import OVERTURNED, RESPONSE_FIELDS
from stress.solver import solve

Record = Callable[[str, object], None]
DATA = Path(__file__).parents[1] / "data"
EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Kind:
    """A kind of block: how many reference cases, their error, and how often one ulp of the input explains an error."""

    rigid: bool
    cases: int
    relative: float
    ulps: float


KINDS = {"slender": Kind(False, 290, 1e-12, 200.0), "rigid": Kind(True, 129, 1e-10, 1000.0)}
"""About 50 roundings of exact arcs, of which the largest effect is 53 ulps; some hundred Taylor steps."""


class Table:
    """Rows of a table for slender or for rigid blocks; empty fields are nan. The responses of the solver to them."""

    def __init__(self, path: Path, rigid: bool) -> None:
        rows = [row for row in rows_of(path) if bool(row.get("alpha_deg") or row.get("alpha")) == rigid]
        self.pulse = np.array([row["pulse"] for row in rows])
        self.true = {name: np.array([float(row[name] or "nan") for row in rows]) for name in rows[0] if name != "pulse"}
        alpha = np.radians(self.true["alpha_deg"]) if "alpha_deg" in self.true else self.true.get("alpha", 0.0)
        self.true["alpha"] = np.nan_to_num(np.broadcast_to(alpha, len(rows)))
        response = solve(tables.Table(path.stem, self.pulse, self.true))
        self.found = {field.name: getattr(response, field.name) for field in (*RESPONSE_FIELDS, OVERTURNED)}

    def relative_error(self, name: str) -> NDArray[np.float64]:
        """|found/true - 1|, absolute where the truth is 0; infinite where only one has a value."""
        found, true = self.found[name], self.true[name]
        error = np.abs(found - true) / np.where(true == 0.0, 1.0, np.abs(true))
        return np.where(np.isnan(found) != np.isnan(true), np.inf, np.nan_to_num(error))

    def row(self, index: int) -> dict[str, object]:
        return {"pulse": str(self.pulse[index]), **{name: column[index] for name, column in self.true.items()}}


@pytest.fixture(scope="module", params=KINDS.values(), ids=KINDS)
def kind(request: pytest.FixtureRequest) -> Kind:
    return request.param  # type: ignore[no-any-return]


@pytest.fixture(scope="module")
def reference(kind: Kind) -> Table:
    return Table(DATA / "reference" / "response.csv", kind.rigid)


@pytest.fixture(scope="module")
def truth(kind: Kind) -> Table:
    return Table(DATA / "multiprecision" / ("rigid.csv" if kind.rigid else "slender.csv"), kind.rigid)


def test_reference_outcomes(reference: Table, kind: Kind) -> None:
    assert len(reference.pulse) == kind.cases
    np.testing.assert_array_equal(reference.found["overturned"], reference.true["overturned"] == 1)


@pytest.mark.parametrize("name", ["peak_rotation", "uplift_time", "first_impact_time", "first_impact_velocity"])
def test_reference_values(reference: Table, kind: Kind, name: str, record_testsuite_property: Record) -> None:
    error = reference.relative_error(name)
    worst = int(np.argmax(error))
    record_testsuite_property(f"worst_{name}_rigid={kind.rigid}", float(error[worst]))
    assert error[worst] <= kind.relative, reference.row(worst)


def test_reference_impacts_where_there_is_no_chatter(reference: Table) -> None:
    counted = ~reference.found["chatter"]
    np.testing.assert_array_equal(reference.found["impacts"][counted], reference.true["impacts"][counted])


def test_table_outcomes_unless_the_last_bit_decides(truth: Table, kind: Kind) -> None:
    margin = truth.true["margin"]
    decided = np.isnan(margin) | (np.abs(margin) > kind.ulps * truth.true["margin_per_ulp"])
    assert decided.mean() > 0.98
    for name in ("outcome", "exceeded_alpha"):
        np.testing.assert_array_equal(truth.found[name][decided], truth.true[name][decided])
    np.testing.assert_array_equal(np.isnan(truth.found["peak_rotation"]), truth.found["overturned"])
    single = truth.true["chatter"] == 0
    np.testing.assert_array_equal(truth.found["impacts"][single], truth.true["impacts"][single])


@pytest.mark.parametrize("name", ["peak_rotation", "uplift_time", "first_impact_time"])
def test_table_errors_are_within_the_effect_of_the_last_bit(
    truth: Table, kind: Kind, name: str, record_testsuite_property: Record
) -> None:
    ulps = EPS + truth.true[f"{name}_per_ulp"]
    if name == "uplift_time":  # computed as a phase relative to a crest (sines) or to the middle of the pulse
        start = np.array([max(abs(rocking.pulse(pulse).start), np.pi / 2) for pulse in truth.pulse])
        tiny = float(np.finfo(float).tiny)
        ulps = ulps + EPS * start / (truth.true["frequency_ratio"] * np.maximum(truth.true["uplift_time"], tiny))
    explained = np.nan_to_num(truth.relative_error(name) / ulps)
    worst = int(np.argmax(explained))
    record_testsuite_property(f"worst_{name}_over_condition_rigid={kind.rigid}", float(explained[worst]))
    assert explained[worst] <= kind.ulps, truth.row(worst)
