"""Taylor steps: the order that they promise, events that no step passes over, and the slender limit."""

from itertools import pairwise

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import rocking
from rocking.pulses import PULSE_NAMES
from rocking.scratch import ORDER
from rocking.taylor_step import evaluate, expand_motion, expand_pulse, first_crossing, polish, slope, step_size
from tests.kernels import cell

SIGNED = tuple(sign + name for name in PULSE_NAMES for sign in ("", "-"))


def step_from(pulse: str, z: float, w: float, phase: float, omega: float, alpha: float, sign: float = -1.0):
    flight = cell(pulse, 0.4, omega, alpha)
    flight["sign"] = sign
    expand_pulse(flight, phase)
    expand_motion(flight, z, w)
    return flight


@pytest.mark.parametrize("alpha", [0.0, 1e-7, 0.3, 1.3])
@pytest.mark.parametrize("name", SIGNED)
def test_coefficients_satisfy_the_equation_of_motion(name, alpha):
    phase, omega, sign = 0.7, 1.9, -1.0
    flight = step_from(name, 0.2, 0.3, phase, omega, alpha, sign)
    pulse = rocking.get_pulse(name)
    for h in (0.0, 0.02, 0.06):
        z = evaluate(flight["z"], ORDER, h)
        assert evaluate(flight["rate_of_z"], ORDER - 1, h) == pytest.approx(slope(flight["z"], ORDER, h), rel=1e-14)
        bend = slope(flight["rate_of_z"], ORDER - 1, h)
        force = sign * float(pulse.shape(phase + omega * h)) / 0.4
        if alpha == 0.0:
            true = z - 1 - force  # (3.1)
        else:
            lean = alpha * (1 - z)
            true = -(np.sin(lean) + np.tan(alpha) * force * np.cos(lean)) / alpha  # (2.2)
        assert bend == pytest.approx(true, rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("degree", [3, 5, 8])
@pytest.mark.parametrize("alpha", [0.0, 0.3])
@pytest.mark.parametrize("name", ["sine", "ricker", "mavroeidis_papageorgiou"])
def test_measured_order(name, alpha, degree):
    steps, orders = np.geomspace(0.1, 0.2, 7), []
    for phase in (0.2, 0.7, 1.3, 2.1, 2.9):  # here or there the first term left out may nearly vanish
        flight = step_from(name, 0.2, 0.3, phase, 1.9, alpha)
        error = [abs(evaluate(flight["z"], degree, h) - evaluate(flight["z"], ORDER, h)) for h in steps]
        orders.append(np.polyfit(np.log(steps), np.log(error), 1)[0])
    assert np.median(orders) == pytest.approx(degree + 1, abs=0.4)


@pytest.mark.parametrize("alpha", [0.0, 0.3])
@pytest.mark.parametrize("name", ["sine", "ricker", "c2"])
def test_one_step_is_exact_to_rounding(name, alpha):
    flight = step_from(name, 0.2, 0.3, 0.7, 1.9, alpha)
    h = float(step_size(flight))
    assert 0.05 < h < 2.0
    once = evaluate(flight["z"], ORDER, h), evaluate(flight["rate_of_z"], ORDER - 1, h)
    z, w = 0.2, 0.3
    parts = 8
    for i in range(parts):
        part = step_from(name, z, w, 0.7 + 1.9 * h * i / parts, 1.9, alpha)
        z, w = evaluate(part["z"], ORDER, h / parts), evaluate(part["rate_of_z"], ORDER - 1, h / parts)
    np.testing.assert_allclose(once, (z, w), rtol=2e-14)


@given(
    roots=st.lists(st.floats(-0.5, 1.5), min_size=1, max_size=5),
    scale=st.sampled_from([-1.0, 1.0, 1e-9, -1e7]),
    falling=st.booleans(),
)
def test_first_crossing_is_the_first_of_all_roots(roots, scale, falling):
    roots = sorted(roots)
    assume(all(b - a > 1e-3 for a, b in pairwise(roots)))
    assume(all(abs(root) > 1e-6 and abs(root - 1) > 1e-6 for root in roots))
    series = np.zeros(ORDER + 1)
    series[: len(roots) + 1] = scale * np.polynomial.polynomial.polyfromroots(roots)
    rising_first = (scale > 0) == (len(roots) % 2 == 1)  # the leftmost root is crossed upwards
    wanted = [r for i, r in enumerate(roots) if 0 < r < 1 and ((i % 2 == 0) == rising_first) != falling]
    found = first_crossing(series, ORDER, 0.0, 1.0, falling)
    if wanted:
        assert found == pytest.approx(wanted[0], abs=1e-9)
    else:
        assert found == -1.0


@given(root=st.floats(1e-6, 1.0), curve=st.floats(-0.4, 0.4), falling=st.booleans())
def test_polish_finds_the_zero_and_leaves_out_the_one_at_the_start(root, curve, falling):
    side = -1.0 if falling else 1.0
    series = np.zeros(ORDER + 1)
    series[1:4] = -side * root, side * (1 - curve * root), side * curve  # side h (h - root)(1 + curve h)
    upper = min(1.3 * root, 1.2)
    found = polish(series, ORDER, 0.0, upper, falling, True)
    with mpmath.workprec(100):
        a, b, c = (mpmath.mpf(float(x)) for x in series[1:4])
        true = (-b + side * mpmath.sqrt(b * b - 4 * a * c)) / (2 * c) if abs(c) > 1e-3 else None
    assert found == pytest.approx(root, rel=1e-13)
    if true is not None:
        assert found == pytest.approx(float(true), rel=1e-14)


@pytest.mark.parametrize("name", PULSE_NAMES)
def test_slender_limit_is_reached_like_alpha_squared(name):
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


@pytest.mark.parametrize("name", SIGNED)
def test_fates_reach_the_slender_limit(name):
    rng = np.random.default_rng(10)
    n = 300
    question = {
        "slenderness": rng.uniform(0.05, 0.98, n),
        "frequency_ratio": np.exp(rng.uniform(-1, 2.5, n)),
        "restitution": rng.uniform(0, 1, n),
    }
    slender = rocking.peak_response(name, **question)
    for alpha in (1e-8, 1e-5):
        found = rocking.peak_response(name, **question, alpha=alpha)
        np.testing.assert_array_equal(found.outcome, slender.outcome)
