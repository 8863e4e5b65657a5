"""One Taylor step of `LANES` blocks under recorded motions, where the ground acceleration is linear in time.

The equation and the recurrences are those of `rocking._solver.taylor.step`, with V S for S; F = F0 + F' tau and
V = V0 + V' tau have two coefficients instead of a series, which removes one of the three convolutions.
"""

from rocking._numba.compilation import Record, kernel
from rocking._numba.simd import absolute, load, minimum, select, splat, store
from rocking._solver.taylor.step import choose_step_size, evaluate_step, extend_half, start_half, start_series


@kernel
def expand_motion(steps: Record) -> None:
    """Fill `z` and `rate` from z0, w0, the force and V: as `rocking._solver.taylor.step.expand_motion`."""
    z, rate, s, c = steps.z, steps.rate, steps.s, steps.c
    force, force_rate = load(steps.force, 0), load(steps.force_rate, 0)
    has_vertical = steps.has_vertical == 1
    vertical, vertical_rate = splat(1.0), splat(0.0)
    if has_vertical:
        vertical, vertical_rate = load(steps.vertical, 0), load(steps.vertical_rate, 0)
    start_series(steps)
    factor, s_rate, c_rate = load(steps.restoring_factor, 0), load(steps.s_rate, 0), load(steps.c_rate, 0)
    restrained, tension = steps.restrained, load(steps.tension, 0)
    spring, drag = load(steps.spring, 0), load(steps.drag, 0)
    if restrained == 2:
        start_half(steps)
    for n in range(steps.order - 1):
        restoring = load(s, n)
        if has_vertical:
            restoring = vertical * restoring
            if n > 0:
                restoring += vertical_rate * load(s, n - 1)
        restoring += force * load(c, n)
        if n > 0:
            restoring += force_rate * load(c, n - 1)
        sine, cosine = splat(0.0), splat(0.0)
        for j in range(n + 1):
            at_j = load(rate, j)
            sine += at_j * load(c, n - j)
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
def take_step(steps: Record) -> None:
    """Expand about z0, w0; set the step size, z and w at the end, the bound of |w''| on the step, and `steady`.

    On a steady step w keeps its sign: it differs from its chord by (largest |w''|) h^2/8 at most. If z > 0 at the end,
    too, the step contains neither an impact nor a peak.
    """
    expand_motion(steps)
    choose_step_size(steps)
    evaluate_step(steps)
    h, w0, w1 = load(steps.h, 0), load(steps.w0, 0), load(steps.w1, 0)
    sagitta = 0.125 * load(steps.second_derivative_bound, 0) * h * h
    steady = (load(steps.z1, 0) > 0.0) & (w0 * w1 > 0.0) & (minimum(absolute(w0), absolute(w1)) > sagitta)
    store(steps.steady, 0, select(steady, splat(1.0), splat(0.0)))
