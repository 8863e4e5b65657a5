"""Ends of flights of `LANES` blocks: impacts, chatter, rest, the outcome by energy after the pulse, and the response.

Given: how each flight has ended (`rocking._solver.stages.flight`). Decided: what follows, `FINISHED` to `UNDECIDED`.
The rules are those of `rocking._solver.rules` for slender blocks with equal edges; a test compares both.
"""

import math
from typing import Any

from rocking._numba.compilation import Record, SimdVector, kernel
from rocking._numba.simd import (
    LANES,
    absolute,
    any_lane,
    load,
    maximum,
    minimum,
    select,
    splat,
    square_root,
    store,
    store_where,
)
from rocking._solver.free_rocking import slender_energy, slender_top
from rocking._solver.rules import AFTER_IMPACT, DIRECTLY, RECOVERS, peak_mode, series_fits
from rocking._solver.stages import columns as column
from rocking._solver.stages.excitation import excitation_at_angles, set_angles
from rocking._solver.stages.state import FINISHED, LONG, REPEATED, REST, SHORT, UNDECIDED
from rocking._solver.state import IMPACT, PULSE_END

MOST_IMPACTS = 400.0
"""Impacts after which a cell is left to the event loop: few cells have as many, and vectors of few cells gain
nothing."""


@kernel
def end_flights(pulse: Record, group: Record, sign: float) -> None:
    """Process the ends of flights with sgn(theta) = `sign`; set `next` and the columns of the next flight."""
    ended = load(group.ended, 0)
    hits, over = ended == float(IMPACT), ended == float(PULSE_END)
    store(group.next, 0, splat(float(UNDECIDED)))
    store(group.outcome, 0, splat(float(RECOVERS)))
    store(group.free_z, 0, splat(0.0))
    store(group.free_w, 0, splat(0.0))
    update_peaks(group, hits | over, load(group.top, 0), load(group.columns, column.IMPACTS), 0.0)
    if any_lane(over):
        final_outcomes(group, over)
    if any_lane(hits):
        on_impacts(pulse, group, sign, hits)


@kernel
def update_peaks(group: Record, where: Any, peak: SimdVector, impacts: SimdVector, free: float) -> None:
    """Update the largest peak; see `rocking._solver.rules.update_peak`."""
    before = load(group.columns, column.PEAK)
    mode = peak_mode(load(group.columns, column.UPLIFTS), impacts, load(group.columns, column.IMPACTS_BEFORE), free)
    higher = where & (peak > before * (1.0 + 1e-12))
    store_where(group.columns, column.MODE, higher, mode)
    store(group.columns, column.PEAK, select(where, maximum(peak, before), before))


@kernel
def final_outcomes(group: Record, over: Any) -> None:
    """Outcome of the cells `over` from the energy at the end of the pulse: `rocking._solver.rules.final_outcome`."""
    z, w, eta = load(group.end_z, 0), load(group.end_w, 0), load(group.columns, column.ETA)
    impacts = load(group.columns, column.IMPACTS)
    x, squared = slender_energy(z, w)
    increases = w > 0.0
    rebound = eta * eta * squared  # after the next impact, which decides nothing if z increases first
    escapes = w >= x  # (3.8)
    escapes_later = ~escapes & ~increases & (rebound >= 1.0)  # (3.16), (3.17)
    overturned, survives = over & (escapes | escapes_later), over & ~escapes & ~escapes_later
    top = select(increases, slender_top(squared, square_root((x - w) * (x + w))), z)
    update_peaks(group, survives, top, impacts, 1.0)
    update_peaks(group, survives & ~increases, slender_top(rebound, square_root(1.0 - rebound)), impacts + 1.0, 1.0)
    store_where(group.columns, column.PEAK, overturned, math.nan)
    store_where(group.columns, column.MODE, overturned, -1.0)
    directly = escapes & (impacts == 0.0)
    outcome = select(directly, splat(float(DIRECTLY)), splat(float(AFTER_IMPACT)))
    store_where(group.outcome, 0, overturned, outcome)
    store(group.columns, column.IMPACTS, select(over & escapes_later, impacts + 1.0, impacts))
    store(group.free_z, 0, select(over, z, splat(0.0)))
    store(group.free_w, 0, select(over, w, splat(0.0)))
    store_where(group.next, 0, over, float(FINISHED))


@kernel
def on_impacts(pulse: Record, group: Record, sign: float, hits: Any) -> None:
    """Impacts of the cells `hits`: the next flight or rest; see `rocking._solver.kernels.event_loop.on_impact`."""
    length, w = load(group.length, 0), load(group.end_w, 0)
    eta, omega = load(group.columns, column.ETA), load(group.columns, column.OMEGA)
    impacts = load(group.columns, column.IMPACTS)
    # the impact: count it, and keep time and velocity of the first one
    first = hits & (impacts == 0.0)
    store_where(group.columns, column.FIRST_TIME, first, length)
    store_where(group.columns, column.FIRST_VELOCITY, first, sign * w)
    store(group.columns, column.IMPACTS, select(hits, impacts + 1.0, impacts))
    phase = load(group.columns, column.PHASE) + omega * length
    w0 = eta * w * -1.0  # (2.3)
    a = load(group.a, 0)
    set_angles(pulse, group, phase)
    u = a * excitation_at_angles(pulse, group)
    quiet = absolute(u) < 1.0  # both edges are held down
    still = w0 <= 0.0  # eta = 0
    chatters = quiet & ~still & chatter_ends_in_rest(pulse, group, u, w0, phase)
    # with a velocity it continues about the other edge. Under its q0 it would fly for 2 w0/q0: short, if the series at
    # the start reaches a quarter beyond that
    q0 = 1.0 - sign * u
    short = (q0 > 0.0) & (2.5 * w0 <= load(group.reach, 0) * q0)
    following = select(short, splat(float(SHORT)), splat(float(LONG)))
    # without velocity, where one edge is destabilised: it uplifts at once, about the same edge if u pushes it there
    same = sign * u < 0.0
    following = select(still & ~quiet, select(same, splat(float(REPEATED)), splat(float(LONG))), following)
    following = select(impacts >= MOST_IMPACTS, splat(float(UNDECIDED)), following)
    # without velocity where both edges are held down, or after impacts that accumulate: rest
    following = select((still & quiet) | chatters, splat(float(REST)), following)
    store_where(group.next, 0, hits, following)
    store_where(group.columns, column.PHASE, hits, phase)
    store_where(group.columns, column.W0, hits, maximum(w0, splat(0.0)))
    store_where(group.columns, column.AT_UPLIFT, hits, 0.0)
    store_where(group.columns, column.CHATTER, hits & chatters, 1.0)


@kernel
def piece_ends(pulse: Record, phase: SimdVector) -> Any:
    """Right ends of the monotone pieces that hold the phases [rad]."""
    ends = splat(pulse.end_phase[1])
    for piece in range(1, pulse.pieces):
        ends = select(phase >= pulse.end_phase[piece], splat(pulse.end_phase[piece + 1]), ends)
    return ends


@kernel
def chatter_ends_in_rest(pulse: Record, group: Record, u0: SimdVector, w: SimdVector, phase: SimdVector) -> Any:
    """Whether chatter certainly ends in rest, as in `rocking._solver.kernels.chatter`.

    The window must end on the piece of the pulse that holds the impact: f is monotone there, so that |a f| < 1 at both
    ends holds between them.
    """
    eta, omega = load(group.columns, column.ETA), load(group.columns, column.OMEGA)
    window = 8.0 * w / ((1.0 - absolute(u0)) * (1.0 - eta))
    end = phase + omega * window
    possible = end <= piece_ends(pulse, phase)
    if not any_lane(possible):
        return possible
    set_angles(pulse, group, end)
    u1 = load(group.a, 0) * excitation_at_angles(pulse, group)
    least, most = minimum(u0, u1), maximum(u0, u1)
    weakest = 1.0 - maximum(absolute(u0), absolute(u1))
    height = w * w / weakest
    fits = series_fits(w, window, eta, weakest, height, (1.0 + least, 1.0 + most), (1.0 - most, 1.0 - least))
    return possible & fits & (weakest > 0.0) & (height <= 0.5 * weakest) & (height <= load(group.columns, column.PEAK))


@kernel
def write_responses(group: Record, done: int, responses: Record) -> None:
    """Write the responses of the lanes whose bits are set in `done`."""
    columns = group.columns
    for lane in range(LANES):
        if not (done >> lane) & 1:
            continue
        response, peak = responses[group.place[lane]], columns[column.PEAK, lane]
        response.peak_rotation, response.exceeded_alpha = peak, not (peak <= 1.0)  # also where it is nan
        response.peak_mode, response.outcome = int(columns[column.MODE, lane]), int(group.outcome[lane])
        response.impacts, response.chatter = int(columns[column.IMPACTS, lane]), columns[column.CHATTER, lane] > 0.0
        response.uplift_time = columns[column.UPLIFT_TIME, lane]
        response.first_impact_time = columns[column.FIRST_TIME, lane]
        response.first_impact_velocity = columns[column.FIRST_VELOCITY, lane]
        response.end_rotation, response.end_velocity = group.free_z[lane], group.free_w[lane]
