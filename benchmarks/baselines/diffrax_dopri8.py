"""Blocks under a pulse by diffrax, which compiles for many at once: its Dopri8 with events.

diffrax is no dependency of the project; where it cannot be imported the benchmark leaves this peer out. All blocks that
still move go together to their next impact or turn, each by its own steps; in between the blocks are sorted in NumPy,
and those at rest leave, so that nobody waits for the last chatter. A rise ends where the velocity falls through zero; a
fall where the height does, or where the velocity rises: one event for each, as diffrax bisects one only, and its
Newton's method may leave the step. JAX counts in doubles here.
"""

from __future__ import annotations

import math
import os
from functools import lru_cache, partial
from typing import Any

os.environ.setdefault("EQX_ON_ERROR", "nan")  # among many blocks, those without an event have no root to be found

import diffrax
import jax
import jax.numpy as jnp
import numpy as np
import optimistix
from numpy.typing import NDArray

from benchmarks.baselines.event_loop import (
    HALF_WINDOW,
    RICKER,
    SINE,
    SMALLEST_VELOCITY,
    duration,
    first_step,
    free_rocking,
    ground,
    uplift,
)
from benchmarks.cells import Cells

jax.config.update("jax_enable_x64", True)

BATCHES = (16, 128, 1024)
"""Sizes that are compiled: fewer blocks than that are filled up."""

START = 1e-18
"""Height at which a flight begins, and speed after a turn: zero itself would be an event."""

LIFT = 1e-6
"""Phase [rad] by which a block that lifts off is moved by hand: z, z' and z'' vanish together."""

LONGEST_STEP = math.pi / 8.0
"""In phase [rad]: a longer step may hold two events of a kind, and lose both."""

MOST_STEPS = 10_000

Array = NDArray[np.float64]


def peaks(rtol: float, cells: Cells) -> Array:
    """Largest |theta|/alpha (cells,), nan where a block overturns; the cells share pulse, restitution and alpha."""
    alpha, eta = float(cells.alpha[0]), float(cells.restitution[0])
    pulse = SINE if cells.pulse[0] == "sine" else RICKER
    lean = 1.0 if alpha == 0.0 else math.tan(alpha) / alpha
    blocks = [(1.0 / s, w, alpha, lean, pulse) for s, w in zip(cells.slenderness, cells.frequency_ratio, strict=True)]
    highest = np.zeros(len(blocks))
    state = np.zeros((4, len(blocks)))  # side, tau, z, v
    moving = np.array([k for k, block in enumerate(blocks) if block[0] > 1.0], dtype=np.intp)
    for k in moving:
        state[:, k] = lifted(blocks[k], 0.0)
    while moving.size:
        ended, which = flown(rtol, blocks, state, moving, slender=alpha == 0.0, pulse=pulse)
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
            elif -eta * v < SMALLEST_VELOCITY and abs(ground(block, tau)) < 1.0:
                state[:, k] = lifted(block, tau)
                if state[0, k] != 0.0:
                    still.append(k)
            else:
                state[:, k] = -side, tau, START, -eta * v
                still.append(k)
        moving = np.array(still, dtype=np.intp)
    return highest


NONE, TURN, IMPACT = range(3)
"""What ended a flight; none is the end of the pulse."""


def lifted(block: Any, after: float) -> tuple[float, float, float, float]:
    """Side, tau, z, v just after the block lifts off next; side 0 if it never does."""
    tau, side = uplift(block, after)
    if side == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    h = LIFT / block[1]
    pull = block[3] * (math.cos(block[2])) * (-side * ground(block, tau + h) - 1.0)
    return side, tau + h, pull * h * h / 6.0, 0.5 * pull * h


def flown(
    rtol: float, blocks: list[Any], state: Array, moving: NDArray[np.intp], *, slender: bool, pulse: float
) -> tuple[Array, NDArray[np.intp]]:
    """State (n, 3) in which the flight of each moving block ends, and which event ended it (n,)."""
    size = next((batch for batch in BATCHES if batch >= moving.size), BATCHES[-1])
    ended, which = [], []
    for start in range(0, moving.size, size):
        part = moving[start : start + size]
        filled = np.resize(part, size)
        columns = np.array([blocks[k][:4] for k in filled]).T
        steps = [first_step(blocks[k], *state[:, k]) for k in filled]
        ends = [duration(blocks[k]) for k in filled]
        result = _many(slender, pulse)(rtol, *columns, *state[:, filled], np.array(steps), np.array(ends))
        found, event = (np.asarray(one) for one in result)
        ended.append(found[: part.size])
        which.append(event[: part.size])
    return np.concatenate(ended), np.concatenate(which)


@lru_cache
def _many(slender: bool, pulse: float) -> Any:
    """The compiled flight of many blocks."""
    return jax.jit(jax.vmap(partial(_flight, slender, pulse), in_axes=(None, *10 * (0,))))


def _flight(slender: bool, pulse: float, rtol: Any, *numbers: Any) -> tuple[Any, Any]:
    """One flight of one block, traced by JAX."""
    a, omega, alpha, lean, side, tau, z, v, step, end = numbers

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
        return jnp.array([y[1], -jnp.sin(angle) / alpha - u * lean * jnp.cos(angle)])  # (2.2)

    def ahead(t: Any, y: Any, args: Any, **_: Any) -> Any:  # noqa: ARG001  # diffrax gives them by name
        return jnp.where(v > 0.0, y[1], jnp.minimum(y[0], -y[1]))

    solution = diffrax.diffeqsolve(
        diffrax.ODETerm(motion),
        diffrax.Dopri8(),
        tau,
        end,
        step,
        jnp.array([z, v]),
        stepsize_controller=diffrax.PIDController(
            rtol=rtol, atol=1e-3 * rtol, dtmax=LONGEST_STEP / omega, factormax=2.0
        ),
        saveat=diffrax.SaveAt(t1=True),
        event=diffrax.Event(ahead, optimistix.Bisection(1e-15, 1e-15, flip="detect"), direction=False),
        adjoint=diffrax.ForwardMode(),
        max_steps=MOST_STEPS,
        throw=False,
    )
    last, height = solution.ys[0], solution.ys[0, 0]
    turned = (v > 0.0) | (height > -last[1])  # of the two that may end a fall, the one that is zero
    event = jnp.where(solution.event_mask, jnp.where(turned, TURN, IMPACT), NONE)
    return jnp.array([solution.ts[0], height, last[1]]), event
