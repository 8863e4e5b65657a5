"""The public interface as text, collected from the code: Python names and signatures, commands, HTTP routes, columns.

`python -m tests.public_names` writes it to tests/data/public_names.txt, in which a change of the interface is seen.
"""

from __future__ import annotations

import enum
import inspect
import re
import textwrap
from collections.abc import Iterable, Iterator
from pathlib import Path
from pkgutil import resolve_name
from types import ModuleType
from typing import Any

import rocking_assessment
import typer
from rocking_api.app import create_app
from rocking_api.settings import Settings

import rocking
from rocking import extension
from rocking._cli.app import app as command_line
from rocking._datasets.cube import AXES, OPTIONAL_VARIABLES, SAMPLES, VARIABLES
from rocking._model.fields import COLUMN_FIELDS, RESPONSE_FIELDS
from workflow.scripts.overturning import curves_of, described

STORED = Path(__file__).parent / "data" / "public_names.txt"
DOCS = Path(__file__).parents[1] / "docs"
REFERENCES = {rocking: DOCS / "reference/python.md", rocking_assessment: DOCS / "assessment/reference.md"}
"""The pages that document the names of each package."""

NOT_DOCUMENTED = {"rocking.Cube": {"level", "slice_at", "promised", "interpolate", "used"}}
"""Members without a leading underscore that the documentation does not name."""


def entry(name: str, words: Iterable[str]) -> str:
    """A name and what belongs to it, in lines of at most 120 characters."""
    return textwrap.fill(" ".join([f"{name}:", *words]), 120, subsequent_indent="    ", break_on_hyphens=False)


def python_names() -> Iterator[str]:
    """Names at the top of each package, their members, and what the reference documents besides them."""
    for package, page in REFERENCES.items():
        yield from names_of(package.__name__, package)
        for name in re.findall(r"^ +(_\w+\.[\w.]+)$", page.read_text(encoding="utf-8"), flags=re.MULTILINE):
            full_name = f"{package.__name__}.{name}"
            yield from names_of(full_name, resolve_name(full_name))
    yield entry("rocking.extension", sorted(extension.__all__))


def names_of(name: str, value: Any) -> Iterator[str]:
    """A module with its names, a class with its members and their signatures, a function with its signature."""
    if isinstance(value, ModuleType):
        own = [key for key, part in vars(value).items() if getattr(part, "__module__", "").startswith(value.__name__)]
        names = sorted(key for key in getattr(value, "__all__", own) if key == "__version__" or key[0] != "_")
        yield entry(name, names)
        for key in names:
            yield from names_of(f"{name}.{key}", getattr(value, key))
    elif inspect.isclass(value) and issubclass(value, enum.Enum):
        yield entry(name, [f"{member.name}={member.value}" for member in value])
    elif inspect.isclass(value):
        fields = {key for base in value.__mro__ for key in inspect.get_annotations(base)}
        members = {key for key in {*dir(value), *fields} - {*dir(Exception)} if key[0] != "_"}
        members -= NOT_DOCUMENTED.get(name, set())
        yield entry(name, sorted(members))
        for key in ("__init__", *sorted(members)):
            if inspect.isfunction(part := getattr(value, key, None)) or inspect.ismethod(part):
                yield signature(f"{name}.{key}", part)
    elif inspect.isfunction(value):
        yield signature(name, value)


def signature(name: str, function: Any) -> str:
    """The parameters of a function as they may be passed, with defaults that are plain values."""
    found = inspect.signature(function)
    parameters = [
        parameter.replace(annotation=parameter.empty)
        if isinstance(parameter.default, (type, int, float, str, tuple, type(None)))
        else parameter.replace(annotation=parameter.empty, default=...)
        for parameter in found.parameters.values()
    ]
    listed = str(found.replace(parameters=parameters, return_annotation=found.empty)).replace("Ellipsis", "...")
    return textwrap.fill(f"{name}{listed}", 120, subsequent_indent="    ")


def command_names() -> Iterator[str]:
    """Options of each command, those of a group under `rocking GROUP COMMAND`."""

    def options(name: str, command: Any) -> Iterator[str]:
        if hasattr(command, "list_commands"):
            for own in sorted(command.list_commands(None)):
                yield from options(f"{name} {own}", command.get_command(None, own))
        else:
            yield entry(name, sorted(option for parameter in command.params for option in parameter.opts))

    return options("rocking", typer.main.get_command(command_line))


def schema_fields(document: dict[str, Any], schema: dict[str, Any], path: str = "") -> Iterator[str]:
    """The fields of a schema of an OpenAPI document, those of parts below the names of these."""
    if "$ref" in schema:
        schema = document["components"]["schemas"][schema["$ref"].rpartition("/")[2]]
    for name, field in schema.get("properties", {}).items():
        yield f"{path}{name}"
        yield from schema_fields(document, field, f"{path}{name}.")
    for part in (*schema.get("anyOf", ()), *schema.get("oneOf", ()), *schema.get("allOf", ()), schema.get("items")):
        if isinstance(part, dict):
            yield from schema_fields(document, part, path)


def http_names() -> Iterator[str]:
    """Parameters of each route, and the fields of its body and of its answers, from the OpenAPI document."""
    document = create_app(Settings(results=STORED.parent)).openapi()

    def contents(name: str, message: dict[str, Any]) -> Iterator[str]:
        for media_type, content in message.get("content", {}).items():
            yield entry(f"{name} {media_type}", sorted(set(schema_fields(document, content.get("schema", {})))))

    errors: set[str] = set()
    for path, operations in sorted(document["paths"].items()):
        for method, operation in operations.items():
            route = f"{method.upper()} {path}"
            yield entry(route, sorted(parameter["name"] for parameter in operation.get("parameters", ())))
            yield from contents(f"{route} body", operation.get("requestBody", {}))
            for status, response in sorted(operation["responses"].items()):
                if status < "400":
                    yield from contents(f"{route} {status}", response)
                else:
                    errors |= {*contents("error", response)}
            yield entry(f"{route} status", sorted(operation["responses"]))
    yield from sorted(errors)


def column_names() -> Iterator[str]:
    window = {"frequency_ratio": (0.2, 15.0), "slenderness": (0.02, 1.0)}
    (curves,) = curves_of("sine", 0.85, [0.0], nodes=16, nodes_rigid=16, **window)
    yield entry("fields of a response", [field.name for field in RESPONSE_FIELDS])
    yield entry("columns of a table", [field.name for field in COLUMN_FIELDS])
    yield entry("variables of a spectrum cube", [*AXES, *SAMPLES, *VARIABLES, *OPTIONAL_VARIABLES])
    yield entry("variables of overturning boundaries", sorted(map(str, described(curves, "sine", 0.85).variables)))


def present() -> str:
    return "\n".join([*python_names(), *command_names(), *http_names(), *column_names(), ""])


if __name__ == "__main__":
    STORED.write_text(present(), encoding="utf-8")
