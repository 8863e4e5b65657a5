"""The event loop of one block, from rest to the final outcome: uplift, flights, impacts, rest, peak, outcome.

Between events the motion is an exact arc for the slender block (3.1) under sinusoids (`rocking.solver.arcs`), and a
sequence of Taylor steps otherwise (`rocking.solver.taylor`), with restitution (2.3) at each impact. The intervals of
the pulse (`rocking.solver.kernels.intervals`) decide for each stretch whether it holds an impact; after the pulse
`free_outcome` decides. The first flight does not depend on the restitution: it is stored and reused for each eta.
"""

from __future__ import annotations

import math

from rocking._numba.compilation import Record, kernel
from rocking.errors import SearchError
from rocking.solver.arcs.events import long_flight, short_flight
from rocking.solver.arcs.flight import set_angles, start_arc
from rocking.solver.excitation import has_exact_arcs
from rocking.solver.kernels.chatter import chatter_ends_in_rest
from rocking.solver.kernels.free_rocking import free_outcome
from rocking.solver.kernels.intervals import split_into_intervals
from rocking.solver.state import IMPACT, OVERTURNS
from rocking.solver.taylor.flight import flight_by_steps

IMPACT_LIMIT = 200_000
"""Number of impacts after which a block that neither rests nor overturns is set to rest and flagged as chatter."""

MODES_PER_UPLIFT = 65536
"""Number of peak modes reserved for the motion between two uplifts from rest."""

ROUNDING = 1e-15
"""Excess of |a f| over 1 at the start of the pulse that is within rounding [-]."""

NO_UPLIFT, SAFE, DIRECTLY, AFTER_IMPACT = 0, 1, 2, 3
"""Values of `rocking.Outcome`, as plain integers for the kernels."""


@kernel
def init_state(slenderness: float, omega: float, alpha: float, flight: Record) -> None:
    """Initialise a cell: empty response, intervals, rest before the first of them."""
    flight.first_flight_known = 0
    flight.by_arcs = int(has_exact_arcs(flight, alpha))
    flight.outcome, flight.peak_rotation, flight.peak_mode = NO_UPLIFT, 0.0, -1
    flight.impacts, flight.chatter = 0, 0
    flight.uplift_time, flight.first_impact_time, flight.first_impact_velocity = math.nan, math.nan, math.nan
    flight.end_rotation, flight.end_velocity, flight.end_sign = 0.0, 0.0, 0.0
    flight.interval, flight.interval_count, flight.at_rest = 0, 0, 1
    flight.uplifts, flight.impacts_before_uplift = 0, 0
    if slenderness >= 1.0:
        return
    flight.a, flight.omega, flight.alpha = 1.0 / slenderness, omega, alpha
    flight.max_rate = 1.0
    for k in range(flight.terms):
        flight.rate[k] = omega * flight.multiple[k]
        flight.max_rate = max(flight.max_rate, flight.rate[k])
    flight.interval_count = split_into_intervals(slenderness, flight)


@kernel
def next_uplift(flight: Record) -> bool:
    """Advance from rest to the next uplift; False if there is none."""
    while flight.interval < flight.interval_count and flight.interval_level[flight.interval] == 0.0:
        flight.interval += 1
    if flight.interval == flight.interval_count:
        return False
    flight.next_phase, flight.next_w = flight.interval_phase[flight.interval], 0.0
    flight.next_sign = -flight.interval_level[flight.interval]  # positive ground acceleration: negative rotation
    flight.uplifts, flight.impacts_before_uplift = flight.uplifts + 1, flight.impacts
    for k in range(flight.terms if flight.by_arcs == 1 else 0):
        flight.cosine0[k] = flight.interval_cosine[flight.interval, k]
        flight.sine0[k] = flight.interval_sine[flight.interval, k]
    if flight.outcome == NO_UPLIFT:
        flight.outcome = SAFE
        flight.uplift_time = (flight.next_phase - flight.end_phase[0]) / flight.omega
    return True


@kernel
def update_peak(flight: Record, peak: float, impacts: int, free: int) -> None:
    """Update the largest peak. Of two peaks that differ by rounding the mode of the earlier one is kept.

    The mode counts the impacts since the last uplift from rest.
    """
    if peak > flight.peak_rotation * (1.0 + 1e-12):
        flight.peak_mode = MODES_PER_UPLIFT * (flight.uplifts - 1) + 2 * (impacts - flight.impacts_before_uplift) + free
    flight.peak_rotation = max(flight.peak_rotation, peak)


@kernel
def final_outcome(flight: Record, z: float, w: float, eta: float, overturns: bool) -> None:
    """Set the outcome from the state at the end of the pulse, or when overturning is certain during it."""
    flight.end_rotation, flight.end_velocity, flight.end_sign = z, w, flight.sign
    escapes, peak, after = (1, 0.0, 0) if overturns else free_outcome(z, w, eta, flight.alpha)
    if escapes > 0:
        flight.outcome = DIRECTLY if escapes == 1 and flight.impacts == 0 else AFTER_IMPACT
        flight.impacts += escapes - 1
        flight.peak_rotation, flight.peak_mode = math.nan, -1
    else:
        update_peak(flight, peak, flight.impacts + after, 1)


@kernel
def on_impact(flight: Record, w: float, eta: float) -> None:
    """Impact with velocity w < 0: set the start of the next flight, or rest."""
    phase = flight.phase + flight.omega * flight.length
    if flight.impacts == 0:
        flight.first_impact_time, flight.first_impact_velocity = flight.length, flight.sign * w
    flight.impacts += 1
    flight.next_phase, flight.next_w, flight.next_sign = phase, -eta * w, -flight.sign  # (2.3)
    while flight.interval < flight.interval_count - 1 and phase >= flight.interval_phase[flight.interval + 1]:
        flight.interval += 1
    if (
        flight.interval_level[flight.interval] * flight.sign < 0.0
        and flight.phase >= flight.interval_phase[flight.interval]
    ):
        # no flight in the direction of the destabilising force ends in its interval: it started within rounding of
        # |a f| = 1, where the interval starts (|f| grows: uplift from rest there) or where it ends (to the next one)
        if flight.interval_level[flight.interval] * flight.interval_slope[flight.interval] > 0.0 and (
            flight.starts_at_uplift == 0
        ):
            flight.at_rest = 1
            return
        flight.interval += 1
        flight.next_phase = phase = flight.interval_phase[flight.interval]
    if flight.interval == flight.interval_count:
        flight.at_rest = 1
        return
    if flight.by_arcs == 1:
        set_angles(flight, phase, flight.cosine0, flight.sine0)
    flight.at_rest = 0
    if flight.interval_level[flight.interval] == 0.0:
        if flight.next_w <= 0.0:
            flight.at_rest = 1
        elif flight.impacts >= IMPACT_LIMIT or chatter_ends_in_rest(
            flight, flight.next_w, eta, phase, flight.interval_phase[flight.interval + 1], flight.peak_rotation
        ):
            flight.at_rest = flight.chatter = 1
    else:
        # such an interval holds at most three impacts: no flight in the direction of the destabilising force ends in it
        if flight.impacts > IMPACT_LIMIT + 3 * flight.interval_count:
            raise SearchError("impacts do not end")
        if flight.next_w <= 0.0:  # eta = 0 in a destabilising interval: immediate uplift
            flight.next_sign, flight.next_w = -flight.interval_level[flight.interval], 0.0


@kernel
def start_flight(flight: Record) -> bool:
    """Start the next flight; False if there is none."""
    if flight.at_rest == 1 and not next_uplift(flight):
        return False
    # through |a f| = 1, unless the pulse starts with a jump beyond it
    through = flight.interval > 0 or (
        flight.interval_slope[0] * flight.end_shape[0] > 0.0 and flight.a * abs(flight.end_shape[0]) <= 1.0 + ROUNDING
    )
    flight.starts_at_uplift = int(flight.at_rest == 1 and through)
    flight.phase, flight.w0, flight.sign = flight.next_phase, flight.next_w, flight.next_sign
    if flight.by_arcs == 1:
        start_arc(flight)
    return True


@kernel
def end_flight(flight: Record, eta: float, ended: int, w: float, z: float, top: float) -> bool:
    """End a flight of duration `flight.length` with w and z and the peak `top`; False if it was the last."""
    if flight.first_flight_known == 0:
        (
            flight.first_flight_known,
            flight.first_flight_end,
            flight.first_flight_w,
            flight.first_flight_z,
            flight.first_flight_peak,
        ) = 1, ended, w, z, top
        flight.first_flight_length, flight.first_flight_phase = flight.length, flight.phase
        flight.first_flight_sign, flight.first_flight_interval = flight.sign, flight.interval
    update_peak(flight, top, flight.impacts, 0)
    if ended != IMPACT:
        final_outcome(flight, z, w, eta, ended == OVERTURNS)
        return False
    on_impact(flight, w, eta)
    return True


@kernel
def repeat_first_flight(flight: Record, eta: float) -> bool:
    """Reuse the first flight of the cell for another eta; False if it was the last."""
    flight.outcome, flight.peak_rotation, flight.peak_mode, flight.impacts, flight.chatter = SAFE, 0.0, -1, 0, 0
    flight.first_impact_time, flight.first_impact_velocity = math.nan, math.nan
    flight.end_rotation, flight.end_velocity, flight.end_sign = 0.0, 0.0, 0.0  # stays so if it comes to rest
    flight.length, flight.phase, flight.sign = (
        flight.first_flight_length,
        flight.first_flight_phase,
        flight.first_flight_sign,
    )
    flight.interval, flight.uplifts, flight.impacts_before_uplift = flight.first_flight_interval, 1, 0
    return end_flight(
        flight, eta, flight.first_flight_end, flight.first_flight_w, flight.first_flight_z, flight.first_flight_peak
    )


@kernel
def advance_by_arc(flight: Record, eta: float) -> bool:
    """Follow the next flight by an exact arc to its end; False if it is the last or there is none."""
    if not start_flight(flight):
        return False
    time_to_interval_end = (flight.interval_phase[flight.interval + 1] - flight.phase) / flight.omega
    ended, z = IMPACT, 0.0
    h, w, top = short_flight(flight, time_to_interval_end, flight.peak_rotation)
    if h < 0.0:
        ended, h, w, z, top = long_flight(flight)
    flight.length = h
    return end_flight(flight, eta, ended, w, z, top)


@kernel
def advance(flight: Record, steps: Record, eta: float) -> bool:
    """The same for any block and excitation."""
    if flight.by_arcs == 1:
        return advance_by_arc(flight, eta)
    if not start_flight(flight):
        return False
    ended, w, z = flight_by_steps(flight, steps)
    flight.length, top = flight.elapsed, flight.largest_z
    return end_flight(flight, eta, ended, w, z, top)
