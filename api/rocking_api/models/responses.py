"""Responses of the routes. Missing numbers are null: there is no peak where a block overturns."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any, TypeVar

from pydantic import BaseModel, create_model

from rocking._dimensional.fields import SHOWN
from rocking._interpolation.kernel import UNKNOWN_IMPACTS
from rocking._model import fields as own
from rocking._model.fields import COLUMN_FIELDS, ResponseField
from rocking._model.outcome import Outcome
from rocking._solver.bounded_response import BoundedResponse
from rocking_api.execution.evaluation import BatchResult
from rocking_api.http.encoding import Column, columns_as_they_are
from rocking_api.models.answer import Bare, Echoed, InGroups, ListAnswer, Q, Solved
from rocking_api.models.params import (
    HistoryParams,
    ListParams,
    LookupOptions,
    OverturningParams,
    ResponseParams,
    SpectrumParams,
)
from rocking_api.models.quantity import said

Model = TypeVar("Model", bound=BaseModel)

OUTCOMES = [outcome.name for outcome in Outcome]

_WORDS = {int(outcome): (outcome.name, outcome.sentence) for outcome in Outcome}

SOURCES = ("solver", "cube")  # by whether a response is from a data set

_OF_POINT = [field for field in own.BOUNDED_FIELDS if field is not own.FROM_CUBE]

OF_SOLVER = (own.PEAK_ROTATION, own.OVERTURNED, own.OUTCOME, own.IMPACTS, own.EXCEEDED_ALPHA)
"""Fields of each response of the solver."""

_LOOKED_UP = [
    replace(one, missing="where a data set leaves it open, method=solver counts") if one is own.IMPACTS else one
    for one in COLUMN_FIELDS
]

_DETAILS = {
    own.OUTCOME.name: f"one of {', '.join(OUTCOMES)}",
    own.EXCEEDED_ALPHA.name: "the ground can bring a block back from there",
}

_DATA = said("sha256 of the data set that answered, of several that next below the restitution; null: the solver did")


def declared(fields: Iterable[ResponseField], *, many: bool = False) -> Callable[[type[Model]], type[Model]]:
    """A decorator that adds declared fields to a model, unless it has them; lists of them if `many`."""

    def add(model: type[Model]) -> type[Model]:
        found: dict[str, Any] = {}
        for one in fields:
            text = "; ".join(filter(None, (one.description(unit=one.label_unit), _DETAILS.get(one.name))))
            kind: Any = str if one.name == "outcome" else {"f": float, "?": bool, "U": str, "i": int}[one.dtype[0]]
            kind = kind | None if one.missing else kind
            if one.label not in model.model_fields:
                found[one.label] = (list[kind] if many else kind), said(text)
        return create_model(model.__name__, __base__=model, __doc__=model.__doc__, **found)

    return add


def with_fields(*kinds: str) -> Callable[[type[Model]], type[Model]]:
    """`declared` with what is found of one body, for responses of some kinds."""
    return declared([one for one in SHOWN if one.dtype != "O" and one.kinds >= {*kinds}])


@declared(_LOOKED_UP)
class PointResponse(InGroups[ResponseParams]):
    """One block."""

    meaning: str = said("the outcome in words")
    note: str | None = said("why peak_rotation, error_bound or impacts is null", None)
    data_version: str | None = _DATA


class Columns(InGroups[Q]):
    """Many blocks, in the order of the request."""

    data_versions: list[str] = said("sha256 of each data set used")


class BatchQuery(LookupOptions):
    """What the answer repeats of a batch."""

    points: int = said("number of points [-]")


@declared(_LOOKED_UP, many=True)
class BatchResponse(Echoed[BatchQuery], Columns[BatchQuery]):
    """A batch."""


@declared(_LOOKED_UP, many=True)
class SpectrumResponse(Echoed[SpectrumParams], Columns[SpectrumParams]):
    """A spectrum."""

    frequency_ratio: list[float] = said("omega_g/p [-]")


class Curve(BaseModel):
    """One boundary curve."""

    outcome: str = said("outcome on the side where the block overturns")
    impacts: int = said("impacts before it overturns there; -1: more than 12, or not counted [-]")
    slenderness: list[float] = said("1/a [-]")
    frequency_ratio: list[float] = said("omega_g/p [-]")


class OverturningResponse(Echoed[OverturningParams], InGroups[OverturningParams]):
    """The boundary curves of a pulse and a restitution."""

    curves: list[Curve] = said("boundary curves")
    source: str = said("dataset (read) or solver (traced for this request)")
    data_version: str | None = _DATA


class ContactResponse(BaseModel):
    """Reactions of the ground during a motion; of a block that overturns, until it passes alpha for the last time."""

    horizontal_reaction: list[float] = said("H/(m g) at the pivot [-]; 0 in the slender limit")
    normal_reaction: list[float] = said("N/(m g) [-]; 0 and below: the block lifts off")
    friction_demand: list[float | None] = said("|H|/N [-]; null where N <= 0; 0 in the slender limit")
    friction_demand_over_slope: list[float | None] | None = said(
        "|H|/(N tan alpha) [-]; null where N <= 0, and without one alpha", None
    )
    largest_friction_demand: float | None = said("largest |H|/N, also between the samples [-]; null if it lifts off")
    largest_friction_demand_over_slope: float | None = said("the same over tan alpha [-]", None)
    smallest_normal_reaction: float = said("smallest N/(m g), also between the samples [-]; 0 and below: it lifts off")
    impulse_ratio: float | None = said("horizontal over vertical impulse at impacts [-]; 0 without; null: infinite")
    lifts_off: bool = said("whether the block leaves the ground")
    warnings: str = said("where the assumption of pure rocking is doubtful, in words")


class Motion(BaseModel):
    """A motion: outcome and samples, over time in seconds or in p t."""

    rotation: list[float] = said("theta/alpha [-]")
    angular_velocity: list[float] = said("d(theta/alpha)/d tau, tau = p t [-]")
    ground_acceleration: list[float] = said("u_g/(g tan alpha) [-]; under a pulse a f")
    contact: ContactResponse | None = said("null unless requested", None)


@declared(OF_SOLVER[:-1])
class HistoryResponse(Echoed[HistoryParams], Motion, Solved[HistoryParams]):
    """A motion under a pulse."""

    tau: list[float] = said("time p t from the start of the pulse [-]")
    impact_time: list[float] = said("times p t of the impacts [-]")


class Link(BaseModel):
    """A link, as in a STAC item."""

    rel: str = said("self: the description; data: the file; version: this version of it; subset; zarr")
    href: str = said("path on this service")
    type: str = said("media type")


class DatasetSummary(BaseModel):
    """An entry of the catalogue."""

    name: str = said("name: the path below the results folder, without suffix")
    title: str = said("title")
    pulse: str | None = said("pulse, see /v1/pulses; null: several or none")
    restitution: float | None = said("coefficient of restitution eta [-]; null: several or none")
    extent: dict[str, tuple[float, float]] = said("ends of alpha [rad], slenderness [-] and frequency_ratio [-]")
    size: int = said("size of the netCDF file [byte]")
    sha256: str = said("sha256 of the netCDF file")
    metadata: str = said("path of its description")
    netcdf: str = said("path of the file, for a download or xarray over HTTP (Range)")
    version_url: str = said("path of this version of the file; immutable")
    zarr: str = said("path for xarray.open_zarr(...)")
    links: list[Link] = said("the same paths with relation and media type")


class PulseCubes(BaseModel):
    """The spectrum cubes of one pulse, which are also one zarr store."""

    name: str = said("folder of the cubes, and name of the store")
    restitution: list[float] = said("coefficients of restitution of the cubes, ascending [-]")
    zarr: str = said("path for xarray.open_zarr(...), over the dimension restitution too")


class DatasetCatalogue(ListAnswer[ListParams]):
    """Data sets."""

    datasets: list[DatasetSummary] = said("in the order of their names")
    pulses: list[PulseCubes] = said("the spectrum cubes of these by pulse, in the order of their names")


class VariableDescription(BaseModel):
    """A variable of a data set."""

    dimensions: list[str] = said("names of its dimensions, in order")
    shape: list[int] = said("its size along each of them [-]")
    dtype: str = said("type of its values")
    attributes: dict[str, Any] = said("CF attributes: units, long_name, equation and others")


class DatasetDescription(DatasetSummary, Bare):
    """Contents of a data set."""

    dimensions: dict[str, int] = said("size of each dimension [-]")
    coordinates: dict[str, VariableDescription] = said("coordinates by name")
    variables: dict[str, VariableDescription] = said("variables by name")
    attributes: dict[str, Any] = said("CF and ACDD attributes, digests of code and settings")


class Health(Bare):
    """State of the service."""

    status: str = said("ok, or degraded: data sets are missing or damaged, and the solver replaces them")
    datasets: int = said("data sets found [-]")
    unchecked: int = said("number of data sets not yet checked; retry in a moment [-]", 0)
    problems: dict[str, str] = said("what is missing or damaged, by name")


def columns_of(result: BatchResult) -> dict[str, Column]:
    """The fields of `Columns` with one value for each point."""
    codes, impacts, from_cube = result.fields[own.OUTCOME.name], result.fields[own.IMPACTS.name], result.from_cube
    columns = columns_as_they_are(result.fields) | {
        own.OVERTURNED.name: lambda part: (codes[part] >= Outcome.OVERTURNED_DIRECTLY).tolist(),
        own.OUTCOME.name: lambda part: [OUTCOMES[code] for code in codes[part].tolist()],
        own.IMPACTS.name: lambda part: [None if one == UNKNOWN_IMPACTS else one for one in impacts[part].tolist()],
        own.SOURCE.name: lambda part: [SOURCES[one] for one in from_cube[part].tolist()],
    }
    return {field.name: columns[field.name] for field in COLUMN_FIELDS}


def point_response(params: ResponseParams, found: BoundedResponse, versions: tuple[str, ...]) -> PointResponse:
    """The response for one block."""
    fields: dict[str, Any] = {one.name: getattr(found, one.name).item() for one in _OF_POINT}
    fields |= {name: values.item() for name, values in found.derived.items()}
    outcome, from_cube = fields["outcome"], found.from_cube.item()
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
    return PointResponse(query=params, warnings=warnings, note=note, data_version=version, **fields)
