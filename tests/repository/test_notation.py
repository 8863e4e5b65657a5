"""docs/notation.md is what `python -m tests.notation` writes from the declarations and the interfaces."""

from __future__ import annotations

import inspect

import typer
from rocking_api.app import create_app
from rocking_api.settings import Settings

import rocking
from rocking._cli.app import app
from rocking._lookup.cube import Cube
from tests.notation import PAGE, page


def test_the_page_is_what_the_declarations_give() -> None:
    assert page() == PAGE.read_text(encoding="utf-8")


def test_slenderness_is_said_to_depend_on_the_motion_wherever_it_is_asked_for() -> None:
    said = "depends on the motion, unlike h/b"
    document = create_app(Settings()).openapi()
    fields = [
        model.get("properties", {}).get("slenderness", {}) for model in document["components"]["schemas"].values()
    ]
    asked = [
        one for path in document["paths"].values() for method in path.values() for one in method.get("parameters", ())
    ]
    assert [one for one in asked if one["name"] == "slenderness" and said not in one["description"]] == []
    assert [one for one in fields if "examples" in one and said not in one["description"]] == []
    group = typer.main.get_command(app)
    for name in ("response", "history", "spectrum"):
        (option,) = [one for one in group.commands[name].params if one.name == "slenderness"]  # type: ignore[attr-defined]
        assert said in option.help
    for function in (rocking.peak_response, rocking.time_history, rocking.overturning_boundary, Cube.response):
        text = inspect.getdoc(function) or ""
        assert said in text.partition("\nslenderness : ")[2].split("\n\n")[0][:200], function
