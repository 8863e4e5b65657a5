"""The report of an assessment: one HTML file without requests to others, which prints on A4."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib import resources
from typing import Any

from rocking._assessment.columns import INPUTS, OUTPUTS, VERDICTS
from rocking._assessment.objects import Object
from rocking._assessment.result import Assessment
from rocking._assessment.site import Site
from rocking._base.version import __version__
from rocking._dimensional.table_reader import BadRow

TEMPLATE = "report.html"

COLOURS = ("#56b4e9", "#f0e442", "#e69f00", "#d55e00")
"""Of the verdicts; people who are colour-blind tell them apart (Okabe and Ito 2008)."""

DRAWING = 160.0
"""Larger dimension of an object in its drawing [pixels]."""


@dataclass(frozen=True)
class Project:
    """What a report states about itself; `command` makes it again."""

    title: str
    place: str
    date: str
    command: str


def report_html(found: Assessment, site: Site, project: Project, bad_rows: Sequence[BadRow] = ()) -> str:
    """The report as text.

    Raises
    ------
    ImportError
        If jinja2, the extra `report`, is not installed.
    """
    from jinja2 import Environment, StrictUndefined  # noqa: PLC0415  (an extra)

    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    template = environment.from_string(resources.files("rocking._assessment").joinpath(TEMPLATE).read_text("utf-8"))
    sections: dict[int, tuple[Object, list[dict[str, Any]]]] = {}  # names may be equal
    for row, factors, one in zip(found.rows, found.factors.tolist(), found.objects, strict=True):
        own = {"factors": dict(zip(found.motions, factors, strict=True)), "drawing": _drawing(one, row["direction"])}
        sections.setdefault(id(one), (one, []))[1].append(row | own)
    return template.render(
        project=project,
        site=site,
        found=found,
        sections=list(sections.values()),
        inputs=INPUTS,
        units={one.name: one.unit for one in OUTPUTS},
        colours=dict(zip(VERDICTS, COLOURS, strict=True)),
        bad_rows=bad_rows,
        version=__version__,
    )


def _drawing(one: Object, direction: str) -> dict[str, float]:
    """Sizes of the drawing of an object from the side [pixels]."""
    base, offset = one.directions[direction]
    given: dict[str, Any] = vars(one)
    height = given["height"]
    centre = 0.5 * height if given["mass_height"] is None else given["mass_height"]
    scale = DRAWING / max(base, height, centre)
    return {"base": base * scale, "height": height * scale, "centre": centre * scale, "offset": offset * scale}
