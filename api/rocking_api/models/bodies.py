"""The description of routes with a body: its formats, and the parameters that JSON takes as well as the query."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rocking_api.models.params import Params
from rocking_api.models.pulses import with_samples

BODIES: set[type[Params]] = set()  # the models of bodies to which the descriptions of routes refer

_TRIANGLE = {"acceleration": [0.0, 1.0, 0.0], "name": "triangle"}


def json_content(body: type[Params], example: Any, *more: dict[str, Any]) -> dict[str, Any]:
    """The description of a JSON body; `more` are alternative schemas."""
    BODIES.add(body)
    schema = {"$ref": f"#/components/schemas/{body.__name__}"}
    return {"application/json": {"schema": {"anyOf": [schema, *more]} if more else schema, "example": example}}


def text_content(media_type: str, example: str) -> dict[str, Any]:
    """The description of a body that is text."""
    return {media_type: {"schema": {"type": "string"}, "example": example}}


def body_of(content: Mapping[str, Any], kind: type[Params], description: str = "") -> dict[str, Any]:
    """The description of a route with a body; the fields of `kind` are in the query or in a JSON body."""
    parameters = [
        {"name": name, "in": "query", "required": False, "description": schema.pop("description"), "schema": schema}
        for name, schema in kind.model_json_schema()["properties"].items()
    ]
    described = {"description": description} if description else {}
    return {"parameters": parameters, "requestBody": {"required": True, "content": dict(content), **described}}


def twin_of(kind: type[Params]) -> dict[str, Any]:
    """The description of a POST that takes the fields of `kind` in a JSON body; GET describes the query."""
    required = {name: field.examples for name, field in kind.model_fields.items() if field.is_required()}
    example = {name: examples[0] for name, examples in required.items() if examples} | {"pulse": _TRIANGLE}
    return {"requestBody": {"required": True, "content": json_content(with_samples(kind), example)}}
