"""`peak_response`: checks and broadcasts the arguments, selects the kernel, and uses all cores."""

from __future__ import annotations

import math
import threading
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._base.errors import broadcast, integer, needed, reject_given
from rocking._base.quantities import RELATIVE_TOLERANCE
from rocking._excitation.pulses import AbstractPulse, as_pulse
from rocking._excitation.records.record import Record as Recording
from rocking._model.checks import check_groups, check_restraint, known_restitution
from rocking._model.energy import outcome_margin
from rocking._model.fields import SOLVED_FIELDS
from rocking._model.labelled import index_of, is_labelled, labelled_response
from rocking._model.response import Response, dimensions_of
from rocking._numba.cancellation import NEVER_STOPPED, StopFlag, check_stop
from rocking._numba.compilation import Record, contiguous_array
from rocking._numba.simd import LANES
from rocking._solver.chunks import AVAILABLE_CORES, fill_chunks
from rocking._solver.kernels.batch import solve_batch
from rocking._solver.records.record_response import record_response, solve_bodies_under_pulse, solve_pulse
from rocking._solver.restrained import equivalent_free, in_own_units, is_restrained, restrain
from rocking._solver.stages.batch import LEFT, solve_by_arcs
from rocking._solver.stages.state import StageState, stage_state
from rocking._solver.state import (
    EDGE_COLUMNS,
    FOLLOWED_FLIGHT,
    FULL_PRECISION,
    RESPONSE_RECORD,
    block_cells,
    pulse_state,
    restraint_level,
    step_state,
)

if TYPE_CHECKING:
    import xarray as xr

MIN_CHUNK, MAX_CHUNK = 2048, 4096
"""Cells given to a thread at a time: at least a millisecond of work, about the time to start a thread."""

MIN_ARC_CHUNK, MAX_ARC_CHUNK = 8192, 32768  # the same for cells that are solved by exact arcs, in a tenth of the time

TRUNCATION_FRACTION = 1e-4
"""Truncation error allowed in one Taylor step, as a fraction of the tolerance [-]: steps and impacts amplify it."""

NEAR_BOUNDARY_MARGIN = 1e-3
"""A block with a smaller outcome margin [-] is solved again at full precision, whatever the tolerance."""


NO_EDGES = np.empty((0, EDGE_COLUMNS))  # for blocks with equal edges
NO_FLIGHTS = np.empty(0, FOLLOWED_FLIGHT)  # where only responses are wanted


class SolverState(threading.local):
    """Records for the most recent pulses, separate in each thread. To make one costs more than to solve a block."""

    def __init__(self) -> None:
        self.of_steps = lru_cache(maxsize=16)(_new_step_state)
        self.of_arcs = lru_cache(maxsize=16)(_new_arc_state)


def _new_arc_state(pulse: AbstractPulse) -> tuple[Record, StageState]:
    return pulse_state(pulse).copy(), stage_state()


def _new_step_state(pulse: AbstractPulse, precision: float, restrained: int = 0) -> tuple[NDArray[np.void], Record]:
    flight, steps = pulse_state(pulse), step_state(pulse_state(pulse), precision)
    steps["restrained"] = restrained
    return np.repeat(flight, LANES), steps


solver_state = SolverState()


@overload
def peak_response(
    motion: str | AbstractPulse | Recording, *, slenderness: xr.DataArray, **others: Any
) -> xr.Dataset: ...


@overload
def peak_response(
    motion: str | AbstractPulse | Recording,
    *,
    slenderness: ArrayLike,
    frequency_ratio: ArrayLike | None = None,
    frequency_parameter: ArrayLike | None = None,
    restitution: ArrayLike,
    alpha: ArrayLike | None = None,
    stiffness: ArrayLike = 0.0,
    prestress: ArrayLike = 0.0,
    damping: ArrayLike = 0.0,
    vertical_scale: ArrayLike | None = None,
    relative_tolerance: float | None = None,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> Response: ...


def peak_response(  # type: ignore[misc]  # of labelled arguments the names are checked here
    motion: str | AbstractPulse | Recording,
    *,
    slenderness: ArrayLike,
    frequency_ratio: ArrayLike | None = None,
    frequency_parameter: ArrayLike | None = None,
    restitution: ArrayLike,
    alpha: ArrayLike | None = None,
    stiffness: ArrayLike = 0.0,
    prestress: ArrayLike = 0.0,
    damping: ArrayLike = 0.0,
    vertical_scale: ArrayLike | None = None,
    relative_tolerance: float | None = None,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> Response | xr.Dataset:
    """Peak rotation and final outcome of blocks under a ground motion, exact to rounding. The arguments broadcast.

    Consecutive cells that differ in restitution only, as along the last axis, share the first flight.

    Parameters
    ----------
    motion : str, AbstractPulse or Record
        A name of `PULSE_NAMES`, with a leading minus for the opposite sign; a pulse; or a recorded ground motion, which
        is linear between its samples and zero after the last.
    slenderness : array_like
        g tan(alpha)/a_g = 1/a [-], [1e-12, inf): depends on the motion, unlike h/b. It is the acceleration of uplift
        over the peak acceleration of the motion; without a vertical component no uplift from 1 on.
    frequency_ratio : array_like
        omega = omega_g/p [-], [1e-9, 1e9]; of a pulse.
    frequency_parameter : array_like
        p = sqrt(3 g/(4 R)) of the block [rad/s], [1e-6, 1e6], at most 50 over the time step; of a record.
    restitution : array_like
        Coefficient of restitution eta [-], [0, 1]; or "momentum": (2.4) of `alpha`, 0 where that is negative;
        or "kalliontzis(k=...)", the impact at the share k of the half base, (0, 1].
    alpha : array_like, optional
        Slenderness angle [rad], [1e-12, 1.57] for (2.2); None or 0 for the slender limit (3.1).
    stiffness, prestress, damping : array_like
        Of a restraint: kappa = k b^2/(m g R) and sigma = P0/(m g) of a vertical tendon along the centre line, [0, 1e4],
        zeta = (3/2) (b/R)^2 c/(m p) of a vertical damper at the edge that uplifts, [0, 10] [-]; 0 is a free block. It
        uplifts at a = 1 + sigma; under a tendon `peak_rotation` beyond 1 is no overturning by itself.
    vertical_scale : array_like, optional
        Factor of the vertical component of a record [-], [0, 1e6]; 1 by default. It adds to gravity, g + w for g in the
        restoring moment, in units of 9.80665 m/s2: under another gravity, multiply by the ratio.
    relative_tolerance : float, optional
        Relative error of the peak under a pulse allowed for speed [-], [1e-13, 1e-3]; by default rounding error only.
        Slender blocks and records are exact in any case, Ricker wavelets from a frequency ratio of 0.8 or 0.98 on. No
        tolerance can be kept where the rounding of the arguments decides on the outcome.
    threads : int, optional
        Number of threads for large arrays, >= 1; by default all cores.
    stop : StopFlag, optional
        Cancels the work: it raises `StoppedError` soon after another thread sets the flag.

    Returns
    -------
    Response
        Arrays of the broadcast shape. Times are p t from the start of the motion. Arguments of xarray broadcast by the
        names of their dimensions and give an `xarray.Dataset` of the same fields; of dask-backed ones it is lazy.

    Raises
    ------
    InvalidArgumentError
        For an unknown pulse; an argument that is missing, out of range, not finite, not a real number or masked, or has
        no meaning for the kind of motion; where the vertical acceleration reaches -g, with the time; shapes that do not
        broadcast; labelled arguments (xarray, pandas) whose dimensions or indexes differ.
    StoppedError
        If `stop` was set.

    Examples
    --------
    >>> peak_response("sine", slenderness=0.75, frequency_ratio=3.0, restitution=0.9)
    <rocking.Response under sine: rocks and comes to rest: peak rotation 0.537221 alpha, 1 impact>
    >>> peak_response("sine", slenderness=[0.2, 0.5, 0.75], frequency_ratio=3.0, restitution=0.9).overturned
    array([ True,  True, False])
    """
    restitution = known_restitution(restitution, alpha)
    arguments = {
        "slenderness": slenderness,
        "frequency_ratio": frequency_ratio,
        "frequency_parameter": frequency_parameter,
        "restitution": restitution,
        "alpha": alpha,
        "stiffness": stiffness,
        "prestress": prestress,
        "damping": damping,
        "vertical_scale": vertical_scale,
    }
    if is_labelled(*arguments.values()):
        options = {"relative_tolerance": relative_tolerance, "threads": threads, "stop": stop}
        return labelled_response(partial(peak_response, motion), arguments, options)
    restraint = check_restraint(stiffness, prestress, damping)
    if isinstance(motion, Recording):
        reject_given("a record", frequency_ratio=frequency_ratio, relative_tolerance=relative_tolerance)
        return record_response(
            motion,
            frequency_parameter=needed("a record", frequency_parameter=frequency_parameter),
            slenderness=slenderness,
            restitution=restitution,
            alpha=alpha,
            vertical_scale=vertical_scale,
            restraint=restraint,
            threads=threads,
            stop=stop,
        )
    made = as_pulse(motion)
    reject_given("a pulse", frequency_parameter=frequency_parameter, vertical_scale=vertical_scale)
    frequency_ratio = needed("a pulse", frequency_ratio=frequency_ratio)
    if threads is not None:
        threads = integer("threads", threads, 1, math.inf)
    given = {"slenderness": slenderness, "frequency_ratio": frequency_ratio, "restitution": restitution, "alpha": alpha}
    checked = check_groups(**given)
    slender = not checked["alpha"].any()
    values = [*checked.values()][: 3 if alpha is None else 4]
    if restraint:
        checked |= restraint
        given |= {"stiffness": stiffness, "prestress": prestress, "damping": damping}
        return _restrained_response(made, checked, given, threads, stop)
    groups = broadcast(given, values)
    shape = groups[0].shape
    cells = [contiguous_array(group).ravel() for group in (groups[:3] if slender else groups)]
    accepted = 0.0 if relative_tolerance is None else RELATIVE_TOLERANCE.number(relative_tolerance)
    exact = made.samples is not None or (made.series.has_exact_arcs and slender)  # no terms to truncate
    precision = FULL_PRECISION if exact else max(FULL_PRECISION, TRUNCATION_FRACTION * accepted)
    records = solve_cells(made, cells, precision, threads, stop)
    if precision > FULL_PRECISION:
        angle = cells[3] if len(cells) == 4 else np.zeros(cells[0].size)
        margin = outcome_margin(records["end_rotation"], records["end_velocity"], cells[2], angle)
        close = np.abs(margin) < NEAR_BOUNDARY_MARGIN + 100.0 * accepted
        near = np.flatnonzero(close & ~solved_by_arcs(made, cells))
        records[near] = solve_cells(made, [cell[near] for cell in cells], FULL_PRECISION, threads, stop)
    found: dict[str, NDArray[Any]] = {field.name: records[field.name].reshape(shape) for field in SOLVED_FIELDS}
    dims, index = dimensions_of(*given.values()), index_of(*given.values())
    return Response(**found, pulse=made.name, groups=checked, dims=dims, index=index, motion=made)


def _restrained_response(
    pulse: AbstractPulse,
    groups: dict[str, NDArray[np.float64]],
    given: dict[str, Any],
    threads: int | None,
    stop: StopFlag | None,
) -> Response:
    """`peak_response` under a pulse to blocks with a tendon or a damper; `given`: the arguments before conversion."""
    names = [*groups]
    columns = dict(zip(names, broadcast(given, [*groups.values()]), strict=True))
    shape = columns["slenderness"].shape
    flat = {name: contiguous_array(column).ravel() for name, column in columns.items()}
    cells = block_cells(flat["frequency_ratio"], flat["slenderness"], flat["restitution"], flat["alpha"])
    restrain(cells, flat)
    records = solve_blocks(pulse, cells, threads, stop)
    found: dict[str, NDArray[Any]] = {field.name: records[field.name].reshape(shape) for field in SOLVED_FIELDS}
    dims, index = dimensions_of(*given.values()), index_of(*given.values())
    return Response(**found, pulse=pulse.name, groups=groups, dims=dims, index=index, motion=pulse)


def solve_blocks(
    pulse: AbstractPulse, cells: NDArray[np.void], threads: int | None, stop: StopFlag | None
) -> NDArray[np.void]:
    """Response records (size,) of blocks `BODY_CELL` under a pulse, free ones or with a tendon or a damper.

    Errors as of `solve_cells`. Free blocks, and slender ones that a free block stands for, take the ways of free ones.
    """
    by_free, replaced = equivalent_free(cells, by_samples=False)
    free = by_free | ~is_restrained(cells)
    records = np.empty(cells.size, RESPONSE_RECORD)
    columns = [replaced["slenderness"][free, 0], replaced["rate"][free], replaced["eta"][free, 0]]
    columns.append(replaced["alpha"][free])
    records[free] = solve_cells(pulse, columns, FULL_PRECISION, threads, stop)
    records[by_free] = in_own_units(records[by_free], cells[by_free])
    held = cells[~free]
    if pulse.samples is not None:
        records[~free] = solve_bodies_under_pulse(pulse, held, threads, stop)[0]
        return records
    solved = np.empty(held.size, RESPONSE_RECORD)

    def fill(part: slice, flag: NDArray[np.uint8]) -> None:
        state = solver_state.of_steps(pulse, FULL_PRECISION, restraint_level(held[part]))
        solve_batch(held[part], *state, flag, solved[part], NO_EDGES, NO_FLIGHTS)

    cores = threads or AVAILABLE_CORES
    fill_chunks(fill, held.size, min(max(math.ceil(held.size / cores), MIN_CHUNK), MAX_CHUNK), cores, stop)
    records[~free] = solved
    return records


def solved_by_arcs(pulse: AbstractPulse, cells: list[NDArray[np.float64]]) -> NDArray[np.bool_]:
    """Return the cells (size,) that are solved by exact arcs, whatever the precision."""
    mask: NDArray[np.bool_] = cells[1] >= pulse.series.least_arc_frequency
    return mask if len(cells) == 3 else mask & (cells[3] == 0.0)


def solve_cells(
    pulse: AbstractPulse, cells: list[NDArray[np.float64]], precision: float, threads: int | None, stop: StopFlag | None
) -> NDArray[np.void]:
    """Response records (size,) of cells, distributed over threads; the searches call it directly, without the checks.

    `cells` (size,): 1/a, omega and eta of each cell, and its alpha (0: slender) unless all are slender; in range, each
    as `contiguous_array` gives it. `precision`: relative truncation error of a Taylor step [-]. `threads`: number of
    threads, None: all cores.
    """
    if pulse.samples is not None:
        return solve_pulse(pulse, cells, threads, stop)
    if len(cells) == 3 and cells[1].min(initial=math.inf) >= pulse.series.least_arc_frequency:
        return _solve_alike(pulse, cells, True, precision, threads, stop)
    if len(cells) == 4 and cells[3].all():  # none is slender
        return _solve_alike(pulse, cells, False, precision, threads, stop)
    exact = solved_by_arcs(pulse, cells)
    if exact.all() or not exact.any():
        return _solve_alike(pulse, cells, bool(exact.any()), precision, threads, stop)
    records = np.empty(exact.size, RESPONSE_RECORD)
    for by_arcs, kind in ((True, exact), (False, ~exact)):
        records[kind] = _solve_alike(pulse, [cell[kind] for cell in cells], by_arcs, precision, threads, stop)
    return records


def _solve_alike(
    pulse: AbstractPulse,
    cells: list[NDArray[np.float64]],
    by_arcs: bool,
    precision: float,
    threads: int | None,
    stop: StopFlag | None,
) -> NDArray[np.void]:
    """Solve cells that are all solved by arcs, or all by Taylor steps."""
    size = cells[0].size
    records = np.empty(size, RESPONSE_RECORD)
    cores = threads or AVAILABLE_CORES
    fewest, most = (MIN_ARC_CHUNK, MAX_ARC_CHUNK) if by_arcs else (MIN_CHUNK, MAX_CHUNK)
    chunk_size = min(max(math.ceil(size / cores), fewest), most)

    solve: Any = _fill_by_arcs if by_arcs else partial(_solve_by_steps, precision)
    if size <= chunk_size:
        flag = NEVER_STOPPED if stop is None else stop.array
        solve(pulse, cells, flag, records)
        if flag[0]:
            check_stop(stop)
        return records

    def fill(part: slice, flag: NDArray[np.uint8]) -> None:
        solve(pulse, [cell[part] for cell in cells], flag, records[part])

    fill_chunks(fill, size, chunk_size, cores, stop)
    return records


def _fill_by_arcs(
    pulse: AbstractPulse, cells: list[NDArray[np.float64]], flag: NDArray[np.uint8], records: NDArray[np.void]
) -> None:
    """Solve slender blocks in stages, and what these leave by Taylor steps."""
    state, stages = solver_state.of_arcs(pulse)
    if solve_by_arcs(*cells[:3], state, *stages, flag, records) == 0:
        return
    left = np.flatnonzero(records["outcome"] == LEFT)
    rest = np.empty(left.size, RESPONSE_RECORD)
    _solve_by_steps(FULL_PRECISION, pulse, [cell[left] for cell in cells], flag, rest)
    records[left] = rest


def _solve_by_steps(
    precision: float,
    pulse: AbstractPulse,
    cells: list[NDArray[np.float64]],
    flag: NDArray[np.uint8],
    records: NDArray[np.void],
) -> None:
    state = solver_state.of_steps(pulse, precision)
    slenderness, omega, eta = cells[:3]
    bodies = block_cells(omega, slenderness, eta, cells[3] if len(cells) == 4 else np.zeros(eta.size))
    solve_batch(bodies, *state, flag, records, NO_EDGES, NO_FLIGHTS)
