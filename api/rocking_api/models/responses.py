"""Responses of the routes. Missing numbers are null: there is no peak where a block overturns."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Annotated, Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, Field, SerializeAsAny, create_model

from rocking._dimensional.fields import SHOWN
from rocking._interpolation.kernel import UNKNOWN_IMPACTS
from rocking._model.fields import (
    BOUNDED_FIELDS,
    COLUMN_FIELDS,
    DERIVED_FIELDS,
    ERROR_BOUND,
    EXCEEDED_ALPHA,
    FROM_CUBE,
    IMPACTS,
    OUTCOME,
    OVERTURNED,
    PEAK_ROTATION,
    SOURCE,
    ResponseField,
)
from rocking._model.response import Outcome
from rocking._solver.bounded_response import BoundedResponse
from rocking_api.execution.evaluation import BatchResult
from rocking_api.http.encoding import Column
from rocking_api.models.answer import ECHO, QUERY, Answer, ListAnswer
from rocking_api.models.metadata import METADATA_URL_FIELD
from rocking_api.models.params import HistoryParams, LookupOptions, OverturningParams, ResponseParams, SpectrumParams

Model = TypeVar("Model", bound=BaseModel)

OUTCOMES = [outcome.name for outcome in Outcome]

_WORDS = {int(outcome): (outcome.name, outcome.sentence) for outcome in Outcome}

_OF_POINT = [field for field in BOUNDED_FIELDS if field is not FROM_CUBE]

_PEAK = Field(description=PEAK_ROTATION.description())
_OVERTURNED = Field(description=OVERTURNED.description())
_OUTCOME = Field(description=f"{OUTCOME.description()}, one of {', '.join(OUTCOMES)}")
_IMPACTS = Field(description=IMPACTS.description())
_CERTAIN_IMPACTS = Field(
    description=f"{IMPACTS.description()}; null where a data set leaves it open: method=solver counts"
)
_EXCEEDED = Field(description=f"{EXCEEDED_ALPHA.description()}; the ground can bring a block back from there")
_BOUND = Field(description=ERROR_BOUND.description())
_SOURCE = Field(description=SOURCE.description())


BY_SOLVER = Field("solver", description="what answered: always the solver")
_DATA = Field(
    description="sha256 of the data set that answered, of that next below the restitution if several did; null if the "
    "solver did"
)


def with_derived_fields(kind: Any) -> Callable[[type[Model]], type[Model]]:
    """A decorator that adds the derived fields, each of the type `kind`, to a model."""
    fields: dict[str, Any] = {field.name: (kind, Field(description=field.description())) for field in DERIVED_FIELDS}
    return lambda model: create_model(model.__name__, __base__=model, __doc__=model.__doc__, **fields)


def with_fields(*kinds: str) -> Callable[[type[Model]], type[Model]]:
    """A decorator that adds what is found of one body, for responses of some kinds, unless the model declares it."""
    declared = [one for one in SHOWN if one.dtype != "O" and one.kinds >= {*kinds}]

    def add(model: type[Model]) -> type[Model]:
        fields: dict[str, Any] = {
            one.label: (_type_of(one), Field(description=one.description(unit=one.label_unit)))
            for one in declared
            if one.label not in model.model_fields
        }
        return create_model(model.__name__, __base__=model, __doc__=model.__doc__, **fields)

    return add


def _type_of(field: ResponseField) -> Any:
    """The type in JSON of the values of a field for one body."""
    if field is OUTCOME:
        return str
    kind: Any = {"f": float, "?": bool, "U": str, "i": int}[field.dtype[0]]
    return kind | None if field.missing else kind


@with_derived_fields(float | None)
class PointResponse(Answer):
    """One block."""

    query: ResponseParams = QUERY
    peak_rotation: float | None = _PEAK
    overturned: bool = _OVERTURNED
    outcome: str = _OUTCOME
    meaning: str = Field(description="the outcome in words")
    impacts: int | None = _CERTAIN_IMPACTS
    exceeded_alpha: bool = _EXCEEDED
    error_bound: float | None = _BOUND
    note: str | None = Field(None, description="why peak_rotation, error_bound or impacts is null")
    source: str = _SOURCE
    data_version: str | None = _DATA
    metadata_url: str = METADATA_URL_FIELD


@with_derived_fields(list[float | None])
class Columns(Answer):
    """Many blocks, in the order of the request."""

    peak_rotation: list[float | None] = _PEAK
    overturned: list[bool] = _OVERTURNED
    outcome: list[str] = _OUTCOME
    impacts: list[int | None] = _CERTAIN_IMPACTS
    exceeded_alpha: list[bool] = _EXCEEDED
    error_bound: list[float | None] = _BOUND
    source: list[str] = _SOURCE
    data_versions: list[str] = Field(description="sha256 of each data set used")
    metadata_url: str = METADATA_URL_FIELD


class BatchQuery(LookupOptions):
    """What the answer repeats of a batch."""

    points: int = Field(description="number of points [-]")


class BatchResponse(Columns):
    """A batch."""

    query: Annotated[SerializeAsAny[BatchQuery], ECHO] = Field(
        description="options of the request, and its number of points"
    )


class SpectrumResponse(Columns):
    """A spectrum."""

    query: Annotated[SerializeAsAny[SpectrumParams], ECHO] = QUERY
    frequency_ratio: list[float] = Field(description="omega_g/p [-]")


class Curve(BaseModel):
    """One boundary curve."""

    outcome: str = Field(description="outcome on the side where the block overturns")
    impacts: int = Field(description="impacts before it overturns there; -1: more than 12, or not counted [-]")
    slenderness: list[float] = Field(description="1/a [-]")
    frequency_ratio: list[float] = Field(description="omega_g/p [-]")


class OverturningResponse(Answer):
    """The boundary curves of a pulse and a restitution."""

    query: Annotated[SerializeAsAny[OverturningParams], ECHO] = QUERY
    curves: list[Curve] = Field(description="boundary curves")
    source: str = Field(description="dataset (read) or solver (traced for this request)")
    data_version: str | None = _DATA
    metadata_url: str = METADATA_URL_FIELD


class ContactResponse(BaseModel):
    """Reactions of the ground during a motion; of a block that overturns, until it passes alpha for the last time."""

    horizontal_reaction: list[float] = Field(description="H/(m g) at the pivot [-]; 0 in the slender limit")
    normal_reaction: list[float] = Field(description="N/(m g) [-]; 0 and below: the block lifts off")
    friction_demand: list[float | None] = Field(description="|H|/N [-]; null where N <= 0; 0 in the slender limit")
    friction_demand_over_slope: list[float | None] = Field(description="|H|/(N tan alpha) [-]; null where N <= 0")
    largest_friction_demand: float | None = Field(description="also between the samples [-]; null if it lifts off")
    largest_friction_demand_over_slope: float | None = Field(description="the same over tan alpha [-]")
    smallest_normal_reaction: float = Field(description="over the weight [-]; 0 and below: it lifts off")
    impulse_ratio: float | None = Field(
        description="horizontal over vertical impulse at its impacts [-]; 0 without impacts; null: infinite"
    )
    lifts_off: bool = Field(description="whether the block leaves the ground")
    warnings: str = Field(description="where the assumption of pure rocking is doubtful, in words")


class Motion(Answer):
    """A motion: outcome and samples, whatever its variable of time is."""

    overturned: bool = _OVERTURNED
    outcome: str = _OUTCOME
    peak_rotation: float | None = _PEAK
    impacts: int = _IMPACTS
    rotation: list[float] = Field(description="theta/alpha [-]")
    angular_velocity: list[float] = Field(description="d(theta/alpha)/d tau, tau = p t [-]")
    ground_acceleration: list[float] = Field(description="u_g/(g tan alpha) [-]; under a pulse a f")
    contact: ContactResponse | None = Field(None, description="null unless requested")
    source: str = BY_SOLVER


class HistoryResponse(Motion):
    """A motion under a pulse."""

    query: Annotated[SerializeAsAny[HistoryParams], ECHO] = QUERY
    tau: list[float] = Field(description="time p t from the start of the pulse [-]")
    impact_time: list[float] = Field(description="times p t of the impacts [-]")
    metadata_url: str = METADATA_URL_FIELD


class Link(BaseModel):
    """A link, as in a STAC item."""

    rel: str = Field(description="self: the description; data: the file; version: this version of it; subset; zarr")
    href: str = Field(description="path on this service")
    type: str = Field(description="media type")


class DatasetSummary(BaseModel):
    """An entry of the catalogue."""

    name: str = Field(description="name: the path below the results folder, without suffix")
    title: str = Field(description="title")
    pulse: str | None = Field(description="pulse, see /v1/pulses; null: several or none")
    restitution: float | None = Field(description="coefficient of restitution eta [-]; null: several or none")
    extent: dict[str, tuple[float, float]] = Field(
        description="smallest and largest alpha [rad], slenderness [-] and frequency_ratio [-]"
    )
    size: int = Field(description="size of the netCDF file [byte]")
    sha256: str = Field(description="sha256 of the netCDF file")
    metadata: str = Field(description="path of its description")
    netcdf: str = Field(description="path of the file, for a download or xarray over HTTP (Range)")
    version_url: str = Field(description="path of this version of the file; immutable")
    zarr: str = Field(description="path for xarray.open_zarr(...)")
    links: list[Link] = Field(description="the same paths with relation and media type")


class PulseCubes(BaseModel):
    """The spectrum cubes of one pulse, which are also one zarr store."""

    name: str = Field(description="folder of the cubes, and name of the store")
    restitution: list[float] = Field(description="coefficients of restitution of the cubes, ascending [-]")
    zarr: str = Field(description="path for xarray.open_zarr(...), over the dimension restitution too")


class DatasetCatalogue(ListAnswer):
    """Data sets."""

    datasets: list[DatasetSummary] = Field(description="in the order of their names")
    pulses: list[PulseCubes] = Field(description="the spectrum cubes of these by pulse, in the order of their names")


class VariableDescription(BaseModel):
    """A variable of a data set."""

    dimensions: list[str] = Field(description="names of its dimensions, in order")
    shape: list[int] = Field(description="its size along each of them [-]")
    dtype: str = Field(description="type of its values")
    attributes: dict[str, Any] = Field(description="CF attributes: units, long_name, equation and others")


class DatasetDescription(DatasetSummary, Answer):
    """Contents of a data set."""

    dimensions: dict[str, int] = Field(description="size of each dimension [-]")
    coordinates: dict[str, VariableDescription] = Field(description="coordinates by name")
    variables: dict[str, VariableDescription] = Field(description="variables by name")
    attributes: dict[str, Any] = Field(description="CF and ACDD attributes, digests of code and settings")


class Health(Answer):
    """State of the service."""

    status: str = Field(description="ok, or degraded: data sets are missing or damaged, and the solver replaces them")
    datasets: int = Field(description="data sets found [-]")
    unchecked: int = Field(0, description="of these, not yet checked; retry in a moment [-]")
    problems: dict[str, str] = Field(description="what is missing or damaged, by name")


class Names:
    """A column of names, stored as codes.

    Parameters
    ----------
    codes : int or bool array, shape (points,)
        Index of each name.
    names : sequence of str
        All names.
    """

    def __init__(self, codes: NDArray[Any], names: Sequence[str]) -> None:
        self._codes = codes
        self._names = np.array(names, dtype=np.object_)  # one object per name, not per point

    def __len__(self) -> int:
        return len(self._codes)

    def __getitem__(self, points: slice) -> NDArray[np.object_]:
        return np.asarray(self._names[self._codes[points].astype(np.intp)])


class Counts:
    """A column of numbers of impacts, None where `UNKNOWN_IMPACTS` stands."""

    def __init__(self, counts: NDArray[np.int32]) -> None:
        self._counts = counts

    def __len__(self) -> int:
        return len(self._counts)

    def __getitem__(self, points: slice) -> NDArray[Any]:
        counts = self._counts[points]
        unknown = counts == UNKNOWN_IMPACTS
        return np.where(unknown, np.array(None), counts.astype(np.object_)) if unknown.any() else counts


def columns_of(result: BatchResult) -> dict[str, Column]:
    """The fields of `Columns` with one value for each point."""
    columns: dict[str, Column] = {
        **result.fields,
        OVERTURNED.name: result.fields[OUTCOME.name] >= Outcome.OVERTURNED_DIRECTLY,
        OUTCOME.name: Names(result.fields[OUTCOME.name], OUTCOMES),
        IMPACTS.name: Counts(result.fields[IMPACTS.name]),
        SOURCE.name: Names(result.from_cube, ["solver", "cube"]),
    }
    return {field.name: columns[field.name] for field in COLUMN_FIELDS}


def point_response(params: ResponseParams, found: BoundedResponse, versions: tuple[str, ...]) -> PointResponse:
    """The response for one block."""
    fields: dict[str, Any] = {one.name: getattr(found, one.name).item() for one in _OF_POINT}
    fields |= {name: values.item() for name, values in found.derived.items()}
    outcome, source = fields["outcome"], "cube" if found.from_cube.item() else "solver"
    note, warnings = None, []
    if outcome >= Outcome.OVERTURNED_DIRECTLY:
        note = "the block overturns: there is no peak"
    elif math.isinf(fields["error_bound"]):
        note = "the outcome changes within the rounding of the question: there is no bound"
        warnings = [note]
    elif fields["impacts"] == UNKNOWN_IMPACTS:
        note = "the data set does not determine the number of impacts: method=solver counts them"
    for name, value in fields.items():
        if value == UNKNOWN_IMPACTS if name == "impacts" else not math.isfinite(value):
            fields[name] = None
    fields["outcome"], fields["meaning"] = _WORDS[outcome]
    return PointResponse(
        query=params,
        warnings=warnings,
        overturned=outcome >= Outcome.OVERTURNED_DIRECTLY,
        note=note,
        source=source,
        data_version=versions[0] if versions and source == "cube" else None,
        **fields,
    )
