"""A measured trace before it is fitted: checks, the rotation at rest, and the flights that stand out."""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import ArrayLike

from rocking.extension import Array, Index, InvalidArgumentError, in_range, integer

MAX_ROTATION = 0.8  # largest rotation and alpha [rad]: beyond it a body hardly rocks, and the numbers are degrees
DURATION = 1e-3, 1e5
"""Shortest and longest trace [s]: bodies of 0.1 mm rock for hundredths of a second, those of 1 km for minutes."""

SHORTEST_STEP = 1e-7  # shortest step between samples [s]
MIN_IMPACTS = 3  # fewest impacts from which eta, alpha and p are told apart [-]
MAX_FLIGHTS = 80  # most flights that are fitted [-]: a fit with a change in each takes some times longer than without
LEVEL = 10.0
"""Peak of the smallest flight that is used, over the noise [-]; at 6, one trace in 100 had a flight too few."""

MIN_SAMPLES = 5  # fewest samples of a flight that is used [-]


def oscillation_text(impacts: Array, peaks: Array) -> str | None:
    """Text about an oscillation, whose periods do not depend on the peaks; None for free rocking.

    Flights of a block last as the power 1/2, and more, of their peaks.
    """
    duration = np.diff(impacts)
    peak = np.abs(peaks[1 : duration.size + 1])
    if np.ptp(np.log(peak)) == 0.0 or np.polyfit(np.log(peak), np.log(duration), 1)[0] > 0.25:
        return None
    return (
        "free rocking, whose flights shorten with their peaks: these last "
        f"{duration.min():.3g} to {duration.max():.3g} s for peaks of {peak.min():.3g} to {peak.max():.3g} rad, as of "
        f"an oscillation of {0.5 / np.median(duration):.3g} Hz"
    )


def peak_text(theta: Array) -> str:
    return f"values up to {np.abs(theta).max():.4g}"


def checked_trace(time: ArrayLike, rotation: ArrayLike, edges: int) -> tuple[Array, Array, int]:
    t = in_range("time", time, -1e9, 1e9, unit="s")
    theta = in_range("rotation", rotation, -1e9, 1e9, unit="rad")
    if t.ndim != 1 or t.shape != theta.shape or t.size < MIN_SAMPLES * MIN_IMPACTS:
        raise InvalidArgumentError("rotation", theta.shape, f"as many samples as of time, {t.shape}, at least 15")
    if not np.all(np.diff(t) > 0.0):
        raise InvalidArgumentError("time", f"a step of {np.diff(t).min():g} s", "ascending times")
    shortest, duration = float(np.diff(t).min()), float(t[-1] - t[0])
    if not (shortest >= SHORTEST_STEP and DURATION[0] <= duration <= DURATION[1]):
        allowed = f"a trace of {DURATION[0]:g} to {DURATION[1]:g} s in steps of {SHORTEST_STEP:g} s or more"
        raise InvalidArgumentError("time", f"{duration:g} s, the shortest step {shortest:g} s", allowed)
    if np.abs(theta).max() > MAX_ROTATION:
        allowed = f"radians, with alpha below {MAX_ROTATION:g} rad: are these degrees?"
        raise InvalidArgumentError("rotation", peak_text(theta), allowed)
    return t, theta, integer("edges", edges, 1, 2)


def rest_of(theta: Array) -> tuple[float, float, bool]:
    """Rotation at rest, the median at the end or the middle if the body rocks on; noise; True if it comes to rest."""
    noise = float(np.median(np.abs(np.diff(theta, 3))) / (0.6745 * math.sqrt(20.0)))  # of normal errors
    end, half = theta[-max(theta.size // 10, 3) :], theta[theta.size // 2 :]
    rests = bool(np.std(end) <= LEVEL * noise)
    return float(np.median(end) if rests else 0.5 * (half.max() + half.min())), noise, rests


def flights_of(t: Array, theta: Array, noise: float) -> tuple[list[Index], Array]:
    """Samples of each flight that stands out, in order, and the times of the impacts between them.

    An impact lies between the roots of the parabolas of two flights. The first flight, which may begin in a hand, is no
    parabola.
    """
    threshold = LEVEL * max(noise, 1e-9 * float(np.abs(theta).max()))
    above = np.flatnonzero(np.abs(theta) > 0.5 * threshold)
    runs = np.split(above, np.flatnonzero(np.diff(np.sign(theta[above]))) + 1)
    stands_out = [run.size >= MIN_SAMPLES and bool(np.abs(theta[run]).max() > threshold) for run in runs]
    first = stands_out.index(True) if any(stands_out) else len(runs)
    flights: list[Index] = []
    for run, is_flight in zip(runs[first:], stands_out[first:], strict=True):
        if not is_flight or len(flights) == MAX_FLIGHTS:
            break
        flights.append(run)
    impacts: list[float] = []
    for flight, following in itertools.pairwise(flights):
        end = _roots(t, theta, flight)[-1] if impacts else t[flight[-1]]
        between = 0.5 * (end + _roots(t, theta, following)[0])
        impacts.append(float(np.clip(between, t[flight[-1]], t[following[0]])))
    return flights, np.array(impacts)


def _roots(t: Array, theta: Array, flight: Index) -> Array:
    """Times at which the parabola through a flight is zero, ascending."""
    start = t[flight[0]]
    coefficients = np.polyfit(t[flight] - start, theta[flight], 2)
    return np.asarray(np.sort(np.roots(coefficients).real) + start)
