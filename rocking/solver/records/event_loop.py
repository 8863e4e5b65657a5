"""Events of a block under a recorded motion: uplift, impact, chatter, rest, peak, outcome; slender and rigid.

The motion is linear between its samples and zero after the last. With u = a f and the mirror image z = |theta|/alpha,
w = dz/dtau of a flight, q = 1 + sgn(theta) u is the restoring acceleration at the ground, linear on a sample interval.
Each interval is cut where q = 0; the cut is computed by one expression, so that it has one value wherever it is used.
"""

from __future__ import annotations

import math

from rocking._numba.compilation import FloatArray, Record, kernel
from rocking.solver.kernels.event_loop import IMPACT_LIMIT, MODES_PER_UPLIFT
from rocking.solver.kernels.free_rocking import free_outcome
from rocking.solver.records.samples import SHAPE, extremes_in_window, next_exceedance

NO_UPLIFT, SAFE, DIRECTLY, AFTER_IMPACT = 0, 1, 2, 3
"""Values of `rocking.Outcome`, as plain integers for the kernels."""

ROUNDING = 1e-15
"""Share of a sample interval in which a flight is within rounding [-]."""

MAX_UPLIFT_MODE = 32_767
"""Largest number of uplifts that the mode of a peak counts: it is an int32."""


@kernel
def init_block_state(block: Record, slenderness: float, eta: float, alpha: float, h: float) -> None:
    """Set a block to rest at the first sample, with an empty response."""
    block.a, block.eta, block.alpha, block.h = 1.0 / slenderness, eta, alpha, h
    block.interval, block.s, block.w0, block.sign, block.at_rest = 0, 0.0, 0.0, 1.0, 1
    block.uplifts, block.impacts_before_uplift, block.largest_z, block.stepped = 0, 0, 0.0, 0
    block.outcome, block.peak_rotation, block.peak_mode = NO_UPLIFT, 0.0, -1
    block.impacts, block.chatter = 0, 0
    block.uplift_time, block.first_impact_time, block.first_impact_velocity = math.nan, math.nan, math.nan
    block.end_rotation, block.end_velocity, block.end_sign = 0.0, 0.0, 0.0


@kernel
def restoring_at(block: Record, samples: FloatArray, sign: float, k: int) -> float:
    """q = 1 + sgn(theta) u at the sample `k`."""
    return float(1.0 + sign * block.a * samples[SHAPE, k])


@kernel
def cut_time(q0: float, q1: float, h: float) -> float:
    """Time since the left end of an interval at which q, of opposite signs at its ends, is zero [tau]."""
    return h * (q0 / (q0 - q1))


@kernel
def start_flight(block: Record, samples: FloatArray) -> bool:
    """Start the next flight, from rest with the next uplift; False if there is none."""
    block.starts_at_uplift, block.largest_z = 0, 0.0
    if block.at_rest == 0:
        return True
    f = samples[SHAPE]
    k, s = block.interval, block.s
    if k == 0 and s == 0.0 and block.a * abs(f[0]) > 1.0:  # the motion starts with a jump
        u = f[0]
    else:
        k = next_exceedance(samples, k, block.a)
        if k == len(f) - 1:
            return False
        u = f[k + 1]
    block.sign = -1.0 if u > 0.0 else 1.0  # positive ground acceleration: negative rotation
    q0, q1 = restoring_at(block, samples, block.sign, k), restoring_at(block, samples, block.sign, k + 1)
    if q0 < 0.0:
        cut = 0.0
    else:
        cut = cut_time(q0, q1, block.h)
        block.starts_at_uplift = 1
    block.s = max(cut, s) if k == block.interval else cut
    block.interval, block.w0, block.at_rest = k, 0.0, 0
    block.uplifts, block.impacts_before_uplift = block.uplifts + 1, block.impacts
    if block.outcome == NO_UPLIFT:
        block.outcome = SAFE
        block.uplift_time = block.h * k + block.s
    return True


@kernel
def update_peak(block: Record, peak: float, impacts: int, free: int) -> None:
    """Update the largest peak. Of two peaks that differ by rounding the mode of the earlier one is kept."""
    if peak > block.peak_rotation * (1.0 + 1e-12):
        uplifts = min(block.uplifts, MAX_UPLIFT_MODE)
        block.peak_mode = MODES_PER_UPLIFT * (uplifts - 1) + 2 * (impacts - block.impacts_before_uplift) + free
    block.peak_rotation = max(block.peak_rotation, peak)


@kernel
def final_outcome(block: Record, z: float, w: float, overturns: bool) -> None:
    """Set the outcome from the state at the last sample, or where overturning is certain before it."""
    block.end_rotation, block.end_velocity, block.end_sign = z, w, block.sign
    escapes, peak, after = (1, 0.0, 0) if overturns else free_outcome(z, w, block.eta, block.alpha)
    if escapes > 0:
        block.outcome = DIRECTLY if escapes == 1 and block.impacts == 0 else AFTER_IMPACT
        block.impacts += escapes - 1
        block.peak_rotation, block.peak_mode = math.nan, -1
    else:
        update_peak(block, peak, block.impacts + after, 1)


@kernel
def on_impact(block: Record, samples: FloatArray, k: int, s: float, w: float) -> None:
    """Impact with velocity w < 0 at time `s` in the interval `k`: set the start of the next flight, or rest."""
    h = block.h
    if block.impacts == 0:
        block.first_impact_time = h * k + s - block.uplift_time
        block.first_impact_velocity = block.sign * w
    block.impacts += 1
    stuck = k == block.interval and s <= block.s + ROUNDING * h
    block.interval, block.s = k, s
    block.w0, block.sign, block.at_rest = -block.eta * w, -block.sign, 0  # (2.3)
    f = samples[SHAPE]
    u = block.a * (f[k] + (f[k + 1] - f[k]) * (s / h))
    if abs(u) < 1.0:
        if block.w0 <= 0.0:
            block.at_rest = 1
        elif block.impacts >= IMPACT_LIMIT or chatter_ends_in_rest(block, samples, u):
            block.at_rest, block.chatter = 1, 1
    elif block.w0 <= 0.0 and stuck:  # |u| = 1 within rounding: flights without length, without end
        block.at_rest, block.s = 1, s + ROUNDING * h
    elif block.w0 <= 0.0:  # eta = 0 while the block is destabilised: immediate uplift
        block.sign, block.w0 = (-1.0 if u > 0.0 else 1.0), 0.0


@kernel
def chatter_ends_in_rest(block: Record, samples: FloatArray, u: float) -> bool:
    """Whether chatter from the start of the next flight, where the ground acceleration is `u`, certainly ends in rest.

    The argument is that of `rocking.solver.kernels.chatter`, with the extremes of u on the window instead of its ends:
    true only if |u| < 1 on the window, the geometric series of bounds of the flights fits into it, and no flight can
    exceed the peak so far.
    """
    w, eta = block.w0, block.eta
    if eta == 1.0:
        return False
    scale = math.sin(block.alpha) / block.alpha if block.alpha > 0.0 else 1.0
    stiffness = 1.0 + math.tan(block.alpha)
    first = scale * (1.0 - abs(u))
    if w * w > block.peak_rotation * first:
        return False
    window = 8.0 * w / (first * (1.0 - eta))
    spread = 1.0 / (eta * eta) if eta > 0.0 else math.inf  # where 1 + u or 1 - u varies more, the series diverges
    least, most = extremes_in_window(samples, block.a, block.interval, block.s, block.h, window, spread)
    weakest = scale * (1.0 - max(-least, most))
    if weakest <= 0.0:
        return False
    height = w * w / weakest  # above z_m while k z_m stays below weakest/2
    softening = stiffness * height
    if softening > 0.5 * weakest or height > block.peak_rotation:
        return False
    spread = max(
        (scale * (1.0 + most) + softening) / (scale * (1.0 + least) - softening),
        (scale * (1.0 - least) + softening) / (scale * (1.0 - most) - softening),
    )
    ratio = eta * math.sqrt(spread)
    return bool(ratio < 1.0 and 2.0 * w <= window * (weakest - softening) * (1.0 - ratio))


@kernel
def write_response(block: Record, response: Record) -> None:
    """Write the response of a block."""
    response.outcome, response.chatter, response.impacts, response.peak_mode = (
        block.outcome,
        block.chatter,
        block.impacts,
        block.peak_mode,
    )
    response.exceeded_alpha = not (block.peak_rotation <= 1.0)  # also where it is nan
    response.peak_rotation, response.uplift_time = block.peak_rotation, block.uplift_time
    response.first_impact_time, response.first_impact_velocity = block.first_impact_time, block.first_impact_velocity
    response.end_rotation, response.end_velocity = block.end_rotation, block.end_velocity
