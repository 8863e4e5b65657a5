"""Bodies with two edges and their responses in SI units: what `rocking.RigidBody` and bodies of your own share."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, in_range, integer, positive, reject_given
from rocking._base.quantities import PERIOD, RESTITUTION, START
from rocking._base.units import Scalar, Values
from rocking._boundary.scan import RESOLUTION, checked_resolution
from rocking._dimensional.curves import boundary, history, over_axis, release
from rocking._dimensional.fields import ERROR_BOUND, FIELDS
from rocking._dimensional.problem import (
    STRENGTHS,
    Problem,
    checked_restitution,
    spread_restitution,
)
from rocking._dimensional.response import BodyResponse, respond
from rocking._dimensional.thresholds import BodyThresholds, thresholds_of
from rocking._excitation.pulses import AbstractPulse, Motion, as_motion
from rocking._model.body import AbstractBody, Edge
from rocking._model.labelled import in_unit, is_labelled, labelled_response
from rocking._numba.cancellation import StopFlag

if TYPE_CHECKING:
    import xarray as xr


class RespondingBody(AbstractBody):
    """Base of every body that rocks about two edges: responses, thresholds, histories.

    A body of your own derives from it and states its edges.

    Its properties `right`, `left`, `gravity`, `top_height` and `description` are those of
    `rocking._model.body.AbstractBody`. They may be arrays, which broadcast with the arguments.
    """

    @overload
    def response(self, motion: Motion, *, peak_acceleration: xr.DataArray, **others: Any) -> xr.Dataset: ...

    @overload
    def response(
        self,
        motion: Motion,
        *,
        peak_acceleration: Values | None = None,
        period: Values | None = None,
        scale: Values | None = None,
        restitution: Values = "momentum",
        error_bound: bool = False,
        thresholds: bool = True,
        threads: int | None = None,
        stop: StopFlag | None = None,
    ) -> BodyResponse: ...

    def response(  # type: ignore[misc]  # the names beside labelled arguments are checked here
        self,
        motion: Motion,
        *,
        peak_acceleration: Values | None = None,
        period: Values | None = None,
        scale: Values | None = None,
        restitution: Values = "momentum",
        error_bound: bool = False,
        thresholds: bool = True,
        threads: int | None = None,
        stop: StopFlag | None = None,
    ) -> BodyResponse | xr.Dataset:
        """Outcome, peak rotation and displacement under a pulse or a record. The arguments broadcast.

        Labelled ones (`xarray.DataArray`), also of the body, broadcast by the names of their dimensions and give an
        `xarray.Dataset` of the same fields, which stays lazy where they are backed by dask.

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
        restitution : array_like, "momentum" or "kalliontzis(k=...)"
            eta [-], [0, 1], of every impact; or from conservation of angular momentum, (2.4) for a block, 0 where that
            is negative.
        error_bound : bool
            Whether the response has a bound of the error of the peak rotation, which takes twice the time.
        thresholds : bool
            Whether the strengths of the motion at which the outcome changes are searched, when they, the warnings or
            the text of the response to a record are first asked for.
        threads : int, optional
            Number of threads for arrays, >= 1; by default all cores.
        stop : StopFlag, optional
            Cancels the work: it raises `StoppedError` soon after another thread sets the flag.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range, missing, or has no meaning for the kind of motion; if shapes do not broadcast.

        Examples
        --------
        >>> import rocking
        >>> block = rocking.Block("40 cm", "160 cm")
        >>> bool(block.response("sine", peak_acceleration="0.4 g", period="500 ms").overturned)
        False
        """
        if threads is not None:
            threads = integer("threads", threads, 1, math.inf)
        given = {"peak_acceleration": peak_acceleration, "period": period, "scale": scale, "restitution": restitution}
        if self.labels or is_labelled(*given.values()):
            return self._labelled_response(motion, given, error_bound, {"threads": threads, "stop": stop})
        problem = Problem.of(self, motion, peak_acceleration, period, restitution, scale=scale)
        return respond(problem, threads, stop, error_bound=error_bound, thresholds=thresholds)

    def _labelled_response(
        self, motion: Motion, given: dict[str, Any], error_bound: bool, options: dict[str, Any]
    ) -> xr.Dataset:
        """The response to labelled arguments, or of a body built from labelled values."""
        eta, own = given.pop("restitution"), self.labels
        if not is_labelled(eta):
            eta = checked_restitution(eta)
        strengths = {
            name: in_unit(name, one, STRENGTHS[name].unit) if is_labelled(one) else STRENGTHS[name].convert(one)
            for name, one in given.items()
            if one is not None
        }
        plain = {name: value for name, value in self.parameters.items() if name not in own}
        make = partial(type(self), **plain) if own else lambda: self
        solve = partial(_respond_part, make, tuple(own), motion, error_bound)
        kinds = {as_motion(motion).kind, "block" if self.moves_as_block else "edges"}
        fields = [one for one in FIELDS if kinds <= one.kinds and (error_bound or one is not ERROR_BOUND)]
        return labelled_response(solve, {**own, **strengths, "restitution": eta}, options, fields)

    def thresholds(
        self,
        motion: Motion,
        *,
        period: Values | None = None,
        restitution: Values = "momentum",
        highest: Scalar | None = None,
        resolution: Scalar = RESOLUTION,
        stop: StopFlag | None = None,
    ) -> BodyThresholds:
        """Every peak acceleration of a pulse, or factor of a record, at which the outcome changes, for each body.

        Parameters
        ----------
        motion, period, restitution, stop
            As for `response`.
        highest : float, optional
            Highest peak acceleration [m/s2] or factor [-] searched, > 0; by default 100 times that of uplift under a
            pulse, 10 times under a record.
        resolution : float
            Largest relative distance of the factors of a record that are tried in search of the lowest [-],
            [1e-4, 0.1]; above it they are 0.2 % apart.
        """
        share, motion = checked_resolution(resolution), as_motion(motion)
        if highest is not None:
            highest = replace(motion.strength, name="highest").number(highest)
        uplift = float(np.min(self.uplift_acceleration))  # a strength that is not read
        value = min(uplift / motion.unit_acceleration, motion.strength.upper)
        strength: dict[str, Any] = {motion.strength.name: value}
        problem = Problem.of(self, motion, **strength, period=period, restitution=restitution)
        return thresholds_of(problem, highest, stop, share)

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
        motion, peak_acceleration, scale, restitution, stop
            As for `response`.
        period : array_like (periods,)
            T_p [s], > 0; one period if `size` is an array.
        size : array_like (sizes,), optional
            Factors of all lengths of the body [-], > 0; stated for a record. p falls with the root of the size.

        Returns
        -------
        xarray.Dataset
            As `BodyResponse.to_xarray`, with the dimension `period` or `size`.
        """
        self._need_one("spectrum", restitution, peak_acceleration=peak_acceleration, scale=scale)
        motion = as_motion(motion)
        if size is None and PERIOD not in motion.arguments:
            raise InvalidArgumentError("size", None, f"factors of all lengths, for the spectrum of a {motion.kind}")
        axis, values = ("period", period) if size is None else ("size", size)
        if values is None:
            raise InvalidArgumentError("period", None, "one dimension of periods")
        along = in_range(axis, values, 0.0, math.inf, closed="neither", unit="s" if axis == "period" else "-")
        if along.ndim > 1:
            raise InvalidArgumentError(axis, along.shape, "one dimension")
        along = np.atleast_1d(along)
        body, times = (self, along) if size is None else (self.scaled(along), period)
        if size is not None and period is not None:
            times = positive("period", period, "s")
        found = respond(Problem.of(body, motion, peak_acceleration, times, restitution, scale=scale), stop=stop)
        return over_axis(found, axis, along)

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
        restitution, stop
            As for `response`.
        period : (float, float), optional
            Window of T_p [s], 0 < low < high; by default the frequency ratios to the right edge from 0.2 to 15.

        Returns
        -------
        xarray.Dataset
            As `rocking.overturning_boundary`, where slenderness(point) is the uplift acceleration of the weaker edge
            over the peak acceleration, and frequency_ratio(point) that to p of the right edge; with
            peak_acceleration(point) [m/s2] and period(point) [s].
        """
        self._need_one("boundary", restitution)
        if PERIOD not in as_motion(motion).arguments:
            raise InvalidArgumentError("motion", motion, "a pulse; `thresholds` gives the factors of a record")
        unit = 2.0 * math.pi / float(self.right.frequency_parameter)  # period at frequency ratio 1 [s]
        problem = Problem.of(self, motion, 1.0, unit, restitution)
        return boundary(problem, period, stop)

    def history(
        self,
        motion: Motion | None = None,
        *,
        start: Scalar | None = None,
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
        motion, peak_acceleration, period, scale, restitution, stop
            As for `response`; numbers.
        start : float, optional
            In place of a motion: the rotation from which the body is released at rest [rad], in (-pi/2, pi/2), not 0,
            or a text such as "3 deg"; positive about the right edge.
        duration : float, optional
            Length [s], > 0; by default the motion and 8/p after it, of the right edge; 16/p after a release.
        samples : int, optional
            Uniform samples, 2 to 1,000,000; by default 400 under a pulse, and those of a record. The uplift, impacts
            and the end of the motion are added.
        contact : bool
            Whether to add reactions and friction demand.

        Returns
        -------
        xarray.Dataset
            time(time) [s]; rotation(time) [rad], positive about the right edge; angular_velocity(time) [rad/s], after
            the impact at an impact; edge(time): 1 right, -1 left, 0 at rest; ground_acceleration(time) and
            vertical_acceleration(time) [m/s2]; displacement(time) [m]; impact_time(impact) [s]. With `contact`
            horizontal_reaction(time), normal_reaction(time): along the base and normal to it, over the weight [-];
            friction_demand(time) [-], infinite where the body lifts off; attributes largest_friction_demand,
            smallest_normal_reaction, impulse_ratio, lifts_off, warnings.
        """
        length = None if duration is None else positive("duration", duration, "s")
        self._need_one("history", restitution, peak_acceleration=peak_acceleration, period=period, scale=scale)
        if start is not None:
            reject_given("a release", motion=motion, peak_acceleration=peak_acceleration, period=period, scale=scale)
            angle = START.number(start)
            if angle == 0.0:
                raise InvalidArgumentError("start", start, "a rotation other than 0")
            return release(self, angle, restitution, length, 400 if samples is None else samples, contact, stop)
        if motion is None:
            raise InvalidArgumentError("motion", None, "a pulse or a record, or the rotation `start`")
        problem = Problem.of(self, motion, peak_acceleration, period, restitution, scale=scale)
        return history(problem, duration=length, samples=samples, contact=contact, stop=stop)

    def scaled(self, size: Values) -> RespondingBody:
        """The body with all lengths times a factor.

        Parameters
        ----------
        size : array_like
            The factor [-], > 0.
        """
        return ScaledBody(self, in_range("size", size, 0.0, math.inf, closed="neither"))

    def _need_one(self, name: str, restitution: Scalar, **numbers: Scalar | None) -> None:
        """Refuse an array of bodies, and arrays where one number is needed."""
        if self.shape:
            raise InvalidArgumentError(name, f"bodies of shape {self.shape}", "one body")
        eta = spread_restitution(self, restitution)
        if checked_restitution(eta) is not None:
            RESTITUTION.number(eta)
        for key, value in numbers.items():
            if value is not None:
                STRENGTHS[key].number(value)


@dataclass(frozen=True, eq=False)
class ScaledBody(RespondingBody):
    """A body with all lengths multiplied by a factor; p is divided by the root of the factor."""

    body: RespondingBody  # the body of factor 1
    size: Array  # the factor [-], > 0

    @property
    def right(self) -> Edge:
        """The right edge."""
        return self._scaled(self.body.right)

    @property
    def left(self) -> Edge:
        """The left edge."""
        return self._scaled(self.body.left)

    @property
    def gravity(self) -> Array | float:
        """g [m/s2]."""
        return self.body.gravity

    @property
    def top_height(self) -> Array | float:
        """Height above the base of the point whose displacement is given [m]."""
        return self.body.top_height * self.size

    @property
    def tilt(self) -> Array:
        """Angle by which the base is inclined towards the right [rad]."""
        return self.body.tilt

    @property
    def is_linear(self) -> bool:
        """Whether the equation of motion is the linear one."""
        return self.body.is_linear

    @property
    def description(self) -> str:
        """The body in words."""
        return f"{self.body.description}, of other sizes"

    def _scaled(self, edge: Edge) -> Edge:
        return replace(edge, frequency_parameter=edge.frequency_parameter / np.sqrt(self.size))


def _respond_part(
    make: Callable[..., RespondingBody], own: tuple[str, ...], motion: Motion, error_bound: bool, **values: Any
) -> Any:
    """The response to arguments as arrays; `make` builds the body from those that belong to it."""
    body = make(**{name: values.pop(name) for name in own})
    return RespondingBody.response(body, motion, error_bound=error_bound, **values)
