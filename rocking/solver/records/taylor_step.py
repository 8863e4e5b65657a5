"""One Taylor step of `LANES` blocks under recorded motions, where the ground acceleration is linear in time.

The equation and the recurrences are those of `rocking.solver.taylor.step`; F = F0 + F' tau has two coefficients instead
of a series, which removes one of the three convolutions.
"""

from __future__ import annotations

from rocking._numba.compilation import Record, kernel
from rocking._numba.simd import absolute, load, splat, store
from rocking._numba.simd_sines import sine_and_cosine
from rocking.solver.taylor.step import choose_step_size


@kernel
def expand_motion(steps: Record) -> None:
    """Fill `z` and `rate` from z0, w0 and the force."""
    z, rate, s, c = steps.z, steps.rate, steps.s, steps.c
    slender, z0, w0 = load(steps.slender, 0), load(steps.z0, 0), load(steps.w0, 0)
    force, force_rate = load(steps.force, 0), load(steps.force_rate, 0)
    store(z, 0, z0)
    store(z, 1, w0)
    store(rate, 0, w0)
    rest = 1.0 - z0
    sines, cosines = sine_and_cosine(load(steps.alpha, 0) * rest)
    store(s, 0, slender * rest + (1.0 - slender) * (sines / load(steps.sine_alpha, 0)))
    store(c, 0, slender + (1.0 - slender) * (cosines / load(steps.cosine_alpha, 0)))
    factor, s_rate, c_rate = load(steps.restoring_factor, 0), load(steps.s_rate, 0), load(steps.c_rate, 0)
    for n in range(steps.order - 1):
        restoring = load(s, n) + force * load(c, n)
        if n > 0:
            restoring += force_rate * load(c, n - 1)
        sine, cosine = splat(0.0), splat(0.0)
        for j in range(n + 1):
            at_j = load(rate, j)
            sine += at_j * load(c, n - j)
            cosine += at_j * load(s, n - j)
        reciprocal = 1.0 / (n + 1.0)
        acceleration = factor * restoring * -reciprocal  # (2.2)
        store(rate, n + 1, acceleration)
        store(z, n + 2, acceleration * (1.0 / (n + 2.0)))
        store(s, n + 1, s_rate * sine * reciprocal)
        store(c, n + 1, c_rate * cosine * reciprocal)


@kernel
def take_step(steps: Record) -> None:
    """Expand about z0, w0; set the step size, z and w at the end, and the bound of |w''| on the step."""
    expand_motion(steps)
    choose_step_size(steps)
    z, rate, order = steps.z, steps.rate, steps.order
    h = load(steps.h, 0)
    rotation, velocity = load(z, order), load(rate, order - 1)
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
