"""Pulses that are polynomials on consecutive pieces of phase, `rocking._excitation.polynomials`.

A Taylor step expands the polynomial of the piece in which it starts, exactly, and ends at the latest at the end of the
piece. Lanes may be in different pieces.
"""

from typing import Any

import numpy as np

from rocking._excitation.polynomials import DEGREE, MAX_POLYNOMIALS
from rocking._excitation.series import Family
from rocking._excitation.smooth import PolynomialSeries
from rocking._numba.compilation import Fields, FloatArray, Record, SimdVector, kernel
from rocking._numba.simd import LANES, gather, load, splat, store

POLYNOMIALS = int(Family.POLYNOMIALS)

POLYNOMIAL_FIELDS: Fields = [
    ("polynomials", np.int64),  # number of pieces
    ("ends", np.float64, (MAX_POLYNOMIALS + 1,)),  # `Polynomials`, with the reciprocals of `halves`
    ("middles", np.float64, (MAX_POLYNOMIALS,)),
    ("inverse_halves", np.float64, (MAX_POLYNOMIALS,)),
    ("coefficients", np.float64, (DEGREE + 1, MAX_POLYNOMIALS)),
    ("phases", np.float64, (LANES,)),  # of the last evaluation,
    ("places", np.int64, (LANES,)),  # and their pieces
]


def fill_polynomials(record: Record, series: PolynomialSeries) -> None:
    """Write a smooth pulse."""
    table = series.polynomials
    count = len(table.coefficients)
    record["polynomials"] = count
    record["ends"][: count + 1] = table.ends
    record["middles"][:count], record["inverse_halves"][:count] = table.middles, 1.0 / table.halves
    record["coefficients"][:, :count] = table.coefficients.T


@kernel
def locate_pieces(pulse: Record, phases: FloatArray) -> None:
    """Set `places` to the pieces that hold phases (LANES,): the search starts at the pieces of the last call."""
    places, ends, last = pulse.places, pulse.ends, pulse.polynomials - 1
    for lane in range(LANES):
        phase, place = phases[lane], places[lane]
        while place > 0 and phase < ends[place]:
            place -= 1
        while place < last and phase >= ends[place + 1]:
            place += 1
        places[lane] = place


@kernel
def polynomials_at(phi: float, flight: Record) -> float:
    """f of the excitation."""
    flight.phases[:] = phi
    locate_pieces(flight, flight.phases)
    place = flight.places[0]
    x, f = (phi - flight.middles[place]) * flight.inverse_halves[place], 0.0
    for k in range(DEGREE + 1):
        f = f * x + flight.coefficients[DEGREE - k, place]
    return f


@kernel
def polynomials_and_slopes(pulse: Record, phase: SimdVector) -> Any:
    """f [-] and df/dphi at phases."""
    store(pulse.phases, 0, phase)
    locate_pieces(pulse, pulse.phases)
    places = pulse.places
    inverse = gather(pulse.inverse_halves, places)
    x = (phase - gather(pulse.middles, places)) * inverse
    f, slope = gather(pulse.coefficients[DEGREE], places), splat(0.0)
    for k in range(1, DEGREE + 1):
        slope = slope * x + f
        f = f * x + gather(pulse.coefficients[DEGREE - k], places)
    return f, slope * inverse


@kernel
def expand_polynomials(steps: Record) -> None:
    """Fill `f` with the coefficients of F in powers of tau about `phase`, and `reach`, by Horner's shift."""
    locate_pieces(steps, steps.phase)
    f, places, phase, omega = steps.f, steps.places, load(steps.phase, 0), load(steps.omega, 0)
    inverse = gather(steps.inverse_halves, places)
    x = (phase - gather(steps.middles, places)) * inverse
    for k in range(DEGREE + 1):
        store(f, k, gather(steps.coefficients[k], places))
    # synthetic division by x, DEGREE times: the coefficients about x
    for first in range(DEGREE):
        carried = load(f, DEGREE)
        for k in range(1, DEGREE + 1 - first):
            carried = load(f, DEGREE - k) + x * carried
            store(f, DEGREE - k, carried)
    # from powers of the piece's variable to powers of tau; the polynomial ends, so do its coefficients
    rate, power = omega * inverse, load(steps.strength, 0)
    for n in range(DEGREE + 1):
        store(f, n, power * load(f, n))
        power = power * rate
    for n in range(DEGREE + 1, steps.order + 1):
        store(f, n, splat(0.0))
    store(steps.reach, 0, (gather(steps.ends[1:], places) - phase) / omega)
