"""Sums of sinusoids, `rocking._excitation.sinusoids`."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking._excitation.series import Family
from rocking._excitation.shapes import MAX_PIECES
from rocking._excitation.sinusoids import MAX_SINUSOIDS, SinusoidSeries
from rocking._numba.compilation import Fields, Record, SimdVector, kernel
from rocking._numba.simd import load, splat, store
from rocking._numba.simd_functions import sine_and_cosine

SINUSOIDS = int(Family.SINUSOIDS)

SERIES_LENGTH = 17  # length of the series at the start of the slender arcs: degree 16 in z
SERIES_RADIUS = 0.68  # largest max(1, Omega) h at which this series is exact to rounding: 0.68^16/16! = 1e-16

SINUSOID_FIELDS: Fields = [
    ("terms", np.int64),  # number of sinusoids c cos(w phi + d), 0 for other families
    ("amplitude", np.float64, (MAX_SINUSOIDS,)),  # c
    ("multiple", np.float64, (MAX_SINUSOIDS,)),  # w
    ("shift", np.float64, (MAX_SINUSOIDS,)),  # d
]

SINUSOID_END_FIELDS: Fields = [
    # at the ends of the monotone pieces: cosines and sines of the angles
    ("end_cosine", np.float64, (MAX_PIECES + 1, MAX_SINUSOIDS)),
    ("end_sine", np.float64, (MAX_PIECES + 1, MAX_SINUSOIDS)),
    # single sinusoid: phase at which the half period that holds the piece starts, and the cosine there, +1 or -1
    ("half_period_phase", np.float64, (MAX_PIECES + 1,)),
    ("half_period_cosine", np.float64, (MAX_PIECES + 1,)),
]


def fill_sinusoids(record: Record, series: SinusoidSeries, ends: NDArray[np.float64]) -> None:
    """Write a sum of sinusoids, the ends of whose monotone pieces are `ends` [rad]."""
    count, pieces = len(series.terms), len(ends) - 1
    amplitude, multiple, shift = (np.array(column) for column in zip(*series.terms, strict=True))
    record["terms"], record["series_length"] = count, SERIES_LENGTH
    record["amplitude"][:count], record["multiple"][:count], record["shift"][:count] = amplitude, multiple, shift
    angles = multiple * ends[:, None] + shift
    record["end_cosine"][: pieces + 1, :count] = np.cos(angles)
    record["end_sine"][: pieces + 1, :count] = np.sin(angles)
    half_turn = np.floor((0.5 * (angles[:-1, 0] + angles[1:, 0])) / np.pi)
    record["half_period_phase"][:pieces] = half_turn * np.pi - shift[0]
    record["half_period_cosine"][:pieces] = 1.0 - 2.0 * (half_turn % 2.0)


@kernel
def is_unit_sinusoid(flight: Record) -> bool:
    """Whether f is one sinusoid of amplitude 1 and frequency 1, for which phases of |a f| = 1 have closed forms."""
    return bool(
        flight.family == SINUSOIDS
        and flight.terms == 1
        and flight.multiple[0] == 1.0
        and abs(flight.amplitude[0]) == 1.0
    )


@kernel
def sinusoids_at(phi: float, flight: Record) -> float:
    """f of the excitation."""
    f = 0.0
    for k in range(flight.terms):
        f += flight.amplitude[k] * math.cos(flight.multiple[k] * phi + flight.shift[k])
    return f


@kernel
def sinusoids_and_slopes(pulse: Record, phase: SimdVector) -> Any:
    """f [-] and df/dphi at phases."""
    f, slope = splat(0.0), splat(0.0)
    for k in range(pulse.terms):
        sine, cosine = sine_and_cosine(phase * pulse.multiple[k] + pulse.shift[k])
        f += pulse.amplitude[k] * cosine
        slope -= pulse.amplitude[k] * pulse.multiple[k] * sine
    return f, slope


@kernel
def expand_sinusoids(steps: Record) -> None:
    """Fill `f` with the coefficients of F in powers of tau about `phase`."""
    f, phase, omega, strength = steps.f, load(steps.phase, 0), load(steps.omega, 0), load(steps.strength, 0)
    for k in range(steps.terms):
        sine, cosine = sine_and_cosine(phase * steps.multiple[k] + steps.shift[k])
        rate = omega * steps.multiple[k]
        # cos(x + r tau) = cos x (1 - r^2 tau^2/2 + ...) - sin x (r tau - ...): even and odd powers apart
        scale, rate_squared = strength * steps.amplitude[k], rate * rate
        even, odd = scale * cosine, scale * rate * sine * -1.0
        for n in range(0, steps.order + 1, 2):
            store(f, n, even if k == 0 else load(f, n) + even)
            even = even * rate_squared * (-1.0 / ((n + 1.0) * (n + 2.0)))
        for n in range(1, steps.order + 1, 2):
            store(f, n, odd if k == 0 else load(f, n) + odd)
            odd = odd * rate_squared * (-1.0 / ((n + 1.0) * (n + 2.0)))
