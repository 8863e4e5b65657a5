"""Checks of standards for bodies under the motions of a site: demand over capacity."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence

import numpy as np

from rocking.extension import Array, InvalidArgumentError, Record, StopFlag, largest_displacement, velocity
from rocking_assessment import standards
from rocking_assessment._objects.columns import CLAUSES
from rocking_assessment._objects.objects import BodyArray
from rocking_assessment._objects.site import Motion, sampled
from rocking_assessment.standards.circolare2019 import DAMPING

PERIODS: Array = 0.05 * 1.05 ** np.arange(160, dtype=np.float64)
"""Periods [s] at which the largest spectral displacement up to T_SLV is looked for, beside T_SLV: up to 117 s."""


def checked_clauses(names: object) -> tuple[str, ...]:
    """Names of clauses, in one text or several, in the order of `CLAUSES`; "all" is all of them, nothing none."""
    listed = names.split(",") if isinstance(names, str) and names else names
    clauses = {str(name).strip() for name in listed} if isinstance(listed, Iterable) else {""}
    if not clauses <= {"all", *CLAUSES}:
        raise InvalidArgumentError("standards", names, f"all, or some of {', '.join(CLAUSES)}")
    return tuple(CLAUSES) if "all" in clauses else tuple(name for name in CLAUSES if name in clauses)


def demand_over_capacity(
    body: BodyArray, motions: Sequence[Motion], clauses: Sequence[str], stop: StopFlag | None = None
) -> dict[str, Array]:
    """Demand over capacity of each clause, arrays (bodies, motions); nan where a body cannot rock by a clause."""
    parameters = body.rigid.parameters
    names = "left", "right", "height", "gyration"
    arrays = [np.ravel(np.asarray(parameters[name], dtype=np.float64)) for name in names]
    left, right, h, r = np.broadcast_arrays(*arrays)
    b = np.where(body.side == 0.0, np.minimum(left, right), np.where(body.side > 0.0, right, left))
    ratios = {name: np.full((b.size, len(motions)), np.nan) for name in clauses}
    for k, motion in enumerate(motions):
        for name in clauses:
            clause = DEMANDS[name]
            ratio = clause(motion, b, h, r, stop)
            if motion.below is not None and name in AT_GROUND_TOO:
                ratio = np.maximum(ratio, clause(motion.below, b, h, r, stop))
            ratios[name][:, k] = ratio
    return ratios


def _static(motion: Motion, b: Array, h: Array, _r: Array, _stop: StopFlag | None) -> Array:
    """PGA over g b/h."""
    ratio: Array = motion.peak_acceleration / standards.west_acceleration(b, h)
    return ratio


def _ishiyama(motion: Motion, b: Array, h: Array, r: Array, stop: StopFlag | None) -> Array:
    """The smaller one of PGA and PGV over their bounds."""
    record, scale = _scaled(motion)
    pgv = scale * np.abs(velocity(record.acceleration, record.time_step)).max()
    ratio: Array = np.minimum(_static(motion, b, h, r, stop), pgv / standards.ishiyama_velocity(b, h, r))
    return ratio


def _asce43(motion: Motion, b: Array, h: Array, r: Array, stop: StopFlag | None) -> Array:
    """Spectral demand over capacity at alpha, at most PGA over g b/h."""
    record, scale = _scaled(motion)
    spectral = np.array([scale * _at_alpha(record, *dimensions, stop) for dimensions in zip(b, h, r, strict=True)])
    ratio: Array = np.minimum(_static(motion, b, h, r, stop), spectral)
    return ratio


def _circolare_linear(motion: Motion, b: Array, h: Array, r: Array, stop: StopFlag | None) -> Array:
    """PGA/q over g b/h, q = 2."""
    return 0.5 * _static(motion, b, h, r, stop)


def _circolare2009_nonlinear(motion: Motion, b: Array, h: Array, _r: Array, stop: StopFlag | None) -> Array:
    """S_De(T_s) at 5 % over 0.4 b."""
    record, scale = _scaled(motion)
    periods = standards.circolare2009_secant_period(b, h)
    demand = [largest_displacement(record.acceleration, record.time_step, t, 0.05, stop) for t in periods]
    ratio: Array = scale * np.array(demand) / standards.circolare2009_displacement_capacity(b)
    return ratio


def _circolare2019_nonlinear(motion: Motion, b: Array, h: Array, r: Array, stop: StopFlag | None) -> Array:
    """Largest S_De at 8 % up to T_SLV over 0.4 b, at most PGA over g b/h: what is not activated passes."""
    record, scale = _scaled(motion)
    longest = standards.circolare2019_period(b, h)
    at_end = _displacements(record, longest, stop)
    below = np.searchsorted(PERIODS, longest, side="right")  # number of periods up to that of each body
    largest = np.maximum.accumulate([0.0, *_displacements(record, PERIODS[: below.max()], stop)])
    demand = np.maximum(at_end, largest[below])
    in_displacements = scale * demand / standards.circolare2019_displacement_capacity(b)
    ratio: Array = np.minimum(_static(motion, b, h, r, stop), in_displacements)
    return ratio


def _displacements(record: Record, periods: Array, stop: StopFlag | None) -> Array:
    """S_De of an unscaled record at some periods [s] and the damping ratio of SLV [m]."""
    damping = DAMPING["SLV"]
    return np.array([largest_displacement(record.acceleration, record.time_step, t, damping, stop) for t in periods])


DEMANDS: dict[str, Callable[[Motion, Array, Array, Array, StopFlag | None], Array]] = {
    "static": _static,
    "ishiyama": _ishiyama,
    "asce43": _asce43,
    "circolare_linear": _circolare_linear,
    "circolare_nonlinear": _circolare2009_nonlinear,
    "circolare2019_nonlinear": _circolare2019_nonlinear,
}
"""Demand over capacity of each of `CLAUSES` under one motion, of bodies with half widths b, heights h of their centres
of mass, and radii of gyration r [m]."""

AT_GROUND_TOO = {"circolare_linear", "circolare_nonlinear", "circolare2019_nonlinear"}
"""Clauses by which a body on a floor passes under the motion of the ground as well."""


def _scaled(motion: Motion) -> tuple[Record, float]:
    """The samples of a motion, and the factor that they have at the site [-]."""
    record = sampled(motion)
    return record, motion.peak_acceleration / record.peak_acceleration


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
