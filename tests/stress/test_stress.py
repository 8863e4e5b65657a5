"""The hard cases of stress/: every fate, every error over the conditioning, every symmetry; counts, never seconds."""

import json
import subprocess
import sys
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from reference.conditioning import integrate_with_conditioning
from stress.examine import beyond_promised_bound
from stress.families import BY_NAME
from stress.report import EXACT_SYMMETRIES, broken
from stress.solver import errors, solve, ulps_that_explain, wrong_events, wrong_fates
from stress.symmetries import symmetries
from stress.truth import COLUMNS, INPUTS, Table, answered, read

ROOT = Path(__file__).parents[2]
HARMLESS = dict.fromkeys(BY_NAME, 20.0) | {"strong": 1000.0, "grazing": 100.0}
"""Bounds on the error of the peak over what one unit in the last place of an input explains."""


@pytest.fixture(scope="module", params=list(BY_NAME))
def table(request: pytest.FixtureRequest) -> Table:
    return read(request.param)


def promised(table: Table, promise: str) -> None:
    if promise not in BY_NAME[table.family].promises:
        pytest.skip(f"{table.family} cells are told, not judged")


def test_fates_and_events_are_right(table: Table) -> None:
    promised(table, "fates")
    found = solve(table)
    wrong = wrong_fates(table, found) | wrong_events(table, found)
    assert not wrong.any(), table.cell(int(np.argmax(wrong)))


def test_fates_are_right_up_to_the_last_bits() -> None:
    table = read("last-bits")
    decided = np.abs(table["margin"]) > 20 * table["margin_per_ulp"]
    assert 0.5 < decided.mean() < 1.0
    assert not wrong_fates(table, solve(table))[decided].any()


def test_errors_are_what_the_last_bits_explain(table: Table) -> None:
    promised(table, "digits")
    error = errors(table, solve(table))
    worst = int(np.argmax(np.nan_to_num(error.peak_in_ulps)))
    assert np.nanmax(error.peak_in_ulps) <= HARMLESS[table.family], table.cell(worst)
    assert np.nanmedian(error.peak_in_ulps) <= 3.0
    assert np.nanmax(error.uplift_time_in_ulps) <= 20.0
    assert np.nanmax(error.impact_time_in_ulps, initial=0.0) <= 100.0


def test_no_error_is_beyond_the_bound_that_is_promised(table: Table) -> None:
    promised(table, "bounds")
    assert beyond_promised_bound(table) == 0


def test_symmetries_hold_to_the_last_bit_or_to_rounding(table: Table) -> None:
    found = symmetries(table, solve(table))
    for symmetry in EXACT_SYMMETRIES:
        assert found[symmetry]["identical"] == found[symmetry]["cells"] == len(table), symmetry
    for symmetry in ("size_3.7", "units_mm_ms"):  # the groups themselves differ by some ulps
        if "fates" in BY_NAME[table.family].promises:
            assert found[symmetry]["other_fates"] == 0
        assert found[symmetry]["largest_in_ulps"] <= 5 * HARMLESS[table.family]


def test_every_family_has_both_equations_signs_and_its_pulses(table: Table) -> None:
    family = BY_NAME[table.family]
    assert len(table) >= {"nearly-elastic": 12, "unending": 4}.get(table.family, 150)
    assert set(table["alpha"] > 0.0) == set(family.rigid)
    assert {name.startswith("-") for name in table.pulse} == {False, True}
    assert {name.removeprefix("-") for name in table.pulse} <= set(family.pulses)


def test_truth_does_not_depend_on_its_precision(table: Table) -> None:
    """Two rows anew with 256 instead of 192 bits, which takes other steps as well."""
    cheap = np.flatnonzero(table["impacts"] < 500)
    for k in cheap[:: max(1, len(cheap) // 2)][:2]:
        cell = table.cell(int(k))
        truth, condition = integrate_with_conditioning(**cell, bits=256)
        assert truth.outcome == table["outcome"][k]
        assert truth.impacts == table["impacts"][k]
        if truth.peak_rotation is not None:
            assert float(truth.peak_rotation) == pytest.approx(table["peak_rotation"][k], rel=1e-15)
            assert condition.peak_rotation == pytest.approx(table["peak_rotation_per_ulp"][k], rel=1e-3)


@pytest.mark.parametrize("name", ["ordinary", "onset", "uplift-again", "quasi-static", "separatrix", "last-bits"])
def test_the_tables_are_what_their_generator_writes(name: str) -> None:
    table = read(name)
    for k, cell in enumerate(islice(BY_NAME[name].cells(), 4)):
        row = answered(cell)
        assert row["pulse"] == table.pulse[k]
        assert tuple(float(row[column]) for column in INPUTS) == tuple(table[column][k] for column in INPUTS)
        for column in COLUMNS[1:]:
            np.testing.assert_equal(float(row[column] or "nan"), table[column][k], err_msg=column)


def test_a_wrong_fate_is_found_and_its_explanation_sought() -> None:
    """The answers of neighbours one ulp away explain themselves; those of other cells do not."""
    table = read("last-bits")
    table = table.chosen(np.flatnonzero((table["alpha"] == 0.0) & (table["impacts"] < 5)))  # quick ones
    closest = int(np.argmin(np.abs(table["margin"]) / table["margin_per_ulp"]))
    here = table.chosen(np.array([closest]))
    fallen = here["outcome"][0] >= 2
    for moved in (-8, 8):
        beside = Table(
            here.family, here.pulse, here.columns | {"slenderness": here["slenderness"] * (1 + moved * 2e-16)}
        )
        found = solve(beside)
        if found.overturned[0] != fallen:
            assert wrong_fates(here, found).all()
            assert ulps_that_explain(here, 0, found) in (1, 2, 4, 8)
            break
    else:
        pytest.fail("no neighbour has another fate")
    far = solve(Table(here.family, here.pulse, here.columns | {"slenderness": np.array([2.0])}))
    assert wrong_fates(here, far).all()
    assert ulps_that_explain(here, 0, far) is None


@pytest.mark.slow
def test_the_command_runs_and_keeps_its_promises(tmp_path: Path) -> None:
    out = tmp_path / "stress.json"
    command = [sys.executable, "-m", "stress", "angles", "last-bits", "--out", str(out)]
    done = subprocess.run(command, check=False, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    families = json.loads(out.read_text())["families"]
    assert list(families) == ["ordinary", "angles", "last-bits"]
    timeless = {name: record | {"time": {"slow_per_impact": 0.0}} for name, record in families.items()}
    assert not broken(timeless)
    assert broken({"angles": timeless["angles"] | {"wrong": [{"wrong": "fate", "explained_by_ulps": 2}]}})
    assert out.with_suffix(".png").read_bytes().startswith(b"\x89PNG")
    assert "last-bits" in done.stdout
