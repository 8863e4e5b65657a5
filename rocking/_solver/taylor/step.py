"""One Taylor step of `LANES` rocking blocks, slender or rigid, under any excitation.

With z = |theta|/alpha and w = dz/dtau, (2.2) reads for the edge s (`rocking._solver.rules`)

    z'' = -(p_s/p)^2 (sin(alpha_s)/alpha) (S + F C),
    S = sin(alpha_s - alpha z)/sin(alpha_s),  C = cos(alpha_s - alpha z)/cos(alpha_s)

with F = sgn(theta) a_s f. S and C follow from S' = -(alpha/tan(alpha_s)) C z' and C' = alpha tan(alpha_s) S z'; at
z = 0 both are 1, so that the acceleration is exactly zero at uplift through F = -1. As alpha goes to 0 this tends to
(3.1), with S = 1 - z and C = 1, without a separate form. alpha_s enters as alpha (alpha_s/alpha), in lanes `alpha` and
`ratio`; z is exact near the unstable equilibrium, where S vanishes.

A tendon and a damper (`rocking._solver.restrained_rocking`) add -kappa sin(alpha z)/alpha, where the sine is
sin(alpha) cos(alpha) (C - S), -(sin(alpha)/alpha) sigma D with D = cos(alpha z/2), and -2 zeta z'. With F over
1 + sigma the first factor is larger by 1 + sigma, and S becomes S + (sigma/(1 + sigma)) (D - S): 1 at z = 0 as before.
"""

import math

from rocking._numba.compilation import Record, kernel
from rocking._numba.simd import (
    absolute,
    approx_exp2,
    approx_log2,
    load,
    maximum,
    minimum,
    select,
    splat,
    square_root,
    store,
)
from rocking._numba.simd_functions import sine_and_cosine
from rocking._solver.excitation import expand_excitation
from rocking._solver.restrained_rocking import steepest_pull


@kernel
def set_edge_lane(steps: Record, lane: int, state: Record, side: int) -> None:
    """Set a lane to an edge of the body of a solver state (`alpha` 0: slender)."""
    slender, alpha = (1.0, 1.0) if state.alpha == 0.0 else (0.0, state.alpha)
    ratio, stiffness = state.ratio[side], state.stiffness[side]
    if steps.restrained > 0:
        steps.s_rate[lane] = 0.0  # of the body before: set all
    if (
        steps.alpha[lane] == alpha
        and steps.ratio[lane] == ratio
        and steps.stiffness[lane] == stiffness
        and steps.slender[lane] == slender
        and steps.s_rate[lane] != 0.0
    ):
        return  # the edge of the flight before
    steps.slender[lane], steps.alpha[lane], steps.ratio[lane], steps.stiffness[lane] = slender, alpha, ratio, stiffness
    # by the same function as the sines of S and C in `start_series`: the quotients are then exactly 1 at z = 0
    sines, cosines = sine_and_cosine(load(steps.alpha, 0) * load(steps.ratio, 0))
    store(steps.sine_alpha, 0, sines)
    store(steps.cosine_alpha, 0, cosines)
    if slender == 1.0:
        steps.restoring_factor[lane], steps.s_rate[lane], steps.c_rate[lane] = 1.0, -1.0, 0.0
        if steps.restrained > 0:
            set_restraint_lane(steps, lane, state, 1.0)
        return
    sine, cosine = steps.sine_alpha[lane], steps.cosine_alpha[lane]
    steps.restoring_factor[lane], steps.s_rate[lane], steps.c_rate[lane] = (
        stiffness * (sine / alpha),
        -alpha * cosine / sine,
        alpha * sine / cosine,
    )
    if steps.restrained > 0:
        set_restraint_lane(steps, lane, state, sine * cosine / alpha)


@kernel
def set_restraint_lane(steps: Record, lane: int, state: Record, sines: float) -> None:
    """Set a lane to the restraint of the body; `sines`: sin(alpha) cos(alpha)/alpha, 1 in the slender limit.

    The cap of the step size: z'' + 2 zeta z' + k z >= 0 while the body is destabilised, with k of `steepest_pull`. From
    z >= 0 with z' >= 0 it takes a quarter of the period 2 pi/sqrt(k) to z = 0, damped or not, and half of it from there
    back to z = 0, likewise below z = 0 while it is restored. On shorter steps z has the zeros of a free body.
    """
    pull = steepest_pull(state)
    steps.cap[lane] = 1.5 / math.sqrt(pull) if pull > 0.0 else math.inf
    steps.may_turn[lane] = float(state.may_turn)
    steps.spring[lane], steps.drag[lane] = state.spring * sines, 2.0 * state.damping
    if state.restrained == 1:
        steps.tension[lane] = (state.level - 1.0) / state.level
        steps.restoring_factor[lane] *= state.level
    else:
        steps.tension[lane] = 0.0


@kernel
def start_half(steps: Record) -> None:
    """Set D at the start of the step, exactly 1 at z = 0: 2 D^2 = 1 + cos(alpha z), the cosine from S and C."""
    sine, slender = load(steps.sine_alpha, 0), load(steps.slender, 0)
    share = (1.0 - slender) * sine * sine
    cosine = share * load(steps.s, 0) + (1.0 - share) * load(steps.c, 0)
    half = square_root(0.5 + 0.5 * cosine)
    store(steps.half, 0, select(load(steps.z0, 0) == 0.0, splat(1.0), half))


@kernel
def extend_half(steps: Record, n: int) -> None:
    """Set the coefficient n >= 1 of D from the square of the series."""
    half = steps.half
    sine, slender = load(steps.sine_alpha, 0), load(steps.slender, 0)
    share = (1.0 - slender) * sine * sine
    left = 0.5 * (share * load(steps.s, n) + (1.0 - share) * load(steps.c, n))
    for j in range(1, n):
        left -= load(half, j) * load(half, n - j)
    store(half, n, 0.5 * left / load(half, 0))


@kernel
def start_series(steps: Record) -> None:
    """Set the first coefficients of z, w, S and C from z0 and w0."""
    slender, z0, w0 = load(steps.slender, 0), load(steps.z0, 0), load(steps.w0, 0)
    store(steps.z, 0, z0)
    store(steps.z, 1, w0)
    store(steps.rate, 0, w0)
    # alpha_s - alpha z = alpha (alpha_s/alpha - z); in the slender limit S = alpha_s/alpha - z and C = 1
    rest = load(steps.ratio, 0) - z0
    sines, cosines = sine_and_cosine(load(steps.alpha, 0) * rest)
    store(steps.s, 0, slender * rest + (1.0 - slender) * (sines / load(steps.sine_alpha, 0)))
    store(steps.c, 0, slender + (1.0 - slender) * (cosines / load(steps.cosine_alpha, 0)))


@kernel
def expand_motion(steps: Record) -> None:
    """Fill `z` and `rate` from z0, w0 and `f`: the equation of motion, coefficient by coefficient.

    (n + 1) w_{n+1} is the n-th coefficient of -factor (S + F C), (2.2). The sums are convolutions: F C, and S' and C'
    as products of z' with C and with S. Each needs coefficients up to n only, which are there.
    """
    z, rate, f, s, c = steps.z, steps.rate, steps.f, steps.s, steps.c
    at_uplift = load(steps.starts_at_uplift, 0)
    store(f, 0, (1.0 - at_uplift) * load(f, 0) - at_uplift)  # |a f| = 1 exactly at uplift
    start_series(steps)
    factor, s_rate, c_rate = load(steps.restoring_factor, 0), load(steps.s_rate, 0), load(steps.c_rate, 0)
    restrained, tension = steps.restrained, load(steps.tension, 0)
    spring, drag = load(steps.spring, 0), load(steps.drag, 0)
    if restrained == 2:
        start_half(steps)
    for n in range(steps.order - 1):
        restoring, sine, cosine = load(s, n), splat(0.0), splat(0.0)
        for j in range(n + 1):
            at_j, back = load(rate, j), load(c, n - j)
            restoring += load(f, j) * back
            sine += at_j * back
            cosine += at_j * load(s, n - j)
        reciprocal = 1.0 / (n + 1.0)
        if restrained == 2:
            restoring += tension * (load(steps.half, n) - load(s, n))
        acceleration = factor * restoring * -reciprocal  # (2.2)
        if restrained > 0:
            acceleration -= (spring * (load(c, n) - load(s, n)) + drag * load(rate, n)) * reciprocal
        store(rate, n + 1, acceleration)
        store(z, n + 2, acceleration * (1.0 / (n + 2.0)))
        store(s, n + 1, s_rate * sine * reciprocal)
        store(c, n + 1, c_rate * cosine * reciprocal)
        if restrained == 2:
            extend_half(steps, n + 1)


@kernel
def choose_step_size(steps: Record) -> None:
    """Set `h`, the largest step on which the last two terms meet the precision, at most `limit`.

    The terms are compared with the largest of the first four at the end of the step, by approximate binary logarithms.
    """
    z, order = steps.z, steps.order
    shortest = splat(900.0)
    # |z_k| h^k <= precision |z_j| h^j for the j that allows the longest h, and for both k; `shortest` is log2 of this h
    for k in range(order - 1, order + 1):
        last = approx_log2(absolute(load(z, k)))
        longest = splat(-900.0)
        for j in range(4):
            gap = approx_log2(absolute(load(z, j))) - last + steps.log_precision
            longest = maximum(longest, gap * (1.0 / (k - j)))
        shortest = minimum(shortest, longest)
    longest = minimum(approx_exp2(shortest), load(steps.limit, 0))
    if steps.restrained > 0:
        longest = minimum(longest, load(steps.cap, 0))
    store(steps.h, 0, longest)


@kernel
def evaluate_step(steps: Record) -> None:
    """Set z and w at the end of the step of size `h`, and the bound of |w''| on the step."""
    z, rate, order = steps.z, steps.rate, steps.order
    h = load(steps.h, 0)
    rotation, velocity = load(z, order), load(rate, order - 1)
    # the sum of n (n - 1) |w_n| h^(n-2) over the terms, by Horner's scheme as z and w
    bound = absolute(velocity) * ((order - 1.0) * (order - 2.0))
    for i in range(1, order):
        n = order - 1 - i
        rotation = rotation * h + load(z, n + 1)
        velocity = velocity * h + load(rate, n)
        if n > 1:
            bound = bound * h + absolute(load(rate, n)) * (n * (n - 1.0))
    store(steps.z1, 0, rotation * h + load(z, 0))
    store(steps.w1, 0, velocity)
    store(steps.second_derivative_bound, 0, bound)


@kernel
def take_step(steps: Record) -> None:
    """Expand about z0, w0 at `phase`; set the step size, z and w at the end, and the bound of |w''| on the step."""
    expand_excitation(steps)
    expand_motion(steps)
    choose_step_size(steps)
    store(steps.h, 0, minimum(load(steps.h, 0), load(steps.reach, 0)))
    evaluate_step(steps)
