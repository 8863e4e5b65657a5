"""Blocks under a pulse with diffrax: Dopri8 with events, compiled for many blocks at once.

diffrax is not a dependency of the project; the benchmark omits this baseline where it cannot be imported. All blocks
that still move are integrated together to their next impact or turning point, each with its own steps. Between two
such calls the events are handled in NumPy and blocks at rest are removed, so that no block waits for the chatter of
another. A rise ends where the velocity falls through zero; a fall where the height does, or where the velocity rises
through zero. Each is one event function, because diffrax bisects only one, and its Newton method may leave the step.
JAX uses double precision here.
"""

from __future__ import annotations

import math
import os
from functools import lru_cache, partial
from typing import Any

os.environ.setdefault("EQX_ON_ERROR", "nan")  # blocks without an event have no root

import diffrax
import jax
import jax.numpy as jnp
import numpy as np
import optimistix
from numpy.typing import NDArray

from benchmarks.baselines.event_loop import (
    CHATTER_VELOCITY,
    HALF_WINDOW,
    RICKER,
    SINE,
    duration,
    first_step,
    free_rocking,
    ground,
    next_uplift,
)
from benchmarks.cells import Cells

jax.config.update("jax_enable_x64", True)

BATCHES = (16, 128, 1024)
"""Batch sizes that are compiled; smaller batches are filled up with repeated blocks."""

START = 1e-18
"""Height at the start of a flight, and speed after a turning point: zero itself would be an event."""

LIFT = 1e-6
"""Phase [rad] bridged by a series at uplift, because z, z' and z'' vanish together there."""

MAX_STEP = math.pi / 8.0
"""Maximum step in phase [rad]: a longer step may contain two events of one kind and miss both."""

MAX_STEPS = 10_000

Array = NDArray[np.float64]


def peaks(rtol: float, cells: Cells) -> Array:
    """Return the largest |theta|/alpha (cells,), nan where overturned; the cells share pulse, restitution and alpha."""
    alpha, eta = float(cells.alpha[0]), float(cells.restitution[0])
    pulse = SINE if cells.pulse[0] == "sine" else RICKER
    tan_ratio = 1.0 if alpha == 0.0 else math.tan(alpha) / alpha
    blocks = [
        (1.0 / s, w, alpha, tan_ratio, pulse) for s, w in zip(cells.slenderness, cells.frequency_ratio, strict=True)
    ]
    highest = np.zeros(len(blocks))
    state = np.zeros((4, len(blocks)))  # side, tau, z, v
    moving = np.array([k for k, block in enumerate(blocks) if block[0] > 1.0], dtype=np.intp)
    for k in moving:
        state[:, k] = state_after_uplift(blocks[k], 0.0)
    while moving.size:
        ended, which = integrate_flights(rtol, blocks, state, moving, slender=alpha == 0.0, pulse=pulse)
        still = []
        for k, (tau, z, v), event in zip(moving, ended, which, strict=True):
            block, side = blocks[k], state[0, k]
            highest[k] = max(highest[k], z)
            if alpha * z > 0.5 * math.pi:
                highest[k] = math.nan
            elif event == NONE:
                highest[k] = free_rocking(alpha, eta, z, v, highest[k])
            elif event == TURN:
                state[:, k] = side, tau, z, -math.copysign(START, state[3, k])
                still.append(k)
            elif -eta * v < CHATTER_VELOCITY and abs(ground(block, tau)) < 1.0:
                state[:, k] = state_after_uplift(block, tau)
                if state[0, k] != 0.0:
                    still.append(k)
            else:
                state[:, k] = -side, tau, START, -eta * v
                still.append(k)
        moving = np.array(still, dtype=np.intp)
    return highest


NONE, TURN, IMPACT = range(3)
"""Event that ended a flight; NONE is the end of the pulse."""


def state_after_uplift(block: Any, after: float) -> tuple[float, float, float, float]:
    """Return side, tau, z, v just after the next uplift; side 0 if there is none."""
    tau, side = next_uplift(block, after)
    if side == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    h = LIFT / block[1]
    outward = block[3] * (math.cos(block[2])) * (-side * ground(block, tau + h) - 1.0)
    return side, tau + h, outward * h * h / 6.0, 0.5 * outward * h


def integrate_flights(
    rtol: float, blocks: list[Any], state: Array, moving: NDArray[np.intp], *, slender: bool, pulse: float
) -> tuple[Array, NDArray[np.intp]]:
    """Return the state (n, 3) at the end of the flight of each moving block, and the event that ended it (n,)."""
    size = next((batch for batch in BATCHES if batch >= moving.size), BATCHES[-1])
    ended, which = [], []
    for start in range(0, moving.size, size):
        part = moving[start : start + size]
        filled = np.resize(part, size)
        columns = np.array([blocks[k][:4] for k in filled]).T
        steps = [first_step(blocks[k], *state[:, k]) for k in filled]
        ends = [duration(blocks[k]) for k in filled]
        result = _compiled_batch(slender, pulse)(rtol, *columns, *state[:, filled], np.array(steps), np.array(ends))
        found, event = (np.asarray(one) for one in result)
        ended.append(found[: part.size])
        which.append(event[: part.size])
    return np.concatenate(ended), np.concatenate(which)


@lru_cache
def _compiled_batch(slender: bool, pulse: float) -> Any:
    """Return the compiled flight of a batch of blocks."""
    return jax.jit(jax.vmap(partial(_flight, slender, pulse), in_axes=(None, *10 * (0,))))


def _flight(slender: bool, pulse: float, rtol: Any, *numbers: Any) -> tuple[Any, Any]:
    """Integrate one flight of one block; traced by JAX."""
    a, omega, alpha, tan_ratio, side, tau, z, v, step, end = numbers

    def shape(t: Any) -> Any:
        if pulse == SINE:
            return jnp.sin(omega * t)
        square = (omega * t - HALF_WINDOW) ** 2
        return (1.0 - 0.5 * square) * jnp.exp(-0.25 * square)

    def motion(t: Any, y: Any, _args: Any) -> Any:
        u = side * a * shape(t)
        if slender:
            return jnp.array([y[1], y[0] - 1.0 - u])  # (3.1)
        angle = alpha * (1.0 - y[0])
        return jnp.array([y[1], -jnp.sin(angle) / alpha - u * tan_ratio * jnp.cos(angle)])  # (2.2)

    def distance_to_event(t: Any, y: Any, args: Any, **_: Any) -> Any:  # noqa: ARG001  # passed by name
        return jnp.where(v > 0.0, y[1], jnp.minimum(y[0], -y[1]))

    solution = diffrax.diffeqsolve(
        diffrax.ODETerm(motion),
        diffrax.Dopri8(),
        tau,
        end,
        step,
        jnp.array([z, v]),
        stepsize_controller=diffrax.PIDController(rtol=rtol, atol=1e-3 * rtol, dtmax=MAX_STEP / omega, factormax=2.0),
        saveat=diffrax.SaveAt(t1=True),
        event=diffrax.Event(distance_to_event, optimistix.Bisection(1e-15, 1e-15, flip="detect"), direction=False),
        adjoint=diffrax.ForwardMode(),
        max_steps=MAX_STEPS,
        throw=False,
    )
    last, height = solution.ys[0], solution.ys[0, 0]
    turned = (v > 0.0) | (height > -last[1])  # which of the two ends of a fall it is
    event = jnp.where(solution.event_mask, jnp.where(turned, TURN, IMPACT), NONE)
    return jnp.array([solution.ts[0], height, last[1]]), event
