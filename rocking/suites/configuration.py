"""Configuration of a suite of records: which files, blocks, levels and limit states.

A configuration is a mapping, as read from a file; `docs/fragility.md` lists its keys. Those with a default may be left
out: `DEFAULTS`, and `LAYOUT`, that of the files of the records.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking._base.arrays import Array
from rocking._base.equality import EqualByValue
from rocking._base.errors import InvalidArgumentError, in_range, number, one_of, positive
from rocking._base.quantities import RESTITUTION
from rocking._excitation.records.readers.layout import stated_layout
from rocking._excitation.records.readers.read_record import FORMATS, parse_record, read_content
from rocking._excitation.records.record import Record
from rocking._model.block import AbstractBlock, RectangularBlock
from rocking._model.body import AbstractBody
from rocking.suites.checks import check_demands
from rocking.suites.intensity import MEASURES

if TYPE_CHECKING:  # it needs numba, which the rules of a workflow do not
    from rocking._dimensional.rigid_body import RigidBody

DEFAULTS: dict[str, Any] = {
    "restitution": "momentum",
    "demand": ["overturning"],
    "confidence": 0.95,
    "map": None,
    "sensitivity": None,
}

LAYOUT: dict[str, Any] = {
    "format": None,
    "acceleration": None,
    "time": None,
    "time_step": None,
    "time_unit": None,
    "unit": None,
    "skip": 0,
    "delimiter": None,
    "decimal": ".",
    "wrapped": False,
    "vertical": None,
    "allow_unusual": False,
}
"""Layout of the files of the records, in the section `records`: the arguments of `rocking.read_record`."""

MAX_POINTS = 10_000  # most levels, and most points of one axis of the map
MAX_CELLS = 1_000_000  # most points of the map


@dataclass(frozen=True)
class RecordFiles:
    """Folder of the records and the layout of their files: the keys of `docs/fragility.md`."""

    folder: Path
    pattern: str
    layout: Mapping[str, Any]
    baseline_order: int | None

    def paths(self) -> list[Path]:
        """Return the files, at least one, in the order of their names."""
        try:
            paths = sorted(path for path in self.folder.glob(self.pattern) if path.is_file())
        except (NotImplementedError, ValueError):  # the pattern is a path from the root, or empty
            paths = []
        if not paths:
            raise InvalidArgumentError(
                "records",
                f"{self.folder}/{self.pattern}",
                "a folder, relative to the file of the configuration, and a pattern of its files: there is none",
            )
        return paths

    def read(self, path: Path) -> Record:
        """Read the motion of a file, corrected if an order is given; its name is that of the file without suffix."""
        motion = parse_record(  # read_record would take a file of the name `vertical` in the working directory
            read_content("path", path),
            path.name,
            **self.layout,
        )
        corrected = motion.baseline_corrected(order=self.baseline_order)
        return Record(
            corrected.acceleration,
            corrected.time_step,
            "m/s2",
            name=path.stem,
            source=corrected.source,
            remarks=corrected.remarks,
            vertical=corrected.vertical,
        )


@dataclass(frozen=True, eq=False)
class BlockMap(EqualByValue):
    """Grid of sizes and shapes at one level of intensity."""

    intensity: float  # the level, in the unit of the measure
    half_diagonal: Array  # R [m], ascending
    alpha: Array  # slenderness angles [rad], ascending


@dataclass(frozen=True, eq=False)
class Sensitivity(EqualByValue):
    """Arguments of `rocking.suites.suite_sensitivity`."""

    intensity: Array  # levels, ascending, in the unit of the measure
    restitution_step: float  # change of the coefficient of restitution [-]


@dataclass(frozen=True, eq=False)
class SuiteConfiguration(EqualByValue):
    """A checked configuration, in SI units."""

    name: str
    records: RecordFiles
    blocks: tuple[AbstractBlock, ...] | RigidBody
    restitution: str | float
    measure: str
    intensity: Array
    demand: tuple[str | float, ...]
    confidence: float
    map: BlockMap | None
    sensitivity: Sensitivity | None

    def motions(self) -> list[Record]:
        """Read the motions of all files, in the order of their names."""
        return [self.records.read(path) for path in self.records.paths()]


def suite_configuration(configuration: Mapping[str, Any], folder: Path) -> SuiteConfiguration:
    """Check a configuration as described above; `records.folder` is relative to `folder`, that of its file.

    Raises `InvalidArgumentError` for the first key that is missing, unknown or has an invalid value; `parameter` is the
    key, such as `map.alpha_deg`.
    """
    values = _with_defaults(configuration, DEFAULTS)
    _keys("suite", values, SuiteConfiguration.__annotations__)
    measure = one_of("measure", values["measure"], MEASURES)
    blocks = _blocks(values["blocks"])
    if values["sensitivity"] is not None and not isinstance(blocks, tuple):
        raise InvalidArgumentError("sensitivity", values["sensitivity"], "null beside a body with two different edges")
    restitution = values["restitution"]
    if restitution != "momentum":
        restitution = RESTITUTION.number(restitution)
    return SuiteConfiguration(
        name=str(values["name"]),
        records=_record_files(values["records"], folder),
        blocks=blocks,
        restitution=restitution,
        measure=measure,
        intensity=_levels("intensity", values["intensity"], logarithmic=True),
        demand=tuple(check_demands(values["demand"])),
        confidence=number("confidence", values["confidence"], 0.0, 1.0, closed="neither"),
        map=None if values["map"] is None else _map(values["map"]),
        sensitivity=None if values["sensitivity"] is None else _sensitivity(values["sensitivity"]),
    )


def _with_defaults(section: Any, defaults: Mapping[str, Any]) -> Any:
    return {**defaults, **section} if isinstance(section, Mapping) else section


def _keys(name: str, section: Any, keys: Iterable[str]) -> None:
    """Refuse a section with a missing or an unknown key."""
    expected = list(keys)
    if not isinstance(section, Mapping):
        raise InvalidArgumentError(name, section, "a mapping with the keys " + ", ".join(expected))
    if {*section} != {*expected}:
        wrong = [f"no {key}" for key in expected if key not in section]
        wrong += [f"unknown {key}" for key in section if key not in expected]
        raise InvalidArgumentError(name, ", ".join(wrong), "exactly the keys " + ", ".join(expected))


def _record_files(section: Any, folder: Path) -> RecordFiles:
    values = _with_defaults(section, LAYOUT | {"baseline_order": None})
    _keys("records", values, ("folder", "pattern", *LAYOUT, "baseline_order"))
    layout = {name: values[name] for name in LAYOUT}
    columns = {name: value for name, value in layout.items() if name not in ("vertical", "allow_unusual")}
    try:
        stated_layout(FORMATS, **columns)
    except InvalidArgumentError as error:
        raise InvalidArgumentError(f"records.{error.parameter}", error.value, error.allowed) from None
    return RecordFiles(folder / str(values["folder"]), str(values["pattern"]), layout, values["baseline_order"])


def _blocks(values: Any) -> tuple[AbstractBlock, ...] | RigidBody:
    if not isinstance(values, list) or not values:
        raise InvalidArgumentError("blocks", values, "a list of bodies, such as their width and height [m]")
    bodies = [_block(f"blocks[{index}]", value) for index, value in enumerate(values)]
    rectangles = tuple(body for body in bodies if isinstance(body, RectangularBlock))
    if len(rectangles) == len(bodies):
        return rectangles
    from rocking.suites.body_arrays import as_blocks  # noqa: PLC0415  (as below)

    return as_blocks(bodies)


def _block(key: str, value: Any) -> AbstractBody:
    """Return a body from its parameters, or from a text such as `hollow(width=40cm, ...)`."""
    if isinstance(value, Mapping) and value.keys() == {"width", "height"}:
        width = positive(f"{key}.width", value["width"], "m")
        return RectangularBlock(width, positive(f"{key}.height", value["height"], "m"))
    # others need numba, which the rules of a workflow do not
    from rocking._dimensional.block import Block  # noqa: PLC0415
    from rocking._dimensional.body_kinds import body  # noqa: PLC0415

    try:
        solid = body(value)
    except InvalidArgumentError as error:
        parameter = key if error.parameter == "body" else f"{key}.{error.parameter}"
        raise InvalidArgumentError(parameter, error.value, error.allowed) from None
    return RectangularBlock(solid.width, solid.height, solid.gravity) if isinstance(solid, Block) else solid


def _levels(parameter: str, values: Any, *, logarithmic: bool) -> Array:
    """Return levels from a list of values, or from `points` values from `low` to `high`."""
    if not isinstance(values, Mapping):
        levels = np.atleast_1d(in_range(parameter, values, 0.0, math.inf, closed="neither"))
        if levels.ndim != 1 or not 1 <= levels.size <= MAX_POINTS or not np.all(np.diff(levels) > 0.0):
            raise InvalidArgumentError(parameter, values, f"1 to {MAX_POINTS} ascending values")
        return levels
    _keys(parameter, values, ("low", "high", "points"))
    low = positive(f"{parameter}.low", values["low"], "-")
    high = number(f"{parameter}.high", values["high"], low, math.inf, closed="neither")
    points = values["points"]
    if type(points) is not int or not 2 <= points <= MAX_POINTS:
        raise InvalidArgumentError(f"{parameter}.points", points, f"an integer from 2 to {MAX_POINTS}")
    # rounded so that the values in files are short, and equal on every machine
    spaced = np.geomspace(low, high, points) if logarithmic else np.linspace(low, high, points)
    return np.array([float(f"{value:.12g}") for value in spaced])


def _map(section: Any) -> BlockMap:
    _keys("map", section, ("intensity", "half_diagonal", "alpha_deg"))
    angles = _levels("map.alpha_deg", section["alpha_deg"], logarithmic=False)
    in_range("map.alpha_deg", angles, 0.0, 89.0, closed="right", unit="deg")
    sizes = _levels("map.half_diagonal", section["half_diagonal"], logarithmic=False)
    if sizes.size * angles.size > MAX_CELLS:
        raise InvalidArgumentError("map", f"{sizes.size} times {angles.size} points", f"at most {MAX_CELLS} points")
    return BlockMap(positive("map.intensity", section["intensity"], "-"), sizes, np.radians(angles))


def _sensitivity(section: Any) -> Sensitivity:
    _keys("sensitivity", section, Sensitivity.__annotations__)
    return Sensitivity(
        _levels("sensitivity.intensity", section["intensity"], logarithmic=True),
        number("sensitivity.restitution_step", section["restitution_step"], 0.0, 1.0, closed="right"),
    )
