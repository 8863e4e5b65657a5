"""The slender solver against multi-precision tables: the reference of 419 random cases, and 1000 cells of our own.

The tables are read with csv and compared with `peak_response`; the file takes about a second with compiled kernels.
The worst figures are recorded in the test report (`pytest --junit-xml`).
"""

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import rocking
from rocking._model.fields import SOLVED_FIELDS

Record = Callable[[str, object], None]
DATA = Path(__file__).parents[1] / "data"
EPS = float(np.finfo(float).eps)
BEYOND_ONE_ULP = 200.0
"""Bound on an error over the change that one ulp of the input makes: about 50 roundings; the largest value is 53."""


class Table:
    """Columns of a table; empty fields are nan."""

    def __init__(self, path: Path) -> None:
        rows = [row for row in csv.DictReader(path.read_text().splitlines()) if not row.get("alpha_deg")]
        self.pulse = np.array([row["pulse"] for row in rows])
        self.columns = {
            name: np.array([float(row[name] or "nan") for row in rows]) for name in rows[0] if name != "pulse"
        }

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self.columns[name]

    def solved(self) -> rocking.Response:
        """All rows by the solver, pulse by pulse."""
        fields: dict[str, NDArray[np.generic]] = {}
        for pulse in np.unique(self.pulse):
            rows = self.pulse == pulse
            inputs = {name: self[name][rows] for name in ("slenderness", "frequency_ratio", "restitution")}
            response = rocking.peak_response(str(pulse), **inputs)
            for field in SOLVED_FIELDS:
                name, values = field.name, getattr(response, field.name)
                fields.setdefault(name, np.empty(len(rows), values.dtype))[rows] = values
        return rocking.Response(**fields)  # type: ignore[arg-type]  # the fields by name, each of its own dtype


@pytest.fixture(scope="module")
def reference() -> tuple[Table, rocking.Response]:
    table = Table(DATA / "reference" / "response.csv")
    return table, table.solved()


@pytest.fixture(scope="module")
def truth() -> tuple[Table, rocking.Response]:
    table = Table(DATA / "multiprecision" / "slender.csv")
    return table, table.solved()


def _relative(found: NDArray[np.float64], true: NDArray[np.float64]) -> NDArray[np.float64]:
    """|found/true - 1|; nan where both have no value; infinite where only one has."""
    found, true = np.where(true == 0.0, found + 1.0, found), np.where(true == 0.0, 1.0, true)
    error = np.abs(found - true) / np.abs(true)
    return np.where(np.isnan(found) != np.isnan(true), np.inf, error)


def test_reference_outcomes(reference: tuple[Table, rocking.Response]) -> None:
    table, found = reference
    assert np.array_equal(found.overturned, table["overturned"] == 1)


@pytest.mark.parametrize("column", ["peak_rotation", "uplift_time", "first_impact_time", "first_impact_velocity"])
def test_reference_values_within_1e_12(
    reference: tuple[Table, rocking.Response], column: str, record_testsuite_property: Record
) -> None:
    table, found = reference
    error = _relative(getattr(found, column), table[column])
    worst = int(np.nanargmax(error))
    record_testsuite_property(f"worst_{column}", float(error[worst]))
    assert error[worst] <= 1e-12, (table.pulse[worst], {name: column[worst] for name, column in table.columns.items()})


def test_reference_impacts_where_there_is_no_chatter(reference: tuple[Table, rocking.Response]) -> None:
    table, found = reference
    counted = ~found.chatter
    assert np.array_equal(found.impacts[counted], table["impacts"][counted])


def test_table_outcomes_unless_the_last_bit_decides(truth: tuple[Table, rocking.Response]) -> None:
    table, found = truth
    decided = np.isnan(table["margin"]) | (np.abs(table["margin"]) > BEYOND_ONE_ULP * table["margin_per_ulp"])
    assert decided.mean() > 0.99
    assert np.array_equal(found.outcome[decided], table["outcome"][decided])
    assert np.array_equal(found.exceeded_alpha[decided], table["exceeded_alpha"][decided] == 1)


def test_table_has_a_peak_for_each_surviving_block(truth: tuple[Table, rocking.Response]) -> None:
    _, found = truth
    assert np.array_equal(np.isnan(found.peak_rotation), found.overturned)


def test_table_impacts_and_chatter(truth: tuple[Table, rocking.Response]) -> None:
    table, found = truth
    chatter = table["chatter"] == 1
    assert chatter.sum() > 100
    assert np.array_equal(found.impacts[~chatter], table["impacts"][~chatter])


@pytest.mark.parametrize("column", ["peak_rotation", "uplift_time", "first_impact_time"])
def test_table_errors_are_within_the_effect_of_the_last_bit(
    truth: tuple[Table, rocking.Response], column: str, record_testsuite_property: Record
) -> None:
    table, found = truth
    error = _relative(getattr(found, column), table[column])
    ulps = EPS + table[f"{column}_per_ulp"]
    if (
        column == "uplift_time"
    ):  # computed as a phase, a double relative to a crest (sines) or to the middle of the pulse
        start = np.array([max(abs(rocking.pulse(name).start), np.pi / 2) for name in table.pulse])
        tiny = float(np.finfo(float).tiny)
        ulps += EPS * start / (table["frequency_ratio"] * np.maximum(table["uplift_time"], tiny))
    explained = error / ulps
    worst = int(np.nanargmax(explained))
    record_testsuite_property(f"worst_{column}_over_condition", float(explained[worst]))
    record_testsuite_property(f"median_{column}", float(np.nanmedian(error)))
    assert explained[worst] <= BEYOND_ONE_ULP, (table.pulse[worst], {n: c[worst] for n, c in table.columns.items()})
