"""The event loop of one body under a pulse, from rest to the final outcome; `rocking._solver.rules` has the rules.

Given: the body, and the pulse divided into intervals (`rocking._solver.kernels.intervals`). On an interval the ground
acceleration holds both edges down (level 0) or destabilises the body about one edge (level +-1), and f is monotone.

Decided: when a body at rest uplifts, what follows each impact, and what is known when the pulse has ended.

No uplift is missed, since |a f| = 1 at ends of intervals only. No impact is missed, since each flight between two
events is followed by Taylor steps that end where q changes its sign (`rocking._solver.taylor.flight`). The loop ends:
at most three impacts take place in a destabilising interval, and elsewhere at most `IMPACT_LIMIT`.

The first flight does not depend on the restitution: it is stored and reused for each eta.
"""

from rocking._base.errors import SearchError
from rocking._numba.compilation import Record, kernel
from rocking._solver.kernels.chatter import chatter_ends_in_rest
from rocking._solver.kernels.intervals import split_into_intervals
from rocking._solver.restrained_rocking import steepest_pull
from rocking._solver.rules import (
    IMPACT_LIMIT,
    count_impact,
    count_uplift,
    final_outcome,
    reset_response,
    set_sign,
    update_peak,
)
from rocking._solver.state import IMPACT, OVERTURNS

ROUNDING = 1e-15  # excess of |a f| over 1 at the start of the pulse that is within rounding [-]


@kernel
def init_state(flight: Record, omega: float) -> None:
    """Initialise a cell, whose body is set: empty response, intervals, rest before the first of them."""
    reset_response(flight)
    flight.first_flight_known = 0
    flight.interval, flight.interval_count = 0, 0
    if flight.slenderness[0] >= 1.0 and flight.slenderness[1] >= 1.0:
        return  # |a f| <= 1 throughout: no uplift, without a look at the pulse
    flight.omega = omega
    flight.interval_count = split_into_intervals(flight)


@kernel
def next_uplift(flight: Record) -> bool:
    """Advance from rest to the next uplift; False if there is none."""
    # a body at rest uplifts where |a f| rises through 1, and that is the start of an interval with level +-1
    while flight.interval < flight.interval_count and flight.interval_level[flight.interval] == 0.0:
        flight.interval += 1
    if flight.interval == flight.interval_count:
        return False
    flight.next_phase, flight.next_w = flight.interval_phase[flight.interval], 0.0
    flight.next_sign = -flight.interval_level[flight.interval]  # positive ground acceleration: negative rotation
    count_uplift(flight, (flight.next_phase - flight.end_phase[0]) / flight.omega)
    return True


@kernel
def on_impact(flight: Record, w: float) -> None:
    """Impact with velocity w < 0 at the end of the flight: set the start of the next flight, or rest.

    Given: the flight that has ended, and the interval in which it started. Decided: the interval of the impact, and
    what follows there: a flight about the next edge, an uplift, or rest. In a destabilising interval a flight about the
    edge of its level does not end, since z'' >= 0. So at most three impacts take place there: a flight from an earlier
    interval ends, then one about the other edge, and one within rounding of an end of the interval. A tendon can end a
    flight there: by the comparison of `rocking._solver.taylor.step.set_restraint_lane` it lasts pi/sqrt(k) or more.
    """
    phase = flight.phase + flight.omega * flight.length
    flight.next_w = count_impact(flight, flight.length, w)
    flight.next_phase, flight.next_sign = phase, flight.turn * flight.sign
    while flight.interval < flight.interval_count - 1 and phase >= flight.interval_phase[flight.interval + 1]:
        flight.interval += 1
    if (
        flight.interval_level[flight.interval] * flight.sign < 0.0
        and flight.phase >= flight.interval_phase[flight.interval]
        and not (flight.may_turn == 1 and steepest_pull(flight) * flight.length * flight.length > 1.0)
    ):
        # the flight started in this interval about the edge that is destabilised here, and should not have ended: it
        # has no length but for rounding, at one end of the interval or the other
        if flight.interval_level[flight.interval] * flight.interval_slope[flight.interval] > 0.0 and (
            flight.starts_at_uplift == 0
        ):
            flight.at_rest = 1  # |f| grows: at the start of the interval, where the body uplifts from rest
            return
        flight.interval += 1  # |f| falls: at its end, so that the next interval decides
        flight.next_phase = phase = flight.interval_phase[flight.interval]
    if flight.interval == flight.interval_count:  # the pulse has ended with this impact
        flight.at_rest = 1
        return
    flight.at_rest = 0
    if flight.interval_level[flight.interval] == 0.0:  # both edges are held down: without velocity the body rests
        if flight.next_w <= 0.0:  # eta = 0
            flight.at_rest = 1
        elif flight.impacts >= IMPACT_LIMIT or chatter_ends_in_rest(
            flight, flight.next_w, phase, flight.interval_phase[flight.interval + 1]
        ):
            flight.at_rest = flight.chatter = 1
    else:  # one edge is destabilised: the body does not rest
        if flight.impacts > IMPACT_LIMIT + 3 * flight.interval_count:
            raise SearchError("impacts do not end")
        if flight.next_w <= 0.0:  # eta = 0: it uplifts at once, about the edge that the ground destabilises
            flight.next_sign, flight.next_w = -flight.interval_level[flight.interval], 0.0


@kernel
def start_flight(flight: Record) -> bool:
    """Start the next flight; False if there is none."""
    if flight.at_rest == 1 and not next_uplift(flight):
        return False
    flight.phase, flight.w0 = flight.next_phase, flight.next_w
    set_sign(flight, flight.next_sign)
    # an uplift passes through |a f| = 1, where q = 0 without rounding, unless the pulse starts with a jump beyond it
    through = flight.interval > 0 or (
        flight.interval_slope[0] * flight.end_shape[0] > 0.0
        and flight.a[flight.side] * abs(flight.end_shape[0]) <= 1.0 + ROUNDING
    )
    flight.starts_at_uplift = int(flight.at_rest == 1 and through)
    return True


@kernel
def end_flight(flight: Record, ended: int, w: float, z: float, top: float) -> bool:
    """End a flight of duration `flight.length` with w and z and the peak `top`; False if it was the last."""
    # stored before the impact, which is the first event that depends on eta
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
    update_peak(flight, flight.side, top, flight.impacts, 0)
    if ended != IMPACT:  # the pulse has ended, or the body overturns: energy decides what follows
        final_outcome(flight, z, w, ended == OVERTURNS)
        return False
    on_impact(flight, w)
    return True


@kernel
def repeat_first_flight(flight: Record) -> bool:
    """Reuse the first flight of the cell for another restitution, which is set; False if it was the last."""
    uplift_time = flight.uplift_time
    reset_response(flight)
    count_uplift(flight, uplift_time)
    set_sign(flight, flight.first_flight_sign)
    flight.length, flight.phase = flight.first_flight_length, flight.first_flight_phase
    flight.interval = flight.first_flight_interval
    return end_flight(
        flight, flight.first_flight_end, flight.first_flight_w, flight.first_flight_z, flight.first_flight_peak
    )
