"""`record_response`: responses of blocks under a recorded ground motion."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._numba.cancellation import StopFlag
from rocking._numba.compilation import contiguous_array
from rocking._numba.simd import LANES
from rocking.errors import InvalidArgumentError, broadcast, in_range, integer
from rocking.excitation.records.record import Record
from rocking.model.checks import check, check_alpha
from rocking.model.fields import RESPONSE_FIELDS
from rocking.model.parameters import FREQUENCY_PARAMETER, RESTITUTION, SLENDERNESS
from rocking.model.response import Response, dimensions_of
from rocking.solver.chunks import AVAILABLE_CORES, fill_chunks
from rocking.solver.records.batch import solve_rigid, solve_slender
from rocking.solver.records.samples import motion_samples
from rocking.solver.records.state import BLOCK_STATE, step_state
from rocking.solver.state import RESPONSE_RECORD

Array = NDArray[np.float64]

MAX_INTERVAL = 50.0
"""Largest length p dt of a sample interval [tau]: no motion that moves a block is sampled so coarsely."""

MIN_CHUNK, MAX_CHUNK = 64, 512
"""Cells given to a thread at a time: about a millisecond of work at least, and full SIMD lanes for most of it."""


def record_response(
    motion: Record,
    *,
    frequency_parameter: ArrayLike,
    slenderness: ArrayLike,
    restitution: ArrayLike,
    alpha: ArrayLike | None = None,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> Response:
    """Peak rotation and final outcome of blocks under a recorded motion, exact to rounding. The arguments broadcast.

    The motion is linear between its samples and zero after the last; the block rests at the first.

    Parameters
    ----------
    motion : Record
        The ground motion.
    frequency_parameter : array_like
        p = sqrt(3 g/(4 R)) of the block [rad/s], [1e-6, 1e6], at most 50 over the time step of the motion.
    slenderness : array_like
        g tan(alpha)/PGA [-], [1e-12, inf), with the peak acceleration PGA of the motion; no uplift from 1 on. To scale
        the motion by a factor, divide by it.
    restitution : array_like
        Coefficient of restitution eta [-], [0, 1].
    alpha : array_like, optional
        Slenderness angle [rad], [1e-12, 1.57] for (2.2); None or 0 for the slender limit (3.1).
    threads : int, optional
        Number of threads, >= 1; by default all cores.
    stop : StopFlag, optional
        Cancels the work: it raises `StoppedError` soon after another thread sets the flag.

    Returns
    -------
    Response
        Arrays of the broadcast shape. Times are p t from the first sample; "pulse" in the descriptions stands for the
        motion. Impacts are counted until the outcome and the peak are certain.

    Raises
    ------
    InvalidArgumentError
        If `motion` is not a record; for an argument that is out of range, not finite, not a real number or masked;
        shapes that do not broadcast; labelled arguments (xarray, pandas) whose dimensions or indexes differ.
    StoppedError
        If `stop` was set.
    """
    cores = AVAILABLE_CORES if threads is None else integer("threads", threads, 1, math.inf)
    given = {
        "frequency_parameter": frequency_parameter,
        "slenderness": slenderness,
        "restitution": restitution,
        "alpha": alpha,
    }
    checked = check_record_groups(motion, frequency_parameter, slenderness, restitution, alpha)
    groups = broadcast(given, checked)
    shape = groups[0].shape
    cells = [contiguous_array(group).ravel() for group in groups]
    cells[0] = cells[0] * motion.time_step
    records = _solve_cells(motion, cells, cores, stop)
    found: dict[str, NDArray[Any]] = {field.name: records[field.name].reshape(shape) for field in RESPONSE_FIELDS}
    return Response(
        **found,
        pulse=motion.name,
        groups=dict(zip(given, checked, strict=True)),
        dims=dimensions_of(*given.values()),
    )


def check_record_groups(
    motion: Record,
    frequency_parameter: ArrayLike,
    slenderness: ArrayLike,
    restitution: ArrayLike,
    alpha: ArrayLike | None,
) -> tuple[Array, Array, Array, Array]:
    """The groups of a response under a record as float64 arrays of their own shapes; alpha = None is 0.

    Raises
    ------
    InvalidArgumentError
        If `motion` is not a record, or a value is out of range.
    """
    return (
        in_range("frequency_parameter", frequency_parameter, *frequency_parameter_range(motion), unit="rad/s"),
        check(SLENDERNESS, slenderness),
        check(RESTITUTION, restitution),
        check_alpha(alpha),
    )


def frequency_parameter_range(motion: Record) -> tuple[float, float]:
    """Smallest and largest frequency parameter p of a block under this record [rad/s].

    Raises
    ------
    InvalidArgumentError
        If `motion` is not a record.
    """
    if not isinstance(motion, Record):
        raise InvalidArgumentError("motion", motion, "a rocking.Record, such as rocking.read_record returns")
    return FREQUENCY_PARAMETER.lower, min(FREQUENCY_PARAMETER.upper, MAX_INTERVAL / motion.time_step)


def _solve_cells(
    motion: Record, cells: list[NDArray[np.float64]], threads: int, stop: StopFlag | None
) -> NDArray[np.void]:
    """Response records (size,) of cells given by four arrays (size,): p dt [tau], 1/a, eta, alpha [rad]."""
    rigid = cells[3] > 0.0
    records = np.empty(rigid.size, RESPONSE_RECORD)
    if rigid.any() and not rigid.all():
        for kind in (rigid, ~rigid):
            records[kind] = _solve_cells(motion, [cell[kind] for cell in cells], threads, stop)
        return records
    samples = motion_samples(motion)
    if rigid.size and rigid[0]:
        longest = float(cells[0].max())

        def fill(part: slice, flag: NDArray[np.uint8]) -> None:
            blocks = np.zeros(LANES, BLOCK_STATE)
            solve_rigid(samples, *(cell[part] for cell in cells), blocks, step_state(longest), flag, records[part])

    else:

        def fill(part: slice, flag: NDArray[np.uint8]) -> None:
            block = np.zeros(1, BLOCK_STATE)[0]
            solve_slender(samples, *(cell[part] for cell in cells[:3]), block, flag, records[part])

    chunk_size = min(max(math.ceil(rigid.size / threads), MIN_CHUNK), MAX_CHUNK)
    fill_chunks(fill, rigid.size, chunk_size, threads, stop)
    return records
