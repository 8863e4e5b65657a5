"""The report of an assessment: one HTML file without requests to others, which prints on A4."""

from __future__ import annotations

import math
import platform
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import metadata, resources
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking._assessment.charts import HEIGHT, WIDTH, Axis, Chart, line_of, thinned
from rocking._assessment.columns import INPUTS, OUTPUTS, VERDICTS
from rocking._assessment.motions import envelope_of
from rocking._assessment.objects import Object
from rocking._assessment.result import Assessment
from rocking._base.version import __version__
from rocking._dimensional.table_reader import BadRow

Array = NDArray[np.float64]

TEMPLATE = "report.html"

COLOURS = ("#56b4e9", "#f0e442", "#e69f00", "#d55e00")
"""Of the verdicts; people who are colour-blind tell them apart (Okabe and Ito 2008)."""

DRAWING = 150.0  # larger dimension of an object in its drawing [pixels]

MOST_DETAILED = 60
"""Rows, from the worst one on, that have pictures and the friction needed [-]: each takes 0.1 s or so."""

STRONGEST = 3.0  # height of the axis of an envelope over the peak acceleration of the site [-]


@dataclass(frozen=True)
class Project:
    """What a report states about itself; `command` makes it again."""

    title: str
    author: str
    place: str
    date: str
    command: str


def report_html(found: Assessment, project: Project, bad_rows: Sequence[BadRow] = (), reading: str = "") -> str:
    """The report as text; `reading` says what the columns of the table of objects were read as."""
    from jinja2 import Environment, StrictUndefined  # noqa: PLC0415  (an extra)

    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    template = environment.from_string(resources.files("rocking._assessment").joinpath(TEMPLATE).read_text("utf-8"))
    sections: dict[int, tuple[Object, list[dict[str, Any]]]] = {}  # names may be equal
    envelopes = _envelopes(found)
    for k, (row, one) in enumerate(zip(found.rows[:MOST_DETAILED], found.objects, strict=False)):
        own = {
            "drawing": _drawing(one, row["direction"]),
            "motions": _motions(found, k),
            "charts": [*envelopes[k : k + 1], *_histories(found, k)],
            "plane": one.planes[row["direction"]],
            "worst": found.worst_motion(k),
            "strength": found.strength(k),
        }
        sections.setdefault(id(one), (one, []))[1].append(row | own)
    return template.render(
        project=project,
        site=found.site,
        found=found,
        sections=list(sections.values()),
        most_detailed=MOST_DETAILED,
        inputs=INPUTS,
        units={one.name: one.unit for one in OUTPUTS},
        colours=dict(zip(VERDICTS, COLOURS, strict=True)),
        bad_rows=bad_rows,
        reading=reading,
        versions={"rocking": __version__, "Python": platform.python_version()}
        | {name: metadata.version(name) for name in ("numpy", "numba", "scipy")},
        chart_size=(WIDTH, HEIGHT),
    )


def _motions(found: Assessment, k: int) -> list[dict[str, Any]]:
    """What the report states of a row under each motion."""
    friction = found.friction(k)
    columns = zip(
        *(found.motions, found.site.motions, found.factors[k].tolist(), found.rotations[k].tolist()),
        *(friction["friction_needed"].values.tolist(), friction["exceeded_at"].values.tolist()),
        strict=True,
    )
    names = "name", "motion", "factor", "rotation", "friction", "exceeded_at"
    return [dict(zip(names, one, strict=True)) for one in columns]


def _envelopes(found: Assessment) -> list[Chart]:
    """Thresholds over shapes and periods, of the detailed rows; none for records."""
    rows = found.rows[:MOST_DETAILED]
    given = [(one, str(row["direction"])) for one, row in zip(found.objects, rows, strict=False)]
    motions = found.site.motions
    top = STRONGEST * max(motion.peak_acceleration for motion in motions)
    periods, lowest = envelope_of(given, motions, top)
    charts = []
    for k in range(len(given) if lowest else 0):
        axes = (
            Axis("period of the pulse [s]", float(periods[0]), float(periods[-1]), WIDTH, logarithmic=True),
            Axis("peak acceleration [m/s²]", 0.0, top, HEIGHT),
        )
        lines = [line_of(name, axes, periods, values[k], style) for style, (name, values) in enumerate(lowest.items())]
        colours: dict[tuple[float, float], str] = {}
        for motion in motions:
            place, own = (motion.period, motion.peak_acceleration), lines[list(lowest).index(motion.motion.name)].colour
            colours[place] = "black" if colours.get(place, own) != own else own  # of several shapes
        marked = [(float(axes[0].at(t)), -float(axes[1].at(a)), colour) for (t, a), colour in colours.items()]
        charts.append(
            Chart(
                "Lowest peak acceleration that overturns it, for each shape; rings: the motions of the site",
                *axes,
                lines,
                marked,
            )
        )
    return charts


def _histories(found: Assessment, k: int) -> list[Chart]:
    """Ground acceleration and rotation under the worst motion."""
    history = found.history(k)
    time = history["time"].values
    limits = math.degrees(history.attrs["alpha"]), math.degrees(history.attrs["alpha_left"])
    rotation = np.degrees(history["rotation"].values)
    end = float(time[-1])
    fallen = np.flatnonzero(np.abs(rotation) >= 2.0 * max(limits))
    if fallen.size:
        end = float(time[fallen[0]])
    charts = []
    for title, values, label in (
        ("Ground acceleration", history["ground_acceleration"].values, "acceleration [m/s²]"),
        ("Rotation; dashed where it is balanced on an edge", rotation, "rotation [degrees]"),
    ):
        shown = values[time <= end]
        half = 1.1 * max(float(np.abs(shown).max()), 1e-9)
        edges = [limits[0], -limits[1]] if values is rotation else []
        half = max([half, *(1.1 * abs(edge) for edge in edges)])
        axes = Axis("time [s]", 0.0, end, WIDTH), Axis(label, -half, half, 0.55 * HEIGHT)
        lines = [line_of("", axes, *thinned(time[time <= end], shown))]
        lines += [line_of("", axes, np.array([0.0, end]), np.full(2, edge), 11) for edge in edges]
        charts.append(Chart(title, *axes, lines, []))
    return charts


def _drawing(one: Object, direction: str) -> dict[str, Any]:
    """Sizes of the drawing of an object from the side [pixels], and of its scale bar."""
    plane, outline = one.planes[direction], one.outline(direction)
    width = 2.0 * float(max(np.abs(outline[:, 0]).max(), 0.5 * plane.base))
    largest = max(width, plane.height, plane.mass_height)
    scale = DRAWING / largest
    unit = 10.0 ** math.floor(math.log10(0.5 * largest))
    bar = unit * max(m for m in (1, 2, 5) if m * unit <= 0.5 * largest)
    sizes = {"base": plane.base, "width": width, "height": plane.height, "centre": plane.mass_height}
    sizes |= {"offset": plane.offset, "bar": bar}
    points = " ".join(f"{x:.1f},{-y:.1f}" for x, y in (scale * outline).tolist())
    return {name: size * scale for name, size in sizes.items()} | {"bar_length": bar, "outline": points}
