"""Responses of bodies with two edges under any motion, and how far they are from another outcome."""

import math

import numpy as np
from numpy.typing import NDArray

from rocking._base.arrays import Array
from rocking._excitation.records.record import Record
from rocking._excitation.shapes import AbstractPulse
from rocking._numba.cancellation import StopFlag
from rocking._solver.chunks import AVAILABLE_CORES, fill_chunks
from rocking._solver.kernels.batch import solve_batch
from rocking._solver.peak_response import MAX_CHUNK, MIN_CHUNK, NO_FLIGHTS, solver_state
from rocking._solver.records.record_response import solve_bodies, solve_bodies_under_pulse
from rocking._solver.records.samples import motion_samples
from rocking._solver.restrained import is_restrained, restrained_margin
from rocking._solver.state import EDGE_COLUMNS, FULL_PRECISION, RESPONSE_RECORD, restraint_level


def solve_motion(
    motion: AbstractPulse | Record, cells: NDArray[np.void], threads: int | None, stop: StopFlag | None
) -> tuple[NDArray[np.void], Array]:
    """Response records (size,) of bodies `BODY_CELL` (size,), and what differs from edge to edge, (size, EDGE_COLUMNS).

    `rate` of a cell is the frequency ratio under a pulse, and p times the time step under a record. Errors are those of
    `rocking._solver.peak_response.solve_cells`.
    """
    if isinstance(motion, Record):
        return solve_bodies(motion_samples(motion), cells, threads, stop, each_side=True)
    if motion.samples is not None:
        return solve_bodies_under_pulse(motion, cells, threads, stop, each_side=True)
    records, edges = np.empty(cells.size, RESPONSE_RECORD), np.empty((cells.size, EDGE_COLUMNS))

    def fill(part: slice, flag: NDArray[np.uint8]) -> None:
        state = solver_state.of_steps(motion, FULL_PRECISION, restraint_level(cells[part]))
        solve_batch(cells[part], *state, flag, records[part], edges[part], NO_FLIGHTS)

    cores = threads or AVAILABLE_CORES
    fill_chunks(fill, cells.size, min(max(math.ceil(cells.size / cores), MIN_CHUNK), MAX_CHUNK), cores, stop)
    return records, edges


def outcome_margin_of(records: NDArray[np.void], edges: Array, cells: NDArray[np.void]) -> Array:
    """Energy at the end of the motion, or after one of the next two impacts, less the energy of the barrier.

    As `rocking._model.energy.outcome_margin`, for bodies with two edges: the largest of three margins, since a
    body that does not escape about its present edge can do so about the other one after an impact, and about the
    present one after two (`rocking._solver.rules.final_outcome`); against a wall all are about the present one.
    Of bodies with a tendon or a damper `rocking._solver.restrained.restrained_margin`. Continuous, zero at the
    transition. Array (size,).
    """
    restrained = is_restrained(cells)
    if restrained.any():
        margins = np.empty(cells.size)
        margins[restrained] = restrained_margin(records[restrained], cells[restrained])
        margins[~restrained] = outcome_margin_of(records[~restrained], edges[~restrained], cells[~restrained])
        return margins
    right = edges[:, 2] >= 0.0
    ones = np.ones(cells.size)
    ratio, stiffness = np.stack([ones, cells["ratio"]]), np.stack([ones, cells["stiffness"]])
    order = np.where(right, [[0], [1]], [[1], [0]])  # the present edge, then the edge of the next flight
    order[1] = np.where(np.isinf(cells["slenderness"]).any(axis=1), order[0], order[1])
    ratio, stiffness = np.take_along_axis(ratio, order, 0), np.take_along_axis(stiffness, order, 0)
    eta = np.take_along_axis(cells["eta"].T, order, 0)
    speed = ratio * np.sqrt(stiffness)
    half = 0.5 * cells["alpha"] * ratio
    slender = half == 0.0
    safe_half = np.where(slender, 1.0, half)
    barrier = np.where(slender, 1.0, np.sin(safe_half) / safe_half)
    z, w = records["end_rotation"] / ratio[0], records["end_velocity"] / speed[0]
    x = np.where(slender[0], 1.0 - z, np.sin(safe_half[0] * (1.0 - z)) / safe_half[0])
    escape = (w - x) / barrier[0]  # (3.8)
    squared = barrier[0] ** 2 - (x - w) * (x + w)  # of the velocity at the next impact
    over = eta[0] * speed[0] / speed[1]
    first = squared * over**2 / barrier[1] ** 2 - 1.0  # (3.16)
    back = eta[1] * speed[1] / speed[0]
    second = squared * (over * back) ** 2 / barrier[0] ** 2 - 1.0
    return np.asarray(np.where(w < x, np.maximum(np.maximum(escape, first), second), escape))
