"""The slender block on a piece: hyperbolic functions, state, hidden impacts and hidden peaks."""

import mpmath
import numpy as np
import pytest

from rocking._solver.records.piece import follow_piece, hyperbolic, piece_state
from tests.sampling import number


@pytest.mark.parametrize("s", [1e-9, 1e-3, 0.0499, 0.0501, 0.3, 0.999, 1.001, 3.0, 20.0, 49.0])
def test_hyperbolic_functions_keep_their_digits(s: float) -> None:
    with mpmath.workdps(40):
        exact = [mpmath.cosh(s) - 1, mpmath.sinh(s), mpmath.sinh(s) - s]
    for found, value in zip(hyperbolic(s), exact, strict=True):
        assert abs(found / value - 1) < 2e-15


def test_the_state_satisfies_the_equation() -> None:
    z, w, q0, r = 0.3, -0.4, 0.7, -2.0
    e = 1e-4
    for s in (0.01, 0.2, 0.6):
        before, here, after = (piece_state(z, w, q0, r, s + d)[0] for d in (-e, 0.0, e))
        assert (after - 2 * here + before) / e**2 == pytest.approx(here - (q0 + r * s), abs=1e-6)
        assert piece_state(z, w, q0, r, s)[1] == pytest.approx((after - before) / (2 * e), abs=1e-8)


def dense(z: float, w: float, q0: float, r: float, length: float) -> np.ndarray:
    return np.array([piece_state(z, w, q0, r, s)[0] for s in np.linspace(0.0, length, 4001)])


def test_random_pieces_against_dense_samples() -> None:
    """Both signs of q; the impact and the largest maximum are those of 4,000 samples."""
    random = np.random.default_rng(2)
    impacts = peaks = 0
    count = number(50, 1000)
    for _ in range(count):
        length = 10.0 ** random.uniform(-2, 0.5)
        restoring = random.uniform() < 0.6
        ends = random.uniform(0.0, 3.0, 2) * (1.0 if restoring else -1.0)
        r = (ends[1] - ends[0]) / length
        z, w = random.choice([0.0, 1e-3, 0.4]), random.normal() * random.choice([0.01, 0.5])
        if z == 0.0:
            w = abs(w)
        impact, z1, w1, top = follow_piece(z, w, ends[0], r, length, restoring, 0.0)
        path = dense(z, w, ends[0], r, length)
        below = np.flatnonzero(path[1:] < -1e-13)
        if impact >= 0.0:
            impacts += 1
            assert below.size == 0 or impact <= (below[0] + 1) / 4000 * length * (1 + 1e-9)
            assert abs(piece_state(z, w, ends[0], r, impact)[0]) < 1e-14
            assert z1 == 0.0
            assert w1 <= 0.0
            path = path[: max(int(impact / length * 4000), 1)]
        else:
            assert below.size == 0
            assert (z1, w1) == piece_state(z, w, ends[0], r, length)
        inner = path[1:-1]
        maxima = inner[(inner > path[:-2]) & (inner >= path[2:])] if path.size > 2 else inner[:0]
        if restoring and maxima.size:
            peaks += 1
            assert top == pytest.approx(maxima.max(), rel=1e-6, abs=1e-6 * length * length)
        assert top <= max(path.max(initial=0.0), z) * (1 + 1e-6) + 1e-6 * length * length
    assert impacts > count / 4
    assert peaks > count / 8


def test_a_hidden_peak_is_found() -> None:
    """The velocity is positive at both ends and negative between."""
    q0, r, length = 2.0, -2.0, 1.0
    z, w = 1.0, 0.2
    assert piece_state(z, w, q0, r, length)[1] > 0.0
    impact, _, _, top = follow_piece(z, w, q0, r, length, True, 0.0)
    path = dense(z, w, q0, r, length)
    inside = path[1:-1]
    maxima = inside[(inside > path[:-2]) & (inside >= path[2:])]
    assert impact < 0.0
    assert maxima.size == 1
    assert top == pytest.approx(maxima[0], rel=1e-6)
    assert z < top < path[-1]
