"""The report of an assessment: one HTML file without requests, which prints on A4 with page numbers."""

from __future__ import annotations

import math
import platform
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import metadata, resources
from typing import Any

import numpy as np

from rocking.extension import STANDARD_GRAVITY, BadRow, __version__
from rocking_assessment._objects.charts import HEIGHT, WIDTH, Axis, Chart, line_of, thinned
from rocking_assessment._objects.columns import CLAUSES, VERDICTS
from rocking_assessment._objects.motions import envelope_of, friction_needed
from rocking_assessment._objects.objects import Object
from rocking_assessment._objects.result import Assessment
from rocking_assessment._objects.site import Motion, Site
from rocking_assessment._objects.summary import (
    Line,
    counts_of,
    lines_of,
    names_in_short,
    number_of,
    text_of,
    warnings_of,
)

TEMPLATE = "report.html"

COLOURS = ("#56b4e9", "#f0e442", "#cc79a7", "#e69f00", "#d55e00")
"""Colours of the verdicts; colour-blind people can tell them apart (Okabe and Ito 2008)."""

WORST = 5  # objects that are drawn on the first page [-]
LARGEST = 115.0, 150.0  # largest width and height of a drawing on the first page [pixels]; all have one scale
DRAWING = 105.0  # height of an object in its drawings, and width of these together, at most [pixels]
MOST_DETAILED = 60  # largest number of objects with drawings and charts, the worst ones [-]
MOST_MOTIONS = 8  # number of motions listed beside an object, the worst first [-]; `detailed` lists all

STRONGEST = 3.0  # height of the axis of an envelope over the peak acceleration of the site [-]


@dataclass(frozen=True)
class Project:
    """Title, author, date and site of a report, and the command that makes it again."""

    title: str
    author: str
    place: str
    date: str
    command: str


def report_html(
    assessment: Assessment,
    project: Project,
    bad_rows: Sequence[BadRow] = (),
    reading: str = "",
    *,
    detailed: bool = False,
) -> str:
    """The report as text; `reading` says what the columns of the table of objects were read as.

    Objects that rock, overturn or are within 20 % of overturning are shown in detail, in their worse direction. With
    `detailed` every object is, in each direction.
    """
    from jinja2 import Environment, StrictUndefined  # noqa: PLC0415  (only a report needs it)

    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters |= {"css": css_text, "shown": text_of, "rounded": number_of}
    template = environment.from_string(
        resources.files("rocking_assessment._objects").joinpath(TEMPLATE).read_text("utf-8")
    )
    lines = lines_of(assessment)
    verdicts = Counter(line.values["verdict"] for line in lines)
    concerned = [line for line in lines if detailed or line.concerns][:MOST_DETAILED]
    return template.render(
        project=project,
        site=assessment.site,
        assessment=assessment,
        lines=lines,
        clauses=CLAUSES,
        counts={verdict: verdicts[verdict] for verdict in reversed(VERDICTS)},
        full_strength=counts_of(lines),
        worst=_worst(lines),
        blocks=_blocks(assessment, concerned, detailed),
        detailed=detailed,
        numbers={line.rows[0]: number for number, line in enumerate(concerned, start=1)},
        motions=_motion_texts(assessment.site),
        warnings=[(text, len(names), names_in_short(names)) for text, names in warnings_of(assessment)],
        colours=dict(zip(VERDICTS, COLOURS, strict=True)),
        bad_rows=bad_rows,
        reading=reading,
        versions={"rocking": __version__, "Python": platform.python_version()}
        | {name: metadata.version(name) for name in ("numpy", "numba", "scipy")},
    )


def css_text(text: str) -> str:
    """A text between the quotes of a style sheet."""
    return "".join(char if char.isascii() and char.isalnum() else f"\\{ord(char):x} " for char in text)


def _motion_texts(site: Site) -> list[str]:
    """The motions of the site in words: records, shapes on a floor, or shapes with their periods."""
    if site.records:
        groups: dict[int, list[Motion]] = {}
        for motion in site.motions:
            groups.setdefault(motion.group, []).append(motion)
        texts = []
        for motions in groups.values():
            text = motions[0].name.removesuffix(", 0 deg")
            if len(motions) > 1:
                text += f", a pair at angles every {180 // len(motions)} degrees"
            texts.append(text)
        return texts
    if site.floor_periods is not None:
        return [motion.name for motion in site.motions]
    periods: dict[str, list[str]] = {}
    for motion in site.motions:
        periods.setdefault(motion.motion.name, []).append(number_of(motion.period))
    shapes: dict[str, list[str]] = {}
    for name, numbers in periods.items():
        shapes.setdefault(", ".join(numbers), []).append(name)
    return [f"{', '.join(names)} of {numbers} s" for numbers, names in shapes.items()]


def _worst(lines: Sequence[Line]) -> list[dict[str, Any]]:
    """The worst objects with their drawings, which have one scale."""
    worst = lines[:WORST]
    outlines = [line.object.outline(line.values["direction"]) for line in worst]
    width = max(2.0 * np.abs(outline[:, 0]).max() for outline in outlines)
    height = max(outline[:, 1].max() for outline in outlines)
    scale = min(LARGEST[0] / width, LARGEST[1] / height)
    return [{"line": line, "drawing": _drawing(line.object, line.values["direction"], scale)} for line in worst]


def _blocks(assessment: Assessment, concerned: Sequence[Line], detailed: bool) -> list[dict[str, Any]]:
    """The contents of the report for some objects, in each direction or in the worse one."""
    lines = list(concerned)
    if detailed:
        lines = []
        for line in concerned:
            lines += lines_of(assessment, directions=True, only=line)
    if not lines:
        return []
    objects = [(line.object, str(line.values["direction"])) for line in lines]
    needed = friction_needed(objects, assessment.site.motions)
    envelopes = _envelopes(assessment, objects)
    blocks = []
    for k, (line, (obj, direction)) in enumerate(zip(lines, objects, strict=True)):
        row = line.row
        factors, rotations = assessment.factors[row], assessment.rotations[row]
        order = np.lexsort((-np.nan_to_num(rotations), np.nan_to_num(factors, nan=np.inf))).tolist()
        motions = [
            {
                "name": assessment.motions[m],
                "factor": float(factors[m]),
                "rotation": float(rotations[m]),
                "friction": float(needed[k, m]),
            }
            for m in order
        ]
        bases = {name: plane.base for name, plane in obj.planes.items()}
        largest = max(bases, key=bases.__getitem__)
        drawn = [direction] if len(bases) > 2 or direction == largest else [direction, largest]
        outlines = [obj.outline(name) for name in drawn]
        width = sum(2.0 * float(np.abs(outline[:, 0]).max()) for outline in outlines)
        scale = DRAWING / max(width, *(float(outline[:, 1].max()) for outline in outlines))
        histories = _histories(assessment, row)
        blocks.append(
            {
                "line": line,
                "plane": obj.planes[direction],
                "drawings": [(name, _drawing(obj, name, scale)) for name in drawn],
                "motions": motions if detailed else motions[:MOST_MOTIONS],
                "friction": float(np.max(needed[k])),
                "other_directions": [] if detailed else lines_of(assessment, directions=True, only=line)[1:],
                "charts": [*(histories if detailed else histories[1:]), *envelopes[k : k + 1]],
            }
        )
    return blocks


def _envelopes(assessment: Assessment, objects: Sequence[tuple[Object, str]]) -> list[Chart]:
    """Thresholds over shapes and periods, of objects and directions; none for records."""
    motions = assessment.site.motions
    highest = STRONGEST * max(motion.peak_acceleration for motion in motions)
    periods, thresholds = envelope_of(objects, motions, highest)
    if not thresholds:
        return []
    axes = (
        Axis("period of the pulse [s]", float(periods[0]), float(periods[-1]), WIDTH, logarithmic=True),
        Axis("peak acceleration [g]", 0.0, highest / STANDARD_GRAVITY, HEIGHT),
    )
    charts = []
    for k in range(len(objects)):
        lines = {
            name: line_of(name, axes, periods, values[k] / STANDARD_GRAVITY, style)
            for style, (name, values) in enumerate(thresholds.items())
        }
        colours: dict[tuple[float, float], str] = {}
        for motion in motions:
            colour = lines[motion.motion.name].colour
            point = motion.period, motion.peak_acceleration / STANDARD_GRAVITY
            is_shared = colours.setdefault(point, colour) != colour
            if is_shared:
                colours[point] = "black"  # of several shapes
        marks = [(float(axes[0].at(t)), -float(axes[1].at(a)), colour) for (t, a), colour in colours.items()]
        title = "Lowest peak acceleration that overturns it; rings: the site"
        charts.append(Chart(title, *axes, [*lines.values()], marks))
    return charts


def _histories(assessment: Assessment, row: int) -> list[Chart]:
    """Ground acceleration and rotation under the worst motion."""
    history = assessment.history(row)
    time = history["time"].values
    limits = math.degrees(history.attrs["alpha"]), math.degrees(history.attrs["alpha_left"])
    rotation = np.degrees(history["rotation"].values)
    overturned = np.flatnonzero(np.abs(rotation) >= 2.0 * max(limits))
    end = float(time[overturned[0]] if overturned.size else time[-1])
    title = f"Rotation under {assessment.worst_motion(row).name.replace('_', ' ')}"
    if assessment.strength(row) < 1.0:
        title += f", {assessment.strength(row):.3g} times the site"
    acceleration = history["ground_acceleration"].values / STANDARD_GRAVITY
    charts = []
    for name, values, label, edges in (
        ("Ground acceleration", acceleration, "acceleration [g]", ()),
        (title, rotation, "rotation [deg]", (limits[0], -limits[1])),
    ):
        drawn = values[time <= end]
        half = 1.1 * max([float(np.abs(drawn).max()), 1e-9, *np.abs(edges)])
        axes = Axis("time [s]", 0.0, end, WIDTH), Axis(label, -half, half, HEIGHT)
        lines = [line_of("", axes, *thinned(time[time <= end], drawn))]
        lines += [line_of("", axes, np.array([0.0, end]), np.full(2, edge), 11) for edge in edges]
        charts.append(Chart(name, *axes, lines, []))
    return charts


def _drawing(obj: Object, direction: str, scale: float) -> dict[str, Any]:
    """Sizes of the drawing of an object from the side [pixels] at a scale [pixels/m], and of its scale bar."""
    plane, outline = obj.planes[direction], obj.outline(direction)
    width = 2.0 * float(max(np.abs(outline[:, 0]).max(), 0.5 * plane.base))
    largest = 35.0 / scale
    unit = 10.0 ** math.floor(math.log10(largest))
    bar = unit * max(m for m in (1, 2, 5) if m * unit <= largest)
    sizes = {"base": plane.base, "width": width, "height": float(outline[:, 1].max()), "centre": plane.mass_height}
    sizes |= {"offset": plane.offset, "bar": bar}
    points = " ".join(f"{x:.1f},{-y:.1f}" for x, y in (scale * outline).tolist())
    return {name: size * scale for name, size in sizes.items()} | {"bar_length": bar, "outline": points}
