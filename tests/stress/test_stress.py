"""The hard cases of stress/: outcomes, errors relative to the conditioning, symmetries; no time is asserted."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks.tables import DATA as BENCHMARKS
from benchmarks.tables import Table, rows_of, solved
from reference.conditioning import integrate_with_conditioning
from stress.families import BY_NAME, DATA, read_family
from stress.report import EXACT_SYMMETRIES, count_beyond_error_bound, violations
from stress.solver import errors, solve, wrong_events, wrong_outcomes
from stress.symmetries import symmetries
from tests.sampling import number

ROOT = Path(__file__).parents[2]
MAX_ERROR = dict.fromkeys(BY_NAME, 20.0) | {"strong": 1000.0, "grazing": 100.0}
"""Maximum error of the peak over the effect of one unit in the last place of an input."""


@pytest.fixture(scope="module", params=list(BY_NAME))
def table(request: pytest.FixtureRequest) -> Table:
    return read_family(request.param)


def skip_unless_required(table: Table, requirement: str) -> None:
    if requirement not in BY_NAME[table.name].requirements:
        pytest.skip(f"not required of {table.name} cells: {requirement}")


def test_outcomes_and_events_are_right(table: Table) -> None:
    skip_unless_required(table, "outcomes")
    found = solve(table)
    wrong = wrong_outcomes(table, found) | wrong_events(table, found)
    assert not wrong.any(), table.cell(int(np.argmax(wrong)))


def test_outcomes_are_right_unless_the_last_bits_decide() -> None:
    table = read_family("last-bits")
    decided = np.abs(table["margin"]) > 20 * table["margin_per_ulp"]
    assert 0.5 < decided.mean() < 1.0
    assert not wrong_outcomes(table, solve(table))[decided].any()


def test_errors_are_within_the_conditioning(table: Table) -> None:
    skip_unless_required(table, "digits")
    error = errors(table, solve(table))
    worst = int(np.argmax(np.nan_to_num(error.peak_in_ulps)))
    assert np.nanmax(error.peak_in_ulps) <= MAX_ERROR[table.name], table.cell(worst)
    assert np.nanmedian(error.peak_in_ulps) <= 3.0
    assert np.nanmax(error.uplift_time_in_ulps) <= 20.0
    assert np.nanmax(error.impact_time_in_ulps, initial=0.0) <= 100.0


def test_no_error_exceeds_its_bound(table: Table) -> None:
    skip_unless_required(table, "bounds")
    assert count_beyond_error_bound(table) == 0


def test_symmetries_hold_to_the_last_bit_or_to_rounding(table: Table) -> None:
    found = symmetries(table, solve(table))
    for symmetry in EXACT_SYMMETRIES:
        assert found[symmetry]["identical"] == found[symmetry]["cells"] == len(table), symmetry
    for symmetry in ("size_3.7", "units_mm_ms"):  # the groups themselves differ by some ulps
        if "outcomes" in BY_NAME[table.name].requirements:
            assert found[symmetry]["other_outcomes"] == 0
        assert found[symmetry]["largest_in_ulps"] <= 5 * MAX_ERROR[table.name]


def test_reference_responses_do_not_depend_on_the_precision(table: Table) -> None:
    """Repeat rows with 256 instead of 192 bits, which also changes the steps."""
    cheap = np.flatnonzero(table["impacts"] < 500)
    for k in cheap[:: max(1, len(cheap) // 2)][: number(1, 2)]:
        cell = table.cell(int(k))
        exact, condition = integrate_with_conditioning(**cell, bits=256)
        assert exact.outcome == table["outcome"][k]
        assert exact.impacts == table["impacts"][k]
        if exact.peak_rotation is not None:
            assert float(exact.peak_rotation) == pytest.approx(table["peak_rotation"][k], rel=1e-15)
            assert condition.peak_rotation == pytest.approx(table["peak_rotation_per_ulp"][k], rel=1e-3)


SOLVED_AGAIN = {path: slice(3, None, 1000) for path in sorted(BENCHMARKS.glob("*.csv"))} | {
    DATA / f"{name}.csv": slice(4)
    for name in ("ordinary", "onset", "uplift-again", "quasi-static", "separatrix", "last-bits")
}


@pytest.mark.parametrize("path", SOLVED_AGAIN, ids=lambda path: path.stem)
def test_rows_of_the_tables_are_solved_again_to_the_same_text(path: Path) -> None:
    for row in rows_of(path)[SOLVED_AGAIN[path]]:
        assert solved(row) == row


@pytest.mark.long
def test_the_command_runs_and_reports_violations(tmp_path: Path) -> None:
    out = tmp_path / "stress.json"
    command = [sys.executable, "-m", "stress", "--family", "last-bits", "--out", str(out)]
    done = subprocess.run(command, check=False, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    families = json.loads(out.read_text())["families"]
    assert list(families) == ["ordinary", "last-bits"]
    without_times = {name: record | {"time": {"slow_per_impact": 0.0}} for name, record in families.items()}
    assert not violations(without_times)
    wrong = {"wrong": [{"wrong": "outcome", "explained_by_ulps": 2}]}
    assert violations({"ordinary": without_times["ordinary"] | wrong})
    assert out.with_suffix(".png").read_bytes().startswith(b"\x89PNG")
    assert "last-bits" in done.stdout
