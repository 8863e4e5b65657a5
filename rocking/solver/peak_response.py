"""The front door: `peak_response` checks the question, broadcasts it, picks the solver and uses all cores."""

from __future__ import annotations

import math
import os
import threading
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from itertools import repeat

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._numba.cancellation import StopFlag, array_of, check
from rocking._numba.compilation import Record, plain
from rocking._numba.simd import LANES
from rocking.errors import broadcast, in_range
from rocking.excitation.pulses import AbstractPulse, SinusoidalPulse, as_pulse
from rocking.model.outcome_margin import fate_margin
from rocking.model.response import Response
from rocking.solver.kernels.batch import rock_arcs, rock_many
from rocking.solver.state import ANSWER, FINEST, SINGLE, has_one_sinusoid, prepared, prepared_steps

SMALLEST_SHARE, LARGEST_SHARE = 2048, 4096
"""Cells handed to one thread at a time: at least a millisecond of work, as long as a thread takes to start."""

SMALLEST_SLENDERNESS = 1e-12
"""Smallest 1/a answered [-]: an acceleration of 10^12 g tan(alpha)."""

FREQUENCY_RATIOS = (1e-9, 1e9)
"""Frequency ratios answered [-]."""

ALPHAS = (1e-12, 1.57)
"""Slenderness angles of (2.2) answered [rad]; 0 is the slender limit. At pi/2 tan(alpha) leaves all measure."""

TOLERANCES = (1e-13, 1e-3)
"""Tolerances that can be asked for [-]."""

RESERVE = 1e-4
"""Share of the tolerance that the truncated terms of one Taylor step may have [-]: steps and impacts magnify it."""

CLOSE = 1e-3
"""Margin of the fate [-] below which a block is solved as accurately as doubles allow, whatever the tolerance."""


CORES = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
"""Cores that this process may use [-]."""


class Scratch(threading.local):
    """Memory of the kernels for the pulses last asked for, each thread its own: to make it costs more than a block."""

    def __init__(self) -> None:
        self.of = lru_cache(maxsize=16)(_scratch_of)
        self.single = lru_cache(maxsize=16)(_single_scratch_of)


def _single_scratch_of(pulse: AbstractPulse) -> Record:
    return prepared(pulse, SINGLE).copy()


def _scratch_of(pulse: AbstractPulse, precision: float) -> tuple[NDArray[np.void], Record]:
    flight = prepared(pulse)
    return np.repeat(flight, LANES), prepared_steps(flight, precision)


scratch = Scratch()


def checked_groups(
    slenderness: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike, alpha: ArrayLike | None
) -> list[NDArray[np.float64]]:
    """The groups, checked and broadcast against each other; alpha = None is the slender limit, 0."""
    groups = (
        in_range("slenderness", slenderness, SMALLEST_SLENDERNESS, math.inf),
        in_range("frequency_ratio", frequency_ratio, *FREQUENCY_RATIOS),
        in_range("restitution", restitution, 0.0, 1.0),
        in_range("alpha", 0.0 if alpha is None else alpha, 0.0, ALPHAS[1], unit="rad"),
    )
    angles = groups[3]
    in_range("alpha", angles[angles > 0.0], *ALPHAS, unit="rad")
    given = {"slenderness": slenderness, "frequency_ratio": frequency_ratio, "restitution": restitution, "alpha": alpha}
    return broadcast(given, groups)


def peak_response(
    pulse: str | AbstractPulse,
    *,
    slenderness: ArrayLike,
    frequency_ratio: ArrayLike,
    restitution: ArrayLike,
    alpha: ArrayLike | None = None,
    tolerance: float | None = None,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> Response:
    """Peak rotation and final fate of blocks under a pulse, exact to rounding; the arguments broadcast by position.

    Cells that differ in restitution alone and follow one another, as along a last axis, share their first flight.

    Parameters
    ----------
    pulse : str or AbstractPulse
        A name of `PULSE_NAMES`, with a leading minus for the opposite sign, or a pulse.
    slenderness : array_like
        Dimensionless slenderness g tan(alpha)/a_g = 1/a [-], from 1e-12; from 1 on the block never uplifts.
    frequency_ratio : array_like
        omega = omega_g/p [-], [1e-9, 1e9].
    restitution : array_like
        Coefficient of restitution eta [-], [0, 1].
    alpha : array_like, optional
        Slenderness angle [rad], [1e-12, 1.57] for (2.2); None and 0 are the slender limit (3.1).
    tolerance : float, optional
        Relative error of the peak that may be left for speed [-], [1e-13, 1e-3]; by default rounding only. Slender
        blocks under sinusoids are exact in any case. Where the last bit of the question decides, nothing can be kept.
    threads : int, optional
        Threads for large arrays, >= 1; all cores by default.
    stop : StopFlag, optional
        Once another thread sets it, this ends soon with `StoppedError`.

    Returns
    -------
    Response
        Arrays of the broadcast shape.

    Raises
    ------
    InvalidArgumentError
        Naming the argument that is no pulse, out of range, not finite, not a real number or masked; arguments whose
        shapes do not broadcast; labelled ones (xarray, pandas) whose dimensions or indexes differ.
    StoppedError
        If `stop` was set.
    """
    if threads is not None:
        in_range("threads", threads, 1, math.inf)
    made = as_pulse(pulse)
    groups = checked_groups(slenderness, frequency_ratio, restitution, alpha)
    shape = groups[0].shape
    cells = [plain(group).ravel() for group in groups]
    allowed = 0.0 if tolerance is None else float(in_range("tolerance", tolerance, *TOLERANCES))
    by_arcs = isinstance(made, SinusoidalPulse) and not cells[3].any()  # which have nothing to leave out
    precision = FINEST if by_arcs else max(FINEST, RESERVE * allowed)
    answers = _rock(made, cells, precision, threads, stop)
    if precision > FINEST:
        margin = fate_margin(answers["end_z"], answers["end_w"], cells[2], cells[3])
        near = np.flatnonzero(np.abs(margin) < CLOSE + 100.0 * allowed)
        answers[near] = _rock(made, [cell[near] for cell in cells], FINEST, threads, stop)
    found = {name: answers[name].reshape(shape) for name in ANSWER.names or ()}
    peak = found["peak"]
    return Response(
        peak_rotation=peak,
        outcome=found["outcome"],
        impacts=found["impacts"],
        chatter=found["chatter"],
        exceeded_alpha=np.asarray(np.isnan(peak) | (peak > 1.0)),
        uplift_time=found["uplift_time"],
        first_impact_time=found["first_time"],
        first_impact_velocity=found["first_velocity"],
        peak_mode=found["mode"],
        end_rotation=found["end_z"],
        end_velocity=found["end_w"],
    )


def _rock(
    pulse: AbstractPulse,
    cells: list[NDArray[np.float64]],
    precision: float,
    threads: int | None,
    stop: StopFlag | None,
) -> NDArray[np.void]:
    """The answers (size,) to questions of four arrays (size,), shared out among threads."""
    size = cells[0].size
    answers = np.empty(size, ANSWER)
    single, rigid = has_one_sinusoid(pulse), bool(cells[3].any())
    if single and rigid and not cells[3].all():
        for kind in (cells[3] > 0.0, cells[3] == 0.0):
            answers[kind] = _rock(pulse, [cell[kind] for cell in cells], precision, threads, stop)
        return answers
    by_arcs = single and not rigid
    cores = int(threads) if threads else CORES
    share = min(max(math.ceil(size / cores), SMALLEST_SHARE), LARGEST_SHARE)

    def fill(start: int, flag: NDArray[np.uint8]) -> None:
        part = slice(start, start + share)
        questions = [cell[part] for cell in cells]
        if by_arcs:
            rock_arcs(*questions, scratch.single(pulse), flag, answers[part])
        else:
            rock_many(*questions, *scratch.of(pulse, precision), flag, answers[part])

    starts = range(0, size, share)
    workers = min(cores, len(starts))
    if workers <= 1:
        for start in starts:
            fill(start, array_of(stop))
            check(stop)
    else:
        with (stop or StopFlag()).part() as own, ThreadPoolExecutor(workers) as pool:
            try:
                list(pool.map(fill, starts, repeat(own.array)))
            except BaseException:  # an interrupt from the keyboard among them: the pool waits for its threads
                own.set()
                raise
        check(stop)
    return answers
