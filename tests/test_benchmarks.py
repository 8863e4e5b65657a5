"""The benchmarks' truth is the truth, their peers are fair ones, and the commands still run; no time is asserted."""

import json
import math
import subprocess
import sys
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

import rocking
from benchmarks import fixed_step_peer, truth
from benchmarks.equal_error import time_for
from benchmarks.measure import accuracy
from benchmarks.one_sine import rock, rock_many
from benchmarks.rigid_cell import ours
from benchmarks.scipy_peer import peak_rotation
from benchmarks.tolerance import peaks, summary

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def grid() -> truth.Cells:
    return truth.read("grid")


@pytest.fixture(scope="module")
def standing(grid) -> truth.Cells:
    """A dozen blocks of the grid that rock and stand."""
    return grid.chosen(np.flatnonzero(~np.isnan(grid.peak_rotation))[::130])


def rigid_peaks(cells: truth.Cells, fly: object, setting: object) -> np.ndarray:
    """By a peer in Python."""
    columns = (cells.slenderness, cells.frequency_ratio, cells.restitution, cells.alpha)
    return np.array([rock.py_func(fly, setting, *map(float, cell)) for cell in zip(*columns, strict=True)])


@pytest.mark.parametrize("name", truth.TABLES)
def test_the_tables_are_what_their_generator_writes(name: str) -> None:
    cells, solve = truth.TABLES[name]
    table = truth.read(name)
    assert len(table) == sum(1 for _ in cells())
    for k, cell in islice(enumerate(cells()), 3, None, len(table) // 3):
        row = solve(cell)
        assert row.get("pulse", "sine") == table.pulse[k]
        for column in truth.COLUMNS[name]:
            if column != "pulse":
                np.testing.assert_allclose(float(row[column] or "nan"), getattr(table, column)[k], rtol=1e-14)


def test_the_script_with_scipy_finds_the_same_slender_peaks() -> None:
    """A dozen cells, from no uplift over impacts to chatter and renewed uplift."""
    random = np.random.default_rng(3)
    slenderness = np.r_[random.uniform(0.1, 0.97, 10), 0.97, 1.2]
    frequency_ratio = np.r_[random.uniform(0.5, 12.0, 10), 4.0, 2.0]
    found = [peak_rotation(s, w, 0.6) for s, w in zip(slenderness, frequency_ratio, strict=True)]
    response = rocking.peak_response("sine", slenderness=slenderness, frequency_ratio=frequency_ratio, restitution=0.6)
    assert response.chatter.any()
    np.testing.assert_allclose(found, response.peak_rotation, rtol=1e-6, atol=1e-10)


@pytest.mark.parametrize(("method", "error"), [("DOP853", 1e-6), ("LSODA", 1e-5)])
def test_the_script_with_scipy_finds_the_rigid_truth(standing: truth.Cells, method: str, error: float) -> None:
    cells = zip(standing.slenderness, standing.frequency_ratio, strict=True)
    found = [
        peak_rotation(s, w, truth.GRID_RESTITUTION, 1e-10, alpha=truth.GRID_ALPHA, method=method) for s, w in cells
    ]
    np.testing.assert_allclose(found, standing.peak_rotation, rtol=error)


def test_fixed_steps_converge_to_the_truth_with_the_fourth_order(grid: truth.Cells) -> None:
    found = np.empty((3, len(grid)))
    columns = (grid.slenderness, grid.frequency_ratio, truth.GRID_RESTITUTION, truth.GRID_ALPHA)
    for steps, row in zip((64, 128, 256), found, strict=True):
        rock_many(fixed_step_peer.flight, steps, *columns, row)
    errors = [accuracy(row, grid.peak_rotation) for row in found]
    assert errors[2]["wrong_fates"] == 0
    order = np.log2(errors[0]["median_error"] / errors[2]["median_error"]) / 2
    assert 3.7 < order < 4.3


def test_heyoka_finds_the_truth(standing: truth.Cells) -> None:
    peer = pytest.importorskip("benchmarks.heyoka_peer", exc_type=ModuleNotFoundError)
    np.testing.assert_allclose(rigid_peaks(standing, peer.flight, 1e-13), standing.peak_rotation, rtol=1e-10)


@pytest.mark.parametrize(("flight", "error"), [("dop853_flight", 1e-8), ("lsoda_flight", 1e-6)])
def test_numbalsoda_finds_the_truth(standing: truth.Cells, flight: str, error: float) -> None:
    peer = pytest.importorskip("benchmarks.numbalsoda_peer", exc_type=ModuleNotFoundError)
    found = np.empty(len(standing))
    columns = (standing.slenderness, standing.frequency_ratio, truth.GRID_RESTITUTION, truth.GRID_ALPHA)
    rock_many(getattr(peer, flight), 1e-11, *columns, found)
    np.testing.assert_allclose(found, standing.peak_rotation, rtol=error)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8, 1e-10, 1e-12])
def test_the_grid_keeps_to_the_tolerance(grid: truth.Cells, tolerance: float) -> None:
    found = accuracy(ours(tolerance, grid), grid.peak_rotation)
    assert found["wrong_fates"] == 0
    assert found["largest_error"] <= tolerance


@pytest.mark.parametrize("tolerance", [1e-4, 1e-7, 1e-10, 1e-13])
def test_random_cells_keep_to_the_tolerance_as_far_as_their_condition_allows(tolerance: float) -> None:
    cells = truth.read("random")
    counts = summary(cells, peaks(cells, tolerance), tolerance)
    assert counts["wrong_fates"] == 0
    assert counts["above_and_unexplained"] == 0
    assert counts["above_tenfold"] == 0


def test_time_for_an_error_lies_between_the_settings() -> None:
    times, errors = [1.0, 100.0, 10.0], [1e-2, 1e-6, 1e-4]
    assert time_for(1e-4, times, errors) == pytest.approx(10.0)
    assert time_for(1e-5, times, errors) == pytest.approx(math.sqrt(1000.0))
    assert time_for(1.0, times, errors) == pytest.approx(1.0)
    assert math.isnan(time_for(1e-7, times, errors))


def test_a_setting_that_is_slower_and_worse_does_not_count() -> None:
    assert time_for(1e-2, [50.0, 10.0], [1e-2, 1e-4]) == pytest.approx(10.0)


def run(module: str, out: Path, *options: str) -> tuple[dict, str]:
    """The record and what the command prints."""
    command = [sys.executable, "-m", f"benchmarks.{module}", *options, "--out", str(out)]
    done = subprocess.run(command, check=False, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(out.read_text()), done.stdout


@pytest.mark.slow
def test_the_slender_benchmark_runs_and_finds_both_right(tmp_path: Path) -> None:
    options = ("--count", "40", "--sample", "30", "--rounds", "2", "--no-fresh")  # compiling anew takes too long here
    record, text = run("slender_cell", tmp_path / "a.json", *options)
    assert record["accuracy"]["ours"]["wrong_fates"] == record["accuracy"]["scipy"]["wrong_fates"] == 0
    assert record["accuracy"]["ours"]["largest_error"] < 1e-12
    assert record["accuracy"]["scipy"]["largest_error"] < 1e-6
    assert "scipy over ours" in text


@pytest.mark.slow
def test_the_rigid_benchmark_runs_and_compares_at_equal_error(tmp_path: Path) -> None:
    record, text = run("rigid_cell", tmp_path / "a.json", "--cells", "300", "--sample", "20", "--rounds", "1")
    assert record["cells"]["grid"] == 300
    assert record["cells"]["sample"] == record["methods"]["scipy DOP853"][0]["cells"] == 20
    assert all(rows[-1]["wrong_fates"] == 0 for rows in record["methods"].values())
    for peers in record["time_over_ours_at_equal_error"].values():
        assert set(peers) == set(record["methods"]) - {"rocking"}
        assert peers["scipy DOP853"]["1e-09"] > 0.0
    assert all(f"{peer} cannot be imported here" in text for peer in record["missing_peers"])


@pytest.mark.slow
def test_the_tolerance_benchmark_runs_and_draws(tmp_path: Path) -> None:
    record, _ = run("tolerance", tmp_path / "a.json")
    assert record["cells"] == 1000
    assert len(record["tolerances"]) == 11
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
