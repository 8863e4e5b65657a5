"""The report of an assessment: one HTML file without requests to others, which prints on A4 with page numbers."""

from __future__ import annotations

import math
import platform
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import metadata, resources
from typing import Any

import numpy as np

from rocking.extension import STANDARD_GRAVITY, BadRow, __version__
from rocking_assessment._objects.charts import HEIGHT, WIDTH, Axis, Chart, line_of, thinned
from rocking_assessment._objects.columns import CLAUSES, VERDICTS
from rocking_assessment._objects.motions import envelope_of, frictions_of
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
    found: Assessment, project: Project, bad_rows: Sequence[BadRow] = (), reading: str = "", *, detailed: bool = False
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
    lines = lines_of(found)
    concerned = [one for one in lines if detailed or one.concerns][:MOST_DETAILED]
    chosen = [
        one for line in concerned for one in (lines_of(found, directions=True, only=line) if detailed else [line])
    ]
    numbers: dict[int, int] = {}  # of an object in the part on objects, by its first row
    for line in chosen:
        numbers.setdefault(line.rows[0], len(numbers) + 1)
    return template.render(
        project=project,
        site=found.site,
        found=found,
        lines=lines,
        clauses=CLAUSES,
        counts={verdict: sum(one.values["verdict"] == verdict for one in lines) for verdict in reversed(VERDICTS)},
        full_strength=counts_of(lines),
        worst=_worst(lines),
        blocks=_blocks(found, chosen, detailed),
        all_concerned=sum(one.concerns for one in lines),
        detailed=detailed,
        numbers=numbers,
        motions=_motion_texts(found.site),
        warnings=[(text, len(names), names_in_short(names)) for text, names in warnings_of(found)],
        colours=dict(zip(VERDICTS, COLOURS, strict=True)),
        bad_rows=bad_rows,
        reading=reading,
        versions={"rocking": __version__, "Python": platform.python_version()}
        | {name: metadata.version(name) for name in ("numpy", "numba", "scipy")},
    )


def css_text(text: str) -> str:
    """A text between the quotes of a style sheet."""
    return "".join(one if one.isascii() and one.isalnum() else f"\\{ord(one):x} " for one in text)


def _motion_texts(site: Site) -> list[str]:
    """The motions of the site in words: records, shapes on a floor, or shapes with their periods."""
    if site.records:
        texts = []
        for motions in _by_group(site.motions):
            first = motions[0].name.removesuffix(", 0 deg")
            texts.append(
                first if len(motions) == 1 else f"{first}, a pair at angles every {180 // len(motions)} degrees"
            )
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


def _by_group(motions: Sequence[Motion]) -> list[list[Motion]]:
    """The motions of each group, those of a pair of components together."""
    groups: dict[int, list[Motion]] = {}
    for motion in motions:
        groups.setdefault(motion.group, []).append(motion)
    return list(groups.values())


def _worst(lines: Sequence[Line]) -> list[dict[str, Any]]:
    """The worst objects with their drawings, which have one scale."""
    chosen = lines[:WORST]
    outlines = [one.object.outline(one.values["direction"]) for one in chosen]
    sizes = [(2.0 * np.abs(outline[:, 0]).max(), outline[:, 1].max()) for outline in outlines]
    scale = min(room / max(size) for room, size in zip(LARGEST, zip(*sizes, strict=True), strict=True))
    return [{"line": one, "drawing": _drawing(one.object, one.values["direction"], scale)} for one in chosen]


def _blocks(found: Assessment, chosen: Sequence[Line], detailed: bool) -> list[dict[str, Any]]:
    """The contents of the report for some rows."""
    given = [(one.object, str(one.values["direction"])) for one in chosen]
    if not given:
        return []
    needed, exceeded = frictions_of(given, found.site.motions)
    envelopes = _envelopes(found, given)
    blocks = []
    for k, (line, (one, direction)) in enumerate(zip(chosen, given, strict=True)):
        row = line.row
        names = "name", "ground", "period", "factor", "rotation", "friction", "exceeded_at"
        motions = [
            dict(zip(names, (motion.name, motion.ground, motion.period, *values), strict=True))
            | {"is_record": motion.motion.is_scanned}
            for motion, *values in zip(
                *(found.site.motions, found.factors[row].tolist(), found.rotations[row].tolist()),
                *(needed[k].tolist(), exceeded[k].tolist()),
                strict=True,
            )
        ]
        order = np.lexsort((-np.nan_to_num(found.rotations[row]), np.nan_to_num(found.factors[row], nan=np.inf)))
        largest = max((each for each in one.planes), key=lambda each: one.planes[each].base)
        drawn = [direction] if len(one.planes) > 2 or direction == largest else [direction, largest]
        outlines = [one.outline(each) for each in drawn]
        wide = sum(2.0 * float(np.abs(outline[:, 0]).max()) for outline in outlines)
        scale = DRAWING / max(wide, *(float(outline[:, 1].max()) for outline in outlines))
        histories = _histories(found, row)
        blocks.append(
            {
                "line": line,
                "plane": one.planes[direction],
                "drawings": [(each, _drawing(one, each, scale)) for each in drawn],
                "motions": [motions[m] for m in order[: None if detailed else MOST_MOTIONS]],
                "friction": float(np.max(needed[k])),
                "others": [] if detailed else lines_of(found, directions=True, only=line)[1:],
                "charts": [*(histories if detailed else histories[1:]), *envelopes[k : k + 1]],
                "worst": found.worst_motion(row),
                "strength": found.strength(row),
            }
        )
    return blocks


def _envelopes(found: Assessment, given: Sequence[tuple[Object, str]]) -> list[Chart]:
    """Thresholds over shapes and periods, of objects and directions; none for records."""
    motions = found.site.motions
    top = STRONGEST * max(motion.peak_acceleration for motion in motions)
    periods, lowest = envelope_of(given, motions, top)
    top, lowest = top / STANDARD_GRAVITY, {name: values / STANDARD_GRAVITY for name, values in lowest.items()}
    charts = []
    for k in range(len(given) if lowest else 0):
        axes = (
            Axis("period of the pulse [s]", float(periods[0]), float(periods[-1]), WIDTH, logarithmic=True),
            Axis("peak acceleration [g]", 0.0, top, HEIGHT),
        )
        lines = [line_of(name, axes, periods, values[k], style) for style, (name, values) in enumerate(lowest.items())]
        colours: dict[tuple[float, float], str] = {}
        for motion in motions:
            place, own = (
                (motion.period, motion.peak_acceleration / STANDARD_GRAVITY),
                lines[list(lowest).index(motion.motion.name)].colour,
            )
            colours[place] = "black" if colours.get(place, own) != own else own  # of several shapes
        marked = [(float(axes[0].at(t)), -float(axes[1].at(a)), colour) for (t, a), colour in colours.items()]
        charts.append(Chart("Lowest peak acceleration that overturns it; rings: the site", *axes, lines, marked))
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
    strength = f", {found.strength(k):.3g} times the site" if found.strength(k) < 1.0 else ""
    charts = []
    for title, values, label in (
        ("Ground acceleration", history["ground_acceleration"].values / STANDARD_GRAVITY, "acceleration [g]"),
        (f"Rotation under {found.worst_motion(k).name.replace('_', ' ')}{strength}", rotation, "rotation [deg]"),
    ):
        shown = values[time <= end]
        half = 1.1 * max(float(np.abs(shown).max()), 1e-9)
        edges = [limits[0], -limits[1]] if values is rotation else []
        half = max([half, *(1.1 * abs(edge) for edge in edges)])
        axes = Axis("time [s]", 0.0, end, WIDTH), Axis(label, -half, half, HEIGHT)
        lines = [line_of("", axes, *thinned(time[time <= end], shown))]
        lines += [line_of("", axes, np.array([0.0, end]), np.full(2, edge), 11) for edge in edges]
        charts.append(Chart(title, *axes, lines, []))
    return charts


def _drawing(one: Object, direction: str, scale: float) -> dict[str, Any]:
    """Sizes of the drawing of an object from the side [pixels] at a scale [pixels/m], and of its scale bar."""
    plane, outline = one.planes[direction], one.outline(direction)
    width = 2.0 * float(max(np.abs(outline[:, 0]).max(), 0.5 * plane.base))
    largest = 35.0 / scale
    unit = 10.0 ** math.floor(math.log10(largest))
    bar = unit * max(m for m in (1, 2, 5) if m * unit <= largest)
    sizes = {"base": plane.base, "width": width, "height": float(outline[:, 1].max()), "centre": plane.mass_height}
    sizes |= {"offset": plane.offset, "bar": bar}
    points = " ".join(f"{x:.1f},{-y:.1f}" for x, y in (scale * outline).tolist())
    return {name: size * scale for name, size in sizes.items()} | {"bar_length": bar, "outline": points}
