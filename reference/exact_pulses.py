"""The nine pulses in multi-precision arithmetic, defined independently of `rocking._excitation`.

The definitions are those of the table of pulses in docs/notation.md: f(phi) over a window of phase. Each pulse has its
value, its Taylor series in time and the phases at which it is stationary, all in ball arithmetic.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

from flint import arb, arb_series, ctx


class ExactPulse(NamedTuple):
    """A pulse f(phi) on `start` <= phi <= `end` [rad]; `series(phi, rate, n)`: n terms of f(phi + rate x) in x."""

    start: arb
    end: arb
    stationary: tuple[arb, ...]
    max_rate: float
    """Largest d(argument)/d(phi) of its trigonometric or Gaussian factors: the time scale that steps must resolve."""
    series: Callable[[arb, arb, int], list[arb]]

    def value(self, phi: arb) -> arb:
        """f(phi) [-]."""
        return self.series(phi, arb(0), 1)[0]


def _padded(coefficients: list[arb], n: int) -> list[arb]:
    return coefficients + [arb(0)] * (n - len(coefficients))


def _sinusoids(terms: Sequence[tuple[arb, arb, arb]]) -> Callable[[arb, arb, int], list[arb]]:
    """Sum of c sin(w phi + d)."""

    def series(phi: arb, rate: arb, n: int) -> list[arb]:
        ctx.cap = n
        total = [arb(0)] * n
        for c, w, d in terms:
            sine = arb_series([w * phi + d, w * rate], n).sin() if n > 1 else arb_series([(w * phi + d).sin()], n)
            total = [x + c * y for x, y in zip(total, _padded(sine.coeffs(), n), strict=True)]
        return total

    return series


def _wavelet(polynomial: Sequence[arb], spread: int) -> Callable[[arb, arb, int], list[arb]]:
    """(sum of c_k phi^k) exp(-phi^2/spread)."""

    def series(phi: arb, rate: arb, n: int) -> list[arb]:
        ctx.cap = n
        argument = arb_series([phi, rate][:n], n)
        factor = arb_series([polynomial[-1]], n)
        for c in reversed(polynomial[:-1]):
            factor = factor * argument + c
        return _padded((factor * (-argument * argument / spread).exp()).coeffs(), n)

    return series


def _newton(function: Callable[[arb], tuple[arb, arb]], guess: arb) -> arb:
    """Return the root near `guess` of a function that returns its value and its slope."""
    x = guess.mid()
    for _ in range(100):
        value, slope = function(x)
        step = (value / slope).mid()
        x = (x - step).mid()
        if abs(step) <= (abs(x) + 1) * arb(2) ** (4 - ctx.prec):
            return x
    raise ArithmeticError("Newton's iteration does not converge")


def _type_c(cycles: int) -> ExactPulse:
    """Makris & Chang (2000): cos(phi) from phi_n to (2 n + 1) pi - phi_n."""
    span = (2 * cycles + 1) * arb.pi()

    def end_displacement(x: arb) -> tuple[arb, arb]:
        value = (span - x).cos() + (span - 2 * x) * x.sin() - x.cos()
        slope = (span - x).sin() - 2 * x.sin() + (span - 2 * x) * x.cos() + x.sin()
        return value, slope

    start = _newton(end_displacement, arb("0.2"))
    stationary = tuple(k * arb.pi() for k in range(1, 2 * cycles + 1))
    return ExactPulse(start, span - start, stationary, 1.0, _sinusoids([(arb(1), arb(1), arb.pi() / 2)]))


def _one_sinusoid(shift: arb, end: arb, stationary: Sequence[arb]) -> ExactPulse:
    return ExactPulse(arb(0), end, tuple(stationary), 1.0, _sinusoids([(arb(1), arb(1), shift)]))


def _ricker() -> ExactPulse:
    root = arb(6).sqrt()
    series = _wavelet([arb(1), arb(0), arb(-1) / 2], 4)
    return ExactPulse(-4 * arb.pi(), 4 * arb.pi(), (-root, arb(0), root), 3.0, series)


def _ricker_antisymmetric() -> ExactPulse:
    """(z^2 - 3) z exp(-z^2/2)/beta, z = phi/sqrt(3)."""
    six, three = arb(6).sqrt(), arb(3).sqrt()
    beta = six * (3 - six).sqrt() * (-(3 - six) / 2).exp()
    inner, outer = three * (3 - six).sqrt(), three * (3 + six).sqrt()
    series = _wavelet([arb(0), -3 / (three * beta), arb(0), 1 / (three**3 * beta)], 6)
    return ExactPulse(-4 * arb.pi(), 4 * arb.pi(), (-outer, -inner, inner, outer), 3.0, series)


def _mavroeidis_papageorgiou(gamma: arb, nu: arb) -> ExactPulse:
    """Product form as published (2003), expanded into sinusoids, divided by its largest absolute value."""
    end = arb.pi() * gamma

    def product(phi: arb) -> arb:
        envelope, carrier = phi / gamma, phi + nu
        return -(envelope.sin() * carrier.cos() + gamma * carrier.sin() * (1 + envelope.cos()))

    # sin A cos B = [sin(B + A) - sin(B - A)]/2, sin B cos A = [sin(B + A) + sin(B - A)]/2, A = phi/gamma, B = phi + nu
    slow, fast = 1 - 1 / gamma, 1 + 1 / gamma
    raw = [(-gamma, arb(1), nu), (-(gamma + 1) / 2, fast, nu), (-(gamma - 1) / 2, slow, nu)]
    unscaled = _sinusoids(raw)

    def slope_and_curvature(phi: arb) -> tuple[arb, arb]:
        coefficients = unscaled(phi, arb(1), 3)
        return coefficients[1], 2 * coefficients[2]

    n = 4096
    grid = [(-end + 2 * end * k / n).mid() for k in range(n + 1)]
    slopes = [slope_and_curvature(phi)[0] for phi in grid]
    stationary = []
    for k in range(1, n):  # for some (gamma, nu) the ends are stationary; they are not interior points
        if abs(slopes[k]) < arb(2) ** (16 - ctx.prec):
            stationary.append(grid[k])
        elif k > 1 and (slopes[k - 1] < 0) != (slopes[k] < 0):
            stationary.append(_newton(slope_and_curvature, (grid[k - 1] + grid[k]) / 2))
    peak = max((abs(product(phi)) for phi in (-end, *stationary, end)), key=float)
    scaled = _sinusoids([(c / peak, w, d) for c, w, d in raw])
    return ExactPulse(-end, end, tuple(stationary), float(fast), scaled)


@lru_cache(maxsize=64)
def _build_pulse(name: str, precision: int, cycles: float, phase: float) -> ExactPulse:
    if precision != ctx.prec:
        raise ValueError("the precision must be the working precision; it is a key of the cache")
    pi = arb.pi()
    makers: dict[str, Callable[[], ExactPulse]] = {
        "sine": lambda: _one_sinusoid(arb(0), 2 * pi, [pi / 2, 3 * pi / 2]),
        "cosine": lambda: _one_sinusoid(pi / 2, 2 * pi, [pi]),
        "half_sine": lambda: _one_sinusoid(arb(0), pi, [pi / 2]),
        "rectangular": lambda: ExactPulse(arb(0), pi, (), 0.0, lambda _phi, _rate, n: _padded([arb(1)], n)),
        "c1": lambda: _type_c(1),
        "c2": lambda: _type_c(2),
        "ricker": _ricker,
        "ricker_antisymmetric": _ricker_antisymmetric,
        "mavroeidis_papageorgiou": lambda: _mavroeidis_papageorgiou(arb(cycles), arb(phase)),
    }
    return makers[name]()


PULSES = (
    "sine",
    "cosine",
    "half_sine",
    "rectangular",
    "c1",
    "c2",
    "ricker",
    "ricker_antisymmetric",
    "mavroeidis_papageorgiou",
)


def exact_pulse(name: str, cycles: float = 2.0, phase: float = 0.0) -> ExactPulse:
    """Return the named pulse at the working precision; a leading minus reverses its sign."""
    pulse = _build_pulse(name.removeprefix("-"), ctx.prec, cycles, phase)
    if not name.startswith("-"):
        return pulse
    return pulse._replace(series=lambda phi, rate, n: [-c for c in pulse.series(phi, rate, n)])


def unit_crossings(pulse: ExactPulse, amplitude: arb) -> list[arb]:
    """Return the phases [rad], ascending, at which |amplitude f| rises through 1, to the working precision.

    f is monotone between neighbouring stationary phases, so that it has at most one crossing of each sign there: none
    is missed.
    """
    ends = [pulse.start, *pulse.stationary, pulse.end]
    found = []
    for left, right in pairwise(ends):
        low, high = amplitude * pulse.value(left), amplitude * pulse.value(right)
        found += [
            _root_in_bracket(pulse, sign * amplitude, left.mid(), right.mid())
            for sign in (1, -1)
            if sign * low < 1 and sign * high > 1
        ]
    return found


def _root_in_bracket(pulse: ExactPulse, factor: arb, left: arb, right: arb) -> arb:
    """Return the root of factor f = 1 in a bracket where it rises: bisection far from it, Newton near it."""
    x = (left + right).mid() / 2
    for _ in range(1000):
        value, slope = pulse.series(x, arb(1), 2)
        excess = (factor * value - 1).mid()
        left, right = (x, right) if excess < 0 else (left, x)
        step = (excess / (factor * slope)).mid() if slope != 0 else arb(0)
        trial = (x - step).mid()
        if slope != 0 and abs(step) <= (1 + abs(x)) * arb(2) ** (8 - ctx.prec):
            return trial
        x = trial if slope != 0 and left < trial < right else ((left + right) / 2).mid()
        if right - left <= (1 + abs(x)) * arb(2) ** (8 - ctx.prec):
            return x
    raise ArithmeticError("no crossing found")
