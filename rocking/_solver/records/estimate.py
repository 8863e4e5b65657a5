"""Estimated outcomes of many bodies under one record, for searches: `LANES` bodies at a time.

Equation and rules are those of `rocking._solver.rules`. One step of degree 5 follows a sample interval, or what an
impact leaves of it; its error is 1e-8 or less, which shifts a change of outcome by a relative 1e-6 or less in the
strength. Impacts that certainly accumulate within an interval, and flights much shorter than one, end in rest. Of
19,200 responses of 12 bodies 19 had another outcome than that of `rocking._solver.records.record_response`. A body
against a wall has two edges here that are alike and lift under the same acceleration: it rocks about them in turn.

Each flight carries the derivatives of z and w with respect to the logarithm of the factor g of the record: from

    z'' = -pull (V S + F C),   dF/d ln g = F,  dV/d ln g = V - 1,  dS/dz = s' C,  dC/dz = c' S

and at an impact with the velocity w at a time that changes by -dz/w. At a peak z of a flight, (1 - z)/|dz/d ln g| is
about how far away in ln g it reaches the unstable equilibrium; the smallest of all peaks, and of the same for z + w at
the end of the record, is the reach of the response.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rocking._numba.cancellation import StopFlag, is_stopped
from rocking._numba.compilation import FloatArray, Record, entry, kernel
from rocking._numba.simd import LANES, any_lane, lane_bits, load, maximum, minimum, select, splat, square_root, store
from rocking._solver.bodies import outcome_margin_of
from rocking._solver.chunks import AVAILABLE_CORES, fill_chunks
from rocking._solver.records.samples import LATER, LATER_LOW, SHAPE, VERTICAL
from rocking._solver.state import EDGE_COLUMNS, RESPONSE_RECORD

Array = NDArray[np.float64]

FAR = 1e9
"""Reach of a body without a peak."""

LONGEST = 0.06
"""Longest step [tau]."""

SHORTEST = 256.0
"""A flight shorter than a sample interval over half of this ends in rest [-]."""

RATE, FACTOR = 0, 1
A, ETA, PULL, S_RATE, C_RATE, RATIO = range(2, 14, 2)
SIGN, Z, W, S, C, DZ, DW, NEAREST, AT, F0, F1, V0, V1, IN_USE, ROWS = range(14, 29)
"""Rows of the lanes: constants of the body, those of the right edge followed by those of the left one; sgn(theta), the
state with its derivatives, the reach, the time since the sample before, f and V there and at the next one."""

OVER, REACH, END_Z, END_W, END_SIGN = range(5)
"""Columns of the results."""

CHUNK = 32 * LANES
"""Bodies given to a thread at a time."""

TINY = 1e-300


def estimate_outcomes(
    samples: Array, cells: NDArray[np.void], threads: int | None = None, stop: StopFlag | None = None
) -> tuple[NDArray[np.bool_], Array]:
    """Whether each body overturns, and the reach of its response; arrays (size,).

    Parameters
    ----------
    samples : float array (7, samples)
        Of `sample_rows`, equidistant.
    cells : array (size,) of `BODY_CELL`
        The bodies. Where neighbours are alike, the work is least.
    threads, stop
        As for `rocking._solver.records.record_response.solve_bodies`.
    """
    found = np.empty((cells.size, END_SIGN + 1))

    def fill(part: slice, flag: NDArray[np.uint8]) -> None:
        own = cells[part]
        follow_lanes(samples, own, np.ones((ROWS, LANES)), np.zeros((2, LANES), np.int64), flag, found[part])

    fill_chunks(fill, cells.size, CHUNK, threads or AVAILABLE_CORES, stop)
    ends, edges = np.zeros(cells.size, RESPONSE_RECORD), np.zeros((cells.size, EDGE_COLUMNS))
    ends["end_rotation"], ends["end_velocity"], edges[:, 2] = found[:, END_Z], found[:, END_W], found[:, END_SIGN]
    return (found[:, OVER] > 0.0) | (outcome_margin_of(ends, edges, cells) >= 0.0), found[:, REACH]


@kernel
def set_lane(lanes: FloatArray, lane: int, cell: Record) -> None:
    """Set a lane to a body at rest."""
    lanes[RATE, lane], lanes[FACTOR, lane], lanes[NEAREST, lane] = cell.rate, cell.vertical, FAR
    lanes[SIGN, lane], lanes[IN_USE, lane], lanes[AT, lane] = 1.0, 1.0, -1.0
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
def uplift(samples: FloatArray, lanes: FloatArray, places: FloatArray, lane: int) -> bool:
    """Set a lane that rests to its next uplift; False if there is none."""
    f, vertical, later, later_low = samples[SHAPE], samples[VERTICAL], samples[LATER], samples[LATER_LOW]
    right, left, factor = lanes[A, lane], lanes[A + 1, lane], lanes[FACTOR, lane]
    strongest = max(right, left)
    lanes[Z, lane], lanes[W, lane], lanes[S, lane], lanes[C, lane] = 0.0, 0.0, 1.0, 1.0
    lanes[DZ, lane], lanes[DW, lane] = 0.0, 0.0
    for k in range(places[0, lane], len(f) - 1):
        v1 = 1.0 + factor * vertical[k + 1]
        if v1 - left * f[k + 1] < 0.0 or v1 + right * f[k + 1] < 0.0:
            sign = -1.0 if v1 - left * f[k + 1] < 0.0 else 1.0
            strength, v0 = (right if sign > 0.0 else -left), 1.0 + factor * vertical[k]
            q0 = max(v0 + strength * f[k], 0.0)
            at = lanes[RATE, lane] * q0 / (q0 - (v1 + strength * f[k + 1]))
            if k == places[0, lane] and at <= lanes[AT, lane]:
                continue  # it rests again at once: within rounding of the end of the interval
            lanes[SIGN, lane], lanes[AT, lane], places[0, lane] = sign, at, k
            lanes[F0, lane], lanes[F1, lane], lanes[V0, lane], lanes[V1, lane] = f[k], f[k + 1], v0, v1
            return True
        if strongest * later[k + 1] <= 1.0 + factor * later_low[k + 1]:
            break
    return False


@kernel
def never_returns(samples: FloatArray, lanes: FloatArray, places: FloatArray, lane: int) -> bool:
    """`rocking._solver.records.taylor_flight.never_returns` at the sample of a lane, and beyond a right angle."""
    side, k = (0 if lanes[SIGN, lane] > 0.0 else 1), places[0, lane]
    if lanes[W, lane] <= 0.0 or lanes[S, lane] >= 0.0:
        return False
    # sin(alpha_s)^2 = p/(p + c') of the rates of S and C, whose product is -alpha^2
    steep = -lanes[C_RATE + side, lane] / lanes[S_RATE + side, lane]  # tan(alpha_s)^2
    lever = -lanes[S, lane] / math.sqrt(1.0 + steep)
    strongest = abs(lanes[A + side, lane]) * samples[LATER, k]
    least = 1.0 + lanes[FACTOR, lane] * samples[LATER_LOW, k]
    return bool(lanes[C, lane] < 0.0 or lever * least > strongest)


@kernel
def take_step(lanes: FloatArray) -> tuple[int, int, int]:
    """Take a step of all lanes. Returns those at the next sample, those at rest, those that may never return."""
    zero, one = splat(0.0), splat(1.0)
    on_right, in_use = load(lanes, SIGN) > 0.0, load(lanes, IN_USE) > 0.0
    h, z, w, s0, c0 = load(lanes, RATE), load(lanes, Z), load(lanes, W), load(lanes, S), load(lanes, C)
    dz, dw, at = load(lanes, DZ), load(lanes, DW), load(lanes, AT)
    right_a, left_strength = load(lanes, A), -1.0 * load(lanes, A + 1)
    f0, f1, v0, v1 = load(lanes, F0), load(lanes, F1), load(lanes, V0), load(lanes, V1)
    pull = select(on_right, load(lanes, PULL), load(lanes, PULL + 1))
    s_rate = select(on_right, load(lanes, S_RATE), load(lanes, S_RATE + 1))
    c_rate = select(on_right, load(lanes, C_RATE), load(lanes, C_RATE + 1))
    strength = select(on_right, right_a, left_strength)
    per_h = 1.0 / h
    f_rate, v_rate = per_h * (f1 - f0), per_h * (v1 - v0)
    # the series of w, S and C
    force, force_rate, v = strength * (f0 + f_rate * at), strength * f_rate, v0 + v_rate * at
    s1, c1 = s_rate * (w * c0), c_rate * (w * s0)
    w1 = pull * -1.0 * (v * s0 + force * c0)
    s2, c2 = s_rate * 0.5 * (w * c1 + w1 * c0), c_rate * 0.5 * (w * s1 + w1 * s0)
    w2 = pull * -0.5 * (v * s1 + v_rate * s0 + force * c1 + force_rate * c0)
    s3 = s_rate * (1.0 / 3.0) * (w * c2 + w1 * c1 + w2 * c0)
    c3 = c_rate * (1.0 / 3.0) * (w * s2 + w1 * s1 + w2 * s0)
    w3 = pull * (-1.0 / 3.0) * (v * s2 + v_rate * s1 + force * c2 + force_rate * c1)
    s4 = s_rate * 0.25 * (w * c3 + w1 * c2 + w2 * c1 + w3 * c0)
    c4 = c_rate * 0.25 * (w * s3 + w1 * s2 + w2 * s1 + w3 * s0)
    w4 = pull * -0.25 * (v * s3 + v_rate * s2 + force * c3 + force_rate * c2)
    z2, z3, z4, z5 = w1 * 0.5, w2 * (1.0 / 3.0), w3 * 0.25, w4 * 0.2
    step = select(in_use, minimum(h - at, splat(LONGEST)), zero)
    end_z = z + step * (w + step * (z2 + step * (z3 + step * (z4 + step * z5))))
    end_s = s0 + step * (s1 + step * (s2 + step * (s3 + step * s4)))
    end_c = c0 + step * (c1 + step * (c2 + step * (c3 + step * c4)))
    hits = in_use & (end_z <= 0.0)
    if any_lane(hits):
        # Newton's method, from a zero of the parabola through both ends; from the ground, of that of z/tau
        ground = z <= 0.0
        bend = select(ground, z3, (end_z - z - w * step) / maximum(step * step, splat(TINY)))
        slope, height = select(ground, z2, w), select(ground, w, z)
        root = square_root(maximum(slope * slope - 4.0 * bend * height, zero))
        falling = 2.0 * height / maximum(root - slope, splat(TINY))
        time = select(slope < 0.0, falling, (root + slope) / maximum(-2.0 * bend, splat(TINY)))
        time = maximum(minimum(time, step), zero)
        for _ in range(2):
            value = z + time * (w + time * (z2 + time * (z3 + time * (z4 + time * z5))))
            rate = w + time * (w1 + time * (w2 + time * (w3 + time * w4)))
            time = maximum(minimum(select(rate < 0.0, time - value / rate, time), step), zero)
        step = select(hits, time, step)
        end_z, end_s, end_c = select(hits, zero, end_z), select(hits, one, end_s), select(hits, one, end_c)
    end_w = w + step * (w1 + step * (w2 + step * (w3 + step * w4)))
    # the derivatives, by a rule of second order
    start = pull * -1.0 * ((v * s_rate * c0 + force * c_rate * s0) * dz + (v - 1.0) * s0 + force * c0)
    force, v = force + force_rate * step, v + v_rate * step
    dz = dz + step * (dw + 0.5 * step * start)
    end = pull * -1.0 * ((v * s_rate * end_c + force * c_rate * end_s) * dz + (v - 1.0) * end_s + force * end_c)
    dw = dw + 0.5 * step * (start + end)
    turns = in_use & (w > 0.0) & (end_w <= 0.0)
    if any_lane(turns):
        left = maximum(select(on_right, load(lanes, RATIO), load(lanes, RATIO + 1)) - maximum(z, end_z), zero)
        left = left / maximum(maximum(dz, -1.0 * dz), splat(TINY))
        nearest = load(lanes, NEAREST)
        store(lanes, NEAREST, select(turns, minimum(nearest, left), nearest))
    arrived = in_use & (step >= h - at)
    at = select(arrived, zero, at + step)
    held = hits & (step < zero)
    if any_lane(hits):
        eta = select(on_right, load(lanes, ETA), load(lanes, ETA + 1))
        other = select(on_right, left_strength, right_a)
        other_pull = select(on_right, load(lanes, PULL + 1), load(lanes, PULL))
        after = -1.0 * eta * minimum(end_w, zero)
        q, other_q = v + force, v + other * (f0 + f_rate * select(arrived, h, at))
        other_q = select(other == strength, q, other_q)  # against a wall: no edge is lifted by rounding where q = 0
        delay = select(end_w < 0.0, -1.0 * dz / minimum(end_w, splat(-TINY)), zero)
        changed = other_pull * other_q * delay - eta * (dw - pull * q * delay)
        now, at_end = minimum(q, other_q), minimum(v1 + strength * f1, v1 + other * f1)
        now, weakest = now * minimum(pull, other_pull), minimum(now, at_end) * minimum(pull, other_pull)
        held = (after <= 0.0) & (now >= 0.0)
        held = held | ((weakest > 0.0) & (2.0 * after <= weakest * (one - eta) * (h - at)))
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
    store(lanes, F0, select(arrived, f1, f0))
    store(lanes, V0, select(arrived, v1, v0))
    risky = arrived & (end_w > 0.0) & (end_s < 0.0)
    return lane_bits(arrived), lane_bits(held), lane_bits(risky)


@kernel
def write_result(lanes: FloatArray, lane: int, found: FloatArray, cell: int) -> None:
    """Write the result of a lane."""
    over = lanes[S, lane] == -math.inf
    if not over:  # after the record it overturns from z + w of 1, about, see `rocking._solver.free_rocking`
        left = max(lanes[RATIO + (0 if lanes[SIGN, lane] > 0.0 else 1), lane] - lanes[Z, lane] - lanes[W, lane], 0.0)
        size = max(abs(lanes[DZ, lane] + lanes[DW, lane]), 1.0 / FAR)
        lanes[NEAREST, lane] = min(lanes[NEAREST, lane], left / size)
    found[cell, OVER], found[cell, REACH], found[cell, END_SIGN] = 0.0, lanes[NEAREST, lane], lanes[SIGN, lane]
    found[cell, END_Z], found[cell, END_W] = lanes[Z, lane], lanes[W, lane]
    if over:
        found[cell, OVER], found[cell, END_Z], found[cell, END_W] = 1.0, 0.0, 0.0


@entry
def follow_lanes(
    samples: FloatArray, cells: Record, lanes: FloatArray, places: FloatArray, stop: FloatArray, found: FloatArray
) -> None:
    """Fill `found` (cells, 5); `lanes` (ROWS, LANES) and `places` (2, LANES) are to work with: sample and cell."""
    f, vertical, count = samples[SHAPE], samples[VERTICAL], samples.shape[1] - 1
    following, busy = 0, 0
    ended = (1 << LANES) - 1
    for lane in range(LANES):
        places[1, lane] = -1
    while not is_stopped(stop):
        for lane in range(LANES):
            if (ended >> lane) & 1 == 0:
                continue
            if places[1, lane] >= 0:
                write_result(lanes, lane, found, places[1, lane])
                busy -= 1
            places[1, lane] = -1
            while following < len(cells):
                set_lane(lanes, lane, cells[following])
                places[0, lane], places[1, lane] = 0, following
                following += 1
                if uplift(samples, lanes, places, lane):
                    busy += 1
                    break
                write_result(lanes, lane, found, places[1, lane])
                places[1, lane] = -1
            if places[1, lane] < 0:
                lanes[IN_USE, lane] = 0.0
        if busy == 0:
            break
        ended = 0
        while ended == 0:
            arrived, held, risky = take_step(lanes)
            for lane in range(LANES):
                if (arrived >> lane) & 1 == 1:
                    k = places[0, lane] + 1
                    places[0, lane] = k
                    if k == count:
                        ended |= 1 << lane
                    else:
                        lanes[F1, lane], lanes[V1, lane] = f[k + 1], 1.0 + lanes[FACTOR, lane] * vertical[k + 1]
            if held | risky != 0:
                for lane in range(LANES):
                    if (held >> lane) & 1 == 1 and not uplift(samples, lanes, places, lane):
                        ended |= 1 << lane
                    if (risky >> lane) & 1 == 1 and never_returns(samples, lanes, places, lane):
                        ended |= 1 << lane
                        lanes[S, lane] = -math.inf
