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
from rocking._boundary.tracing import overturning_boundary, trace_curves
from rocking._dimensional.fields import CONTACT_FORCES
from rocking._dimensional.problem import Problem, frequency_ratio_of
from rocking._dimensional.response import BodyResponse, respond
from rocking._excitation.records.record import Record
from rocking._history.contact import contact_extremes, reactions_of
from rocking._history.motion import BodyMotion, FreeMotion, SamplesMotion
from rocking._history.time_history import DEFAULT_SAMPLES, MAX_SAMPLES, default_times, time_history
from rocking._model.block import AbstractBlock
from rocking._model.body import AbstractBody
from rocking._model.fields import ERROR_BOUND, IMPACTS, OUTCOME, OVERTURNED, PEAK_ROTATION
from rocking._model.labelled import variable
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.bounded_response import solve_with_bound
from rocking._solver.state import block_cell

if TYPE_CHECKING:
    import xarray as xr

RELEASED = 16.0  # default length of the motion of a body that is released [tau]


def history(
    problem: Problem,
    *,
    duration: float | None = None,
    samples: int | None = None,
    contact: bool = False,
    stop: StopFlag | None = None,
) -> xr.Dataset:
    """Rotation of one body against time in SI units, as `rocking.Block.history`; `duration` is checked [s].

    Of a block under a record also the coordinate tau(time) [-].
    """
    if not problem.is_block:
        return _body_history(problem, duration, samples, contact, stop)
    if duration is not None and not isinstance(problem.motion, Record):
        duration *= problem.block.frequency_parameter
    groups = problem.groups
    found = time_history(problem.motion, **groups, duration=duration, samples=samples, contact=contact, stop=stop)
    return in_si_units(found, problem)


def in_si_units(found: xr.Dataset, problem: Problem) -> xr.Dataset:
    """A time history of `rocking.time_history` for the groups of a problem, as `history` returns it."""
    about = _description(problem)
    if isinstance(problem.motion, Record):
        return _in_radians(found, problem.block).assign_attrs(about | {"scale": problem.scale})
    p = problem.block.frequency_parameter
    time = variable("time", found["tau"].values / p, "s", "time from pulse start")
    impacts = found["impact_time"]
    history = found.rename({"tau": "time"}).assign_coords(time=time)
    history["impact_time"] = variable(impacts.dims, impacts.values / p, "s", "time of impact")
    times = {"period": problem.period, "pulse_end": float(found.attrs["pulse_end"]) / p}
    return _in_radians(history, problem.block).assign_attrs(about | times)


def _in_radians(history: xr.Dataset, block: AbstractBlock) -> xr.Dataset:
    """A history over time [s] with rotation [rad], velocity [rad/s] and ground acceleration [m/s2] for groups."""
    scales = {
        "rotation": (block.alpha, "rad", "rotation theta"),
        "angular_velocity": (block.alpha * block.frequency_parameter, "rad s-1", "velocity theta'"),
        "ground_acceleration": (block.uplift_acceleration, "m s-2", "ground acceleration"),
        "vertical_acceleration": (block.gravity, "m s-2", "vertical ground acceleration, upwards"),
    }
    scaled = {
        name: variable(history[name].dims, scale * history[name].values, unit, meaning)
        for name, (scale, unit, meaning) in scales.items()
        if name in history
    }
    moved = block.top_height * np.sin(scaled["rotation"][1])
    scaled["top_displacement"] = variable(history["rotation"].dims, moved, "m", "top corner displacement")
    return history.assign(scaled)


def with_forces(motion: xr.Dataset, mass: float, gravity: float) -> xr.Dataset:
    """A motion with reactions, and these in newtons for a mass [kg] at a gravity [m/s2]."""
    forces = {
        name: variable(motion[reaction].dims, mass * gravity * motion[reaction].values, "N", meaning)
        for name, (reaction, meaning) in CONTACT_FORCES.items()
    }
    return motion.assign(forces)


def _body_history(
    problem: Problem, duration: float | None, samples: int | None, contact: bool, stop: StopFlag | None
) -> xr.Dataset:
    """The history of one body whose edges differ."""
    if samples is not None:
        samples = integer("samples", samples, 2, MAX_SAMPLES)
    body, moving = problem.body, problem.body_motion(duration, stop)
    if samples is None and isinstance(moving, SamplesMotion) and isinstance(problem.motion, Record):
        grid = default_times(moving)
    else:
        grid = np.linspace(0.0, moving.horizon, DEFAULT_SAMPLES if samples is None else samples)
    end = moving.pulse_end / float(body.right.frequency_parameter)
    attributes: dict[str, Any] = {
        "motion": problem.motion.name,
        "peak_acceleration": float(problem.peak_acceleration),
        "slenderness": float(moving.cell["slenderness"][0]),
        "slenderness_left": float(moving.cell["slenderness"][1]),
        "motion_end": end,
    }
    if not isinstance(problem.motion, Record):
        attributes |= {"pulse": problem.motion.name, "pulse_end": end}
    return _history_of(moving, body, grid, contact).assign_attrs(attributes)


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
    problem = Problem.of(body, "sine", float(body.uplift_acceleration), unit, restitution)
    groups = problem.groups if problem.is_block else {}
    cell = block_cell(1.0, 1.0, groups["restitution"], groups["alpha"] or 0.0) if groups else problem.cells[0]
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
        "top_displacement": (moved, "m", "horizontal displacement of the top"),
    }
    attributes: dict[str, Any] = {
        "body": body.description,
        "outcome": Outcome(int(record["outcome"])).name,
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
        {"time": variable("time", tau / p, "s", "time from the start of the motion")},
        attributes,
    )


def spectrum(problem: Problem, period: Array, stop: StopFlag | None = None) -> xr.Dataset:
    """Peak rotation of one body over periods of the pulse (periods,) [s], as `rocking.Block.spectrum`.

    The period of the problem is not read. Of a block with the coordinate frequency_ratio(period) [-].
    """
    if not problem.is_block:
        eta = "momentum" if problem.restitution is None else problem.restitution
        many = Problem.of(problem.body, problem.motion, problem.peak_acceleration, period, eta)
        return over_axis(respond(many, stop=stop), "period", period)
    import xarray as xr  # noqa: PLC0415  # takes longer to load than the solver

    block = problem.block
    ratio = frequency_ratio_of(block, 1.0) / period
    found = solve_with_bound(problem.pulse, **problem.groups | {"frequency_ratio": ratio}, stop=stop)
    rotation = found.peak_rotation * block.alpha
    variables = {
        "rotation": variable("period", rotation, "rad", "peak rotation"),
        "top_displacement": variable("period", block.top_height * np.sin(rotation), "m", "largest top displacement"),
    }
    variables |= {
        field.name: field.variable("period", getattr(found, field.name))
        for field in (PEAK_ROTATION, OVERTURNED, OUTCOME, IMPACTS, ERROR_BOUND)
    }
    coordinates = {
        "period": variable("period", period, "s", "period of the pulse"),
        "frequency_ratio": variable("period", ratio, "1", "frequency ratio omega_g/p"),
    }
    return xr.Dataset(variables, coordinates, _description(problem))


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
    if problem.is_block:
        groups = problem.groups
        window = window or frequency_window(period, lambda one: frequency_ratio_of(problem.block, one))
        found = overturning_boundary(
            problem.pulse, restitution=groups["restitution"], alpha=groups["alpha"], frequency_ratio=window, stop=stop
        )
        return _with_si_axes(found, problem.block.uplift_acceleration, unit)
    window = window or frequency_window(period, lambda one: unit / one)
    block = float(problem.cells["eta"][0, 0]), 0.0, 401  # the solver knows the angles
    (curves,) = trace_curves(problem.solver(0, stop), [block], window, (0.02, 1.0))
    uplift = float(body.uplift_acceleration)
    curves.attrs |= {"pulse": problem.motion.name, "body": body.description, "uplift_acceleration": uplift}
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


def _description(problem: Problem) -> dict[str, float]:
    """Attributes that name the problem of a block, in SI units."""
    size = {name: getattr(problem.block, name) for name in ("width", "height", "alpha", "gravity")}
    return size | {"peak_acceleration": problem.peak_acceleration, "restitution": problem.groups["restitution"]}
