"""`record_response`: responses of blocks under a recorded ground motion."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._base.errors import InvalidArgumentError, broadcast, in_range, integer
from rocking._excitation.records.record import Record
from rocking._excitation.records.vertical import check_vertical_scale
from rocking._excitation.shapes import AbstractPulse
from rocking._model.checks import check, check_alpha
from rocking._model.fields import SOLVED_FIELDS
from rocking._model.parameters import FREQUENCY_PARAMETER, RESTITUTION, SLENDERNESS
from rocking._model.response import Response, dimensions_of
from rocking._numba.cancellation import StopFlag
from rocking._numba.compilation import contiguous_array
from rocking._numba.simd import LANES
from rocking._solver.chunks import AVAILABLE_CORES, fill_chunks
from rocking._solver.records.batch import solve_by_steps, solve_slender
from rocking._solver.records.samples import TIME, motion_samples, pulse_samples
from rocking._solver.records.state import body_states, step_state
from rocking._solver.state import EDGE_COLUMNS, RESPONSE_RECORD, block_cells

Array = NDArray[np.float64]

MAX_INTERVAL = 50.0
"""Largest length p dt of a sample interval [tau]: no motion that moves a block is sampled so coarsely."""

MAX_DIVIDED = 200_000
"""Most intervals into which the samples of a pulse are divided where they are longer than `MAX_INTERVAL`."""

MIN_CHUNK, MAX_CHUNK = 64, 512
"""Cells given to a thread at a time: about a millisecond of work at least, and full SIMD lanes for most of it. Of a
motion with fewer samples than an ordinary record, 2,000, so many more."""


def record_response(
    motion: Record,
    *,
    frequency_parameter: ArrayLike,
    slenderness: ArrayLike,
    restitution: ArrayLike,
    alpha: ArrayLike | None = None,
    vertical_scale: ArrayLike | None = 1.0,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> Response:
    """Peak rotation and final outcome of blocks under a recorded motion, exact to rounding. The arguments broadcast.

    The motion is linear between its samples and zero after the last; the block rests at the first. A vertical component
    adds to gravity: (2.2) or (3.1) with g + w for g in the restoring moment.

    Parameters
    ----------
    motion : Record
        The ground motion.
    frequency_parameter : array_like
        p = sqrt(3 g/(4 R)) of the block [rad/s], [1e-6, 1e6], at most 50 over the time step of the motion.
    slenderness : array_like
        g tan(alpha)/PGA [-], [1e-12, inf): depends on the motion, unlike h/b, through its peak acceleration PGA.
        Without a vertical component no uplift from 1 on. To scale the horizontal component by a factor, divide by it.
    restitution : array_like
        Coefficient of restitution eta [-], [0, 1].
    alpha : array_like, optional
        Slenderness angle [rad], [1e-12, 1.57] for (2.2); None or 0 for the slender limit (3.1).
    vertical_scale : array_like, optional
        Factor of the vertical component [-], [0, 1e6]. In units of g = 9.80665 m/s2: under another gravity, multiply by
        the ratio. 1 or None for a record without one.
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
        where the vertical acceleration reaches -g, with the time; shapes that do not broadcast; labelled arguments
        (xarray, pandas) whose dimensions or indexes differ.
    StoppedError
        If `stop` was set.
    """
    cores = AVAILABLE_CORES if threads is None else integer("threads", threads, 1, math.inf)
    given = {
        "frequency_parameter": frequency_parameter,
        "slenderness": slenderness,
        "restitution": restitution,
        "alpha": alpha,
        "vertical_scale": vertical_scale,
    }
    checked = check_record_groups(motion, frequency_parameter, slenderness, restitution, alpha, vertical_scale)
    groups = broadcast(given, checked)
    shape = groups[0].shape
    p, s, eta, angle, vertical = (contiguous_array(group).ravel() for group in groups)
    cells = block_cells(p * motion.time_step, s, eta, angle, vertical)
    records, _ = solve_bodies(motion_samples(motion), cells, cores, stop)
    found: dict[str, NDArray[Any]] = {field.name: records[field.name].reshape(shape) for field in SOLVED_FIELDS}
    named = dict(zip(given, checked, strict=True))
    if motion.vertical is None:
        del named["vertical_scale"]
    return Response(
        **found,
        pulse=motion.name,
        groups=named,
        dims=dimensions_of(*given.values()),
    )


def check_record_groups(
    motion: Record,
    frequency_parameter: ArrayLike,
    slenderness: ArrayLike,
    restitution: ArrayLike,
    alpha: ArrayLike | None,
    vertical_scale: ArrayLike | None,
) -> tuple[Array, Array, Array, Array, Array]:
    """The groups of a response under a record as float64 arrays of their own shapes; alpha = None is 0.

    The factor of the vertical component is 0 for a record without one.

    Raises
    ------
    InvalidArgumentError
        If `motion` is not a record, or a value is out of range.
    """
    limits = frequency_parameter_range(motion)
    return (
        in_range("frequency_parameter", frequency_parameter, *limits, unit="rad/s"),
        check(SLENDERNESS, slenderness),
        check(RESTITUTION, restitution),
        check_alpha(alpha),
        check_vertical_scale(motion, vertical_scale),
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


def solve_pulse(
    pulse: AbstractPulse, cells: list[Array], threads: int | None, stop: StopFlag | None
) -> NDArray[np.void]:
    """Response records (size,) of blocks under a sampled pulse; `cells` as for `solve_cells` of `peak_response`.

    Raises
    ------
    InvalidArgumentError
        If the frequency ratio is so low that the samples had to be divided into more than `MAX_DIVIDED` intervals.
    StoppedError
        If `stop` was set.
    """
    slenderness, omega, eta = cells[:3]
    alpha = cells[3] if len(cells) == 4 else np.zeros(omega.size)
    return solve_bodies(
        pulse_rows(pulse, float(omega.min(initial=math.inf))),
        block_cells(1.0 / omega, slenderness, eta, alpha),
        threads,
        stop,
    )[0]


def pulse_rows(pulse: AbstractPulse, lowest: float) -> Array:
    """`pulse_samples` with intervals of at most `MAX_INTERVAL` at frequency ratios from `lowest` on.

    Raises
    ------
    InvalidArgumentError
        If that takes more than `MAX_DIVIDED` intervals.
    """
    phases = pulse_samples(pulse)[TIME]
    longest = float(np.diff(phases).max())
    parts = max(1, math.ceil(longest / (MAX_INTERVAL * lowest)))
    most = max(1, MAX_DIVIDED // phases.size)
    if parts > most:
        least = longest / (MAX_INTERVAL * most)
        raise InvalidArgumentError(
            "frequency_ratio", lowest, f"at least {least:.3g} for this pulse of {phases.size} samples"
        )
    return pulse_samples(pulse, parts)


def solve_bodies(
    samples: Array,
    cells: NDArray[np.void],
    threads: int | None,
    stop: StopFlag | None,
    each_side: bool = False,
) -> tuple[NDArray[np.void], Array]:
    """Response records (size,) of bodies under samples, and what differs from edge to edge.

    Parameters
    ----------
    samples : float array (7, samples)
        Of `sample_rows`.
    cells : array (size,) of `BODY_CELL`
        The bodies.
    threads : int or None
        Number of threads, None: all cores.
    stop : StopFlag or None
        Cancels the work.
    each_side : bool
        Whether the peaks of each edge are wanted, as they must be where the edges differ: float array
        (size, EDGE_COLUMNS); else the second result has no rows.

    Raises
    ------
    StoppedError
        If `stop` was set.
    """
    by_steps = (cells["alpha"] > 0.0) | (cells["vertical"] != 0.0) | each_side
    records, edges = np.empty(cells.size, RESPONSE_RECORD), np.empty((cells.size if each_side else 0, EDGE_COLUMNS))
    if by_steps.any() and not by_steps.all():
        for kind in (by_steps, ~by_steps):
            records[kind] = solve_bodies(samples, cells[kind], threads, stop)[0]
        return records, edges
    if cells.size and by_steps[0]:

        def fill(part: slice, flag: NDArray[np.uint8]) -> None:
            blocks, steps = body_states(samples, LANES), step_state(samples, cells[part])
            solve_by_steps(samples, cells[part], blocks, steps, flag, records[part], edges[part])

    else:

        def fill(part: slice, flag: NDArray[np.uint8]) -> None:
            solve_slender(samples, cells[part], body_states(samples, 1)[0], flag, records[part])

    cores = int(threads or AVAILABLE_CORES)
    fewest = max(MIN_CHUNK, MIN_CHUNK * 2000 // samples.shape[1])
    chunk_size = min(max(math.ceil(cells.size / cores), fewest), max(MAX_CHUNK, fewest))
    fill_chunks(fill, cells.size, chunk_size, cores, stop)
    return records, edges
