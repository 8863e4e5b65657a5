"""Estimated outcomes of many bodies under one record, for searches: `FLOAT_LANES` bodies at a time.

Equation and rules are those of `rocking._solver.rules`. One step of degree 4 follows a sample interval, or what an
impact leaves of it, in single precision; its error is 1e-7 or less, which shifts a change of outcome by a relative 1e-6
or so in the strength. Impacts that certainly accumulate within an interval, and flights much shorter than one, end in
rest. Of 27,698 responses of 24 bodies, most near a change, 16 had another outcome by steps of degree 5 in double
precision. A body against a wall has two edges here that are alike and lift under the same acceleration: it rocks about
them in turn.

Each flight carries the derivatives of z and w with respect to the logarithm of the factor g of the record: from

    z'' = -pull (V S + F C),   dF/d ln g = F,  dV/d ln g = V - 1,  dS/dz = s' C,  dC/dz = c' S

and at an impact with the velocity w at a time that changes by -dz/w. At a peak z of a flight, (1 - z)/|dz/d ln g| is
about how far away in ln g it reaches the unstable equilibrium, above g or below it by the sign of the derivative. It is
divided by z, since a low peak seldom grows so far. The smallest of all peaks, and the same for z + w at the end of the
record without that division, are the reaches of the response. The sum of z**2 over all peaks and its derivative tell
whether the response jumps between two factors.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rocking._base.arrays import Array
from rocking._numba.cancellation import StopFlag, is_stopped
from rocking._numba.compilation import FloatArray, Record, entry, kernel
from rocking._numba.simd import (
    FLOAT_LANES,
    any_lane,
    lane_bits,
    load,
    maximum,
    minimum,
    pick,
    select,
    square_root,
    store,
)
from rocking._solver.bodies import outcome_margin_of
from rocking._solver.chunks import AVAILABLE_CORES, fill_chunks
from rocking._solver.records.samples import BLOCK, BLOCKS, BLOCKS_LOW, LATER, LATER_LOW, SHAPE, VERTICAL
from rocking._solver.state import EDGE_COLUMNS, RESPONSE_RECORD

FAR = 1e9
"""Reach of a body without a peak."""

LARGEST = 1e300
"""Larger sums of squares and derivatives are set to 0: the difference of two infinite ones is not a number."""

LONGEST = 0.06
"""Longest step [tau]."""

LEAST = 1e-5
"""Sample intervals by which each step advances at least: a lane ends even where rounding leaves a root at the start."""

SHORTEST = 256.0
"""A flight shorter than a sample interval over half of this ends in rest [-]."""

RATE, FACTOR = 0, 1
A, ETA, PULL, S_RATE, C_RATE, RATIO = range(2, 14, 2)
SIGN, Z, W, S, C, DZ, DW, UP, DOWN, PLACE, AT, F0, F1, V0, V1, IN_USE, PER_RATE, SUM, SLOPE, ROWS = range(14, 34)
"""Rows of the lanes: constants of the body, those of the right edge followed by those of the left one; sgn(theta), the
state with its derivatives, the reaches, the sample before and the time since it, f and V there and at the next one, and
the sum of squares of the peaks with its derivative."""

OVER, REACH, SQUARES, END_Z, END_W, END_SIGN = 0, 1, 3, 5, 6, 7

CHUNK = 16 * FLOAT_LANES

TINY = 1e-30


def estimate_outcomes(
    samples: Array, cells: NDArray[np.void], threads: int | None = None, stop: StopFlag | None = None
) -> tuple[NDArray[np.bool_], Array]:
    """Whether each body overturns, array (size,); the reaches above and below, sum and derivative, array (size, 4).

    `samples` (7, samples): of `sample_rows`, equidistant. `cells` (size,): the bodies, `BODY_CELL`; the work is least
    where neighbours are alike. `threads`, `stop`: as for `rocking._solver.records.record_response.solve_bodies`.
    """
    found, motion = np.zeros((cells.size, END_SIGN + 1)), samples[[SHAPE, VERTICAL]].astype(np.float32)

    def fill(part: slice, flag: NDArray[np.uint8]) -> None:
        lanes, places = np.ones((ROWS, FLOAT_LANES), np.float32), np.full(FLOAT_LANES, -1)
        follow_lanes(samples, motion, cells[part], lanes, places, flag, found[part])

    fill_chunks(fill, cells.size, CHUNK, threads or AVAILABLE_CORES, stop)
    ends, edges = np.zeros(cells.size, RESPONSE_RECORD), np.zeros((cells.size, EDGE_COLUMNS))
    ends["end_rotation"], ends["end_velocity"], edges[:, 2] = found[:, END_Z], found[:, END_W], found[:, END_SIGN]
    return (found[:, OVER] > 0.0) | (outcome_margin_of(ends, edges, cells) >= 0.0), found[:, REACH : SQUARES + 2]


@kernel
def set_lane(lanes: FloatArray, lane: int, cell: Record) -> None:
    """Set a lane to a body at rest."""
    lanes[RATE, lane], lanes[PER_RATE, lane], lanes[FACTOR, lane] = cell.rate, 1.0 / cell.rate, cell.vertical
    lanes[UP, lane], lanes[DOWN, lane], lanes[IN_USE, lane] = FAR, FAR, 1.0
    lanes[SIGN, lane], lanes[PLACE, lane], lanes[AT, lane] = 1.0, 0.0, -1.0
    lanes[SUM, lane], lanes[SLOPE, lane] = 0.0, 0.0
    for side in range(2):
        ratio, stiffness = (1.0, 1.0) if side == 0 else (cell.ratio, cell.stiffness)
        sine, cosine, alpha = math.sin(cell.alpha * ratio), math.cos(cell.alpha * ratio), cell.alpha
        slender = alpha == 0.0
        strength = 1.0 / cell.slenderness[side]  # of the edge that a wall blocks: sgn(theta) a_s of the other one
        lanes[A + side, lane] = -1.0 / cell.slenderness[1 - side] if strength == 0.0 else strength
        lanes[ETA + side, lane] = cell.eta[side]
        lanes[RATIO + side, lane] = ratio
        lanes[PULL + side, lane] = stiffness * (1.0 if slender else sine / alpha)
        lanes[S_RATE + side, lane] = -1.0 if slender else -alpha * cosine / sine
        lanes[C_RATE + side, lane] = 0.0 if slender else alpha * sine / cosine


@kernel
def uplift(samples: FloatArray, lanes: FloatArray, lane: int) -> bool:
    """Set a lane that rests to its next uplift; False if there is none."""
    f, vertical, later, later_low = samples[SHAPE], samples[VERTICAL], samples[LATER], samples[LATER_LOW]
    right, left, factor = lanes[A, lane], lanes[A + 1, lane], lanes[FACTOR, lane]
    strongest, blocks, blocks_low = max(right, left), samples[BLOCKS], samples[BLOCKS_LOW]
    first = int(lanes[PLACE, lane])
    lanes[Z, lane], lanes[W, lane], lanes[S, lane], lanes[C, lane] = 0.0, 0.0, 1.0, 1.0
    lanes[DZ, lane], lanes[DW, lane] = 0.0, 0.0
    k = first
    while k < len(f) - 1:
        if k % BLOCK == 0 and strongest * blocks[k // BLOCK] <= 1.0 + factor * blocks_low[k // BLOCK]:
            k += BLOCK
            continue
        v1 = 1.0 + factor * vertical[k + 1]
        if v1 - left * f[k + 1] < 0.0 or v1 + right * f[k + 1] < 0.0:
            sign = -1.0 if v1 - left * f[k + 1] < 0.0 else 1.0
            strength, v0 = (right if sign > 0.0 else -left), 1.0 + factor * vertical[k]
            q0 = max(v0 + strength * f[k], 0.0)
            at = lanes[RATE, lane] * q0 / (q0 - (v1 + strength * f[k + 1]))
            if k > first or at > 1.000001 * lanes[AT, lane]:  # otherwise it rests again at once, by rounding
                lanes[SIGN, lane], lanes[AT, lane], lanes[PLACE, lane] = sign, at, k
                lanes[F0, lane], lanes[F1, lane], lanes[V0, lane], lanes[V1, lane] = f[k], f[k + 1], v0, v1
                return True
        if strongest * later[k + 1] <= 1.0 + factor * later_low[k + 1]:
            break
        k += 1
    return False


@kernel
def never_returns(samples: FloatArray, lanes: FloatArray, lane: int) -> bool:
    """`rocking._solver.records.taylor_flight.never_returns` at the sample of a lane, and beyond a right angle."""
    side, k = (0 if lanes[SIGN, lane] > 0.0 else 1), int(lanes[PLACE, lane])
    if lanes[W, lane] <= 0.0 or lanes[S, lane] >= 0.0:
        return False
    # sin(alpha_s)^2 = p/(p + c') of the rates of S and C, whose product is -alpha^2
    steep = -lanes[C_RATE + side, lane] / lanes[S_RATE + side, lane]  # tan(alpha_s)^2
    lever = -lanes[S, lane] / math.sqrt(1.0 + steep)
    strongest = abs(lanes[A + side, lane]) * samples[LATER, k]
    least = 1.0 + lanes[FACTOR, lane] * samples[LATER_LOW, k]
    return bool(lanes[C, lane] < 0.0 or lever * least > strongest)


@kernel
def take_step(lanes: FloatArray, f: FloatArray, vertical: FloatArray, upright: bool) -> tuple[int, int, int]:
    """Take a step of all lanes. Returns those at the end of the record, those at rest, those that may never return."""
    on_right, in_use = load(lanes, SIGN) > 0.0, load(lanes, IN_USE) > 0.0
    h, z, w, s0, c0 = load(lanes, RATE), load(lanes, Z), load(lanes, W), load(lanes, S), load(lanes, C)
    dz, dw, at, per_h = load(lanes, DZ), load(lanes, DW), load(lanes, AT), load(lanes, PER_RATE)
    right_a, left_strength = load(lanes, A), -1.0 * load(lanes, A + 1)
    f0, f1, v0, v1 = load(lanes, F0), load(lanes, F1), load(lanes, V0), load(lanes, V1)
    pull = -1.0 * select(on_right, load(lanes, PULL), load(lanes, PULL + 1))
    s_rate = select(on_right, load(lanes, S_RATE), load(lanes, S_RATE + 1))
    c_rate = select(on_right, load(lanes, C_RATE), load(lanes, C_RATE + 1))
    strength = select(on_right, right_a, left_strength)
    f_rate, v_rate = per_h * (f1 - f0), per_h * (v1 - v0)
    force, force_rate, v = strength * (f0 + f_rate * at), strength * f_rate, v0 + v_rate * at
    # z'' = g(t, z), its partial derivatives, and the coefficients of w; the second derivative in t is 0
    tilt_s, tilt_c, square = s_rate * c0, c_rate * s0, s_rate * c_rate
    g, g_z = pull * (v * s0 + force * c0), pull * (v * tilt_s + force * tilt_c)
    g_t, g_tz = pull * (v_rate * s0 + force_rate * c0), pull * (v_rate * tilt_s + force_rate * tilt_c)
    w_square = w * w
    w2 = g_t + w * g_z
    w3 = 2.0 * (w * g_tz) + g * (g_z + square * w_square)
    w4 = 3.0 * (g * g_tz) + w2 * g_z + square * w * (3.0 * (w * g_t + g * g) + w_square * g_z)
    z2, z3, z4 = g * 0.5, w2 * (1.0 / 6.0), w3 * (1.0 / 24.0)
    w2, w3, w4, w_rate = w2 * 0.5, w3 * (1.0 / 6.0), w4 * (1.0 / 24.0), w2
    step = select(in_use, maximum(minimum(h - at, LONGEST), 0.0), 0.0)
    end_z = z + step * (w + step * (z2 + step * (z3 + step * z4)))
    hits = in_use & (end_z <= 0.0)
    if any_lane(hits):
        # Newton's method, from a zero of the parabola through both ends; from the ground, of that of z/tau
        ground = z <= 0.0
        bend = select(ground, z3 * step, end_z - z - w * step)
        slope, height = select(ground, z2, w) * step, select(ground, w, z)
        bend = select(ground, bend * step, bend)
        root = square_root(maximum(slope * slope - 4.0 * bend * height, 0.0))
        falls = slope < 0.0
        over = select(falls, 2.0 * height, root + slope)
        time = step * (over / maximum(select(falls, root - slope, -2.0 * bend), TINY))
        time = maximum(minimum(time, step), 0.0)
        for _ in range(2):
            value = z + time * (w + time * (z2 + time * (z3 + time * z4)))
            rate = w + time * (g + time * (w2 + time * (w3 + time * w4)))
            time = maximum(minimum(select(rate < 0.0, time - value / rate, time), step), 0.0)
        step = select(hits, time, step)
        end_z = select(hits, 0.0, end_z)
    end_w = w + step * (g + step * (w2 + step * (w3 + step * w4)))
    moved = end_z - z
    bend = square * moved * moved
    lean, turn = 1.0 + 0.5 * bend, moved * (1.0 + (1.0 / 6.0) * bend)
    end_s, end_c = select(hits, 1.0, s0 * lean + tilt_s * turn), select(hits, 1.0, c0 * lean + tilt_c * turn)
    # the derivatives
    start = g_z * dz + g - pull * s0
    rate = (g_tz + square * w * g) * dz + g_z * dw + w_rate - pull * tilt_s * w
    turns = in_use & (w > 0.0) & (end_w <= 0.0)
    if any_lane(turns):
        time = step * (w / maximum(w - end_w, TINY))  # of the peak
        top = z + 0.5 * time * w
        peak_dz = dz + time * (dw + 0.5 * time * (start + (1.0 / 3.0) * time * rate))
        left = maximum(select(on_right, load(lanes, RATIO), load(lanes, RATIO + 1)) - top, 0.0) / maximum(top, TINY)
        up, down = load(lanes, UP), load(lanes, DOWN)
        store(lanes, UP, select(turns, minimum(up, left / maximum(peak_dz, TINY)), up))
        store(lanes, DOWN, select(turns, minimum(down, left / maximum(-1.0 * peak_dz, TINY)), down))
        total, slope = load(lanes, SUM), load(lanes, SLOPE)
        store(lanes, SUM, select(turns, total + top * top, total))
        store(lanes, SLOPE, select(turns, slope + 2.0 * top * peak_dz, slope))
    dz, dw = (
        dz + step * (dw + 0.5 * step * (start + (1.0 / 3.0) * step * rate)),
        dw + step * (start + 0.5 * step * rate),
    )
    arrived = in_use & (step >= h - at)
    at = select(arrived, 0.0, at + maximum(step, LEAST * h))
    held = hits & (step < 0.0)
    if any_lane(hits):
        force, v = force + force_rate * step, v + v_rate * step
        eta = select(on_right, load(lanes, ETA), load(lanes, ETA + 1))
        other = select(on_right, left_strength, right_a)
        pull = -1.0 * pull
        other_pull = select(on_right, load(lanes, PULL + 1), load(lanes, PULL))
        after = -1.0 * eta * minimum(end_w, 0.0)
        q, other_q = v + force, v + other * (f0 + f_rate * select(arrived, h, at))
        other_q = select(other == strength, q, other_q)  # against a wall: no edge is lifted by rounding where q = 0
        delay = select(end_w < 0.0, -1.0 * dz / minimum(end_w, -TINY), 0.0)
        changed = other_pull * other_q * delay - eta * (dw - pull * q * delay)
        now, at_end = minimum(q, other_q), minimum(v1 + strength * f1, v1 + other * f1)
        now, weakest = now * minimum(pull, other_pull), minimum(now, at_end) * minimum(pull, other_pull)
        held = (after <= 0.0) & (now >= 0.0)
        held = held | ((weakest > 0.0) & (2.0 * after <= weakest * (1.0 - eta) * (h - at)))
        held = hits & (held | ((now > 0.0) & (SHORTEST * after <= now * h)))
        sign = load(lanes, SIGN)
        store(lanes, SIGN, select(hits & ((after > 0.0) | (q >= 0.0)), -1.0 * sign, sign))
        end_w = select(hits, after, end_w)
        dz, dw = select(hits, -1.0 * eta * dz, dz), select(hits, changed, dw)
    store(lanes, Z, end_z)
    store(lanes, W, end_w)
    store(lanes, S, end_s)
    store(lanes, C, end_c)
    store(lanes, DZ, dz)
    store(lanes, DW, dw)
    store(lanes, AT, at)
    place = load(lanes, PLACE)
    place = select(arrived, place + 1.0, place)
    store(lanes, PLACE, place)
    store(lanes, F0, select(arrived, f1, f0))
    last = len(f) - 1.0
    following = minimum(place + 1.0, last)
    store(lanes, F1, pick(f, following))
    if not upright:
        store(lanes, V0, select(arrived, v1, v0))
        store(lanes, V1, 1.0 + load(lanes, FACTOR) * pick(vertical, following))
    risky = arrived & (end_w > 0.0) & (end_s < 0.0)
    return lane_bits(in_use & (place >= last)), lane_bits(held), lane_bits(risky)


@kernel
def write_result(lanes: FloatArray, lane: int, found: FloatArray, cell: int) -> None:
    """Write the result of a lane."""
    over = lanes[S, lane] == -math.inf
    squares, slope = lanes[SUM, lane], lanes[SLOPE, lane]
    if not (squares < LARGEST and abs(slope) < LARGEST):  # a body with next to no base
        squares = slope = 0.0
    found[cell, SQUARES], found[cell, SQUARES + 1] = squares, slope
    if not over:  # after the record it overturns from z + w of 1, about, see `rocking._solver.free_rocking`
        left = max(lanes[RATIO + (0 if lanes[SIGN, lane] > 0.0 else 1), lane] - lanes[Z, lane] - lanes[W, lane], 0.0)
        slope = lanes[DZ, lane] + lanes[DW, lane]
        found[cell, REACH] = min(lanes[UP, lane], left / max(slope, 1.0 / FAR))
        found[cell, REACH + 1] = min(lanes[DOWN, lane], left / max(-slope, 1.0 / FAR))
    found[cell, OVER], found[cell, END_SIGN] = 0.0, lanes[SIGN, lane]
    found[cell, END_Z], found[cell, END_W] = lanes[Z, lane], lanes[W, lane]
    if over:
        found[cell, OVER], found[cell, END_Z], found[cell, END_W] = 1.0, 0.0, 0.0


@entry
def follow_lanes(
    samples: FloatArray,
    motion: FloatArray,
    cells: Record,
    lanes: FloatArray,
    places: FloatArray,
    stop: FloatArray,
    found: FloatArray,
) -> None:
    """Fill `found` (cells, 8); `motion` (2, samples): f and vertical acceleration over g in single precision.

    `lanes` (ROWS, FLOAT_LANES) and `places` (FLOAT_LANES,) are to work with: the cell of each lane, -1 at first.
    """
    upright = len(cells) > 0 and cells[0].vertical == 0.0
    following, busy = 0, 0
    ended = (1 << FLOAT_LANES) - 1
    while not is_stopped(stop):
        for lane in range(FLOAT_LANES):
            if (ended >> lane) & 1 == 0:
                continue
            if places[lane] >= 0:
                write_result(lanes, lane, found, places[lane])
                busy -= 1
            places[lane] = -1
            while following < len(cells):
                set_lane(lanes, lane, cells[following])
                places[lane] = following
                following += 1
                if uplift(samples, lanes, lane):
                    busy += 1
                    break
                write_result(lanes, lane, found, places[lane])
                places[lane] = -1
            if places[lane] < 0:
                lanes[IN_USE, lane] = 0.0
        if busy == 0:
            break
        ended = 0
        while ended == 0:
            ended, held, risky = take_step(lanes, motion[0], motion[1], upright)
            if held | risky != 0:
                for lane in range(FLOAT_LANES):
                    if (held >> lane) & 1 == 1 and not uplift(samples, lanes, lane):
                        ended |= 1 << lane
                    if (risky >> lane) & 1 == 1 and never_returns(samples, lanes, lane):
                        ended |= 1 << lane
                        lanes[S, lane] = -math.inf
