"""Amplitudes at which the outcome for a block changes, the frequency of its pulse being fixed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking._base.equality import EqualByValue
from rocking._base.errors import number
from rocking._base.units import Scalar
from rocking._boundary.search import UNCOUNTED, Floats, Solve, block_solver, classifier, counted_code, outcomes_along
from rocking._excitation.pulses import AbstractPulse, as_pulse
from rocking._model.checks import check_number
from rocking._model.outcome_code import SURVIVES, decode_outcomes
from rocking._model.parameters import FREQUENCY_RATIO, RESTITUTION
from rocking._numba.cancellation import StopFlag


@dataclass(frozen=True, eq=False)
class Thresholds(EqualByValue):
    """Amplitudes at which the outcome for a block changes, ascending; all arrays (thresholds,).

    Attributes
    ----------
    amplitude : float array [-]
        a = a_g/(g tan alpha).
    overturns_above : bool array
        True where the block overturns just above the threshold and survives just below it.
    outcome : int8 array
        Code of `Outcome` on the overturning side.
    impacts : int32 array
        Impacts before overturning there.
    """

    amplitude: Floats
    overturns_above: NDArray[np.bool_]
    outcome: NDArray[np.int8]
    impacts: NDArray[np.int32]


def critical_amplitude(
    pulse: str | AbstractPulse,
    *,
    frequency_ratio: Scalar,
    restitution: Scalar,
    alpha: Scalar | None = None,
    highest_amplitude: Scalar = 100.0,
    stop: StopFlag | None = None,
) -> Thresholds:
    """Every amplitude between 1 and `highest_amplitude` at which the outcome changes.

    Parameters
    ----------
    pulse, frequency_ratio, restitution, alpha
        As for `peak_response`; scalars.
    highest_amplitude : float
        Largest a = a_g/(g tan alpha) considered [-], (1, 1e6].
    stop : StopFlag, optional
        Once another thread sets it, this ends soon with `StoppedError`.

    Returns
    -------
    Thresholds
        Each good to `RESOLUTION` in 1/a, or to `ELASTIC_RESOLUTION` where an elastic block overturns after more than
        `MOST_COUNTED` impacts. A region of one way of overturning narrower than 1/2000 of the range and surrounded by a
        single other outcome can be missed; a safe band between two ways of overturning, of which all with more than
        `MOST_COUNTED` impacts are one, is not, unless it is narrower than `RESOLUTION`.

    Raises
    ------
    InvalidArgumentError
        For an argument out of range.
    StoppedError
        If `stop` was set.
    """
    highest = number("highest_amplitude", highest_amplitude, 1.0, 1e6, closed="right")
    omega, eta = check_number(FREQUENCY_RATIO, frequency_ratio), check_number(RESTITUTION, restitution)
    return amplitude_changes(block_solver(as_pulse(pulse), alpha, stop), omega, eta, highest)


def amplitude_changes(solve: Solve, omega: float, eta: float, highest: float) -> Thresholds:
    """`critical_amplitude` by any solver, whose amplitude is 1 at uplift."""
    lowest, log_omega = 1.0 / highest, float(np.log(omega))
    nodes = np.union1d(np.linspace(lowest, 1.0, 2001), np.geomspace(lowest, 1.0, 2001))
    grid, codes = outcomes_along(0, (lowest, log_omega, eta), nodes, classifier(solve, counted_code))
    overturns = codes != SURVIVES
    edge = np.flatnonzero(overturns[1:] != overturns[:-1])[::-1]
    above = overturns[edge]  # 1/a falls as the amplitude rises
    overturned = np.where(above, edge, edge + 1)
    place, met = grid[overturned], codes[overturned]
    many = met == UNCOUNTED
    if many.any():
        met[many], _ = classifier(solve)(place[many], *np.array([log_omega, eta]))
    return Thresholds(1.0 / place, above, *decode_outcomes(met))
