"""The rigid block (2.2) against multi-precision tables: reference rows with an angle, and 300 further cells."""

import csv
from pathlib import Path

import numpy as np
import pytest

import rocking
from rocking._model.fields import OVERTURNED, RESPONSE_FIELDS

DATA = Path(__file__).parents[1] / "data"
EPS = float(np.finfo(float).eps)
INPUTS = ("slenderness", "frequency_ratio", "restitution", "alpha")


class Table:
    """Rows of a table with an angle alpha [rad], and the responses of the solver."""

    def __init__(self, path: Path) -> None:
        rows = [row for row in csv.DictReader(path.read_text().splitlines()) if row.get("alpha_deg") != ""]
        self.pulse = np.array([row["pulse"] for row in rows])
        self.true = {name: np.array([float(row[name] or "nan") for row in rows]) for name in rows[0] if name != "pulse"}
        if "alpha_deg" in self.true:
            self.true["alpha"] = np.radians(self.true["alpha_deg"])
        self.found: dict[str, np.ndarray] = {}
        for pulse in np.unique(self.pulse):
            here = self.pulse == pulse
            response = rocking.peak_response(str(pulse), **{name: self.true[name][here] for name in INPUTS})
            for field in (*RESPONSE_FIELDS, OVERTURNED):
                name, values = field.name, getattr(response, field.name)
                self.found.setdefault(name, np.empty(len(rows), values.dtype))[here] = values

    def relative_error(self, name: str) -> np.ndarray:
        """|found/true - 1|, absolute where the truth is 0; infinite where only one has a value."""
        found, true = self.found[name], self.true[name]
        error = np.abs(found - true) / np.where(true == 0.0, 1.0, np.abs(true))
        return np.where(np.isnan(found) != np.isnan(true), np.inf, np.nan_to_num(error))

    def row(self, index: int) -> dict[str, object]:
        return {"pulse": str(self.pulse[index]), **{name: column[index] for name, column in self.true.items()}}


@pytest.fixture(scope="module")
def reference() -> Table:
    return Table(DATA / "reference" / "response.csv")


@pytest.fixture(scope="module")
def truth() -> Table:
    return Table(DATA / "multiprecision" / "rigid.csv")


def test_reference_outcomes(reference):
    assert len(reference.pulse) == 129
    np.testing.assert_array_equal(reference.found["overturned"], reference.true["overturned"] == 1)


@pytest.mark.parametrize("name", ["peak_rotation", "uplift_time", "first_impact_time", "first_impact_velocity"])
def test_reference_values_within_1e_10(reference, name, record_testsuite_property):
    error = reference.relative_error(name)
    worst = int(np.argmax(error))
    record_testsuite_property(f"worst_rigid_{name}", float(error[worst]))
    assert error[worst] <= 1e-10, reference.row(worst)


def test_reference_impacts_where_there_is_no_chatter(reference):
    counted = ~reference.found["chatter"]
    np.testing.assert_array_equal(reference.found["impacts"][counted], reference.true["impacts"][counted])


def test_table_outcomes_unless_the_last_bit_decides(truth):
    decided = np.isnan(truth.true["margin"]) | (np.abs(truth.true["margin"]) > 1000 * truth.true["margin_per_ulp"])
    assert decided.mean() > 0.98
    for name in ("outcome", "exceeded_alpha"):
        np.testing.assert_array_equal(truth.found[name][decided], truth.true[name][decided])
    np.testing.assert_array_equal(np.isnan(truth.found["peak_rotation"]), truth.found["overturned"])


@pytest.mark.parametrize("name", ["peak_rotation", "uplift_time", "first_impact_time"])
def test_table_errors_are_bounded_by_the_conditioning(truth, name, record_testsuite_property):
    # some hundred Taylor steps with rounding errors
    ulps = EPS + truth.true[f"{name}_per_ulp"]
    if name == "uplift_time":  # computed as a phase relative to a crest or to the middle of the pulse
        start = np.array([max(abs(rocking.pulse(pulse).start), np.pi / 2) for pulse in truth.pulse])
        tiny = float(np.finfo(float).tiny)
        ulps = ulps + EPS * start / (truth.true["frequency_ratio"] * np.maximum(truth.true["uplift_time"], tiny))
    explained = np.nan_to_num(truth.relative_error(name) / ulps)
    worst = int(np.argmax(explained))
    record_testsuite_property(f"worst_rigid_{name}_over_condition", float(explained[worst]))
    assert explained[worst] <= 1000, truth.row(worst)
