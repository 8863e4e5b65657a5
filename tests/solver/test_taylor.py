"""Taylor steps: refinement of events, slender limit, unused terms."""

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rocking
from rocking._excitation.pulses import PULSE_NAMES
from rocking._numba.simd import LANES
from rocking._solver.peak_response import SolverState
from rocking._solver.state import MAX_ORDER, step_state
from rocking._solver.taylor.events import refine_root


def one_lane(coefficients: np.ndarray) -> np.ndarray:
    series = np.full((MAX_ORDER + 1, LANES), np.nan)
    series[:, 1] = coefficients
    return series


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
