"""Directives that write reference tables from the code: routes of the service, fields of the data files, settings."""

from __future__ import annotations

import re
from functools import cache
from typing import Any, ClassVar

import typer
from docutils import nodes
from docutils.parsers.rst import Directive
from docutils.statemachine import StringList
from rocking_api.app import create_app
from rocking_api.settings import Settings
from typer.cli import get_docs_for_click

from rocking._base.units import UNITS
from rocking._cli.app import app as command_line
from rocking._datasets.cube import AXES, RESTITUTION_ERROR, VARIABLES


@cache
def openapi_document() -> dict[str, Any]:
    """The description of the service, which takes a second to make."""
    return create_app(Settings()).openapi()


class Generated(Directive):
    """Markdown text made by `lines`, parsed in place."""

    has_content: ClassVar[bool] = False

    def lines(self) -> list[str]:
        """The text."""
        raise NotImplementedError

    def run(self) -> list[nodes.Node]:
        container = nodes.container()
        text = self.lines()
        self.state.nested_parse(
            StringList(text, source=type(self).__name__), self.content_offset, container, match_titles=True
        )
        return container.children


def cell(text: Any) -> str:
    """Text as the cell of a table."""
    return " ".join(str(text).replace("|", "\\|").split())


class Routes(Generated):
    """Every route of the service with its parameters and the fields of its response, from the OpenAPI description.

    A field that is an object, or a list of them, names its model; the models follow after the routes, once each.
    """

    def lines(self) -> list[str]:
        """The text."""
        document = openapi_document()
        models = document["components"]["schemas"]
        text: list[str] = []
        used: list[str] = []
        for path, operations in document["paths"].items():
            for method, operation in operations.items():
                text += [f"### {method.upper()} `{path}`", "", operation.get("summary", ""), ""]
                parameters = operation.get("parameters", [])
                if parameters:
                    text += ["| parameter | in | required | meaning |", "|---|---|---|---|"]
                    for one in parameters:
                        meaning = one.get("description") or one["schema"].get("description", "")
                        need = "yes" if one.get("required") else "no"
                        text.append(f"| `{one['name']}` | {one['in']} | {need} | {cell(meaning)} |")
                    text.append("")
                body = operation.get("requestBody", {}).get("content", {})
                if body:
                    text += ["Body: " + ", ".join(f"`{kind}`" for kind in body) + ".", ""]
                content = operation["responses"]["200"].get("content", {})
                if content:
                    text += ["Response: " + ", ".join(f"`{kind}`" for kind in content) + ".", ""]
                schema = content.get("application/json", {}).get("schema", {})
                for one in schema.get("anyOf", [schema]):
                    text += self.fields(one, models, used)
        text += ["## Parts of responses", ""]
        for name in used:  # grows while models refer to others
            table = self.fields(models[name], models, used)
            text += [f"### `{name}`", "", cell(models[name].get("description", "")), "", *table]
        return text

    def fields(self, schema: dict[str, Any], models: dict[str, Any], used: list[str]) -> list[str]:
        """The table of the fields of a model; models that it refers to are added to `used`."""
        model = models[_model_of(schema)[0]] if "$ref" in schema else schema
        if "properties" not in model:
            return []
        rows = ["| field | type | unit | meaning |", "|---|---|---|---|"]
        for name, one in model["properties"].items():
            used += [part for part in dict.fromkeys(_model_of(one)) if part not in used]
            meaning = one.get("description", "")
            unit = re.search(r"\[([^\]]+)\]", meaning)
            rows.append(f"| `{name}` | {_type_of(one)} | {cell(unit[1] if unit else '')} | {cell(meaning)} |")
        return [*rows, ""]


def _model_of(schema: Any) -> list[str]:
    """Names of the models that a schema refers to, at any depth."""
    if isinstance(schema, dict):
        own = [schema["$ref"].rpartition("/")[2]] if "$ref" in schema else []
        return own + [name for key, value in schema.items() if key != "$ref" for name in _model_of(value)]
    return [name for one in schema for name in _model_of(one)] if isinstance(schema, list) else []


def _type_of(schema: dict[str, Any]) -> str:
    """The type in words: number, null, list of Threshold."""
    if "$ref" in schema:
        return f"`{_model_of(schema)[0]}`"
    if "anyOf" in schema:
        return " or ".join(_type_of(one) for one in schema["anyOf"])
    kind = str(schema.get("type", "any"))
    if kind == "array":
        inner = schema.get("items", {})
        each = _type_of(inner) if inner else "any"
        return f"list of ({each})" if " or " in each else f"list of {each}"
    return kind


class ServiceSettings(Generated):
    """Environment variables of the service with their defaults."""

    def lines(self) -> list[str]:

        rows = [
            f"| `ROCKING_{name.upper()}` | `{field.default}` | {cell(field.description or '')} |"
            for name, field in Settings.model_fields.items()
        ]
        return ["| variable | default | meaning |", "|---|---|---|", *rows, ""]


class CubeFields(Generated):
    """Axes and variables of a spectrum cube."""

    def lines(self) -> list[str]:

        text = ["| variable | type | unit | equation | meaning |", "|---|---|---|---|---|"]
        fields = [(name, "f8", about) for name, about in AXES.items()]
        fields += [(name, kind, about) for name, (kind, about) in (VARIABLES | RESTITUTION_ERROR).items()]
        for name, kind, about in fields:
            unit, equation = about.get("units", "1"), about.get("equation", "")
            meaning = "; ".join(str(about[key]) for key in ("long_name", "comment", "flag_meanings") if key in about)
            text.append(f"| `{name}` | {kind} | {unit} | {equation} | {cell(meaning)} |")
        return [*text, ""]


class UnitNames(Generated):
    """Names of the units of each quantity."""

    def lines(self) -> list[str]:

        rows = [f"| {unit} | {', '.join(f'`{name}`' for name in names)} |" for unit, names in UNITS.items()]
        return ["| SI unit | names |", "|---|---|", *rows, ""]


class Command(Generated):
    """Every command with its options, as `typer utils docs` writes them."""

    def lines(self) -> list[str]:

        command = typer.main.get_command(command_line)
        with typer.Context(command, info_name="rocking") as context:
            text = get_docs_for_click(obj=command, ctx=context, name="rocking", title="rocking")
        return text.replace("**Usage**", "Usage").splitlines()[1:]


def setup(app: Any) -> dict[str, bool]:
    """Register the directives."""
    app.add_directive("service-routes", Routes)
    app.add_directive("service-settings", ServiceSettings)
    app.add_directive("cube-fields", CubeFields)
    app.add_directive("command-options", Command)
    app.add_directive("unit-names", UnitNames)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
