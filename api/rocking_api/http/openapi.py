"""The OpenAPI document: that of FastAPI, with one named schema for each thing that several routes have.

Generators of clients make a class of each schema that stands inside of another one, and number those of one name. Here
sets of words and objects stand for themselves, under the names of their fields, and every content has a schema.
"""

from __future__ import annotations

from collections.abc import Callable
from threading import Lock
from typing import Any

from fastapi import FastAPI
from pydantic import BaseModel

Schema = dict[str, Any]

REF = "#/components/schemas/"

_CONSTRAINTS = {"enum", "minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum", "pattern"}

_KEPT = {"description", "default", "examples"}  # what a place says of a shared schema

CONTENT: dict[str, Schema] = {
    "application/json": {},
    "text/plain": {"type": "string"},
    "text/csv": {"type": "string"},
    "application/xml": {"type": "string"},
}
"""Schemas of contents that declare none; others are bytes."""


def describe(app: FastAPI, models: Callable[[], list[type[BaseModel]]]) -> None:
    """Let an application describe itself so, with some models that no route declares; threads may ask for it."""
    generate, lock = app.openapi, Lock()

    def described() -> dict[str, Any]:
        with lock:
            if app.openapi_schema is None:
                document = generate()
                schemas = document["components"]["schemas"]
                for model in models():
                    schema = model.model_json_schema(ref_template=REF + "{model}")
                    schemas.update(schema.pop("$defs", {}))
                    schemas[model.__name__] = schema
                _share(document)
            return generate()

    app.openapi = described  # type: ignore[method-assign]  # FastAPI's documented way to extend the description


def _share(document: dict[str, Any]) -> None:
    schemas = document["components"]["schemas"]
    for name in list(schemas):
        _visit_parts(schemas[name], name, schemas)
    for methods in document["paths"].values():
        for operation in methods.values():
            for parameter in operation.get("parameters", ()):
                parameter["schema"] = _visit(parameter["schema"], _camel(parameter["name"]), schemas)
            for answer in (operation.get("requestBody", {}), *operation["responses"].values()):
                for media, content in answer.get("content", {}).items():
                    given = content.get("schema") or CONTENT.get(media, {"type": "string", "format": "binary"})
                    content["schema"] = _visit(given, "Content", schemas)


def _visit(schema: Schema, name: str, schemas: dict[str, Schema]) -> Schema:
    """A schema within others, or a reference to it where it has a name of its own; `name` is that of its field."""
    if "$ref" in schema:
        return schema
    name = _camel(schema.pop("title", name))
    if alternatives := schema.get("anyOf"):  # of a number or text and null, whose limits stand beside them
        limits = {key: schema.pop(key) for key in _CONSTRAINTS & schema.keys()}
        limits |= {"enum": [one for one in limits["enum"] if one is not None]} if "enum" in limits else {}
        alternatives[0] |= limits
    _visit_parts(schema, name, schemas)
    is_shared = "enum" in schema or (
        schema.get("type") == "object" and schema.keys() & {"properties", "additionalProperties"}
    )
    if not is_shared:
        return schema
    kept = {key: schema.pop(key) for key in _KEPT & schema.keys()}
    while schemas.setdefault(name, schema) != schema:
        words = schema.get("enum")
        name += "Of" + "".join(_camel(str(word)) for word in words) if words else "Echo"
    return {"$ref": REF + name, **kept}


def _visit_parts(schema: Schema, name: str, schemas: dict[str, Schema]) -> None:
    for key in ("anyOf", "oneOf", "prefixItems"):
        if key in schema:
            schema[key] = [_visit(part, name, schemas) for part in schema[key]]
    for key in ("items", "additionalProperties"):
        if isinstance(schema.get(key), dict):
            schema[key] = _visit(schema[key], f"{name}Item", schemas)
    if "properties" in schema:
        schema["properties"] = {key: _visit(part, _camel(key), schemas) for key, part in schema["properties"].items()}


def _camel(name: str) -> str:
    return "".join(part[:1].upper() + part[1:] for part in name.replace("-", "_").replace(" ", "_").split("_"))
