"""The front door: `peak_response` checks the question, broadcasts it, picks the solver and uses all cores."""

from __future__ import annotations

import math
import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.errors import InvalidArgumentError, in_range
from rocking.pulses import AbstractPulse, get_pulse
from rocking.response import Response
from rocking.rock import rock_many
from rocking.scratch import prepared

CHUNK = 4096
"""Cells handed to one thread at a time: about a millisecond of work, fine enough to balance the threads."""


SMALLEST_SLENDERNESS = 1e-12
"""Smallest 1/a answered [-]: an acceleration of 10^12 g tan(alpha)."""

FREQUENCY_RATIOS = (1e-9, 1e9)
"""Frequency ratios answered [-]."""

ALPHAS = (1e-12, 1.57)
"""Slenderness angles of (2.2) answered [rad]; 0 is the slender limit. At pi/2 tan(alpha) leaves all measure."""


def as_pulse(pulse: str | AbstractPulse) -> AbstractPulse:
    """The pulse itself, or the one of that name."""
    return get_pulse(pulse) if isinstance(pulse, str) else pulse


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
    try:
        return list(np.broadcast_arrays(*groups))
    except ValueError:
        shapes = tuple(group.shape for group in groups)
        raise InvalidArgumentError(
            "slenderness, frequency_ratio, restitution, alpha", shapes, "shapes that broadcast against each other"
        ) from None


def peak_response(
    pulse: str | AbstractPulse,
    *,
    slenderness: ArrayLike,
    frequency_ratio: ArrayLike,
    restitution: ArrayLike,
    alpha: ArrayLike | None = None,
    threads: int | None = None,
) -> Response:
    """Peak rotation and final fate of blocks under a pulse, exact to rounding; the arguments broadcast.

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
    threads : int, optional
        Threads for large arrays, >= 1; all cores by default.

    Returns
    -------
    Response
        Arrays of the broadcast shape.

    Raises
    ------
    InvalidArgumentError
        Naming the argument that is out of range, not finite, or of a shape that does not broadcast.
    """
    if threads is not None:
        in_range("threads", threads, 1, math.inf)
    made = as_pulse(pulse)
    groups = checked_groups(slenderness, frequency_ratio, restitution, alpha)
    shape = groups[0].shape
    cells = [np.ascontiguousarray(group).ravel() for group in groups]
    size = cells[0].size
    outcome, peak, mode = np.empty(size, np.int8), np.empty(size), np.empty(size, np.int32)
    impacts, chatter = np.empty(size, np.int32), np.empty(size, np.bool_)
    uplift, first_time, first_velocity = np.empty(size), np.empty(size), np.empty(size)
    fields = (outcome, peak, impacts, chatter, uplift, first_time, first_velocity, mode)

    def fill(start: int) -> None:
        part = slice(start, start + CHUNK)
        rock_many(*(cell[part] for cell in cells), prepared(made).copy(), *(field[part] for field in fields))

    starts = range(0, size, CHUNK)
    workers = min(int(threads) if threads else os.cpu_count() or 1, len(starts))
    if workers <= 1:
        for start in starts:
            fill(start)
    else:
        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(fill, starts))
    return Response(
        peak_rotation=peak.reshape(shape),
        outcome=outcome.reshape(shape),
        impacts=impacts.reshape(shape),
        chatter=chatter.reshape(shape),
        exceeded_alpha=(np.isnan(peak) | (peak > 1.0)).reshape(shape),
        uplift_time=uplift.reshape(shape),
        first_impact_time=first_time.reshape(shape),
        first_impact_velocity=first_velocity.reshape(shape),
        peak_mode=mode.reshape(shape),
    )
