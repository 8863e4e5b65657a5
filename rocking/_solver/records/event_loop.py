"""Events of a body under samples: where it uplifts, and what follows an impact; `rocking._solver.rules` has the rules.

Given: the body, and samples of the motion, which is linear between them and zero after the last. Decided: when a body
at rest uplifts, and what follows each impact. No uplift is missed, since the restoring acceleration q = V + F of an
edge is linear on a sample interval: it is negative at one of the ends or nowhere.

Flights are followed in `arc_flight` (slender) and `taylor_flight` (rigid). They cut an interval where q = 0, and on
each of its two pieces q keeps its sign. One expression, `cut_time`, computes the cut, so that it has one value wherever
it is used.
"""

import math

from rocking._numba.compilation import FloatArray, Record, kernel
from rocking._solver.records.samples import (
    SHAPE,
    TIME,
    extremes_in_window,
    ground_at,
    interval_length,
    lifting_sign,
    next_exceedance,
    vertical_at,
)
from rocking._solver.rules import (
    IMPACT_LIMIT,
    count_impact,
    count_uplift,
    impacts_accumulate,
    pulls_of,
    reset_response,
    set_body,
    set_sign,
)

ROUNDING = 1e-15  # share of a sample interval in which a flight is within rounding [-]


@kernel
def init_body_state(block: Record, cell: Record, each_side: bool) -> None:
    """Set a body to rest at the first sample, with an empty response; `each_side`: peaks are wanted for each edge."""
    set_body(block, cell, each_side)
    reset_response(block)
    # V and F over 1 + sigma, less the prestress, have the levels of a free body
    block.h, block.vertical = cell.rate, cell.vertical / block.level
    set_sign(block, 1.0)
    block.interval, block.s, block.w0, block.largest_z, block.stepped = 0, 0.0, 0.0, 0.0, 0


@kernel
def restoring_at(block: Record, samples: FloatArray, k: int) -> float:
    """q = V + F at the sample `k`, on the edge of the flight."""
    return float(vertical_at(block, samples, k) + block.strength * samples[SHAPE, k])


@kernel
def ground_on(block: Record, samples: FloatArray, k: int) -> tuple[float, float, float, float]:
    """q at both ends of the sample interval `k`, on the edge of the flight, and V there."""
    v0, v1 = 1.0, 1.0
    if block.vertical != 0.0:
        v0, v1 = vertical_at(block, samples, k), vertical_at(block, samples, k + 1)
    return v0 + block.strength * samples[SHAPE, k], v1 + block.strength * samples[SHAPE, k + 1], v0, v1


@kernel
def cut_time(q0: float, q1: float, h: float) -> float:
    """Time since the left end of an interval at which q, of opposite signs at its ends, is zero [tau]."""
    return h * (q0 / (q0 - q1))


@kernel
def start_flight(block: Record, samples: FloatArray) -> bool:
    """Start the next flight, from rest with the next uplift; False if there is none.

    At rest q >= 0 on both edges. Since q is linear on an interval, the body uplifts in the first interval at whose
    right end q < 0 on an edge: at the zero of q there, or at once where the motion starts with a jump to q < 0.
    """
    block.starts_at_uplift, block.largest_z = 0, 0.0
    if block.at_rest == 0:
        return True
    k, s = block.interval, block.s
    jump = False
    if k == 0 and s == 0.0:
        # before the first sample the ground is still: a first sample beyond the level uplifts the body at once
        lifted = lifting_sign(block, samples[SHAPE, 0], vertical_at(block, samples, 0))
        set_sign(block, lifted if lifted != 0.0 else 1.0)
        jump = restoring_at(block, samples, 0) < 0.0
    if not jump:
        k = next_exceedance(block, samples, k)
        if k == samples.shape[1] - 1:
            return False  # no sample lifts the body: it rests to the end
        set_sign(block, lifting_sign(block, samples[SHAPE, k + 1], vertical_at(block, samples, k + 1)))
    q0, q1, _, _ = ground_on(block, samples, k)
    if q0 < 0.0:
        cut = 0.0
    else:
        cut = cut_time(q0, q1, interval_length(block, samples, k))
        block.starts_at_uplift = 1
    block.s = max(cut, s) if k == block.interval else cut  # not before the time at which it came to rest
    block.interval, block.w0, block.at_rest = k, 0.0, 0
    count_uplift(block, block.h * samples[TIME, k] + block.s)
    return True


@kernel
def on_impact(block: Record, samples: FloatArray, k: int, s: float, w: float) -> None:
    """Impact with velocity w < 0 at time `s` in the interval `k`: set the start of the next flight, or rest."""
    h = interval_length(block, samples, k)
    time = block.h * samples[TIME, k] + s - block.uplift_time
    block.w0 = count_impact(block, time, w)
    stuck = k == block.interval and s <= block.s + ROUNDING * h
    block.interval, block.s, block.at_rest = k, s, 0
    set_sign(block, block.turn * block.sign)
    f, vertical = ground_at(block, samples, k, s)
    lifted = lifting_sign(block, f, vertical)
    if lifted == 0.0:  # both edges are held down
        if block.w0 <= 0.0:  # eta = 0
            block.at_rest = 1
        elif block.impacts >= IMPACT_LIMIT or chatter_ends_in_rest(block, samples):
            block.at_rest, block.chatter = 1, 1
    elif block.w0 <= 0.0 and stuck:
        # eta = 0, one edge is lifted, but the flight had no length: q = 0 within rounding. The body rests for a moment,
        # or the same flight would start again and again
        block.at_rest, block.s = 1, s + ROUNDING * h
    elif block.w0 <= 0.0:  # eta = 0, one edge is lifted: uplift at once
        set_sign(block, lifted)
        block.w0 = 0.0
    # with a velocity the body continues about the next edge, whichever the ground lifts


@kernel
def chatter_ends_in_rest(block: Record, samples: FloatArray) -> bool:
    """Whether chatter from the start of the next flight certainly ends in rest: `impacts_accumulate`.

    Given: an impact where both edges are held down. Decided: whether the impacts that follow accumulate to rest in a
    window, which is four times as long as the series of flights would be under the present q. No extreme of q is
    missed: q is linear between samples, so that the samples in the window and its two ends have them all.
    """
    w, eta = block.w0, max(block.eta[0], block.eta[1])
    if eta == 1.0:  # no impact takes energy
        return False
    f, vertical = ground_at(block, samples, block.interval, block.s)
    pulls = pulls_of(block)
    q_right, q_left = vertical + block.a[0] * f, vertical - block.a[1] * f
    first = min(pulls[0] * q_right, pulls[1] * q_left)
    window = 8.0 * w / (first * (1.0 - eta))
    # cheaper first: under the q of the moment alone. Where that fails, no other q in the window makes it hold
    if not impacts_accumulate(block, w, pulls, window, (q_right, q_right), (q_left, q_left), vertical):
        return False
    # where q varies more, 1 - eta sqrt(spread) is below 0.24 (1 - eta): a quarter is needed for the sum of the series
    spread = ((0.76 + 0.24 * eta) / eta) ** 2 if eta > 0.0 else math.inf
    least_right, most_right, least_left, most_left, highest = extremes_in_window(block, samples, window, spread)
    right, left = (least_right, most_right), (least_left, most_left)
    return bool(impacts_accumulate(block, w, pulls, window, right, left, highest))
