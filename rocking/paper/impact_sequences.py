"""Overturning of the slender block after several impacts under a sum of sinusoids, semi-analytical as (3.30).

Between impacts theta/alpha is the sum of a constant, two exponentials and the forced terms, (3.4). The time of each
impact is a root of that sum, found numerically; after the last impact one integral decides about overturning, (3.19),
as in `no_impact`, or, if that impact follows the pulse, its velocity does, (3.17). This gives the islands of three and
more impacts under the sine, which (3.10) to (3.31) do not contain, and the regions of two and four under the cosine.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

from rocking._base.errors import InvalidArgumentError, integer
from rocking._base.quantities import RESTITUTION
from rocking._excitation.pulses import AbstractPulse, SinusoidalPulse, as_pulse
from rocking._model.checks import check_ends
from rocking.paper.any_pulse import first_uplift_phase, margin_after_impact
from rocking.paper.arguments import ANY_FREQUENCY_RATIO, UPLIFTING_AMPLITUDE

_SAMPLES = 48
"""Points per radian of the pulse at which a change of sign of theta is looked for [-]: no two impacts are closer."""

MAX_IMPACTS = 1000  # most impacts that are followed [-]
_AMPLITUDES = 401  # amplitudes at which overturning is looked for first [-]


class Impact(NamedTuple):
    """An impact while the pulse acts."""

    phase: float  # phi of the pulse [rad]
    velocity: float  # d(theta/alpha)/d tau just before it, with its sign [-]


def impacts_in_pulse(
    pulse: str | AbstractPulse, amplitude: float, frequency_ratio: float, restitution: float, most: int
) -> list[Impact]:
    """The first impacts of a block while the pulse acts.

    Parameters
    ----------
    pulse : str or AbstractPulse
        A sum of sinusoids: sine, cosine, C1, ...
    amplitude : float
        a [-], (1, 1e12].
    most : int
        Number of impacts after which the motion is no longer followed, 1 to 1000.

    Returns
    -------
    list of Impact
        At most `most`. Impacts closer than 1/48 rad of the pulse are not told apart: from there on, phases are nan.
    """
    return _motion(pulse, amplitude, frequency_ratio, restitution, integer("most", most, 0, math.inf))[0]


def _motion(
    pulse: str | AbstractPulse, amplitude: float, frequency_ratio: float, restitution: float, most: int
) -> tuple[list[Impact], _Arc | None]:
    """The first impacts, and the arc on which the pulse ends; None without uplift or after the last impact wanted."""
    shape = as_pulse(pulse)
    if not isinstance(shape, SinusoidalPulse):
        raise InvalidArgumentError("pulse", shape.name, "a sum of sinusoids")
    a = UPLIFTING_AMPLITUDE.number(amplitude)
    omega = ANY_FREQUENCY_RATIO.number(frequency_ratio)
    eta = RESTITUTION.number(restitution)
    most = integer("most", most, 1, MAX_IMPACTS)
    phase, y_dot = first_uplift_phase(shape, a), 0.0
    found: list[Impact] = []
    if math.isnan(phase):
        return found, None
    side = -math.copysign(1.0, float(shape.shape(phase)))
    while len(found) < most:
        arc = _Arc(shape, a, omega, phase, y_dot, side)
        end = arc.first_root()
        if end is None:
            return found, arc
        if math.isnan(end):
            return found + [Impact(math.nan, math.nan)] * (most - len(found)), None
        velocity = float(arc.velocity(end))
        found.append(Impact(end, velocity))
        phase, y_dot, side = end, eta * velocity, -side
    return found, None


class _Arc:
    """Motion from theta = 0 at a phase, on one side, (3.4): y = side + forced + A e^-s + B e^s, s = tau since then."""

    def __init__(
        self, shape: SinusoidalPulse, a: float, omega: float, phase: float, velocity: float, side: float
    ) -> None:
        self.shape, self.omega, self.phase, self.side = shape, omega, phase, side
        # y'' - y = -side - a f: each term c cos(w phi + d) of f gives a c cos(w phi + d)/((w omega)^2 + 1)
        self.terms = [(a * c / ((w * omega) ** 2 + 1), w, d) for c, w, d in shape.terms]
        forced, rate = self._forced(np.array(phase))
        self.decaying = 0.5 * (-(side + float(forced)) - (velocity - float(rate)))
        self.growing = 0.5 * (-(side + float(forced)) + (velocity - float(rate)))

    def _forced(self, phi: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        values = sum(k * np.cos(w * phi + d) for k, w, d in self.terms)
        rates = sum(-k * w * self.omega * np.sin(w * phi + d) for k, w, d in self.terms)
        return np.asarray(values), np.asarray(rates)

    def rotation(self, phi: NDArray[np.float64] | float) -> NDArray[np.float64]:
        """theta/alpha [-]."""
        s = (np.asarray(phi) - self.phase) / self.omega
        with np.errstate(over="ignore", invalid="ignore"):
            free = self.decaying * np.exp(-s) + self.growing * np.exp(s)
        return np.asarray(self.side + self._forced(np.asarray(phi))[0] + free)

    def velocity(self, phi: NDArray[np.float64] | float) -> NDArray[np.float64]:
        """d(theta/alpha)/d tau [-]."""
        s = (np.asarray(phi) - self.phase) / self.omega
        with np.errstate(over="ignore", invalid="ignore"):
            free = self.growing * np.exp(s) - self.decaying * np.exp(-s)
        return np.asarray(self._forced(np.asarray(phi))[1] + free)

    def first_root(self) -> float | None:
        """Phase of the first return to theta = 0 within the pulse; None if there is none, nan if it is too early."""
        # Decided: the first sample beyond theta = 0, then the root before it. An arc that passes zero and comes back
        # between two samples, 1/48 rad apart, is missed. A crossing before the first sample cannot be told from the
        # start of the arc.
        count = 2 + int(_SAMPLES * (self.shape.end - self.phase))
        phi = np.linspace(self.phase, self.shape.end, count)[1:]
        if not phi.size or phi[0] >= self.shape.end:
            return None
        crossed = np.flatnonzero(self.side * self.rotation(phi) < 0)
        if not crossed.size:
            return None
        if crossed[0] == 0:
            return math.nan
        low, high = phi[crossed[0] - 1], phi[crossed[0]]
        return float(brentq(lambda x: float(self.rotation(x)), low, high, xtol=1e-15, rtol=8.9e-16))


def margin_after_impacts(
    pulse: str | AbstractPulse, amplitude: float, frequency_ratio: float, restitution: float, impacts: int
) -> float:
    """Margin of overturning after a number of impacts, the last of which may follow the pulse.

    Parameters
    ----------
    pulse, amplitude, frequency_ratio, restitution
        As for `impacts_in_pulse`.
    impacts : int
        Impacts before overturning, 1 to 999.

    Returns
    -------
    float
        Outward velocity less distance from the unstable equilibrium, in the growing part of the motion [-]: zero on the
        boundary of overturning after these impacts, positive inside it; nan if there are fewer impacts, or one more
        while the pulse acts.
    """
    count = integer("impacts", impacts, 1, MAX_IMPACTS - 1)
    found, last = _motion(pulse, amplitude, frequency_ratio, restitution, count + 1)
    if len(found) == count:
        return margin_after_impact(pulse, amplitude, frequency_ratio, restitution, *found[-1])
    if len(found) != count - 1 or last is None:
        return math.nan
    # free rocking from the end of the pulse to one more impact, (3.15) from any state
    end = last.shape.end
    rotation, outward = last.side * float(last.rotation(end)), last.side * float(last.velocity(end))
    if rotation + outward >= 1.0:
        return math.nan  # it overturns before that impact
    return float(restitution) * math.sqrt(1.0 + outward**2 - (rotation - 1.0) ** 2) - 1.0  # (3.17)


def overturning_interval(
    pulse: str | AbstractPulse,
    frequency_ratio: float,
    restitution: float,
    impacts: int,
    *,
    amplitude: tuple[float, float],
) -> tuple[float, float]:
    """The first range of amplitudes in which the block overturns after a number of impacts.

    Parameters
    ----------
    pulse, frequency_ratio, restitution, impacts
        As for `margin_after_impacts`.
    amplitude : (float, float)
        Smallest and largest a considered [-], 1 < low < high <= 1e12.

    Returns
    -------
    (float, float)
        a [-], roots of the margin; nan at an end where the range ends because the number of impacts changes, and (nan,
        nan) if no amplitude of a grid of 401 is inside.
    """
    grid = _amplitudes(amplitude)

    def margin(a: float) -> float:
        return margin_after_impacts(pulse, a, frequency_ratio, restitution, impacts)

    values = np.array([margin(float(a)) for a in grid])
    inside = np.flatnonzero(values > 0)
    if not inside.size:
        return math.nan, math.nan
    first = int(inside[0])
    last = first + int(np.argmin(np.append(values[first:] > 0, False))) - 1
    ends = []
    for edge, outer in ((first, first - 1), (last, last + 1)):
        # beyond the range the margin is negative (a root lies between) or nan: another number of impacts
        known = 0 <= outer < grid.size and values[outer] <= 0  # comparison with nan is false
        ends.append(float(brentq(margin, grid[edge], grid[outer], xtol=1e-15, rtol=8.9e-16)) if known else math.nan)
    return ends[0], ends[1]


def island_tip(
    pulse: str | AbstractPulse,
    restitution: float,
    impacts: int,
    *,
    frequency_ratio: tuple[float, float],
    amplitude: tuple[float, float],
) -> tuple[float, float]:
    """Where a region of overturning after several impacts begins: the largest omega at which it has a width.

    Parameters
    ----------
    pulse, restitution, impacts
        As for `margin_after_impacts`.
    frequency_ratio, amplitude : (float, float)
        Window of omega and of a [-] with one such region, wide at the smaller omega and absent at the larger one.

    Returns
    -------
    (float, float)
        omega and a at which the largest margin over the amplitudes vanishes [-].

    Raises
    ------
    InvalidArgumentError
        If the window has no such tip.
    """
    grid = _amplitudes(amplitude)
    low, high = check_ends(ANY_FREQUENCY_RATIO, frequency_ratio)

    def best(omega: float) -> tuple[float, float]:
        values = np.array([margin_after_impacts(pulse, float(a), omega, restitution, impacts) for a in grid])
        if np.all(np.isnan(values)):
            return -1.0, math.nan
        k = int(np.nanargmax(values))
        around = grid[max(k - 1, 0)], grid[min(k + 1, grid.size - 1)]
        found = minimize_scalar(
            lambda a: -np.nan_to_num(margin_after_impacts(pulse, a, omega, restitution, impacts), nan=-1.0),
            bounds=around, method="bounded", options={"xatol": 1e-12},
        )  # fmt: skip
        return max(-float(found.fun), float(values[k])), float(found.x)

    if not best(low)[0] > 0 > best(high)[0]:
        raise InvalidArgumentError("frequency_ratio", frequency_ratio, "a window in which one region ends")
    tip = float(brentq(lambda omega: best(omega)[0], low, high, xtol=1e-10))
    return tip, best(tip)[1]


def _amplitudes(window: tuple[float, float]) -> NDArray[np.float64]:
    """The grid of amplitudes over a window [-]."""
    ends = check_ends(UPLIFTING_AMPLITUDE, window)
    return np.geomspace(*ends, _AMPLITUDES)
