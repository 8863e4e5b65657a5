"""Responses of the routes. Missing numbers are null: there is no peak where a block overturns."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from pydantic import BaseModel

from rocking._dimensional.response import BodyResponse
from rocking._interpolation.kernel import UNKNOWN_IMPACTS
from rocking._model import fields as own
from rocking._model.fields import COLUMN_FIELDS
from rocking._model.outcome import Outcome
from rocking._solver.bounded_response import BoundedResponse
from rocking_api.execution.evaluation import BatchResult
from rocking_api.http.encoding import Column, columns_as_they_are
from rocking_api.models.answer import Bare, InGroups, ListAnswer, Solved
from rocking_api.models.fields import OUTCOMES, LookedUp, ManyLookedUp, Peaked
from rocking_api.models.params import (
    HistoryParams,
    ListParams,
    LookupOptions,
    OverturningParams,
    ResponseParams,
    SpectrumParams,
)
from rocking_api.models.quantity import said

SOURCES = ("solver", "cube")  # by whether a response is from a data set

_WORDS = {int(outcome): (outcome.name, outcome.sentence) for outcome in Outcome}

_OF_POINT = [field for field in (*own.BOUNDED_FIELDS, *own.DERIVED_FIELDS) if field is not own.FROM_CUBE]

_DATA = said("sha256 of the data set that answered, of several that next below the restitution; null: the solver did")


class PointResponse(LookedUp, InGroups[ResponseParams]):
    """One block."""

    meaning: str = said("the outcome in words")
    note: str | None = said("why peak_rotation, error_bound or impacts is null", None)
    data_version: str | None = _DATA


class BatchQuery(LookupOptions):
    """What the answer repeats of a batch."""

    points: int = said("number of points", unit="-")
    pulse_digest: str | None = said("sha256 of the samples of the pulse; null for a pulse by its name", None)


class BatchResponse(ManyLookedUp, InGroups[BatchQuery]):
    """Many blocks, in the order of the request."""

    data_versions: list[str] = said("sha256 of each data set used")


class SpectrumResponse(ManyLookedUp, InGroups[SpectrumParams]):
    """A spectrum."""

    frequency_ratio: list[float] = said("omega_g/p", unit="-")
    data_versions: list[str] = said("sha256 of each data set used")


class Curve(BaseModel):
    """One boundary curve."""

    outcome: str = said("outcome on the side where the block overturns")
    impacts: int = said("impacts before it overturns there; -1: more than 12, or not counted", unit="-")
    slenderness: list[float] = said("1/a", unit="-")
    frequency_ratio: list[float] = said("omega_g/p", unit="-")


class OverturningResponse(InGroups[OverturningParams]):
    """The boundary curves of a pulse and a restitution."""

    curves: list[Curve] = said("boundary curves")
    source: str = said("dataset (read) or solver (traced for this request)")
    data_version: str | None = _DATA


class ContactResponse(BaseModel):
    """Reactions of the ground during a motion; of a block that overturns, until it passes alpha for the last time."""

    horizontal_reaction: list[float] = said("H/(m g) at the pivot; 0 in the slender limit", unit="-")
    normal_reaction: list[float] = said("N/(m g); 0 and below: the block lifts off", unit="-")
    friction_demand: list[float | None] = said("|H|/N; null where N <= 0; 0 in the slender limit", unit="-")
    friction_demand_over_slope: list[float | None] | None = said(
        "|H|/(N tan alpha); null where N <= 0, and without one alpha", None, unit="-"
    )
    largest_friction_demand: float | None = said(
        "largest |H|/N, also between the samples; null if it lifts off", unit="-"
    )
    largest_friction_demand_over_slope: float | None = said("the same over tan alpha", None, unit="-")
    smallest_normal_reaction: float = said(
        "smallest N/(m g), also between the samples; 0 and below: it lifts off", unit="-"
    )
    impulse_ratio: float | None = said(
        "horizontal over vertical impulse at impacts; 0 without; null: infinite", unit="-"
    )
    horizontal_force: list[float] | None = said("H; null unless the mass is stated", None, unit="N")
    normal_force: list[float] | None = said("N; null unless the mass is stated", None, unit="N")
    lifts_off: bool = said("whether the block leaves the ground")
    warnings: str = said("where the assumption of pure rocking is doubtful, in words")


class Motion(BaseModel):
    """A motion: outcome and samples, over time in seconds or in p t."""

    rotation: list[float] = said("theta/alpha", unit="-")
    angular_velocity: list[float] = said("d(theta/alpha)/d tau, tau = p t", unit="-")
    ground_acceleration: list[float] = said("u_g/(g tan alpha); under a pulse a f", unit="-")
    contact: ContactResponse | None = said("null unless requested", None)


class HistoryResponse(Motion, Peaked, Solved[HistoryParams]):
    """A motion under a pulse."""

    tau: list[float] = said("time p t from the start of the pulse", unit="-")
    impact_time: list[float] = said("times p t of the impacts", unit="-")


class Link(BaseModel):
    """A link, as in a STAC item."""

    rel: str = said("self: the description; data: the file; subset: a part of it")
    href: str = said("path on this service")
    type: str = said("media type")


class Extent(BaseModel):
    """Ends of the axes of a data set."""

    alpha: tuple[float, float] | None = said("slenderness angle", None, unit="rad")
    slenderness: tuple[float, float] | None = said("g tan(alpha)/a_g", None, unit="-")
    frequency_ratio: tuple[float, float] | None = said("omega_g/p", None, unit="-")


class DatasetSummary(BaseModel):
    """An entry of the catalogue."""

    name: str = said("name: the path below the results folder, without suffix")
    title: str = said("title")
    pulse: str | None = said("pulse, see /v1/pulses; null: several or none")
    restitution: float | None = said("coefficient of restitution eta; null: several or none", unit="-")
    extent: Extent = said("ends of the axes; null: it has no such axis")
    size: int = said("size of the netCDF file", unit="byte")
    sha256: str | None = said("sha256 of the netCDF file; null: it was not read yet, ask again in a moment")
    metadata: str = said("path of its description")
    netcdf: str = said("path of the file, for a download or xarray over HTTP (Range)")
    links: list[Link] = said("the same paths with relation and media type")


class PulseStore(BaseModel):
    """The spectrum cubes of one pulse as one zarr store."""

    name: str = said("pulse")
    zarr: str = said("path for xarray.open_zarr(...), over the dimension restitution too")


class DatasetCatalogue(ListAnswer[ListParams]):
    """Data sets."""

    datasets: list[DatasetSummary] = said("in the order of their names")
    pulses: list[PulseStore] = said("zarr stores of the spectrum cubes, one a pulse")


class VariableDescription(BaseModel):
    """A variable of a data set."""

    dimensions: list[str] = said("names of its dimensions, in order")
    shape: list[int] = said("its size along each of them", unit="-")
    dtype: str = said("type of its values")
    attributes: dict[str, Any] = said("CF attributes: units, long_name, equation and others")


class DatasetDescription(DatasetSummary, Bare):
    """Contents of a data set."""

    dimensions: dict[str, int] = said("size of each dimension", unit="-")
    coordinates: dict[str, VariableDescription] = said("coordinates by name")
    variables: dict[str, VariableDescription] = said("variables by name")
    attributes: dict[str, Any] = said("CF and ACDD attributes, digests of code and settings")


class Health(Bare):
    """State of the service."""

    status: str = said("ok, or degraded: data sets are missing or damaged, and the solver replaces them")
    datasets: int = said("data sets found", unit="-")
    unchecked: int = said("number of data sets not yet checked; retry in a moment", 0, unit="-")
    problems: dict[str, str] = said("what is missing or damaged, by name")


def columns_of(result: BatchResult) -> dict[str, Column]:
    """The fields of `ManyLookedUp`, a value for each point."""
    codes, impacts, from_cube = result.fields[own.OUTCOME.name], result.fields[own.IMPACTS.name], result.from_cube
    columns = columns_as_they_are(result.fields) | {
        own.OVERTURNED.name: lambda part: (codes[part] >= Outcome.OVERTURNED_DIRECTLY).tolist(),
        own.OUTCOME.name: lambda part: [OUTCOMES[code] for code in codes[part].tolist()],
        own.IMPACTS.name: lambda part: [None if one == UNKNOWN_IMPACTS else one for one in impacts[part].tolist()],
        own.SOURCE.name: lambda part: [SOURCES[one] for one in from_cube[part].tolist()],
    }
    return {field.name: columns[field.name] for field in COLUMN_FIELDS}


def point_response(
    params: ResponseParams, found: BoundedResponse | BodyResponse, from_cube: bool, versions: tuple[str, ...], url: str
) -> PointResponse:
    """The response for one block."""
    fields: dict[str, Any] = {one.name: np.asarray(getattr(found, one.name)).item() for one in _OF_POINT}
    outcome = fields["outcome"]
    note, warnings = None, []
    if outcome >= Outcome.OVERTURNED_DIRECTLY:
        note = "the block overturns: there is no peak"
    elif math.isinf(fields["error_bound"]):
        note = "the outcome changes within the rounding of the inputs: there is no bound"
        warnings = [note]
    elif fields["impacts"] == UNKNOWN_IMPACTS:
        note = "the data set does not determine the number of impacts: method=solver counts them"
    for name, value in fields.items():
        if value == UNKNOWN_IMPACTS if name == "impacts" else not math.isfinite(value):
            fields[name] = None
    fields["outcome"], fields["meaning"] = _WORDS[outcome]
    fields["overturned"], fields["source"] = outcome >= Outcome.OVERTURNED_DIRECTLY, SOURCES[from_cube]
    version = versions[0] if versions and from_cube else None
    return PointResponse(query=params, url=url, warnings=warnings, note=note, data_version=version, **fields)
