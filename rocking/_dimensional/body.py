"""Bodies with two edges and their responses in SI units: what `rocking.RigidBody` and bodies of one's own share."""

from __future__ import annotations

import math
from collections.abc import Hashable
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rocking._base.errors import InvalidArgumentError, broadcast, in_range, integer, needed, positive, reject_given
from rocking._base.units import Scalar, Values
from rocking._boundary.tracing import trace_curves
from rocking._dimensional.body_problem import BodyProblem
from rocking._dimensional.body_response import BodyResponse, respond_bodies
from rocking._dimensional.curves import frequency_window, with_si_axes
from rocking._dimensional.problem import HIGHEST_SCALE, checked_restitution
from rocking._dimensional.thresholds import BodyThresholds, thresholds_of
from rocking._excitation.pulses import AbstractPulse, as_pulse
from rocking._excitation.records.record import Record
from rocking._history.contact import contact_extremes, reactions_of
from rocking._history.motion import SamplesMotion
from rocking._history.time_history import DEFAULT_SAMPLES, MAX_SAMPLES, default_times
from rocking._model.body import AbstractBody
from rocking._model.checks import check, check_number
from rocking._model.outcome import Outcome
from rocking._model.parameters import RESTITUTION, Parameter
from rocking._model.response import dimensions_of
from rocking._numba.cancellation import StopFlag

Array = NDArray[np.float64]

Motion = str | AbstractPulse | Record

STRENGTHS = {
    "peak_acceleration": Parameter("peak_acceleration", "a_g", "m/s2", 0.0, math.inf, "neither", "peak acceleration"),
    "period": Parameter("period", "T_p", "s", 0.0, math.inf, "neither", "period of the pulse"),
    "scale": Parameter("scale", "", "-", 0.0, HIGHEST_SCALE, "right", "factor of a record"),
}
"""Arguments that say how strong and how long a motion is."""


class RespondingBody(AbstractBody):
    """Responses of anything that rocks about two edges. A body of one's own derives from it and states its edges.

    Its properties `right`, `left`, `gravity`, `top_height` and `description` are those of
    `rocking._model.body.AbstractBody`. They may be arrays, which broadcast with the arguments.
    """

    def response(
        self,
        motion: Motion,
        *,
        peak_acceleration: Values | None = None,
        period: Values | None = None,
        scale: Values | None = None,
        restitution: Values = "momentum",
        threads: int | None = None,
        stop: StopFlag | None = None,
    ) -> BodyResponse:
        """Outcome and peak rotations about both edges under a pulse or a record. The arguments broadcast.

        Parameters
        ----------
        motion : str, AbstractPulse or Record
            The pulse, or a recorded ground motion; with its vertical component where it has one.
        peak_acceleration : array_like
            a_g [m/s2], > 0; of a pulse. Positive acceleration is to the right, and lifts the right edge.
        period : array_like
            T_p = 2 pi/omega_g [s], > 0; of a pulse.
        scale : array_like
            Factor of a record, of both its components [-], (0, 1e6]; 1 by default.
        restitution : array_like or "momentum"
            eta [-], [0, 1], of every impact; or from conservation of angular momentum, 0 where that is negative.
        threads : int, optional
            Number of threads, >= 1; by default all cores.
        stop : StopFlag, optional
            Cancels the work: it raises `StoppedError` soon after another thread sets the flag.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range, missing, or has no meaning for the kind of motion; if shapes do not broadcast.
        StoppedError
            If `stop` was set.
        """
        if threads is not None:
            threads = integer("threads", threads, 1, math.inf)
        problem, arguments, dims = self._problem(motion, peak_acceleration, period, scale, restitution)
        return respond_bodies(problem, arguments, dims, threads, stop)

    def thresholds(
        self,
        motion: Motion,
        *,
        period: Values | None = None,
        restitution: Values = "momentum",
        highest: Scalar | None = None,
        stop: StopFlag | None = None,
    ) -> BodyThresholds:
        """Every peak acceleration of a pulse, or factor of a record, at which the outcome changes, for each body.

        Parameters
        ----------
        motion, period, restitution
            As for `response`.
        highest : float, optional
            Highest peak acceleration [m/s2] or factor [-] searched, > 0; by default 100 times that of uplift under a
            pulse, 10 times under a record.
        stop : StopFlag, optional
            Cancels the work.

        Raises
        ------
        InvalidArgumentError, StoppedError
            As for `response`.
        """
        strength = {"scale": 1.0} if isinstance(motion, Record) else {"peak_acceleration": 1.0}
        problem, *_ = self._problem(motion, period=period, restitution=restitution, **strength)
        if highest is not None:
            highest = positive("highest", highest, "-" if isinstance(motion, Record) else "m/s2")
        return thresholds_of(problem, highest, stop)

    def spectrum(
        self,
        motion: Motion,
        *,
        peak_acceleration: Scalar | None = None,
        period: Values | None = None,
        scale: Scalar | None = None,
        size: Values | None = None,
        restitution: Scalar = "momentum",
        stop: StopFlag | None = None,
    ) -> xr.Dataset:
        """Peak rotation of one body against the period of a pulse; or against its size, under a pulse or a record.

        Parameters
        ----------
        motion, peak_acceleration, scale, restitution
            As for `response`.
        period : array_like (periods,)
            T_p [s], > 0; one period if `size` is an array.
        size : array_like (sizes,), optional
            Factors of all lengths of the body [-], > 0; stated for a record. p falls with the root of the size.

        Returns
        -------
        xarray.Dataset
            As `BodyResponse.to_xarray`, with the dimension `period` or `size`.

        Raises
        ------
        InvalidArgumentError, StoppedError
            As for `response`; also if `size` is missing for a record, or the body is an array.
        """
        self._need_one("spectrum", restitution, peak_acceleration=peak_acceleration, scale=scale)
        if size is None and isinstance(motion, Record):
            raise InvalidArgumentError("size", None, "factors of all lengths, for the spectrum of a record")
        axis, values = ("period", period) if size is None else ("size", size)
        if axis == "period" and period is None:
            raise InvalidArgumentError("period", None, "one dimension of periods")
        along = in_range(axis, values, 0.0, math.inf, closed="neither", unit="s" if axis == "period" else "-")  # type: ignore[arg-type]
        if along.ndim > 1:
            raise InvalidArgumentError(axis, along.shape, "one dimension")
        body = self if size is None else self.scaled(np.atleast_1d(along))
        found = body.response(
            motion,
            peak_acceleration=peak_acceleration,
            period=np.atleast_1d(along) if size is None else period,
            scale=scale,
            restitution=restitution,
            stop=stop,
        ).to_xarray()
        name = found["rotation"].dims[0]
        about = {"units": "1", "long_name": "factor of all lengths"}
        kept = found.drop_vars([one for one in found.coords if one not in ("period", "peak_acceleration", "scale")])
        return (
            kept if axis == "period" else kept.rename({name: "size"}).assign_coords(size=("size", along.ravel(), about))
        )

    def boundary(
        self,
        motion: str | AbstractPulse,
        *,
        restitution: Scalar = "momentum",
        period: tuple[float, float] | None = None,
        stop: StopFlag | None = None,
    ) -> xr.Dataset:
        """Peak accelerations and periods of a pulse at which the outcome for one body changes.

        Parameters
        ----------
        motion : str or AbstractPulse
            The pulse; of a record there is one strength for each body, see `thresholds`.
        restitution : float or "momentum"
            As for `response`.
        period : (float, float), optional
            Window of T_p [s], 0 < low < high; by default the frequency ratios to the right edge from 0.2 to 15.
        stop : StopFlag, optional
            Cancels the work.

        Returns
        -------
        xarray.Dataset
            As `rocking.overturning_boundary`, where slenderness(point) is the uplift acceleration of the weaker edge
            over the peak acceleration, and frequency_ratio(point) that to p of the right edge; with
            peak_acceleration(point) [m/s2] and period(point) [s].

        Raises
        ------
        InvalidArgumentError, StoppedError
            As for `response`.
        """
        self._need_one("boundary", restitution)
        if isinstance(motion, Record):
            raise InvalidArgumentError("motion", motion, "a pulse; `thresholds` gives the factors of a record")
        unit = 2.0 * math.pi / float(self.right.frequency_parameter)  # period at frequency ratio 1 [s]
        window = frequency_window(period, lambda one: unit / one)
        problem, *_ = self._problem(motion, 1.0, unit, restitution=restitution)
        eta = float(problem.cells["eta"][0, 0])
        curves = trace_curves(problem.solver(0, stop), eta, window, (0.02, 1.0))
        uplift = float(self.uplift_acceleration)
        curves.attrs |= {"pulse": problem.motion.name, "body": self.description, "uplift_acceleration": uplift}
        return with_si_axes(curves, uplift, unit)

    def history(
        self,
        motion: Motion,
        *,
        peak_acceleration: Scalar | None = None,
        period: Scalar | None = None,
        scale: Scalar | None = None,
        restitution: Scalar = "momentum",
        duration: Scalar | None = None,
        samples: int | None = None,
        contact: bool = False,
        stop: StopFlag | None = None,
    ) -> xr.Dataset:
        """Rotation of one body against time, exact to rounding at every sample.

        Parameters
        ----------
        motion, peak_acceleration, period, scale, restitution
            As for `response`; numbers.
        duration : float, optional
            Length [s], > 0; by default the motion and 8/p after it, of the right edge.
        samples : int, optional
            Uniform samples, 2 to 1,000,000; by default 400 under a pulse, and those of a record. The uplift, impacts
            and the end of the motion are added.
        contact : bool
            Whether to add reactions and friction demand.
        stop : StopFlag, optional
            Cancels the work.

        Returns
        -------
        xarray.Dataset
            time(time) [s]; rotation(time) [rad], positive about the right edge; angular_velocity(time) [rad/s], after
            the impact at an impact; edge(time): 1 right, -1 left, 0 at rest; ground_acceleration(time) and
            vertical_acceleration(time) [m/s2]; top_displacement(time) [m]; impact_time(impact) [s]. With `contact`
            horizontal_reaction(time), normal_reaction(time): along the base and normal to it, over the weight [-];
            friction_demand(time) [-], infinite where the body lifts off; attributes largest_friction_demand,
            smallest_normal_reaction, impulse_ratio, lifts_off, warnings.

        Raises
        ------
        InvalidArgumentError, StoppedError
            As for `response`; also if the body or an argument is an array.
        """
        self._need_one("history", restitution, peak_acceleration=peak_acceleration, period=period, scale=scale)
        problem, *_ = self._problem(motion, peak_acceleration, period, scale, restitution)
        if samples is not None:
            samples = integer("samples", samples, 2, MAX_SAMPLES)
        length = None if duration is None else positive("duration", duration, "s")
        moving = problem.body_motion(length, stop)
        p, alpha, g = float(self.right.frequency_parameter), moving.alpha, float(self.gravity)
        if samples is None and isinstance(moving, SamplesMotion) and isinstance(motion, Record):
            grid = default_times(moving)
        else:
            grid = np.linspace(0.0, moving.horizon, DEFAULT_SAMPLES if samples is None else samples)
        record, tau, rotation, velocity, impacts = moving.history(grid)
        side = np.where(rotation != 0.0, np.sign(rotation), np.sign(velocity))
        columns = {
            "rotation": (alpha * rotation, "rad", "rotation theta, positive about the right edge"),
            "angular_velocity": (alpha * p * velocity, "rad s-1", "velocity theta'"),
            "edge": (side.astype(np.int8), "1", "edge in contact: 1 right, -1 left, 0 both"),
            "ground_acceleration": (
                g * math.tan(alpha) * moving.ground_acceleration(tau),
                "m s-2",
                "horizontal ground acceleration",
            ),
            "vertical_acceleration": (g * moving.vertical_acceleration(tau), "m s-2", "vertical ground acceleration"),
            "top_displacement": (
                float(self.top_height) * np.sin(alpha * rotation),
                "m",
                "horizontal displacement of the top",
            ),
        }
        attributes: dict[str, Any] = {
            "motion": problem.motion.name,
            "body": self.description,
            "peak_acceleration": float(problem.acceleration),
            "outcome": Outcome(int(record["outcome"])).name,
            "impacts": int(record["impacts"]),
            "alpha": alpha,
            "alpha_left": float(self.left.alpha),
            "slenderness": float(moving.cell["slenderness"][0]),
            "slenderness_left": float(moving.cell["slenderness"][1]),
            "motion_end": moving.pulse_end / p,
        }
        if not isinstance(motion, Record):
            attributes |= {"pulse": problem.motion.name, "pulse_end": moving.pulse_end / p}
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
            {
                name: ("time", values, {"units": unit, "long_name": text})
                for name, (values, unit, text) in columns.items()
            }
            | {"impact_time": ("impact", impacts / p, {"units": "s", "long_name": "time of impact"})},
            {"time": ("time", tau / p, {"units": "s", "long_name": "time from the start of the motion"})},
            attributes,
        )

    def scaled(self, size: Values) -> RespondingBody:
        """The body with all lengths times a factor.

        Parameters
        ----------
        size : array_like
            The factor [-], > 0.

        Raises
        ------
        InvalidArgumentError
            If it is not positive, or the kind of body cannot be scaled.
        """
        raise InvalidArgumentError("size", size, f"nothing for {type(self).__name__}: it states no lengths")

    def _problem(
        self,
        motion: Motion,
        peak_acceleration: Values | None = None,
        period: Values | None = None,
        scale: Values | None = None,
        restitution: Values = "momentum",
    ) -> tuple[BodyProblem, dict[str, Array], tuple[Hashable, ...]]:
        """The checked problem, its arguments as arrays, and the names of the dimensions of labelled ones."""
        eta = checked_restitution(restitution)
        given: dict[str, Values]
        if isinstance(motion, Record):
            reject_given("a record: state `scale`", peak_acceleration=peak_acceleration, period=period)
            given = {"scale": 1.0 if scale is None else scale}
        else:
            reject_given("a pulse: state `peak_acceleration`", scale=scale)
            strength = needed("a pulse", peak_acceleration=peak_acceleration)
            given = {"peak_acceleration": strength, "period": needed("a pulse", period=period)}
        checked = {name: check(STRENGTHS[name], value) for name, value in given.items()}
        if isinstance(motion, Record):
            acceleration, times = checked["scale"] * motion.peak_acceleration, np.ones(())
        else:
            acceleration, times = checked["peak_acceleration"], checked["period"]
        if eta is not None:
            given["restitution"], checked["restitution"] = restitution, eta
        broadcast({**self.parameters, **given}, [*self.parameters.values(), *checked.values()])
        made = motion if isinstance(motion, Record) else as_pulse(motion)
        return BodyProblem(self, made, acceleration, times, eta), checked, dimensions_of(*given.values())

    def _need_one(self, name: str, restitution: Scalar, **numbers: Scalar | None) -> None:
        """Refuse an array of bodies, and arrays as arguments that are one number."""
        if self.shape:
            raise InvalidArgumentError(name, f"bodies of shape {self.shape}", "one body")
        if checked_restitution(restitution) is not None:
            check_number(RESTITUTION, restitution)
        for key, value in numbers.items():
            if value is not None:
                check_number(STRENGTHS[key], value)
