"""The reference tables are correct, the baselines converge to them, and the commands run; no time is asserted."""

import json
import re
import runpy
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rocking
from benchmarks import tables
from benchmarks.accuracy.tolerance import peaks, summary
from benchmarks.baselines import runge_kutta
from benchmarks.baselines.methods import compiled_peaks, package_peaks, python_peaks
from benchmarks.baselines.scipy_ivp import integrate_flight
from benchmarks.cost import records
from benchmarks.cost.made_up_records import made_up_suite
from benchmarks.cost.work_precision import fastest_baselines
from benchmarks.measure import accuracy, finish
from tests.workflow_fixtures import snakemake

ROOT = Path(__file__).parents[2]


@pytest.fixture(params=tables.DIAGRAMS)
def diagram(request) -> tables.Table:
    return tables.read_table(request.param)


@pytest.fixture
def surviving(diagram) -> tables.Table:
    """Ten blocks of a diagram that uplift and survive."""
    return diagram.select(np.flatnonzero(diagram["peak_rotation"] > 0.0)[::45][:10])


@pytest.mark.parametrize(("method", "rtol", "error"), [("DOP853", 1e-10, 1e-6), ("LSODA", 1e-10, 1e-5)])
def test_scipy_agrees_with_the_reference(surviving, method: str, rtol: float, error: float) -> None:
    found = python_peaks(integrate_flight, lambda tolerance: (method, tolerance))(rtol, surviving)
    np.testing.assert_allclose(found, surviving["peak_rotation"], rtol=error)


def test_fixed_steps_converge_to_the_reference_with_the_fourth_order(diagram: tables.Table) -> None:
    steps = np.array([64, 128, 256]) * (1 if diagram.pulse[0] == "sine" else 8)
    found = [
        accuracy(compiled_peaks(runge_kutta.integrate_flight)(n, diagram), diagram["peak_rotation"]) for n in steps
    ]
    assert found[2]["wrong_outcomes"] == 0
    order = np.log2(found[0]["median_error"] / found[2]["median_error"]) / 2
    assert 3.5 < order < 4.5


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12])
def test_errors_in_the_diagrams_are_within_the_tolerance(diagram: tables.Table, tolerance: float) -> None:
    found = accuracy(package_peaks(tolerance, diagram), diagram["peak_rotation"])
    assert found["wrong_outcomes"] == 0
    assert found["largest_error"] <= tolerance


@pytest.mark.parametrize("tolerance", [1e-4, 1e-7, 1e-10, 1e-13])
def test_errors_of_random_cells_are_within_tolerance_times_condition_number(tolerance: float) -> None:
    table = tables.read_table("random")
    counts = summary(table, peaks(table, tolerance), tolerance)
    assert counts["wrong_outcomes"] == 0
    assert counts["above_and_unexplained"] == 0
    assert counts["above_tenfold"] == 0


Run = Callable[..., tuple[dict[str, Any], str]]


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Run a command as `python -m` does, without a process of its own; return its record and what it prints."""

    def command(module: str, out: Path, *options: str) -> tuple[dict[str, Any], str]:
        monkeypatch.setattr(sys, "argv", [module, *options, "--out", str(out)])
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", category=RuntimeWarning, module="runpy")  # the tests import some of them
            runpy.run_module(f"benchmarks.{module}", run_name="__main__")
        written = out if out.is_file() else next(out.glob("*.json"))
        return json.loads(written.read_text()), capsys.readouterr().out

    return command


@pytest.mark.long
@pytest.mark.parametrize("diagram_name", ["slender-sine", "rigid-ricker"])
def test_a_diagram_of_time_against_error_is_measured_and_compared(run: Run, tmp_path: Path, diagram_name: str) -> None:
    record, text = run("cost.work_precision", tmp_path, diagram_name, "--rounds", "1", "--coarse", "4")
    assert record["cells"]["all"] == 64
    assert all(rows[-1]["wrong_outcomes"] == 0 for rows in record["methods"].values())
    assert record["methods"]["rocking"][-1]["largest_error"] < 1e-12
    assert fastest_baselines(record["methods"], "error_99", "scipy")["1e-06"].startswith("scipy")
    assert all(f"{name} cannot be imported and is omitted" in text for name in record["missing_baselines"])


@pytest.mark.long
def test_the_workflow_plans_every_benchmark_and_one_summary(tmp_path: Path) -> None:
    planned = snakemake(tmp_path, "--dry-run", "--quiet", "host", "--", "bench")
    assert planned.returncode == 0, planned.stdout
    jobs = dict(re.findall(r"^(\w+) +(\d+)$", planned.stdout, flags=re.MULTILINE))
    one_each = ("tolerance", "solver", "first_call", "recorded_motions", "service")
    assert jobs["work_precision"] == str(len(tables.DIAGRAMS))
    assert {jobs[name] for name in (*one_each, "bench")} == {"1"}


def test_the_table_of_records_holds_what_was_measured(tmp_path: Path) -> None:
    measured = records.measure(records=2, scales=4, rounds=1, reference_runs=1)
    finish(measured, tmp_path / "records.json", records.table)
    assert f"{measured['rigid']['runs a second, one core']:.4g}" in (tmp_path / "records.txt").read_text()
    assert measured["slender"]["runs"] == 32


@pytest.mark.long
def test_the_time_of_each_pulse_is_compared_with_another_checkout(run: Run, tmp_path: Path) -> None:
    record, text = run("cost.solver", tmp_path / "a.json", "--baseline", str(ROOT), "--rounds", "1", "--scale", "0.02")
    assert {row["case"].split()[1].rstrip(",") for row in record["rows"]} == set(rocking.PULSE_NAMES)
    assert all(row["here"]["median"] > 0.0 < row["baseline"]["median"] for row in record["rows"])
    assert "ratio" in text


@pytest.mark.long
def test_the_tolerance_benchmark_runs(run: Run, tmp_path: Path) -> None:
    record, _ = run("accuracy.tolerance", tmp_path / "a.json")
    assert record["cells"] == 1000
    assert len(record["tolerances"]) == 11


def test_records_are_made_up_like_real_ones_and_dop853_agrees() -> None:
    suite = made_up_suite(3)
    assert [motion.samples for motion in suite] == [2000, 6000, 18000]
    for alpha in (0.0, 0.25):
        groups = {"frequency_parameter": 3.0, "slenderness": 0.7, "restitution": 0.6}
        peak = float(rocking.peak_response(suite[0], **groups, alpha=alpha).peak_rotation)
        found = records.dop853_peak(suite[0], *groups.values(), alpha)
        assert found == pytest.approx(peak, rel=1e-3)
    share = records.stepped(suite[0], "slender", 4) / (16 * (suite[0].samples - 1))
    assert 0.0 < share < 1.0
