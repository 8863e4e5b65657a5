"""Responses of restrained blocks: against a table, the 192-bit integrator, closed forms, and the free block."""

import csv
from pathlib import Path

import numpy as np
import pytest

import rocking
from reference.exact_response import working_precision
from reference.multiprecision import integrate
from rocking import restraint
from rocking._solver.bodies import outcome_margin_of, solve
from rocking._solver.restrained import restrain
from rocking._solver.state import block_cells

FOLDER = Path(__file__).parents[2] / "reference" / "problems"
TABLE = Path(__file__).parents[1] / "data" / "reference" / "restraints.csv"
FIELDS = ("peak_rotation", "outcome", "impacts", "first_impact_time", "uplift_time", "end_rotation", "end_velocity")
PULSES = ("sine", "cosine", "half_sine", "ricker", "c1", "rectangular")


def random_groups(size: int, seed: int, alpha: float | None) -> dict[str, np.ndarray]:
    """Groups of restrained blocks, a third of each kind of restraint without it."""
    random = np.random.default_rng(seed)
    groups = {
        "slenderness": np.exp(random.uniform(np.log(0.05), 0.0, size)),
        "frequency_ratio": np.exp(random.uniform(np.log(0.4), np.log(8.0), size)),
        "restitution": random.uniform(0.4, 1.0, size),
        "stiffness": random.choice([0.0, 1.0, 8.0], size) * random.uniform(0.0, 1.0, size),
        "prestress": random.choice([0.0, 1.0], size) * random.uniform(0.0, 1.0, size),
        "damping": random.choice([0.0, 0.4, 2.0], size) * random.uniform(0.0, 1.0, size),
    }
    return groups if alpha is None else groups | {"alpha": random.uniform(0.02, alpha, size)}


def test_outcome_and_peak_of_each_case_of_the_table() -> None:
    rows = list(csv.DictReader(TABLE.read_text().splitlines()))
    for pulse in ("sine", "cosine"):
        chosen = [row for row in rows if row["pulse"] == pulse]
        columns = {name: np.array([float(row[name]) for row in chosen]) for name in chosen[0] if name != "pulse"}
        response = rocking.peak_response(
            pulse,
            slenderness=columns["slenderness"],
            frequency_ratio=columns["frequency_ratio"],
            restitution=columns["restitution"],
            stiffness=columns["kappa"],
            prestress=columns["sigma"],
            damping=columns["zeta"],
        )
        assert (response.overturned == columns["overturned"]).all()
        assert response.peak_rotation == pytest.approx(columns["peak_rotation"], rel=1e-11, nan_ok=True)


@pytest.mark.parametrize(("alpha", "seed"), [(None, 1), (1.2, 2)])
def test_responses_are_those_of_the_multiprecision_integrator(alpha: float | None, seed: int) -> None:
    groups = random_groups(60, seed, alpha)
    for k in range(60):
        cell = {name: float(values[k]) for name, values in groups.items()}
        response = rocking.peak_response(PULSES[k % 6], **cell)
        with working_precision(192):
            exact = integrate(PULSES[k % 6], **cell)
        assert int(response.outcome) == exact.outcome, cell
        if exact.outcome == 1:
            assert float(response.peak_rotation) == pytest.approx(float(exact.peak_rotation), rel=1e-10), cell


def test_reference_problems_to_the_digits_that_they_ask_for() -> None:
    rows = list(csv.DictReader((FOLDER / "restrained-blocks.csv").read_text().splitlines()))
    assert len(rows) == 60
    for row in rows:
        pulse, outcome, peak, digits = (row.pop(name) for name in ("pulse", "outcome", "peak_rotation", "digits"))
        response = rocking.peak_response(pulse, **{name: float(value) for name, value in row.items() if value})
        assert int(response.outcome) == int(outcome), row
        if peak:
            assert float(response.peak_rotation) == pytest.approx(float(peak), rel=10.0 ** -int(digits)), row


@pytest.mark.parametrize("alpha", [None, 0.3])
def test_zero_groups_give_the_free_block_to_the_last_digit(alpha: float | None) -> None:
    groups = {name: values[:40] for name, values in random_groups(40, 3, None).items()}
    free = {name: groups[name] for name in ("slenderness", "frequency_ratio", "restitution")}
    expected = rocking.peak_response("sine", **free, alpha=alpha)
    held = dict.fromkeys(("stiffness", "prestress", "damping"), np.zeros(40))
    for restraints in ({}, held, held | {"damping": np.where(np.arange(40) < 20, 0.0, 0.3)}):
        response = rocking.peak_response("sine", **free, alpha=alpha, **restraints)
        for name in FIELDS:
            np.testing.assert_array_equal(getattr(response, name)[:20], getattr(expected, name)[:20], err_msg=name)


@pytest.mark.parametrize("motion", ["sine", "ricker", rocking.Record(np.sin(np.arange(0.0, 12.0, 0.05)), 0.02, "g")])
def test_a_tendon_alone_is_a_free_block_in_other_units(motion: str | rocking.Record) -> None:
    """Two ways of solution: exact arcs of the free block, Taylor steps of the restrained one."""
    groups = random_groups(50, 4, None)
    kappa, sigma = 0.9 * groups["stiffness"] / 8.0, groups["prestress"]
    by_record = isinstance(motion, rocking.Record)
    rate = groups["frequency_ratio"] * (motion.time_step if by_record else 1.0)
    cells = block_cells(rate, groups["slenderness"], groups["restitution"], np.zeros(50))
    restrain(cells, {"stiffness": kappa, "prestress": sigma})
    records, edges = solve(motion if by_record else rocking.pulse(motion), cells, None, None)
    time = {"frequency_parameter" if by_record else "frequency_ratio": groups["frequency_ratio"]}
    response = rocking.peak_response(
        motion,
        slenderness=groups["slenderness"],
        restitution=groups["restitution"],
        stiffness=kappa,
        prestress=sigma,
        **time,
    )
    for name in ("outcome", "impacts"):
        np.testing.assert_array_equal(records[name], getattr(response, name))
    for name in ("peak_rotation", "uplift_time", "first_impact_time"):
        assert records[name] == pytest.approx(getattr(response, name), rel=1e-8, nan_ok=True), name
    moved = records["outcome"] > 0
    margin = outcome_margin_of(records, edges, cells)
    assert ((margin >= 0.0) == (records["outcome"] >= 2))[moved & (kappa + sigma > 0.0)].all()


@pytest.mark.parametrize("frequency_ratio", [2.0, 3.0, 5.0])
@pytest.mark.parametrize("held", [{"damping": 0.1}, {"stiffness": 0.2, "prestress": 0.15, "damping": 0.1}])
def test_thresholds_are_those_of_the_closed_forms(frequency_ratio: float, held: dict[str, float]) -> None:
    amplitudes = restraint.overturning_amplitudes(frequency_ratio, 0.9, **held)
    expected = [float(a) for a in amplitudes if not np.isnan(a)]
    found = rocking.thresholds("sine", frequency_ratio=frequency_ratio, restitution=0.9, **held)
    assert found.amplitude.tolist() == pytest.approx(expected, rel=1e-9)


def test_boundary_lies_on_the_closed_form() -> None:
    held = {"prestress": 0.2, "damping": 0.2}
    curves = rocking.overturning_boundary("sine", restitution=0.9, **held, frequency_ratio=(3.5, 5.0), nodes=16)
    direct = 1.0 / restraint.direct_amplitude(curves.frequency_ratio.values, **held)
    own = np.repeat(curves.impacts.values == 0, curves.row_size.values)
    inside = (curves.slenderness.values > 0.02 / 1.2 * 1.001) & own
    assert inside.sum() > 10
    assert np.abs(curves.slenderness.values / direct - 1.0)[inside].min() < 1e-9
    assert np.median(np.abs(curves.slenderness.values / direct - 1.0)[inside]) < 1e-9


def test_there_is_no_overturning_from_stiffness_one_on() -> None:
    response = rocking.peak_response(
        "sine", slenderness=[0.5, 0.1, 0.02], frequency_ratio=0.8, restitution=0.9, stiffness=[[1.0], [3.0]]
    )
    assert not response.overturned.any()
    assert response.peak_rotation.max() > 10.0


@pytest.mark.parametrize("alpha", [None, 0.25])
def test_history_has_the_peak_of_the_response(alpha: float | None) -> None:
    groups = {"slenderness": 0.5, "frequency_ratio": 3.0, "restitution": 0.9, "alpha": alpha}
    held = {"stiffness": 0.5, "prestress": 0.1, "damping": 0.2}
    history = rocking.time_history("sine", **groups, **held, samples=20_000, duration=12.0)
    peak = float(np.abs(history.rotation).max())
    assert peak == pytest.approx(float(rocking.peak_response("sine", **groups, **held).peak_rotation), rel=1e-6)
    rotation, tau = history.rotation.values, history.tau.values
    middle = np.flatnonzero((np.abs(rotation) > 0.05) & (tau > 0.3))
    middle = middle[(middle > 1) & (middle < tau.size - 2)]
    velocity = history.angular_velocity.values
    steady = np.abs(np.diff(velocity)[middle]) < 0.01  # no impact in the interval
    assert steady.mean() > 0.9


@pytest.mark.parametrize("alpha", [None, 0.8])
def test_samples_of_a_pulse_give_its_response(alpha: float | None) -> None:
    """Linear between 4,000 samples, a sine is wrong by 3e-7."""
    groups = random_groups(30, 5, alpha)
    phase = np.linspace(0.0, 2.0 * np.pi, 4001)
    omega = groups.pop("frequency_ratio")
    expected = rocking.peak_response("sine", frequency_ratio=omega, **groups)
    record = rocking.Record(np.sin(phase), phase[1], "m/s2")
    response = rocking.peak_response(record, frequency_parameter=1.0 / omega, **groups)
    np.testing.assert_array_equal(response.outcome, expected.outcome)
    assert response.peak_rotation == pytest.approx(expected.peak_rotation, rel=1e-3, nan_ok=True)
