"""A flight of the rigid block under a recorded motion, by Taylor steps on pieces of the sample intervals.

Given: the start of the flight, and the samples. Decided for each step: whether it holds an impact or a peak, and
whether the body certainly overturns. No event is missed: a piece ends at a sample and where q = V + F changes its sign,
and no step passes the end of its piece. At z = 0 the acceleration is -pull q (`rocking._solver.rules`), so that the
argument of `rocking._solver.taylor.flight` holds on each piece:

- q > 0: z = 0 is crossed downwards only, once. The sign of z at the end of a step decides.
- q <= 0: F <= -V and S <= C, so that V S + F C <= V (S - C) <= 0. z'' >= 0 for all z >= 0 up to |theta| = pi/2, and z
  has at most one minimum and no maximum; under a tendon (`may_turn`) it may have one, as there.
"""

import math

from rocking._numba.compilation import FloatArray, Record, kernel
from rocking._solver.records.event_loop import cut_time, ground_on
from rocking._solver.records.samples import LATER, LATER_LOW, SHAPE, interval_length
from rocking._solver.rules import known_rotation
from rocking._solver.state import IMPACT, IN_FLIGHT, OVERTURNS, PULSE_END
from rocking._solver.taylor.events import evaluate_series
from rocking._solver.taylor.flight import highest_peak, impact_in_step
from rocking._solver.taylor.step import set_edge_lane


@kernel
def start_piece(block: Record, samples: FloatArray, steps: Record, lane: int, at_cut: bool) -> None:
    """Set the force and the limit of the step that starts at `block.s` in the interval; q is 0 there if `at_cut`."""
    k, s, h = block.interval, block.s, interval_length(block, samples, block.interval)
    q0, q1, v0, v1 = ground_on(block, samples, k)
    slope, vertical_slope = (q1 - q0) / h, 0.0 if v0 == v1 else (v1 - v0) / h
    block.length = block.piece_end = h
    restoring = q0 + q1 > 0.0  # where q keeps its sign, its sign at the middle
    if q0 < 0.0 < q1 or q1 < 0.0 < q0:  # two pieces, before and after the cut
        cut = cut_time(q0, q1, h)
        if s < cut and not at_cut:
            block.piece_end = cut
            restoring = q0 > 0.0
        else:
            restoring = q1 > 0.0
    block.destabilised = int(not restoring)
    vertical = v0 + vertical_slope * s
    if steps.has_vertical == 1:
        steps.vertical[lane], steps.vertical_rate[lane] = vertical, vertical_slope
    # at the cut q = 0 exactly: F = -V without rounding, or the body would uplift with an acceleration of its own
    steps.force[lane] = -vertical if at_cut else (q0 - v0) + (slope - vertical_slope) * s
    steps.force_rate[lane] = slope - vertical_slope
    steps.limit[lane] = max(block.piece_end - s, 0.0)


@kernel
def start_steps(block: Record, samples: FloatArray, steps: Record, lane: int) -> None:
    """Set a lane to the start of a flight."""
    block.from_ground = 1
    set_edge_lane(steps, lane, block, block.side)
    steps.z0[lane], steps.w0[lane] = 0.0, block.w0
    start_piece(block, samples, steps, lane, block.starts_at_uplift == 1)


@kernel
def never_returns(block: Record, samples: FloatArray, z: float, w: float) -> bool:
    """Whether a body with rotation z and velocity w at the right end of the interval certainly overturns.

    Beyond alpha_s and with w > 0, z'' > 0 as long as sin(alpha z - alpha_s) > tan(alpha_s) |F|/V, and the sine
    increases up to |theta| = pi/2; the largest later |f| over the smallest later V bounds the right side. In the
    slender limit z - alpha_s/alpha > (alpha_s/alpha) |F|/V.
    """
    alpha, ratio = block.alpha, block.ratio[block.side]
    beyond = z - ratio
    if w <= 0.0 or beyond <= 0.0:  # it can still come back
        return False
    if alpha * z >= 0.5 * math.pi:  # it lies on its side
        return True
    k = block.interval
    if block.restrained == 1:
        # V sin(alpha z - alpha) exceeds all that restores: it grows up to pi/2, these are bounded, or grow less
        lowest = 1.0 + block.level * block.vertical * samples[LATER_LOW, k]
        strength = block.level * block.a[0] * samples[LATER, k]
        if alpha == 0.0:
            held = block.level - 1.0 + block.spring * z + strength
            return bool(lowest > block.spring and lowest * beyond > held)
        held = block.spring + math.sin(alpha) * (block.level - 1.0) + math.tan(alpha) * strength
        return bool(lowest * math.sin(alpha * beyond) > held)
    strongest = block.a[block.side] * samples[LATER, k] / (1.0 + block.vertical * samples[LATER_LOW, k])
    if beyond <= ratio * strongest:  # sin(x) <= x <= tan(x): no need of either
        return False
    return bool(alpha == 0.0 or math.sin(alpha * beyond) > math.tan(alpha * ratio) * strongest)


@kernel
def process_step(block: Record, samples: FloatArray, steps: Record, lane: int) -> tuple[int, float, float, float]:
    """Process the events of the last step of a lane, and prepare the next step if the flight continues.

    Returns what ended the flight, or `IN_FLIGHT`; the time since the left end of the interval `block.interval`; z and
    w.
    """
    h, z, w = steps.h[lane], steps.z1[lane], steps.w1[lane]
    if steps.steady[lane] == 0.0:  # events are possible; most steps hold none
        destabilised = block.destabilised == 1
        impact = impact_in_step(steps, lane, destabilised, block.from_ground == 1)
        if impact >= 0.0:
            h, z, w = impact, 0.0, min(evaluate_series(steps.rate, lane, steps.order - 1, impact), 0.0)
        if not destabilised or block.may_turn == 1:
            known = max(known_rotation(block), block.largest_z)
            block.largest_z = max(block.largest_z, highest_peak(steps, lane, 0.0, h, z, w, known))
        if impact >= 0.0:
            return IMPACT, block.s + h, z, w
        if block.alpha * block.largest_z >= 0.5 * math.pi:
            return OVERTURNS, block.s + h, z, w
    block.from_ground = 0
    steps.z0[lane], steps.w0[lane] = z, w
    if h < steps.limit[lane]:  # the series is accurate on a part of the piece only
        if block.alpha * z >= 0.5 * math.pi:
            return OVERTURNS, block.s + h, z, w
        block.s += h
        steps.force[lane] += steps.force_rate[lane] * h
        if steps.has_vertical == 1:
            steps.vertical[lane] += steps.vertical_rate[lane] * h
        steps.limit[lane] -= h
        return IN_FLIGHT, block.s, z, w
    at_cut = block.piece_end < block.length
    if at_cut:  # the second piece of the interval
        block.s = block.piece_end
    else:  # the next interval
        block.stepped += 1
        block.interval, block.s = block.interval + 1, 0.0
        if never_returns(block, samples, z, w):
            return OVERTURNS, 0.0, z, w
        if block.interval == len(samples[SHAPE]) - 1:
            return PULSE_END, 0.0, z, w
    start_piece(block, samples, steps, lane, at_cut)
    return IN_FLIGHT, block.s, z, w
