"""The reference tables are correct, the baselines converge to them, and the commands run; no time is asserted."""

import json
import math
import re
import runpy
import sys
import warnings
from collections.abc import Callable
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import rocking
from benchmarks import cells, reference_tables
from benchmarks.accuracy import grid_size
from benchmarks.accuracy.tolerance import peaks, summary
from benchmarks.baselines import runge_kutta
from benchmarks.baselines.event_loop import SINE, respond
from benchmarks.baselines.methods import compiled_peaks, package_peaks, python_peaks
from benchmarks.baselines.scipy_ivp import integrate_flight
from benchmarks.cost import growth, records, stages, work_precision
from benchmarks.cost.equal_error import time_for
from benchmarks.cost.made_up_records import made_up_suite
from benchmarks.measure import accuracy
from benchmarks.summary import page
from rocking._lookup.cube import open_cube
from rocking._solver.peak_response import peak_response
from tests.workflow_fixtures import snakemake

ROOT = Path(__file__).parents[2]


@pytest.fixture(params=cells.DIAGRAMS)
def diagram(request) -> cells.Cells:
    return cells.read_table(request.param)


@pytest.fixture
def surviving(diagram) -> cells.Cells:
    """Ten blocks of a diagram that uplift and survive."""
    return diagram.select(np.flatnonzero(diagram.peak_rotation > 0.0)[::45][:10])


@pytest.mark.parametrize("name", reference_tables.TABLES)
def test_the_tables_are_those_that_their_generator_writes(name: str) -> None:
    generated, solve = reference_tables.TABLES[name]
    table = cells.read_table(name)
    assert len(table) == sum(1 for _ in generated())
    for k, cell in islice(enumerate(generated()), 3, None, len(table) // 3):
        row = solve(cell)
        assert row["pulse"] == table.pulse[k]
        for column in reference_tables.columns(name):
            if column != "pulse":
                np.testing.assert_allclose(float(row[column] or "nan"), getattr(table, column)[k], rtol=1e-14)


def test_scipy_with_the_shared_event_loop_gives_the_same_slender_peaks() -> None:
    """A dozen cells: no uplift, impacts, chatter, renewed uplift."""
    random = np.random.default_rng(3)
    slenderness = np.r_[random.uniform(0.1, 0.97, 10), 0.97, 1.2]
    frequency_ratio = np.r_[random.uniform(0.5, 12.0, 10), 4.0, 2.0]
    groups = zip(slenderness, frequency_ratio, strict=True)
    found = [respond.py_func(integrate_flight, ("DOP853", 1e-9), s, w, 0.6, 0.0, SINE) for s, w in groups]
    response = rocking.peak_response("sine", slenderness=slenderness, frequency_ratio=frequency_ratio, restitution=0.6)
    assert response.chatter.any()
    np.testing.assert_allclose(found, response.peak_rotation, rtol=1e-6, atol=1e-10)


@pytest.mark.parametrize(("method", "rtol", "error"), [("DOP853", 1e-10, 1e-6), ("LSODA", 1e-10, 1e-5)])
def test_scipy_agrees_with_the_reference(surviving, method: str, rtol: float, error: float) -> None:
    found = python_peaks(integrate_flight, lambda tolerance: (method, tolerance))(rtol, surviving)
    np.testing.assert_allclose(found, surviving.peak_rotation, rtol=error)


def test_fixed_steps_converge_to_the_reference_with_the_fourth_order(diagram: cells.Cells) -> None:
    steps = np.array([64, 128, 256]) * (1 if diagram.pulse[0] == "sine" else 8)
    found = [accuracy(compiled_peaks(runge_kutta.integrate_flight)(n, diagram), diagram.peak_rotation) for n in steps]
    assert found[2]["wrong_outcomes"] == 0
    order = np.log2(found[0]["median_error"] / found[2]["median_error"]) / 2
    assert 3.5 < order < 4.5


def test_heyoka_agrees_with_the_reference(surviving: cells.Cells) -> None:
    module = pytest.importorskip("benchmarks.baselines.heyoka_taylor", exc_type=ModuleNotFoundError)
    np.testing.assert_allclose(
        python_peaks(module.integrate_flight)(1e-13, surviving), surviving.peak_rotation, rtol=1e-10
    )


@pytest.mark.parametrize(("name", "error"), [("dop853_flight", 1e-8), ("lsoda_flight", 1e-6)])
def test_numbalsoda_agrees_with_the_reference(surviving: cells.Cells, name: str, error: float) -> None:
    module = pytest.importorskip("benchmarks.baselines.numbalsoda_ivp", exc_type=ModuleNotFoundError)
    found = compiled_peaks(getattr(module, name))(1e-11, surviving)
    np.testing.assert_allclose(found, surviving.peak_rotation, rtol=error)


def test_diffrax_agrees_with_the_reference(surviving: cells.Cells) -> None:
    module = pytest.importorskip("benchmarks.baselines.diffrax_dopri8", exc_type=ModuleNotFoundError)
    np.testing.assert_allclose(module.peaks(1e-11, surviving), surviving.peak_rotation, rtol=1e-6)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12])
def test_errors_in_the_diagrams_are_within_the_tolerance(diagram: cells.Cells, tolerance: float) -> None:
    found = accuracy(package_peaks(tolerance, diagram), diagram.peak_rotation)
    assert found["wrong_outcomes"] == 0
    assert found["largest_error"] <= tolerance


@pytest.mark.parametrize("tolerance", [1e-4, 1e-7, 1e-10, 1e-13])
def test_errors_of_random_cells_are_within_tolerance_times_condition_number(tolerance: float) -> None:
    table = cells.read_table("random")
    counts = summary(table, peaks(table, tolerance), tolerance)
    assert counts["wrong_outcomes"] == 0
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


Run = Callable[..., tuple[dict[str, Any], str]]


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Run a command as `python -m` does, without a process of its own; return its record and what it prints."""

    def command(module: str, out: Path, *options: str) -> tuple[dict[str, Any], str]:
        monkeypatch.setattr(sys, "argv", [module, *options, "--out", str(out)])
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", category=RuntimeWarning, module="runpy")  # the tests import some of them
            runpy.run_module(f"benchmarks.{module}", run_name="__main__")
        return json.loads(out.read_text()), capsys.readouterr().out

    return command


@pytest.mark.slow
@pytest.mark.parametrize("diagram_name", ["slender-sine", "rigid-ricker"])
def test_a_diagram_of_time_against_error_is_measured_and_compared(run: Run, tmp_path: Path, diagram_name: str) -> None:
    record, text = run("cost.work_precision", tmp_path / "a.json", diagram_name, "--rounds", "1", "--coarse", "4")
    assert record["cells"]["all"] == 64
    assert all(rows[-1]["wrong_outcomes"] == 0 for rows in record["methods"].values())
    assert record["methods"]["rocking"][-1]["largest_error"] < 1e-12
    for baselines in record["time_ratios"].values():
        assert set(baselines) == set(record["methods"]) - {"rocking"}
    assert all(f"{name} cannot be imported and is omitted" in text for name in record["missing_baselines"])


@pytest.mark.slow
def test_growth_finds_the_same_outcomes_for_any_number_of_threads(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Of the four measurements one runs in a process of its own, as all of the command do."""
    alone = ("slender", 32, 1)

    def measure(*case: Any) -> dict[str, Any]:
        return in_new_process(*case) if case == alone else growth.measure_grid(*case)

    in_new_process = growth.in_new_process
    monkeypatch.setattr(growth, "in_new_process", measure)
    monkeypatch.setattr(sys, "argv", ["growth", "--largest", "1024", "--out", str(tmp_path / "a.json")])
    growth.main()
    record = json.loads((tmp_path / "a.json").read_text())
    counts = {(one["kind"], one["cells"]): set() for one in record["sizes"]}
    for one in record["sizes"]:
        counts[one["kind"], one["cells"]].add(one["overturned"])
    assert counts == {
        ("slender", 1024): {666},
        ("rigid", 1024): {672},
    }
    assert (tmp_path / "a.svg").exists()


@pytest.mark.slow
def test_interpolation_is_of_fourth_order_where_linear_is_of_second(run: Run, tmp_path: Path) -> None:
    record, text = run(
        "accuracy.grid_size", tmp_path / "a.json", "--count", "20000", "--scales", "0.125", "0.25", "0.5"
    )
    for angle in ("0", "20"):
        package, linear = ([row["alpha_deg"][angle][name] for row in record["grids"]] for name in ("package", "linear"))
        assert all(one["wrong_outcomes"] == 0 for one in package)
        assert 3.0 < math.log2(linear[0]["error"]["0.5"] / linear[2]["error"]["0.5"]) < 4.5
        assert package[2]["within"]["1e-04"] > 0.8
    assert "189 x 121" in text
    assert (tmp_path / "a.png").exists()

    # a coarse grid leaves points with large errors to the solver: compare the points that both answer
    config = yaml.safe_load(grid_size.CONFIG.read_text())
    points = grid_size.random_points(config, 20_000, 0.0, 1)
    exact = peak_response(grid_size.PULSE, **vars(points)).peak_rotation
    errors = []
    for path, _ in grid_size.build_cubes(tmp_path, config, (0.125, 0.5)):
        known, found = open_cube(path).interpolate(points, math.inf)
        errors.append(np.full(exact.size, np.nan))
        errors[-1][known] = np.abs(found.peak_rotation - exact)[known]
    both = ~np.isnan(errors).any(axis=0)
    coarse, fine = (np.median(error[both]) for error in errors)
    assert math.log2(coarse / fine) > 7.0  # one fourth of the spacing: 8 at order 4


def test_stages_add_up(tmp_path: Path) -> None:
    head = "s\th:m:s\tmax_rss\tmax_vms\tmax_uss\tmax_pss\tio_in\tio_out\tmean_load\tcpu_time\n"
    for job, seconds in (("spectra-sine", 3.0), ("spectra-cosine", 4.0), ("figure-08", 1.0)):
        (tmp_path / f"{job}.tsv").write_text(f"{head}{seconds}\t0:00:01\t100.0\t1\t1\t1\t0\t0\t90\t2.5\n")
    (tmp_path / "manifest.tsv").write_text(f"{head}0.1\t0:00:00\tNA\tNA\tNA\tNA\tNA\tNA\tNA\tNA\n")
    rows = {row["kind"]: row for row in stages.measure(tmp_path)}
    assert rows["spectrum cubes"]["jobs"] == 2
    assert rows["spectrum cubes"]["seconds"] == 7.0
    assert rows["manifest"]["processor_seconds"] == 0.0
    assert list(rows) == ["spectrum cubes", "figures and table", "manifest"]
    by_pulse = [row["kind"] for row in stages.measure(tmp_path, stages.kind_and_pulse_of)]
    assert by_pulse == ["spectrum cubes, cosine", "spectrum cubes, sine", "figures and table", "manifest"]


def test_the_fastest_baseline_is_chosen_among_those_that_reach_the_error() -> None:
    def spread(ratio: float) -> dict[str, float]:
        return {"median": ratio, "smallest": ratio, "largest": ratio}

    errors = [f"{error:.0e}" for error in work_precision.TARGETS]
    baselines = {"a": dict.fromkeys(errors, spread(9.0)), "scipy b": dict.fromkeys(errors, spread(50.0))}
    baselines["a"]["1e-12"] = None
    record = {"time_ratios": {"error_99": baselines}}
    best = work_precision.fastest_baselines(record, "error_99")
    assert best["1e-09"][0] == "a"
    assert best["1e-12"][0] == "scipy b"
    assert work_precision.fastest_baselines(record, "error_99", "scipy")["1e-03"][0] == "scipy b"


def test_a_setting_with_a_wrong_outcome_reaches_no_error() -> None:
    rows = [
        {"us": [1.0], "error_99": 1e-9, "wrong_outcomes": 1},
        {"us": [5.0], "error_99": 1e-8, "wrong_outcomes": 0},
    ]
    assert work_precision.least_times(rows, 1e-6, "error_99") == pytest.approx([5.0])
    assert np.isnan(work_precision.least_times(rows, 1e-9, "error_99")).all()
    assert np.isnan(work_precision.least_times(rows[:1], 1e-3, "error_99")).all()


def test_the_workflow_plans_every_benchmark_and_one_summary(tmp_path: Path) -> None:
    planned = snakemake(tmp_path, "--dry-run", "--quiet", "host", "--", "bench")
    assert planned.returncode == 0, planned.stdout
    jobs = dict(re.findall(r"^(\w+) +(\d+)$", planned.stdout, flags=re.MULTILINE))
    one_each = (
        "work_precision_figure",
        "tolerance",
        "solver",
        "growth",
        "grid_size",
        "first_call",
        "recorded_motions",
        "bodies",
        "service",
        "stages",
    )
    assert jobs["work_precision"] == str(len(cells.DIAGRAMS))
    assert {jobs[name] for name in (*one_each, "bench")} == {"1"}


def test_the_summary_holds_what_was_measured_and_omits_the_rest(tmp_path: Path) -> None:
    sizes = [{"kind": "slender", "cells": 1024, "threads": 1, "overturned": 666, "seconds": [2e-3], "peak_bytes": 5e8}]
    (tmp_path / "growth.json").write_text(json.dumps({"sizes": sizes}))
    text = "\n".join(page(tmp_path))
    assert "Cost against the number of cells" in text
    assert "1.953" in text  # us per cell
    measured = records.measure(records=2, scales=4, rounds=1, reference_runs=1)
    (tmp_path / "records.json").write_text(json.dumps(measured))
    text = "\n".join(page(tmp_path))
    assert f"{measured['rigid']['runs_per_second']:,.0f}" in text.partition("Recorded motions")[2]
    assert measured["slender"]["runs"] == 32
    assert "Interpolation" not in text


@pytest.mark.slow
def test_the_time_of_each_pulse_is_compared_with_another_checkout(run: Run, tmp_path: Path) -> None:
    record, text = run("cost.solver", tmp_path / "a.json", "--baseline", str(ROOT), "--rounds", "1", "--scale", "0.02")
    assert {row["case"].split()[1].rstrip(",") for row in record["rows"]} == set(rocking.PULSE_NAMES)
    assert all(row["here"]["median"] > 0.0 < row["baseline"]["median"] for row in record["rows"])
    assert "ratio" in text


@pytest.mark.slow
def test_the_tolerance_benchmark_runs_and_draws(run: Run, tmp_path: Path) -> None:
    record, _ = run("accuracy.tolerance", tmp_path / "a.json")
    assert record["cells"] == 1000
    assert len(record["tolerances"]) == 11
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


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
