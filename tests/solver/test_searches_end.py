"""Searches end with an error, without a result, if rounding invalidates the bound on their steps."""

import numpy as np
import pytest

import rocking
from rocking._base.errors import SearchError
from rocking._numba.simd import LANES
from rocking._solver.kernels.event_loop import on_impact
from rocking._solver.peak_response import SolverState
from rocking._solver.rules import IMPACT_LIMIT
from rocking._solver.state import step_state
from rocking._solver.taylor.events import first_crossing
from tests.kernels import first_flight

ALPHA = 0.3


def test_search_for_a_zero_ends():
    series = np.full((23, LANES), np.nan)
    with pytest.raises(SearchError, match="zero of a Taylor step"):
        first_crossing(series, 0, 22, 0.0, 1.0, True, 1.0)


@pytest.mark.parametrize("order", [1, 2, 3, 4, 5])
def test_zeros_of_any_order_are_found_or_excluded(order):
    """The number of intervals is far below the bound."""
    rng = np.random.default_rng(order)
    for _ in range(20):
        zero = rng.uniform(0.2, 0.8)
        others = np.polynomial.Polynomial([1.0, 0.0, rng.uniform(0.0, 2.0)]) ** rng.integers(0, 8)  # none, and > 0
        polynomial = -np.polynomial.Polynomial.fromroots([zero] * order) * others
        series = np.zeros((23, LANES))
        series[: polynomial.coef.size, 0] = polynomial.coef
        bend = float(np.abs(polynomial.deriv(2).coef).sum()) if order > 1 or others.degree() else 0.0
        found = first_crossing(series, 0, 22, 0.0, 1.0, True, bend)
        if order > 1 and found == -1.0:  # rounding decides whether a multiple zero is crossed
            continue
        assert found == pytest.approx(zero, abs=1e-12 ** (1 / order))


@pytest.mark.parametrize("beyond", [1e-6, 1e-3, 0.02, 0.1, 0.3, 0.7])
def test_zeros_beyond_the_end_are_not_found(beyond):
    """Also where intervals have become short and increase again."""
    for place in np.linspace(0.05, 0.95, 37):
        bowl = np.polynomial.Polynomial([place * place + 1e-4, -2 * place, 1.0])  # almost zero at `place`
        polynomial = bowl * np.polynomial.Polynomial([1.0 + beyond, -1.0])
        series = np.zeros((23, LANES))
        series[: polynomial.coef.size, 0] = polynomial.coef
        bend = float(np.abs(polynomial.deriv(2).coef).sum())
        assert first_crossing(series, 0, 22, 0.0, 1.0, True, bend) == -1.0
        assert first_crossing(series, 0, 22, 0.0, 1.0 + 2 * beyond, True, 4 * bend) == pytest.approx(1.0 + beyond)


def test_flights_end(monkeypatch):
    def without_length(flight, precision):
        steps = step_state(flight, precision)
        steps["log_precision"] = -3000.0  # step size 0
        return steps

    monkeypatch.setattr("rocking._solver.peak_response.step_state", without_length)
    monkeypatch.setattr("rocking._solver.peak_response.solver_state", SolverState())
    with pytest.raises(SearchError, match="flight"):
        rocking.peak_response("sine", slenderness=0.5, frequency_ratio=3.0, restitution=0.9, alpha=ALPHA)


def test_impacts_end():
    flight = first_flight("sine", 0.5, 3.0)
    flight["length"], flight["impacts"] = 0.1, IMPACT_LIMIT + 3 * flight["interval_count"] - 1
    on_impact(flight, -0.1)
    with pytest.raises(SearchError, match="impacts"):
        on_impact(flight, -0.1)
