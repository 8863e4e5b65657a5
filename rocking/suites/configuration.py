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
        """The files, at least one, in the order of their names."""
        found = sorted(path for path in self.folder.glob(self.pattern) if path.is_file()) if self.pattern else []
        if not found:
            raise InvalidArgumentError(
                "records",
                f"{self.folder}/{self.pattern}",
                "a folder, relative to the file of the configuration, and a pattern of its files: there is none",
            )
        return found

    def read(self, path: Path) -> Record:
        """The motion of a file, without its baseline if an order is given; named after the file, without its suffix."""
        motion = parse_record(  # read_record would take a file of the name `vertical` in the working directory
            read_content("path", path),
            path.name,
            **self.layout,
        )
        corrected = motion.baseline_corrected(order=self.baseline_order)
        about = path.stem, corrected.source, corrected.remarks
        return Record(corrected.acceleration, corrected.time_step, "m/s2", *about, vertical=corrected.vertical)


@dataclass(frozen=True, eq=False)
class BlockMap(EqualByValue):
    """Grid of sizes and shapes at one level of intensity."""

    intensity: float  # the level, in the unit of the measure
    half_diagonal: Array  # R [m], ascending
    alpha: Array  # slenderness angles [rad], ascending


@dataclass(frozen=True, eq=False)
class Sensitivity(EqualByValue):
    """What `rocking.suites.suite_sensitivity` is asked for."""

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
        """The motions of all files, in the order of their names."""
        return [self.records.read(path) for path in self.records.paths()]


def suite_configuration(given: Mapping[str, Any], folder: Path) -> SuiteConfiguration:
    """Check a configuration as described above; `records.folder` is relative to `folder`, that of its file.

    Raises `InvalidArgumentError` for the first key that is missing, unknown or has an invalid value; `parameter` is the
    key, such as `map.alpha_deg`.
    """
    given = _with_defaults(given, DEFAULTS)
    _keys("suite", given, SuiteConfiguration.__annotations__)
    measure = one_of("measure", given["measure"], MEASURES)
    blocks = _blocks(given["blocks"])
    if given["sensitivity"] is not None and not isinstance(blocks, tuple):
        raise InvalidArgumentError("sensitivity", given["sensitivity"], "null beside a body with two different edges")
    return SuiteConfiguration(
        name=str(given["name"]),
        records=_record_files(given["records"], folder),
        blocks=blocks,
        restitution="momentum" if given["restitution"] == "momentum" else RESTITUTION.number(given["restitution"]),
        measure=measure,
        intensity=_levels("intensity", given["intensity"], logarithmic=True),
        demand=tuple(check_demands(given["demand"])),
        confidence=number("confidence", given["confidence"], 0.0, 1.0, closed="neither"),
        map=None if given["map"] is None else _map(given["map"]),
        sensitivity=None if given["sensitivity"] is None else _sensitivity(given["sensitivity"]),
    )


def _with_defaults(given: Any, defaults: Mapping[str, Any]) -> Any:
    return {**defaults, **given} if isinstance(given, Mapping) else given


def _keys(section: str, given: Any, keys: Iterable[str]) -> None:
    """Refuse a section with a missing or an unknown key."""
    expected = list(keys)
    if not isinstance(given, Mapping):
        raise InvalidArgumentError(section, given, "a mapping with the keys " + ", ".join(expected))
    if {*given} != {*expected}:
        wrong = [f"no {key}" for key in expected if key not in given]
        wrong += [f"unknown {key}" for key in given if key not in expected]
        raise InvalidArgumentError(section, ", ".join(wrong), "exactly the keys " + ", ".join(expected))


def _record_files(given: Any, folder: Path) -> RecordFiles:
    given = _with_defaults(given, LAYOUT | {"baseline_order": None})
    _keys("records", given, ("folder", "pattern", *LAYOUT, "baseline_order"))
    layout = {name: given[name] for name in LAYOUT}
    try:
        stated_layout(FORMATS, **{name: layout[name] for name in LAYOUT if name not in ("vertical", "allow_unusual")})
    except InvalidArgumentError as error:
        raise InvalidArgumentError(f"records.{error.parameter}", error.value, error.allowed) from None
    return RecordFiles(folder / str(given["folder"]), str(given["pattern"]), layout, given["baseline_order"])


def _blocks(given: Any) -> tuple[AbstractBlock, ...] | RigidBody:
    if not isinstance(given, list) or not given:
        raise InvalidArgumentError("blocks", given, "a list of bodies, such as their width and height [m]")
    made = [_block(f"blocks[{place}]", item) for place, item in enumerate(given)]
    rectangles = tuple(one for one in made if isinstance(one, RectangularBlock))
    if len(rectangles) == len(made):
        return rectangles
    from rocking.suites.body_arrays import as_blocks  # noqa: PLC0415  (as below)

    return as_blocks(made)


def _block(section: str, given: Any) -> AbstractBody:
    """A body from its parameters, or from a text such as `hollow(width=40cm, ...)`."""
    if isinstance(given, Mapping) and given.keys() == {"width", "height"}:
        return RectangularBlock(*(positive(f"{section}.{key}", given[key], "m") for key in ("width", "height")))
    # others need numba, which the rules of a workflow do not
    from rocking._dimensional.block import Block  # noqa: PLC0415
    from rocking._dimensional.body_kinds import body  # noqa: PLC0415

    try:
        made = body(given)
    except InvalidArgumentError as error:
        place = section if error.parameter == "body" else f"{section}.{error.parameter}"
        raise InvalidArgumentError(place, error.value, error.allowed) from None
    return RectangularBlock(made.width, made.height, made.gravity) if isinstance(made, Block) else made


def _levels(parameter: str, given: Any, *, logarithmic: bool) -> Array:
    """A list of values, or `points` values from `low` to `high`."""
    if not isinstance(given, Mapping):
        levels = np.atleast_1d(in_range(parameter, given, 0.0, math.inf, closed="neither"))
        if levels.ndim != 1 or not 1 <= levels.size <= MAX_POINTS or not np.all(np.diff(levels) > 0.0):
            raise InvalidArgumentError(parameter, given, f"1 to {MAX_POINTS} ascending values")
        return levels
    _keys(parameter, given, ("low", "high", "points"))
    low = positive(f"{parameter}.low", given["low"], "-")
    high = number(f"{parameter}.high", given["high"], low, math.inf, closed="neither")
    points = given["points"]
    if type(points) is not int or not 2 <= points <= MAX_POINTS:
        raise InvalidArgumentError(f"{parameter}.points", points, f"an integer from 2 to {MAX_POINTS}")
    # rounded so that the values in files are short, and equal on every machine
    spaced = np.geomspace(low, high, points) if logarithmic else np.linspace(low, high, points)
    return np.array([float(f"{value:.12g}") for value in spaced])


def _map(given: Any) -> BlockMap:
    _keys("map", given, ("intensity", "half_diagonal", "alpha_deg"))
    angles = _levels("map.alpha_deg", given["alpha_deg"], logarithmic=False)
    in_range("map.alpha_deg", angles, 0.0, 89.0, closed="right", unit="deg")
    sizes = _levels("map.half_diagonal", given["half_diagonal"], logarithmic=False)
    if sizes.size * angles.size > MAX_CELLS:
        raise InvalidArgumentError("map", f"{sizes.size} times {angles.size} points", f"at most {MAX_CELLS} points")
    return BlockMap(positive("map.intensity", given["intensity"], "-"), sizes, np.radians(angles))


def _sensitivity(given: Any) -> Sensitivity:
    _keys("sensitivity", given, Sensitivity.__annotations__)
    return Sensitivity(
        _levels("sensitivity.intensity", given["intensity"], logarithmic=True),
        number("sensitivity.restitution_step", given["restitution_step"], 0.0, 1.0, closed="right"),
    )
