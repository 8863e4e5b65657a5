"""Responses of bodies with two edges in SI units: rotations about both edges, outcome in words, margins, warnings."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from html import escape
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rocking._base.equality import EqualByValue
from rocking._base.errors import InvalidArgumentError
from rocking._dimensional.body_problem import BodyProblem
from rocking._dimensional.response import DISPLACEMENT, ROTATION, count_of_impacts, described_peak
from rocking._dimensional.threshold import Threshold, warnings_of_changes
from rocking._dimensional.thresholds import BodyThresholds, thresholds_of
from rocking._excitation.records.record import Record
from rocking._history.contact import ContactExtremes, contact_extremes
from rocking._model.fields import (
    EXCEEDED_ALPHA,
    IMPACTS,
    OUTCOME,
    OVERTURNED,
    PEAK_ROTATION,
    UPLIFT_TIME,
    ResponseField,
)
from rocking._model.labelled import with_index
from rocking._model.outcome import Outcome
from rocking._model.response import along_own_axes, axis_names
from rocking._numba.cancellation import StopFlag

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

Array = NDArray[np.float64]

BODY_FIELDS = (
    ROTATION,
    replace(ROTATION, name="rotation_left", meaning="peak rotation about the left edge"),
    replace(ROTATION, name="rotation_right", meaning="peak rotation about the right edge"),
    DISPLACEMENT,
    OVERTURNED,
    OUTCOME,
    ResponseField(
        "edge",
        "i1",
        "1",
        "2.2",
        "edge of the largest rotation over alpha, or of overturning: 1 right, -1 left, 0 without uplift",
    ),
    IMPACTS,
    EXCEEDED_ALPHA,
    replace(PEAK_ROTATION, meaning="peak of |theta|/alpha, of the larger of both edges"),
    replace(UPLIFT_TIME, unit="s", meaning="time of the first uplift"),
)
"""Fields of `BodyResponse`, in order; units as CF writes them."""


@dataclass(frozen=True, eq=False, repr=False)
class BodyResponse(EqualByValue):
    """What happens to bodies under a ground motion; every field is an array of the broadcast shape, () for one body.

    Attributes
    ----------
    rotation, rotation_left, rotation_right : float64 array [rad]
        Peak rotation, and about each edge; nan where the body overturns.
    displacement : float64 array [m]
        Largest horizontal displacement of the top; nan where the body overturns.
    outcome : int8 array
        A code of `rocking.Outcome`.
    edge : int8 array
        Edge of the largest |theta|/alpha, or about which the body overturns: 1 right, -1 left; 0 without uplift.
    impacts : int32 array
        Impacts until the outcome is certain, as of `rocking.Response`.
    exceeded_alpha : bool array
        Whether the body passed the equilibrium on an edge at some time.
    peak_rotation : float64 array [-]
        Largest |theta|/alpha, alpha of the edge; nan where the body overturns.
    uplift_time : float64 array [s]
        From the start of the motion; nan where there is no uplift.
    problem : BodyProblem
        Bodies and ground motion.
    arguments : mapping of str to array
        The arguments before broadcasting, for the coordinates of `to_xarray`.
    stop : StopFlag or None
        Cancels also what is found later: thresholds, contact forces and warnings.
    """

    rotation: Array
    rotation_left: Array
    rotation_right: Array
    displacement: Array
    outcome: NDArray[np.int8]
    edge: NDArray[np.int8]
    impacts: NDArray[np.int32]
    exceeded_alpha: NDArray[np.bool_]
    peak_rotation: Array
    uplift_time: Array
    problem: BodyProblem = field(compare=False)
    arguments: Mapping[str, Array] = field(default_factory=dict)
    stop: StopFlag | None = field(default=None, compare=False)

    @property
    def overturned(self) -> NDArray[np.bool_]:
        """Whether the body overturns in the end."""
        return np.asarray(self.outcome >= Outcome.OVERTURNED_DIRECTLY)

    @property
    def shape(self) -> tuple[int, ...]:
        """The broadcast shape of bodies and arguments."""
        return self.outcome.shape

    @cached_property
    def thresholds(self) -> BodyThresholds:
        """Peak accelerations [m/s2], or factors of the record, at which the outcome changes, for each body."""
        return thresholds_of(self.problem, stop=self.stop)

    @cached_property
    def contact(self) -> ContactExtremes:
        """Extremes of the contact forces during the motion of one body.

        Raises
        ------
        InvalidArgumentError
            If there are several bodies or motions.
        """
        self._need_one("contact")
        found = contact_extremes(self.problem.body_motion(stop=self.stop))
        return found if np.isfinite(found.smallest_normal_reaction) else found.without_forces()

    @property
    def sentence(self) -> str:
        """The outcome for one body in words; the same errors as `contact`."""
        return self.contact.sentence

    @property
    def margin(self) -> str:
        """From which peak acceleration or factor one body overturns, in words; the same errors as `contact`."""
        self._need_one("margin")
        return self.thresholds.sentence

    @property
    def warnings(self) -> list[str]:
        """Where the response of one body is in doubt; the same errors as `contact`."""
        self._need_one("warnings")
        return self._warnings(self.thresholds)

    def _warnings(self, changes: Iterable[Threshold]) -> list[str]:
        problem, texts = self.problem, list(self.contact.warnings)
        edges = {"right": problem.body.right, "left": problem.body.left}
        if problem.restitution is None and self.outcome != Outcome.NO_UPLIFT:
            texts += [
                f"the restitution of impacts that leave the {name} edge is negative ({float(edge.restitution):.3g}): "
                "the body stops at them, eta = 0; give a number for another restitution"
                for name, edge in edges.items()
                if edge.restitution < 0.0
            ]
        if math.isnan(float(edges["right"].inertia_ratio)):
            texts.append("the contact forces of this body are not known: sliding is not assessed")
        given, name, unit = float(problem.acceleration), "peak acceleration", " m/s2"
        if isinstance(problem.motion, Record):
            given, name, unit = given / problem.motion.peak_acceleration, "scale", ""
            texts += problem.motion.remarks
        return [*texts, *warnings_of_changes(given, changes, name, unit)]

    def summary(self, *, thresholds: bool = True) -> dict[str, Any]:
        """The response of one body as numbers, flags and texts, None in place of nan and infinity.

        Parameters
        ----------
        thresholds : bool
            Whether to search the strengths at which the outcome changes, for the margin and the warnings.

        Raises
        ------
        InvalidArgumentError
            As for `contact`.
        """
        contact, body = self.contact, self.problem.body
        values = {
            "meaning": self.sentence,
            "margin": self.margin if thresholds else None,
            "outcome": Outcome(int(self.outcome)).name,
            "overturned": bool(self.overturned),
            "rocking_model_applies": contact.rocking_applies,
            "edge": {1: "right", -1: "left"}.get(int(self.edge)),
            "peak_rotation_deg": math.degrees(self.rotation),
            "rotation_left_deg": math.degrees(self.rotation_left),
            "rotation_right_deg": math.degrees(self.rotation_right),
            "top_displacement": float(self.displacement),
            "peak_rotation": float(self.peak_rotation),
            "exceeded_alpha": bool(self.exceeded_alpha),
            "impacts": int(self.impacts),
            "uplift_time": float(self.uplift_time),
            "uplift_acceleration": float(body.uplift_acceleration),
            "alpha_left_deg": math.degrees(body.left.alpha),
            "alpha_right_deg": math.degrees(body.right.alpha),
            "friction_demand": contact.largest_friction_demand,
            "lifts_off": contact.lifts_off,
            "warnings": self._warnings(self.thresholds if thresholds else ()),
        }
        return {
            name: None if isinstance(value, float) and not math.isfinite(value) else value
            for name, value in values.items()
        }

    def to_xarray(self) -> xr.Dataset:
        """The response as a labelled data set, with units and meanings; arguments that vary are coordinates."""
        import xarray as xr  # noqa: PLC0415  # takes longer to load than the solver

        names = axis_names(len(self.shape), self.arguments, ())
        variables: dict[str, Any] = {one.name: one.variable(names, getattr(self, one.name)) for one in BODY_FIELDS}
        coordinates: dict[str, Any] = {
            name: (*along_own_axes(value, names), {"units": _UNITS.get(name, "1")})
            for name, value in self.arguments.items()
        }
        found = xr.Dataset(variables, coordinates, {"motion": self.problem.motion.name})
        return with_index(found, names[-1], self.problem.index) if names else found

    def to_pandas(self) -> pd.DataFrame:
        """The fields as columns, one row for each body; the index has the axes of `to_xarray`."""
        labelled = self.to_xarray()
        return (labelled if labelled.dims else labelled.expand_dims("body")).to_dataframe()

    def __repr__(self) -> str:
        """What happened, in words and SI units."""
        under = f"under {self.problem.motion.name or 'a record'}"
        if self.shape:
            counts = np.bincount(self.outcome.ravel(), minlength=len(Outcome))
            parts = [f"{count} {one.plural}" for one, count in zip(Outcome, counts.tolist(), strict=True) if count]
            shape = " x ".join(map(str, self.shape))
            return f"<rocking.BodyResponse {under} of {shape} bodies: {', '.join(parts)}>"
        outcome = Outcome(int(self.outcome))
        happened = outcome.sentence
        edge = "right" if self.edge > 0 else "left"
        if outcome == Outcome.SAFE:
            peak = described_peak(float(self.rotation), float(self.displacement))
            happened += f": {peak}, {count_of_impacts(int(self.impacts))}"
        elif outcome != Outcome.NO_UPLIFT:
            happened += f" about the {edge} edge"
        strength = f"{float(self.problem.acceleration):.4g} m/s2"
        return f"<rocking.BodyResponse: {happened}; {self.problem.body.description} {under} of {strength}>"

    def _repr_html_(self) -> str:
        return f"<p>{escape(repr(self))}</p>{self.to_xarray()._repr_html_()}"

    def _need_one(self, name: str) -> None:
        if self.shape:
            raise InvalidArgumentError(name, f"shape {self.shape}", "a response of one body under one motion")


_UNITS = {
    "peak_acceleration": "m s-2",
    "period": "s",
    "left": "m",
    "right": "m",
    "height": "m",
    "gyration": "m",
    "gravity": "m s-2",
    "top_height": "m",
    "inclination": "rad",
}
"""Units of the arguments; the others are numbers."""


def respond_bodies(
    problem: BodyProblem,
    arguments: Mapping[str, Array] = MappingProxyType({}),
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> BodyResponse:
    """The responses of bodies by the solver; errors as for `RespondingBody.response`."""
    records, edges = problem.solve(threads, stop)
    body, shape = problem.body, problem.shape
    alphas = np.stack([np.broadcast_to(edge.alpha, shape).ravel() for edge in (body.right, body.left)], axis=1)
    angles = edges[:, :2] * alphas[:, :1]  # z has the scale of the right edge
    overturned = records["outcome"] >= Outcome.OVERTURNED_DIRECTLY
    over_alpha = angles / alphas
    larger = np.where(over_alpha[:, 0] >= over_alpha[:, 1], 1, -1)
    larger[records["outcome"] == Outcome.NO_UPLIFT] = 0
    rotation = angles.max(axis=1).reshape(shape)
    p = np.broadcast_to(body.right.frequency_parameter, shape).ravel()
    return BodyResponse(
        rotation=rotation,
        rotation_left=angles[:, 1].reshape(shape),
        rotation_right=angles[:, 0].reshape(shape),
        displacement=np.asarray(body.top_height * np.sin(rotation)),
        outcome=records["outcome"].reshape(shape),
        edge=np.where(overturned, edges[:, 3], larger).astype(np.int8).reshape(shape),
        impacts=records["impacts"].reshape(shape),
        exceeded_alpha=records["exceeded_alpha"].reshape(shape),
        peak_rotation=records["peak_rotation"].reshape(shape),
        uplift_time=(records["uplift_time"] / p).reshape(shape),
        problem=problem,
        arguments={name: value for name, value in (body.parameters | dict(arguments)).items() if value.size},
        stop=stop,
    )
