"""Fields that every JSON answer has: the question, units, warnings, version, and the address that repeats it."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from importlib.metadata import version
from typing import Annotated, Any, Generic, TypeVar, get_args

from fastapi import Depends, Request
from pydantic import BaseModel, Field, SerializeAsAny, computed_field

from rocking._base.errors import InvalidArgumentError
from rocking_api.models.metadata import METADATA, Metadata
from rocking_api.models.params import ListParams, Params
from rocking_api.models.quantity import said, unit_of

Q = TypeVar("Q", bound=Params)
L = TypeVar("L", bound=ListParams)

VERSION = version("rocking")

QUERY = said("parameters of the request, defaults included; empty without any")

BY_SOLVER = said("what answered: always the solver", "solver")


async def url_of(request: Request) -> str:
    """Path and query string of a request, after the method unless it is GET."""
    scope = request.scope
    address = scope["raw_path"] + b"?" + scope["query_string"] if scope["query_string"] else scope["raw_path"]
    url: str = address.decode("latin-1")
    return url if scope["method"] == "GET" else f"{scope['method']} {url}"


async def no_query(request: Request) -> None:
    """Refuse a query beside a JSON body, which holds all parameters."""
    for name, value in request.query_params.items():
        raise InvalidArgumentError(name, value, "in the JSON body, which holds all parameters")


Url = Annotated[str, Depends(url_of)]
"""The address that repeats the question of a request."""


class Answer(BaseModel, Generic[Q]):
    """Base of the models of all routes that answer in JSON, with the kind of the parameters."""

    query: SerializeAsAny[Q] = QUERY
    warnings: list[str] = Field(default_factory=list, description="where the answer is in doubt")
    version: str = said("version of the package", VERSION)
    url: str = said("path and query string that repeat the question; after POST: with the same body", "")

    @computed_field(  # type: ignore[prop-decorator]
        description="unit of each number by its field, 1 for a plain number; names of nested fields are joined by dots"
    )
    @property
    def units(self) -> dict[str, str]:
        return units_of(type(self))


class Bare(Answer[Params]):
    """Base of the models of routes without parameters."""

    query: Params = said(QUERY.description, Params())


class ListAnswer(Answer[L]):
    """Base of the models of lists."""

    next_cursor: str | None = said("`cursor` of the request for the next entries; null: there are no more", None)


class InGroups(Answer[Q]):
    """Base of the models in dimensionless groups."""

    metadata_url: str = said("path of model, assumptions and limits of use", "/v1/metadata")


class Solved(InGroups[Q]):
    """The same, always by the solver."""

    source: str = BY_SOLVER


class InUnits(Answer[Q]):
    """Base of the models in SI units."""

    metadata: Metadata = said("model, assumptions and limits of use", METADATA)


@cache
def units_of(model: type[BaseModel]) -> dict[str, str]:
    """The units of the fields of a model, by field, `1` for a plain number; names of nested fields joined by dots."""
    units: dict[str, str] = {}
    for name, field in model.model_fields.items():
        unit = unit_of(field)
        if unit:
            units[name] = "1" if unit == "-" else unit
        for nested in _models_in(field.annotation):
            units |= {f"{name}.{inner}": unit for inner, unit in units_of(nested).items()}
    return units


def _models_in(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for part in get_args(annotation):
        yield from _models_in(part)
