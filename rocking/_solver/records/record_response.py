"""`record_response`: responses of blocks under a recorded ground motion."""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, broadcast, in_range, integer
from rocking._excitation.records.record import MAX_INTERVAL, Record
from rocking._excitation.records.vertical import check_vertical_scale
from rocking._excitation.shapes import AbstractPulse
from rocking._model.checks import check_groups
from rocking._model.fields import SOLVED_FIELDS
from rocking._model.labelled import index_of
from rocking._model.response import Response, dimensions_of
from rocking._numba.cancellation import StopFlag
from rocking._numba.compilation import contiguous_array
from rocking._numba.simd import LANES
from rocking._solver.chunks import AVAILABLE_CORES, fill_chunks
from rocking._solver.records.batch import solve_by_steps, solve_slender
from rocking._solver.records.samples import TIME, motion_samples, pulse_samples
from rocking._solver.records.state import body_states, step_state, taylor_orders
from rocking._solver.restrained import equivalent_free, in_own_units, is_restrained, restrain
from rocking._solver.state import EDGE_COLUMNS, RESPONSE_RECORD, block_cells

MAX_DIVIDED = 200_000
"""Most intervals of a pulse after those longer than `MAX_INTERVAL` are divided [-]."""

NO_RESTRAINT: Mapping[str, Array] = {}

MIN_CHUNK, MAX_CHUNK = 64, 512
"""Cells given to a thread at a time: at least a millisecond of work, with full SIMD lanes for most of it; more in
proportion for motions of fewer samples than an ordinary record, 2,000."""


def record_response(
    motion: Record,
    *,
    frequency_parameter: ArrayLike,
    slenderness: ArrayLike,
    restitution: ArrayLike,
    alpha: ArrayLike | None = None,
    vertical_scale: ArrayLike | None = 1.0,
    restraint: Mapping[str, Array] = NO_RESTRAINT,
    threads: int | None = None,
    stop: StopFlag | None = None,
    body: Any = None,
) -> Response:
    """`rocking.peak_response` under a record, for arguments without labels; `body` as of `Response`.

    "pulse" in the descriptions of the fields stands for the motion. Impacts are counted until the outcome and the peak
    are certain. `restraint`: of `rocking._model.checks.check_restraint`.
    """
    cores = AVAILABLE_CORES if threads is None else integer("threads", threads, 1, math.inf)
    given = {
        "frequency_parameter": frequency_parameter,
        "slenderness": slenderness,
        "restitution": restitution,
        "alpha": alpha,
        "vertical_scale": vertical_scale,
    }
    named = check_record_groups(motion, **given) | dict(restraint)
    groups = broadcast(given | dict(restraint), [*named.values()])
    shape = groups[0].shape
    p, s, eta, angle, vertical, *held = (contiguous_array(group).ravel() for group in groups)
    cells = block_cells(p * motion.time_step, s, eta, angle, vertical)
    restrain(cells, dict(zip(restraint, held, strict=True)))
    by_free, replaced = equivalent_free(cells, by_samples=True)
    records, _ = solve_bodies(motion_samples(motion), replaced, cores, stop)
    records[by_free] = in_own_units(records[by_free], cells[by_free])
    found: dict[str, NDArray[Any]] = {field.name: records[field.name].reshape(shape) for field in SOLVED_FIELDS}
    if motion.vertical is None:
        del named["vertical_scale"]
    dims, index = dimensions_of(*given.values()), index_of(*given.values())
    return Response(**found, pulse=motion.name, groups=named, dims=dims, index=index, motion=motion, body=body)


def record_cells(
    record: Record,
    *,
    frequency_parameter: Array | float,
    slenderness: Array,
    restitution: float,
    alpha: float | None,
    vertical_scale: Array | None,
    restraint: Mapping[str, Array] = NO_RESTRAINT,
) -> NDArray[np.void]:
    """Cells `BODY_CELL` (size,) of blocks under a record, from groups that have been checked."""
    vertical = 0.0 if record.vertical is None or vertical_scale is None else vertical_scale
    one = np.ones(slenderness.size)
    rate = frequency_parameter * record.time_step * one
    cells = block_cells(rate, slenderness, restitution * one, (alpha or 0.0) * one, vertical)
    restrain(cells, restraint)
    return cells


def check_record_groups(motion: Record, **given: Any) -> dict[str, Array]:
    """The checked groups of a response under a record by name; the vertical factor is 0 without such a component.

    Raises `InvalidArgumentError` if a value is out of range.
    """
    p, vertical = given.pop("frequency_parameter"), given.pop("vertical_scale")
    return {
        "frequency_parameter": in_range("frequency_parameter", p, *motion.frequency_parameters, unit="rad/s"),
        **check_groups(**given),
        "vertical_scale": check_vertical_scale(motion, vertical),
    }


def solve_pulse(
    pulse: AbstractPulse, cells: list[Array], threads: int | None, stop: StopFlag | None
) -> NDArray[np.void]:
    """Response records (size,) of blocks under a sampled pulse; arguments as for `peak_response.solve_cells`."""
    slenderness, omega, eta = cells[:3]
    alpha = cells[3] if len(cells) == 4 else np.zeros(omega.size)
    return solve_bodies_under_pulse(pulse, block_cells(omega, slenderness, eta, alpha), threads, stop)[0]


def solve_bodies_under_pulse(
    pulse: AbstractPulse, cells: NDArray[np.void], threads: int | None, stop: StopFlag | None, each_side: bool = False
) -> tuple[NDArray[np.void], Array]:
    """`solve_bodies` under a sampled pulse; `rate` of the cells is the frequency ratio, errors as `solve_pulse`."""
    parts, sampled = interval_parts(pulse, cells["rate"]), cells.copy()
    sampled["rate"] = 1.0 / cells["rate"]

    def solve(own: NDArray[np.bool_], division: int) -> tuple[NDArray[np.void], Array]:
        return solve_bodies(pulse_samples(pulse, division), sampled[own], threads, stop, each_side)

    return _each_kind(parts, solve, each_side)


def _each_kind(
    kinds: NDArray[np.int64], solve: Callable[[NDArray[np.bool_], int], tuple[NDArray[np.void], Array]], each_side: bool
) -> tuple[NDArray[np.void], Array]:
    """The result of `solve_bodies` for cells of several kinds (size,): `solve` takes the cells of one kind together."""
    records, edges = np.empty(kinds.size, RESPONSE_RECORD), np.empty((kinds.size if each_side else 0, EDGE_COLUMNS))
    for kind in np.unique(kinds):
        own = kinds == kind
        records[own], of_edges = solve(own, int(kind))
        if each_side:
            edges[own] = of_edges
    return records, edges


def pulse_rows(pulse: AbstractPulse, frequency_ratio: float) -> Array:
    """`pulse_samples` as for the response at this frequency ratio; errors as `interval_parts`."""
    return pulse_samples(pulse, int(interval_parts(pulse, np.array([frequency_ratio]))[0]))


def interval_parts(pulse: AbstractPulse, frequency_ratio: Array) -> NDArray[np.int64]:
    """Parts of each sample interval, at most `MAX_INTERVAL` long, at each frequency ratio: powers of two, or the most.

    Raises `InvalidArgumentError` if that takes more than `MAX_DIVIDED` intervals.
    """
    phases = pulse_samples(pulse)[TIME]
    longest, most = float(np.diff(phases).max()), max(1, MAX_DIVIDED // phases.size)
    least = longest / (MAX_INTERVAL * most)
    lowest = float(frequency_ratio.min(initial=math.inf))
    if lowest < least:
        raise InvalidArgumentError(
            "frequency_ratio", lowest, f"at least {least:.3g} for this pulse of {phases.size} samples"
        )
    needed = np.log2(np.maximum(longest / (MAX_INTERVAL * frequency_ratio), 1.0))
    # powers of two, so that an array needs few divisions; each cell has its own, whatever the others need
    return np.left_shift(1, np.ceil(needed).astype(np.int64)).clip(max=most)


def solve_bodies(
    samples: Array, cells: NDArray[np.void], threads: int | None, stop: StopFlag | None, each_side: bool = False
) -> tuple[NDArray[np.void], Array]:
    """Response records (size,) of bodies `BODY_CELL` (size,) under `sample_rows`, and what differs from edge to edge.

    `each_side`: whether the peaks of each edge are wanted, as they must be where the edges differ: float array (size,
    EDGE_COLUMNS); else the second result has no rows. Errors as of `rocking._solver.peak_response.solve_cells`.
    """
    restrained = is_restrained(cells)
    by_steps = (cells["alpha"] > 0.0) | (cells["vertical"] != 0.0) | restrained | each_side
    kinds = np.full(cells.size, -1)
    if by_steps.any():
        # the degree sets the rounding of a cell: it must not depend on the cells beside it in the array or the thread
        kinds[by_steps] = 2 * taylor_orders(samples, cells[by_steps]) + (cells["vertical"][by_steps] != 0.0)
        kinds[restrained] += 100 * (1 + (cells["prestress"][restrained] != 0.0))
    if cells.size and (kinds != kinds[0]).any():
        return _each_kind(kinds, lambda own, _: solve_bodies(samples, cells[own], threads, stop, each_side), each_side)
    records, edges = np.empty(cells.size, RESPONSE_RECORD), np.empty((cells.size if each_side else 0, EDGE_COLUMNS))

    def fill(part: slice, flag: NDArray[np.uint8]) -> None:
        if by_steps[0]:
            blocks, steps = body_states(samples, LANES), step_state(samples, cells[part])
            solve_by_steps(samples, cells[part], blocks, steps, flag, records[part], edges[part])
        else:
            solve_slender(samples, cells[part], body_states(samples, 1)[0], flag, records[part])

    cores = int(threads or AVAILABLE_CORES)
    fewest = max(MIN_CHUNK, MIN_CHUNK * 2000 // samples.shape[1])
    chunk_size = min(max(math.ceil(cells.size / cores), fewest), max(MAX_CHUNK, fewest))
    fill_chunks(fill, cells.size, chunk_size, cores, stop)
    return records, edges
