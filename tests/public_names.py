"""Public names of the package, the command line, the HTTP service and the data sets, collected from the code itself.

`python -m tests.public_names RESULTS` adds the present names to tests/data/public_names.json; RESULTS is the results
folder of a finished run of smoke.yaml. The tests allow new names, but none of the stored ones may disappear.
"""

from __future__ import annotations

import dataclasses
import enum
import inspect
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import netCDF4
import typer
from rocking_api.app import create_app
from rocking_api.settings import Settings

import rocking
from rocking._cli.app import app as command_line

STORED = Path(__file__).parent / "data" / "public_names.json"

UNDOCUMENTED = {"rocking.Cube": {"level", "slice_at", "promised", "interpolate", "used"}}
"""Members without a leading underscore that the documentation does not name."""

Names = dict[str, list[str]]


def python_names() -> Names:
    """Public names of `rocking`: parameters of functions, members of classes, names of modules."""
    found = {"rocking": sorted(rocking.__all__)}
    for name in rocking.__all__:
        found |= members(f"rocking.{name}", getattr(rocking, name))
    return found


def members(name: str, value: Any) -> Names:
    """Names that a user of one public object may write."""
    if isinstance(value, ModuleType):
        names = getattr(value, "__all__", [key for key in vars(value) if not key.startswith("_")])
        found = {name: sorted(names)}
        for key in names:
            if inspect.isfunction(getattr(value, key)) or inspect.isclass(getattr(value, key)):
                found |= members(f"{name}.{key}", getattr(value, key))
        return found
    if inspect.isclass(value) and issubclass(value, enum.Enum):
        return {name: [f"{member.name} = {member.value}" for member in value]}
    if inspect.isclass(value):
        public = {key for key in dir(value) if not key.startswith("_")} - set(dir(Exception))
        if dataclasses.is_dataclass(value):
            public |= {field.name for field in dataclasses.fields(value)}
        public -= UNDOCUMENTED.get(name, set())
        found = {name: sorted(public)}
        for key in public:
            if inspect.isfunction(getattr(value, key, None)):
                found |= members(f"{name}.{key}", getattr(value, key))
        return found
    if inspect.isfunction(value):
        return {name: [key for key in inspect.signature(value).parameters if key != "self"]}
    return {}


def command_names() -> Names:
    """Options of each command, those of a group under `rocking GROUP COMMAND`."""

    def options(name: str, command: Any) -> Names:
        if hasattr(command, "commands"):
            return {
                key: value
                for own, part in command.commands.items()
                for key, value in options(f"{name} {own}", part).items()
            }
        return {name: sorted(option for parameter in command.params for option in parameter.opts)}

    return options("rocking", typer.main.get_command(command_line))


def http_names(results: Path) -> Names:
    """Parameters, media types and fields of each route, from the OpenAPI document."""
    document = create_app(Settings(results=results)).openapi()

    def fields(schema: dict[str, Any], path: str = "") -> Iterator[str]:
        if "$ref" in schema:
            schema = document["components"]["schemas"][schema["$ref"].rpartition("/")[2]]
        for name, field in schema.get("properties", {}).items():
            yield f"{path}{name}"
            yield from fields(field, f"{path}{name}.")
        for part in (*schema.get("anyOf", ()), *schema.get("allOf", ()), schema.get("items")):
            if isinstance(part, dict):
                yield from fields(part, path)

    def contents(name: str, message: dict[str, Any]) -> Names:
        return {
            f"{name} {media_type}": sorted(set(fields(content.get("schema", {}))))
            for media_type, content in message.get("content", {}).items()
        }

    found: Names = {}
    for path, operations in document["paths"].items():
        for method, operation in operations.items():
            route = f"{method.upper()} {path}"
            found[route] = sorted(parameter["name"] for parameter in operation.get("parameters", ()))
            found |= contents(f"{route} body", operation.get("requestBody", {}))
            found[f"{route} status"] = sorted(operation["responses"])
            for status, response in operation["responses"].items():
                found |= contents(f"{route} {status}" if status < "400" else "error", response)
    return found


def file_names(results: Path) -> Names:
    """Dimensions and variables of the data sets and figures in a results folder."""
    found: Names = {}
    for path in sorted(results.rglob("*.nc")):
        with netCDF4.Dataset(path) as dataset:
            names = {f"{variable.name}({', '.join(variable.dimensions)})" for variable in dataset.variables.values()}
        found[path.relative_to(results).as_posix()] = sorted(names)
    return found


def stored() -> dict[str, Names]:
    """Read the stored names by kind: python, commands, http, files."""
    content: dict[str, Names] = json.loads(STORED.read_text(encoding="utf-8"))
    return content


def missing(kind: str, present: Names) -> list[str]:
    """Return the stored names of a kind that are not present."""
    return [
        f"{place}: {name}" if name else place
        for place, names in stored()[kind].items()
        for name in (["", *names] if place not in present else sorted(set(names) - set(present[place])))
    ]


def main(results: Path) -> None:
    """Add the present names to the stored ones."""
    known = stored() if STORED.exists() else {}
    present = {
        "python": python_names(),
        "commands": command_names(),
        "http": http_names(results),
        "files": file_names(results),
    }
    merged = {
        kind: {
            place: sorted({*known.get(kind, {}).get(place, ()), *names.get(place, ())})
            for place in sorted({*known.get(kind, {}), *names})
        }
        for kind, names in present.items()
    }
    STORED.write_text(json.dumps(merged, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
