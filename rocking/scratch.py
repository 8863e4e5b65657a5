"""The one record on which the kernels work: a pulse, and the state of the cell in hand.

Plain memory of fixed layout: kernels read and write it without reference counting, and loops over the sinusoids of the
pulse have a length known when they are compiled. One record is prepared per pulse; each thread works on a copy.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from rocking.compilation import Record
from rocking.pulses import AbstractPulse, SinusoidalPulse, WaveletPulse

MOST_PIECES = 84
"""Most monotone pieces of a pulse: Mavroeidis & Papageorgiou with 20 cycles."""

COEFFICIENTS = 17
"""Length of the series of the slender arcs: degree 16 in z."""

ORDER = 20
"""Degree of the Taylor steps."""

IMPACT, PULSE_END, FALLEN = 0, 1, 2
"""What ends a flight; it has fallen when nothing can bring it back, known before the pulse ends."""

POLYNOMIAL = 4
"""Coefficients of a wavelet's polynomial."""


def layout(terms: int) -> np.dtype[np.void]:
    """Fields of the record for a pulse of that many sinusoids c cos(w phi + d); wavelets have one of amplitude 0."""
    per_term = (terms,)
    ends, cuts = (MOST_PIECES + 1,), (3 * MOST_PIECES + 1,)
    series = (ORDER + 1,)
    return np.dtype(
        [
            # the pulse
            ("amplitude", np.float64, per_term),  # c
            ("multiple", np.float64, per_term),  # w
            ("shift", np.float64, per_term),  # d
            ("spread", np.float64),  # wavelet: f = (sum polynomial[k] phi^k) exp(-phi^2/spread); 0: sinusoids
            ("polynomial", np.float64, (POLYNOMIAL,)),
            ("pieces", np.int64),  # monotone pieces of f
            ("end_phase", np.float64, ends),  # their ends, with f and the angles' cosines and sines there
            ("end_shape", np.float64, ends),
            ("end_cosine", np.float64, (*ends, terms)),
            ("end_sine", np.float64, (*ends, terms)),
            ("half_turn", np.float64, ends),  # single sinusoid: phase at which the piece's half-turn of it starts,
            ("upright", np.float64, ends),  # and its cosine there, +1 or -1
            # the cell
            ("a", np.float64),  # 1/slenderness
            ("omega", np.float64),  # frequency ratio
            ("rate", np.float64, per_term),  # Omega = omega w
            ("fastest", np.float64),  # largest of 1 and the rates
            ("alpha", np.float64),  # slenderness angle [rad], 0: slender limit
            ("cut_phase", np.float64, cuts),  # see `cuts`
            ("cut_level", np.float64, cuts),  # of the interval to the right: +1 if a f > 1, -1 if a f < -1, else 0
            ("cut_rise", np.float64, cuts),  # sign of f' there
            ("cut_cosine", np.float64, (*cuts, terms)),
            ("cut_sine", np.float64, (*cuts, terms)),
            # where `rock` stands
            ("count", np.int64),  # intervals between cuts
            ("interval", np.int64),  # the one that holds the start of the next flight
            ("at_rest", np.int64),  # whether that starts with an uplift
            ("next_phase", np.float64),  # its start
            ("next_w", np.float64),
            ("next_sign", np.float64),
            # the flight
            ("sign", np.float64),  # sgn(theta)
            ("force", np.float64, per_term),  # sgn(theta) a c
            ("phase", np.float64),  # phi at its start
            ("w0", np.float64),  # velocity there
            ("length", np.float64),  # its duration [tau]
            ("lifted", np.int64),  # whether it starts with an uplift through |a f| = 1, where q is exactly 0
            ("q0", np.float64),  # pull there
            ("share", np.float64, per_term),  # coefficients of its arc, see `slender_arcs.anchor`
            ("x0", np.float64),
            ("y0", np.float64),
            ("below", np.float64),
            ("slope", np.float64),
            ("cosine0", np.float64, per_term),  # of the angles there
            ("sine0", np.float64, per_term),
            ("cosine1", np.float64, per_term),  # at the point last turned to
            ("sine1", np.float64, per_term),
            ("coef", np.float64, (COEFFICIENTS,)),  # Taylor coefficients of z about the point last expanded at
            ("scaled", np.float64, per_term),
            # the Taylor step
            ("z", np.float64, series),  # coefficients of z,
            ("rate_of_z", np.float64, series),  # of dz/dtau,
            ("f", np.float64, series),  # of sgn(theta) a f,
            ("gauss", np.float64, series),  # of the wavelet's Gaussian,
            ("s", np.float64, series),  # of sin(alpha (1 - z))/alpha
            ("c", np.float64, series),  # and of cos(alpha (1 - z))
            # the answer, as in `response.Response`
            ("outcome", np.int64),
            ("peak", np.float64),
            ("mode", np.int64),
            ("impacts", np.int64),
            ("chatter", np.int64),
            ("uplift_time", np.float64),
            ("first_time", np.float64),
            ("first_velocity", np.float64),
            ("end_z", np.float64),  # state at the end of the pulse, in the mirror image of the flight,
            ("end_w", np.float64),
            ("end_sign", np.float64),  # and sgn(theta), 0 at rest
        ],
        align=True,
    )


@lru_cache(maxsize=256)
def prepared(pulse: AbstractPulse) -> Record:
    """The record of a pulse, to be copied before use."""
    wavelet = isinstance(pulse, WaveletPulse)
    terms = ((0.0, 1.0, 0.0),) if wavelet else pulse.terms if isinstance(pulse, SinusoidalPulse) else ()
    record: Record = np.zeros(1, layout(len(terms)))[0]
    amplitude, multiple, shift = (np.array(column) for column in zip(*terms, strict=True))
    record["amplitude"], record["multiple"], record["shift"] = amplitude, multiple, shift
    if isinstance(pulse, WaveletPulse):
        record["spread"] = pulse.spread
        record["polynomial"][: len(pulse.polynomial)] = pulse.polynomial
    phases = np.array([pulse.start, *pulse.stationary, pulse.end])
    count = len(phases)
    record["pieces"] = count - 1
    record["end_phase"][:count] = phases
    record["end_shape"][:count] = pulse.shape(phases)
    angles = multiple * phases[:, None] + shift
    record["end_cosine"][:count] = np.cos(angles)
    record["end_sine"][:count] = np.sin(angles)
    half_turn = np.floor((0.5 * (angles[:-1, 0] + angles[1:, 0])) / np.pi)
    record["half_turn"][: count - 1] = half_turn * np.pi - shift[0]
    record["upright"][: count - 1] = 1.0 - 2.0 * (half_turn % 2.0)
    return record
