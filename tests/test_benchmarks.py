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
from benchmarks import cells, fixed_step_peer, truth
from benchmarks.equal_error import time_for
from benchmarks.measure import accuracy
from benchmarks.methods import compiled, ours, plain
from benchmarks.one_pulse import SINE, rock
from benchmarks.scipy_peer import flight
from benchmarks.tolerance import peaks, summary

ROOT = Path(__file__).parents[1]


@pytest.fixture(params=cells.DIAGRAMS)
def diagram(request) -> cells.Cells:
    return cells.read(request.param)


@pytest.fixture
def standing(diagram) -> cells.Cells:
    """Ten blocks of a diagram that rock and stand."""
    return diagram.chosen(np.flatnonzero(diagram.peak_rotation > 0.0)[::45][:10])


@pytest.mark.parametrize("name", truth.TABLES)
def test_the_tables_are_what_their_generator_writes(name: str) -> None:
    generated, solve = truth.TABLES[name]
    table = cells.read(name)
    assert len(table) == sum(1 for _ in generated())
    for k, cell in islice(enumerate(generated()), 3, None, len(table) // 3):
        row = solve(cell)
        assert row["pulse"] == table.pulse[k]
        for column in truth.columns(name):
            if column != "pulse":
                np.testing.assert_allclose(float(row[column] or "nan"), getattr(table, column)[k], rtol=1e-14)


def test_the_script_with_scipy_finds_the_same_slender_peaks() -> None:
    """A dozen cells, from no uplift over impacts to chatter and renewed uplift."""
    random = np.random.default_rng(3)
    slenderness = np.r_[random.uniform(0.1, 0.97, 10), 0.97, 1.2]
    frequency_ratio = np.r_[random.uniform(0.5, 12.0, 10), 4.0, 2.0]
    groups = zip(slenderness, frequency_ratio, strict=True)
    found = [rock.py_func(flight, ("DOP853", 1e-9), s, w, 0.6, 0.0, SINE) for s, w in groups]
    response = rocking.peak_response("sine", slenderness=slenderness, frequency_ratio=frequency_ratio, restitution=0.6)
    assert response.chatter.any()
    np.testing.assert_allclose(found, response.peak_rotation, rtol=1e-6, atol=1e-10)


@pytest.mark.parametrize(("method", "rtol", "error"), [("DOP853", 1e-10, 1e-6), ("LSODA", 1e-10, 1e-5)])
def test_the_script_with_scipy_finds_the_truth(standing, method: str, rtol: float, error: float) -> None:
    found = plain(flight, lambda tolerance: (method, tolerance))(rtol, standing)
    np.testing.assert_allclose(found, standing.peak_rotation, rtol=error)


def test_fixed_steps_converge_to_the_truth_with_the_fourth_order(diagram: cells.Cells) -> None:
    steps = np.array([64, 128, 256]) * (1 if diagram.pulse[0] == "sine" else 8)
    found = [accuracy(compiled(fixed_step_peer.flight)(n, diagram), diagram.peak_rotation) for n in steps]
    assert found[2]["wrong_fates"] == 0
    order = np.log2(found[0]["median_error"] / found[2]["median_error"]) / 2
    assert 3.5 < order < 4.5


def test_heyoka_finds_the_truth(standing: cells.Cells) -> None:
    peer = pytest.importorskip("benchmarks.heyoka_peer", exc_type=ModuleNotFoundError)
    np.testing.assert_allclose(plain(peer.flight)(1e-13, standing), standing.peak_rotation, rtol=1e-10)


@pytest.mark.parametrize(("name", "error"), [("dop853_flight", 1e-8), ("lsoda_flight", 1e-6)])
def test_numbalsoda_finds_the_truth(standing: cells.Cells, name: str, error: float) -> None:
    peer = pytest.importorskip("benchmarks.numbalsoda_peer", exc_type=ModuleNotFoundError)
    found = compiled(getattr(peer, name))(1e-11, standing)
    np.testing.assert_allclose(found, standing.peak_rotation, rtol=error)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12])
def test_the_diagrams_keep_to_the_tolerance(diagram: cells.Cells, tolerance: float) -> None:
    found = accuracy(ours(tolerance, diagram), diagram.peak_rotation)
    assert found["wrong_fates"] == 0
    assert found["largest_error"] <= tolerance


@pytest.mark.parametrize("tolerance", [1e-4, 1e-7, 1e-10, 1e-13])
def test_random_cells_keep_to_the_tolerance_as_far_as_their_condition_allows(tolerance: float) -> None:
    table = cells.read("random")
    counts = summary(table, peaks(table, tolerance), tolerance)
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
@pytest.mark.parametrize("name", ["slender-sine", "rigid-ricker"])
def test_a_diagram_of_time_against_error_is_measured_and_compared(tmp_path: Path, name: str) -> None:
    record, text = run("work_precision", tmp_path / "a.json", name, "--rounds", "1", "--coarse", "8")
    assert record["cells"]["all"] == 16
    assert all(rows[-1]["wrong_fates"] == 0 for rows in record["methods"].values())
    assert record["methods"]["rocking"][-1]["largest_error"] < 1e-12
    for peers in record["time_over_ours"].values():
        assert set(peers) == set(record["methods"]) - {"rocking"}
    assert all(f"{peer} cannot be imported here" in text for peer in record["missing_peers"])


@pytest.mark.slow
def test_the_tolerance_benchmark_runs_and_draws(tmp_path: Path) -> None:
    record, _ = run("tolerance", tmp_path / "a.json")
    assert record["cells"] == 1000
    assert len(record["tolerances"]) == 11
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
