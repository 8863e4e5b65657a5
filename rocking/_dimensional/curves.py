"""Time histories, spectra and boundaries of one body in SI units, as labelled data sets."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

import rocking._base.quantities as q
from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, in_range, integer
from rocking._base.units import Scalar
from rocking._boundary.tracing import trace_curves
from rocking._dimensional.fields import CONTACT_FORCES
from rocking._dimensional.problem import Problem
from rocking._dimensional.response import BodyResponse
from rocking._history.contact import contact_extremes, reactions_of
from rocking._history.motion import BodyMotion, FreeMotion, overturned
from rocking._history.time_history import DEFAULT_SAMPLES, MAX_SAMPLES, default_times
from rocking._model.body import AbstractBody
from rocking._model.labelled import variable
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag

if TYPE_CHECKING:
    import xarray as xr

RELEASED = 16.0  # default length of the motion of a body that is released [tau]


def with_forces(motion: xr.Dataset, mass: float, gravity: float) -> xr.Dataset:
    """A motion with reactions, and these in newtons for a mass [kg] at a gravity [m/s2]."""
    forces = {
        name: variable(motion[reaction].dims, mass * gravity * motion[reaction].values, "N", meaning)
        for name, (reaction, meaning) in CONTACT_FORCES.items()
    }
    return motion.assign(forces)


def history(
    problem: Problem,
    *,
    duration: float | None = None,
    samples: int | None = None,
    contact: bool = False,
    stop: StopFlag | None = None,
) -> xr.Dataset:
    """Rotation of one body against time in SI units, as `rocking.Block.history`; `duration` is checked [s]."""
    if samples is not None:
        samples = integer("samples", samples, 2, MAX_SAMPLES)
    motion, moving = problem.motion, problem.body_motion(duration, stop)
    if samples is None and motion.rate is q.FREQUENCY_PARAMETER:
        grid = default_times(moving)
    else:
        grid = np.linspace(0.0, moving.horizon, DEFAULT_SAMPLES if samples is None else samples)
    arguments = {"peak_acceleration": problem.peak_acceleration, "period": problem.period, "scale": problem.strength}
    stated = {name: float(arguments[name]) for name in ("peak_acceleration", *(one.name for one in motion.arguments))}
    attributes: dict[str, Any] = {
        "motion": motion.name,
        motion.kind: motion.name,
        **stated,
        "slenderness": float(moving.cell["slenderness"][0]),
        "slenderness_left": float(moving.cell["slenderness"][1]),
        "restitution": moving.restitution,
        "motion_end": float(problem.duration),
    }
    if motion.kind == "pulse":
        attributes["pulse_end"] = attributes["motion_end"]
    return _history_of(moving, problem.body, grid, contact).assign_attrs(attributes)


def release(
    body: AbstractBody,
    start: float,
    restitution: Scalar,
    duration: float | None,
    samples: int,
    contact: bool,
    stop: StopFlag | None,
) -> xr.Dataset:
    """The motion of one body that is released at rest from a rotation `start` [rad], as `rocking.Block.history`."""
    if (body.right if start > 0.0 else body.left).blocked:
        raise InvalidArgumentError("start", start, "a rotation about the edge that no wall blocks")
    if contact and not body.contact_is_known:
        raise InvalidArgumentError("contact", contact, "False: the contact forces of this body are not known")
    unit = float(2.0 * math.pi / body.right.frequency_parameter)
    cell = Problem.of(body, "sine", float(body.uplift_acceleration), unit, restitution).cells[0]
    p, alpha = float(body.right.frequency_parameter), float(body.right.alpha)
    in_range("alpha", alpha, q.SMALLEST_ALPHA, math.inf, unit="rad")
    horizon = RELEASED if duration is None else p * duration
    inertia = float(body.right.inertia_ratio), float(body.left.inertia_ratio)
    moving = FreeMotion(cell, horizon, stop, start / alpha, inertia_ratio=inertia, tilt=float(body.tilt))
    found = _history_of(moving, body, np.linspace(0.0, horizon, integer("samples", samples, 2, MAX_SAMPLES)), contact)
    return found.assign_attrs(motion="release", start=start, impacts=found.sizes["impact"], motion_end=0.0)


def _history_of(moving: BodyMotion, body: AbstractBody, grid: Array, contact: bool) -> xr.Dataset:
    """The samples of a motion at `grid` [tau] and at its events, in SI units."""
    import xarray as xr  # noqa: PLC0415  # takes longer to load than the solver

    p, alpha, g = float(body.right.frequency_parameter), float(body.right.alpha), float(body.gravity)
    record, tau, rotation, velocity, impacts = moving.history(grid)
    side = np.where(rotation != 0.0, np.sign(rotation), np.sign(velocity))
    ground = g * math.tan(alpha) * moving.ground_acceleration(tau)
    moved = float(body.top_height) * np.sin(alpha * rotation)
    columns = {
        "rotation": (alpha * rotation, "rad", "rotation theta, positive about the right edge"),
        "angular_velocity": (alpha * p * velocity, "rad s-1", "velocity theta'"),
        "edge": (side.astype(np.int8), "1", "edge in contact: 1 right, -1 left, 0 both"),
        "ground_acceleration": (ground, "m s-2", "horizontal ground acceleration"),
        "vertical_acceleration": (g * moving.vertical_acceleration(tau), "m s-2", "vertical ground acceleration"),
        "displacement": (moved, "m", "horizontal displacement of the top"),
    }
    attributes: dict[str, Any] = {
        "body": body.description,
        "outcome": Outcome(int(record["outcome"])).name,
        "overturned": int(overturned(record)),
        "peak_rotation": float(record["peak_rotation"]),
        "impacts": int(record["impacts"]),
        "alpha": alpha,
        "alpha_left": float(body.left.alpha),
    }
    if contact:
        found = reactions_of(moving, impacts, tau, rotation, velocity)
        slope = math.tan(alpha)
        columns |= {
            "horizontal_reaction": (slope * found.horizontal, "1", "reaction along the base over the weight"),
            "normal_reaction": (found.normal, "1", "reaction normal to the base over the weight"),
            "friction_demand": (slope * found.friction_demand, "1", "friction demand"),
        }
        most = contact_extremes(moving)
        names = "largest_friction_demand", "smallest_normal_reaction", "impulse_ratio"
        attributes |= {name: getattr(most, name) for name in names}
        attributes |= {"lifts_off": int(most.lifts_off), "warnings": "; ".join(most.warnings)}
    return xr.Dataset(
        {name: variable("time", values, unit, text) for name, (values, unit, text) in columns.items()}
        | {"impact_time": variable("impact", impacts / p, "s", "time of impact")},
        {"time": variable("time", tau / p, "s", "time from the start")},
        attributes,
    )


def over_axis(found: BodyResponse, axis: str, along: Array) -> xr.Dataset:
    """The responses of one body over periods [s], or of its sizes, as a data set with this axis."""
    data = found.to_xarray()
    kept = data.drop_vars([one for one in data.coords if one not in ("period", "peak_acceleration", "scale")])
    kept = kept.drop_vars(axis, errors="ignore").rename({data["rotation"].dims[0]: axis})
    about = {"units": "s", "long_name": "period"}
    if axis == "size":
        about = {"units": "1", "long_name": "factor of all lengths"}
    return kept.assign_coords({axis: (axis, along, about)})


def boundary(
    problem: Problem,
    period: tuple[float, float] | None = None,
    stop: StopFlag | None = None,
    window: tuple[float, float] | None = None,
) -> xr.Dataset:
    """Boundary curves of overturning of one body, as of `rocking.Block.boundary`.

    `window`: of checked frequency ratios to the right edge, in place of periods.
    """
    body = problem.body
    unit = 2.0 * math.pi / float(body.right.frequency_parameter)
    window = window or frequency_window(period, lambda one: unit / one)
    block = float(problem.cells["eta"][0, 0]), 0.0, 401  # the solver knows the angles
    (curves,) = trace_curves(problem.solver(0, stop), [block], window, (0.02, 1.0))
    uplift = float(body.uplift_acceleration)
    named = {"pulse": problem.motion.name, "body": body.description, "uplift_acceleration": uplift}
    curves.attrs |= named | {"alpha": float(body.right.alpha)}
    return _with_si_axes(curves, uplift, unit)


def frequency_window(
    period: tuple[float, float] | None, frequency_ratio: Callable[[float], float]
) -> tuple[float, float]:
    """Window of frequency ratios of a window of periods [s], 0 < low < high; 0.2 to 15 without one."""
    if period is None:
        return 0.2, 15.0
    ends = in_range("period", period, 0.0, math.inf, closed="neither", unit="s")
    if ends.shape != (2,) or not ends[0] < ends[1]:
        raise InvalidArgumentError("period", period, "the two ends of a window, ascending [s]")
    low, high = ends.tolist()
    return frequency_ratio(high), frequency_ratio(low)


def _with_si_axes(curves: xr.Dataset, uplift_acceleration: float, unit_period: float) -> xr.Dataset:
    """With peak acceleration and period, from those at slenderness 1 [m/s2] and at frequency ratio 1 [s]."""
    return curves.assign(
        peak_acceleration=variable(
            "point", uplift_acceleration / curves["slenderness"].values, "m s-2", "peak acceleration a_g"
        ),
        period=variable("point", unit_period / curves["frequency_ratio"].values, "s", "period of the pulse"),
    )
