"""`solve`: responses of bodies with two edges under any motion, the bound of their error, and their margin."""

import math

import numpy as np
from numpy.typing import NDArray

from rocking._base.arrays import Array
from rocking._base.quantities import SLENDERNESS
from rocking._excitation.pulses import GroundMotion
from rocking._excitation.records.record import Record
from rocking._model.energy import residual_energy
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.chunks import AVAILABLE_CORES, fill_chunks
from rocking._solver.kernels.batch import solve_batch
from rocking._solver.peak_response import MAX_CHUNK, MIN_CHUNK, NO_FLIGHTS, solver_state
from rocking._solver.records.record_response import solve_bodies, solve_bodies_under_pulse
from rocking._solver.records.samples import motion_samples
from rocking._solver.restrained import is_restrained, restrained_margin
from rocking._solver.rules import IMPACT_LIMIT
from rocking._solver.state import EDGE_COLUMNS, FULL_PRECISION, RESPONSE_RECORD, restraint_level

SOLVER_ERROR = 1e-12
"""Relative error of the solver where the problem is well conditioned, against multi-precision integration [-]."""


def solve(
    motion: GroundMotion, cells: NDArray[np.void], threads: int | None, stop: StopFlag | None
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

    # of free bodies, which are most, without a call
    held = cells["damping"].any() or cells["spring"].any() or cells["prestress"].any()
    level = restraint_level(cells) if held else 0

    def fill(part: slice, flag: NDArray[np.uint8]) -> None:
        state = solver_state.of_steps(motion, FULL_PRECISION, level)
        solve_batch(cells[part], *state, flag, records[part], edges[part], NO_FLIGHTS)

    cores = threads or AVAILABLE_CORES
    fill_chunks(fill, cells.size, min(max(math.ceil(cells.size / cores), MIN_CHUNK), MAX_CHUNK), cores, stop)
    return records, edges


def solve_with_bound(
    motion: GroundMotion, cells: NDArray[np.void], threads: int | None, stop: StopFlag | None
) -> tuple[NDArray[np.void], Array, Array]:
    """As `solve`, with a bound of the absolute error of the peaks (size,).

    The cells are solved twice, as given and with rate, slenderness and restitution smaller by the fraction
    `SOLVER_ERROR`; see `error_bound`.
    """
    size = cells.size
    both = np.concatenate([cells, cells])
    shifted = both[size:]
    shifted["rate"] *= 1.0 - SOLVER_ERROR
    shifted["eta"] *= 1.0 - SOLVER_ERROR  # downwards: eta = 1 stays in [0, 1]
    shifted["slenderness"] = np.maximum(shifted["slenderness"] * (1.0 - SOLVER_ERROR), SLENDERNESS.lower)
    records, edges = solve(motion, both, threads, stop)
    return records[:size], edges[:size], error_bound(records[:size], records[size:])


def error_bound(records: NDArray[np.void], shifted: NDArray[np.void]) -> Array:
    """Bound of the absolute error of the peaks from two responses of each cell; arrays of one shape.

    It is `SOLVER_ERROR` times the peak, plus three times its change when the parameters decrease together by the
    fraction `SOLVER_ERROR`: rounding errors act like such a change and are amplified near an outcome boundary. Infinite
    where only one of the two overturns, or one reached `IMPACT_LIMIT` impacts; nan where the body overturns.
    """
    peak, outcome = records["peak_rotation"], records["outcome"]
    overturned = outcome >= Outcome.OVERTURNED_DIRECTLY
    also = shifted["outcome"] >= Outcome.OVERTURNED_DIRECTLY
    impacts = np.maximum(records["impacts"], shifted["impacts"])
    with np.errstate(invalid="ignore"):
        change = np.abs(shifted["peak_rotation"] - peak)
    bound = np.asarray(SOLVER_ERROR * peak + 3.0 * change)
    bound[overturned | also | (impacts >= IMPACT_LIMIT)] = np.inf
    bound[overturned] = np.nan
    bound[outcome == Outcome.NO_UPLIFT] = 0.0  # |a f| < 1 throughout: exact
    return bound


CHANGE = 1e-9
"""Relative change of the amplitude [-]. The rounding error of a peak is some 1e-16 times the amplification, so that the
difference has six digits or more; a larger change would mix in the curvature where the amplification is large."""


def amplification_of(motion: GroundMotion, cells: NDArray[np.void], stop: StopFlag | None = None) -> Array:
    """Relative change of the peak rotation per relative change of the amplitude of the horizontal motion [-]; (size,).

    By a central difference with amplitudes changed by `CHANGE`. A value A says that samples known to n digits leave
    n - log10(A) digits of the peak. A vertical component is not changed. Infinite where the outcome changes, nan where
    the body overturns or does not uplift.
    """
    size = cells.size
    both = np.concatenate([cells, cells])
    both["slenderness"][:size] /= 1.0 - CHANGE
    both["slenderness"][size:] /= 1.0 + CHANGE
    records, _ = solve(motion, both, None, stop)
    less, more = records[:size], records[size:]
    middle = 0.5 * (more["peak_rotation"] + less["peak_rotation"])
    rocks = (less["outcome"] == Outcome.RECOVERS) & (more["outcome"] == Outcome.RECOVERS)
    relative = np.abs(more["peak_rotation"] - less["peak_rotation"]) / np.where(rocks, middle, 1.0) / (2.0 * CHANGE)
    return np.where(less["outcome"] != more["outcome"], np.inf, np.where(rocks, relative, np.nan))


def residual_energy_of(records: NDArray[np.void], edges: Array, cells: NDArray[np.void]) -> Array:
    """`rocking._model.energy.residual_energy` of bodies with two edges, about the present edge; (size,).

    nan of bodies with a tendon or a damper.
    """
    left = edges[:, 2] < 0.0
    ratio = np.where(left, cells["ratio"], 1.0)
    speed = ratio * np.sqrt(np.where(left, cells["stiffness"], 1.0))
    ends = {"end_rotation": records["end_rotation"] / ratio, "end_velocity": records["end_velocity"] / speed}
    energy = residual_energy(ends, {"alpha": cells["alpha"] * ratio})
    return np.where(is_restrained(cells), np.nan, energy)


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
