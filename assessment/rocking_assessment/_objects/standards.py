"""Checks of standards for bodies under the motions of a site: demand over capacity."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from rocking.extension import Array, InvalidArgumentError, Record, StopFlag, largest_displacement, velocity
from rocking_assessment import standards
from rocking_assessment._objects.columns import CLAUSES
from rocking_assessment._objects.objects import BodyArray
from rocking_assessment._objects.site import Motion, sampled


def checked_clauses(names: object) -> tuple[str, ...]:
    """Names of clauses, in one text or several, in the order of `CLAUSES`; "all" is all of them, nothing none."""
    given = names.split(",") if isinstance(names, str) and names else names
    chosen = {str(one).strip() for one in given} if isinstance(given, Iterable) else {""}
    if chosen <= {"all", *CLAUSES}:
        return tuple(name for name in CLAUSES if name in chosen or "all" in chosen)
    raise InvalidArgumentError("standards", names, f"all, or some of {', '.join(CLAUSES)}")


def demand_over_capacity(
    body: BodyArray, motions: Sequence[Motion], clauses: Sequence[str], stop: StopFlag | None = None
) -> dict[str, Array]:
    """Demand over capacity of each clause, arrays (bodies, motions); nan where a body cannot rock by a clause."""
    given = body.rigid.parameters
    names = "left", "right", "height", "gyration"
    left, right, h, r = np.broadcast_arrays(*(np.ravel(np.asarray(given[name], dtype=np.float64)) for name in names))
    b = np.where(body.side == 0.0, np.minimum(left, right), np.where(body.side > 0.0, right, left))
    found = {name: np.full((b.size, len(motions)), np.nan) for name in clauses}
    for k, motion in enumerate(motions):
        record = sampled(motion)
        scale = motion.peak_acceleration / record.peak_acceleration
        tilt = motion.peak_acceleration / standards.west_acceleration(b, h)
        if "static" in found:
            found["static"][:, k] = tilt
        if "circolare_linear" in found:
            found["circolare_linear"][:, k] = 0.5 * tilt
        if "ishiyama" in found:
            pgv = scale * np.abs(velocity(record.acceleration, record.time_step)).max()
            found["ishiyama"][:, k] = np.minimum(tilt, pgv / standards.ishiyama_velocity(b, h, r))
        if "circolare_nonlinear" in found:
            capacity = standards.circolare2009_displacement_capacity(b)
            periods = standards.circolare2009_secant_period(b, h)
            demand = [
                scale * largest_displacement(record.acceleration, record.time_step, t, 0.05, stop) for t in periods
            ]
            found["circolare_nonlinear"][:, k] = demand / capacity
        if "asce43" in found:
            spectral = [scale * _at_alpha(record, *each, stop) for each in zip(b, h, r, strict=True)]
            found["asce43"][:, k] = np.minimum(tilt, spectral)
    return found


def _at_alpha(record: Record, b: float, h: float, r: float, stop: StopFlag | None) -> float:
    """Spectral acceleration over capacity of ASCE 43-05 at theta = alpha of an unscaled record [-]."""
    alpha = math.atan2(b, h)
    damping = float(standards.asce43_effective_damping(b, h, r))
    if math.isnan(damping):
        return math.nan
    period = 1.0 / float(standards.asce43_effective_frequency(alpha, b, h, r))
    square = (2.0 * math.pi / period) ** 2
    demand = square * largest_displacement(record.acceleration, record.time_step, period, damping, stop)
    ratio = 0.0
    if record.vertical is not None:
        ratio = square * largest_displacement(record.vertical, record.time_step, period, damping, stop) / demand
    return demand / float(standards.asce43_capacity(alpha, b, h, min(ratio, 100.0)))
