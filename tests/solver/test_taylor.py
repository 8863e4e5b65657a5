"""Taylor steps: order of accuracy, detection of events, slender limit."""

from itertools import pairwise

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import rocking
from rocking._excitation.pulses import PULSE_NAMES
from rocking._numba.simd import LANES
from rocking._solver.peak_response import SolverState
from rocking._solver.state import FULL_PRECISION, MAX_ORDER, pulse_state, step_state
from rocking._solver.taylor.events import evaluate_series, first_crossing, refine_root, value_and_slope
from rocking._solver.taylor.step import set_edge_lane, take_step
from tests.kernels import edge

SIGNED = tuple(sign + name for name in PULSE_NAMES for sign in ("", "-"))


def step_from(
    pulse: str,
    z: float,
    w: float,
    phase: float,
    omega: float,
    alpha: float,
    sign: float = -1.0,
    lane: int = 3,
    precision: float = FULL_PRECISION,
    limit: float = np.inf,
):
    steps = step_state(pulse_state(rocking.pulse(pulse)), precision)
    set_edge_lane(steps, lane, edge(alpha), 0)
    steps["omega"][lane] = omega
    for name, value in {"z0": z, "w0": w, "phase": phase, "strength": sign / 0.4, "limit": limit}.items():
        steps[name][lane] = value
    take_step(steps)
    return steps


def rotation(steps, h: float, degree: int = MAX_ORDER, lane: int = 3) -> float:
    return evaluate_series(steps["z"], lane, degree, h)


def velocity(steps, h: float, lane: int = 3) -> float:
    return evaluate_series(steps["rate"], lane, MAX_ORDER - 1, h)


def one_lane(coefficients: np.ndarray) -> np.ndarray:
    series = np.full((MAX_ORDER + 1, LANES), np.nan)
    series[:, 1] = coefficients
    return series


def bend_of(coefficients: np.ndarray, h: float) -> float:
    return float(sum(n * (n - 1) * abs(c) * h ** max(n - 2, 0) for n, c in enumerate(coefficients)))


@pytest.mark.parametrize("alpha", [0.0, 1e-7, 0.3, 1.3])
@pytest.mark.parametrize("name", SIGNED)
def test_coefficients_satisfy_the_equation_of_motion(name, alpha):
    phase, omega, sign = 0.7, 1.9, -1.0
    steps = step_from(name, 0.2, 0.3, phase, omega, alpha, sign)
    pulse = rocking.pulse(name)
    for h in (0.0, 0.02, 0.06):
        z, slope = value_and_slope(steps["z"], 3, MAX_ORDER, h)
        assert z == pytest.approx(rotation(steps, h), rel=1e-14)
        assert velocity(steps, h) == pytest.approx(slope, rel=1e-14)
        _, bend = value_and_slope(steps["rate"], 3, MAX_ORDER - 1, h)
        force = sign * float(pulse.shape(phase + omega * h)) / 0.4
        if alpha == 0.0:
            true = z - 1 - force  # (3.1)
        else:
            lean = alpha * (1 - z)
            true = -(np.sin(lean) + np.tan(alpha) * force * np.cos(lean)) / alpha  # (2.2)
        assert bend == pytest.approx(true, rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("name", ["sine", "ricker", "c2"])
def test_the_error_of_a_step_follows_the_precision(name):
    for precision in (1e-5, 1e-8, 1e-11, 1e-14):
        coarse = step_from(name, 0.2, 0.3, 0.7, 1.9, 0.3, precision=precision)
        h = float(coarse["h"][3])
        z, w, parts = 0.2, 0.3, 16
        for i in range(parts):
            part = step_from(name, z, w, 0.7 + 1.9 * h * i / parts, 1.9, 0.3, limit=h / parts)
            z, w = float(part["z1"][3]), float(part["w1"][3])
        error = abs(float(coarse["z1"][3]) - z) / z
        assert 1e-4 * precision < error + 1e-15 < 10 * precision + 1e-15
        assert int(coarse["order"]) < MAX_ORDER


def test_lanes_are_independent():
    alone = [step_from("c1", 0.2, 0.3, 0.7, 1.9, alpha, lane=lane) for lane, alpha in enumerate((0.0, 0.3, 1e-6))]
    together = step_state(pulse_state(rocking.pulse("c1")))
    for lane, one in enumerate(alone):
        set_edge_lane(together, lane, edge((0.0, 0.3, 1e-6)[lane]), 0)
        together["omega"][lane] = 1.9
        for name in ("z0", "w0", "phase", "strength", "limit"):
            together[name][lane] = one[name][lane]
    take_step(together)
    for lane, one in enumerate(alone):
        for name in ("h", "z1", "w1", "second_derivative_bound"):
            assert together[name][lane] == one[name][lane]
        np.testing.assert_array_equal(together["z"][:, lane], one["z"][:, lane])


@pytest.mark.parametrize("alpha", [0.0, 1e-9, 0.3, 1.5])
def test_acceleration_at_uplift_is_exactly_zero(alpha):
    steps = step_state(pulse_state(rocking.pulse("sine")))
    set_edge_lane(steps, 0, edge(alpha), 0)
    steps["omega"][0] = 2.0
    steps["starts_at_uplift"][0], steps["phase"][0], steps["strength"][0], steps["limit"][0] = 1.0, 0.4, -2.5, 1.0
    take_step(steps)
    assert steps["z"][2, 0] == 0.0
    assert steps["z"][3, 0] > 0.0


def test_the_second_derivative_bound_holds_on_the_step():
    steps = step_from("c2", 0.2, 0.3, 0.7, 1.9, 0.4)
    h = np.linspace(0, float(steps["h"][3]), 200)
    second = np.polynomial.polynomial.polyval(h, np.polynomial.polynomial.polyder(steps["rate"][:MAX_ORDER, 3], 2))
    assert np.abs(second).max() <= steps["second_derivative_bound"][3] * (1 + 1e-12)
    assert steps["second_derivative_bound"][3] < 20 * np.abs(second).max()


@given(
    roots=st.lists(st.floats(-0.5, 1.5), min_size=1, max_size=5),
    scale=st.sampled_from([-1.0, 1.0, 1e-9, -1e7]),
    falling=st.booleans(),
)
def test_first_crossing_is_the_first_of_all_roots(roots, scale, falling):
    roots = sorted(roots)
    assume(all(b - a > 1e-3 for a, b in pairwise(roots)))
    assume(all(abs(root) > 1e-6 and abs(root - 1) > 1e-6 for root in roots))
    series = np.zeros(MAX_ORDER + 1)
    series[: len(roots) + 1] = scale * np.polynomial.polynomial.polyfromroots(roots)
    rising_first = (scale > 0) == (len(roots) % 2 == 1)  # the leftmost root is crossed upwards
    wanted = [r for i, r in enumerate(roots) if 0 < r < 1 and ((i % 2 == 0) == rising_first) != falling]
    found = first_crossing(one_lane(series), 1, MAX_ORDER, 0.0, 1.0, falling, bend_of(series, 1.0))
    if wanted:
        assert found == pytest.approx(wanted[0], abs=1e-9)
    else:
        assert found == -1.0


@given(root=st.floats(1e-6, 1.0), curve=st.floats(-0.4, 0.4), falling=st.booleans())
def test_refine_root_excludes_the_zero_at_the_start(root, curve, falling):
    side = -1.0 if falling else 1.0
    series = np.zeros(MAX_ORDER + 1)
    series[1:4] = -side * root, side * (1 - curve * root), side * curve  # side h (h - root)(1 + curve h)
    upper = min(1.3 * root, 1.2)
    found, slope = refine_root(one_lane(series), 1, MAX_ORDER, 0.0, upper, falling, True, 0.7 * upper)
    assert (slope < 0.0) == falling
    with mpmath.workprec(100):
        a, b, c = (mpmath.mpf(float(x)) for x in series[1:4])
        true = (-b + side * mpmath.sqrt(b * b - 4 * a * c)) / (2 * c) if abs(c) > 1e-3 else None
    assert found == pytest.approx(root, rel=1e-13)
    if true is not None:
        assert found == pytest.approx(float(true), rel=1e-14)


@pytest.mark.parametrize("name", PULSE_NAMES)
def test_error_of_the_slender_limit_is_of_order_alpha_squared(name):
    rng = np.random.default_rng(9)
    n = 60
    question = {
        "slenderness": rng.uniform(0.2, 0.95, n),
        "frequency_ratio": np.exp(rng.uniform(0.5, 2.5, n)),
        "restitution": rng.uniform(0.5, 0.95, n),
    }
    slender = rocking.peak_response(name, **question)
    angles = np.array([0.02, 0.01, 0.005, 1e-4, 1e-8])
    rigid = [rocking.peak_response(name, **question, alpha=alpha) for alpha in angles]
    kept = (slender.peak_rotation < 0.8) & (slender.peak_rotation > 1e-3)
    for one in rigid:
        kept &= (one.peak_mode == slender.peak_mode) & (one.impacts == slender.impacts)
    if name == "rectangular":
        assert np.isnan(slender.peak_rotation[~kept]).any()
    assert kept.sum() >= 3
    gap = np.array([np.abs(one.peak_rotation[kept] - slender.peak_rotation[kept]) for one in rigid])
    order = np.log(gap[0] / gap[2]) / np.log(4.0)
    assert np.median(order) == pytest.approx(2.0, abs=0.05)
    # alpha = 1e-8 changes the sixteenth digit, 1e-4 the eighth
    assert (gap[4] <= 1e-11 * slender.peak_rotation[kept]).mean() >= 0.9
    assert np.median(gap[3] / angles[3] ** 2) == pytest.approx(np.median(gap[1] / angles[1] ** 2), rel=0.05)


@pytest.mark.parametrize("pulse", ["sine", "ricker"])
def test_terms_beyond_the_degree_are_not_used(pulse, monkeypatch):
    """Series of a lower degree do not use the remaining rows of the solver state."""
    rng, n = np.random.default_rng(5), 4000
    groups = {"slenderness": rng.uniform(0.05, 0.99, n), "frequency_ratio": rng.uniform(0.3, 8.0, n)}
    groups |= {"restitution": rng.uniform(0.3, 0.95, n), "alpha": rng.uniform(0.05, 0.6, n)}
    clean = rocking.peak_response(pulse, **groups, relative_tolerance=1.25e-5)

    def spoilt(flight, precision):
        steps = step_state(flight, precision)
        order = int(steps["order"])
        for name in ("z", "f", "gauss", "s", "c"):
            steps[name][order + 1 :] = np.nan
        steps["rate"][order:] = np.nan
        return steps

    monkeypatch.setattr("rocking._solver.peak_response.step_state", spoilt)
    monkeypatch.setattr("rocking._solver.peak_response.solver_state", SolverState())
    found = rocking.peak_response(pulse, **groups, relative_tolerance=1.25e-5)
    for name in ("peak_rotation", "outcome", "impacts", "end_rotation", "end_velocity"):
        np.testing.assert_array_equal(getattr(found, name), getattr(clean, name))
