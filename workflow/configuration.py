"""Validation of the configuration before the first job: keys, types and ranges.

`workflow/config/schema.yaml` holds them; what one value requires of another is checked here. Every error is one line
that names the key, its value and what is allowed.
"""

import math
import reprlib
import textwrap
from collections.abc import Iterator, Mapping
from itertools import chain, pairwise
from pathlib import Path
from typing import Any

import yaml
from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError

from rocking._base.errors import InvalidArgumentError
from rocking._excitation.pulses import PULSE_NAMES
from rocking._model.fields import DERIVED_FIELDS
from rocking.suites.configuration import suite_configuration
from workflow.pulses import configured_pulse, different
from workflow.scripts.axes import steps_between

SCHEMA = Path(__file__).parent / "config/schema.yaml"
NODES = 200_000_000  # largest number of nodes of a cube, which are in memory together
BYTES = 95  # memory per node while cubes are solved [bytes], measured from 0.5 to 12 million nodes

DATA_OF_FIGURES = {
    "figure-04": ["sine"],
    "figure-09": ["sine", "cosine"],
    "figure-10": ["sine", "cosine"],
    "figure-master-spectra": ["sine", "cosine"],
    "figure-scale-law": ["sine"],
}
"""The pulses of the figures that are drawn from data sets."""

MOTIONS = sorted(path.name for path in Path(__file__).with_name("motions").glob("*.csv"))
DERIVED_NAMES = [field.name for field in DERIVED_FIELDS]


class ConfigurationError(ValueError):
    """An invalid configuration; the message is one line."""


def check(config: Mapping[str, Any], folder: Path = Path()) -> None:
    """Raise an error for a configuration that no run could finish.

    `config`: of data sets, with the figures and claims of the paper or without; or of a suite of records, with the keys
    `title` and `suite`. `folder`: folder of the file of the configuration. Raises `ConfigurationError`: one line for
    the first invalid value: key, value and what is allowed.
    """
    schema = yaml.safe_load(SCHEMA.read_text(encoding="utf-8"))
    for error in Draft202012Validator(schema).iter_errors(config):
        raise ConfigurationError(_line(error))
    conflicts = (
        _suite(config, folder)
        if "suite" in config
        else chain(
            _unordered(config),
            _pulses(config, folder),
            _of_grid(config),
            _too_large(config),
            _of_figures(config) if "figures" in config else (),
        )
    )
    for conflict in conflicts:
        raise ConfigurationError(conflict)


def _line(error: ValidationError) -> str:
    """The line for an error that the schema finds."""
    key, value, rules = ".".join(map(str, error.absolute_path)) or "configuration", error.instance, error.schema
    if isinstance(value, dict):
        allowed = rules.get("properties", {})
        found = [f"unknown key {name}" for name in value if name not in allowed]
        missing = [
            *rules.get("required", ()),
            *chain(*(rules.get("dependentRequired", {}).get(name, ()) for name in value)),
        ]
        found += [f"missing key {name}" for name in missing if name not in value]
        names = textwrap.shorten(", ".join(allowed), 160, placeholder=" ...") or "none"
        return f"{key}: {', '.join(found)}; the keys are {names}"
    required = (
        f"missing key {', '.join(rules['required'])}" if "required" in rules else f"allowed: {rules['description']}"
    )
    return f"{key} = {reprlib.repr(value)}: {required}"


def _unordered(config: Any, key: str = "") -> Iterator[str]:
    """Ranges whose low is not below their high, and numbers that are not finite, which no schema excludes."""
    if isinstance(config, float) and not math.isfinite(config):
        yield f"{key} = {config}: allowed: a finite number"
    items = config if isinstance(config, dict) else dict(enumerate(config)) if isinstance(config, list) else {}
    for name, value in items.items():
        yield from _unordered(value, f"{key}.{name}" if key else name)
    if {"low", "high"} <= {*items} and not config["low"] < config["high"]:
        yield f"{key}: low = {config['low']:g}, high = {config['high']:g}; allowed: low < high"


def _pulses(config: Mapping[str, Any], folder: Path) -> Iterator[str]:
    """Pulses that cannot be made; paths of samples are relative to the folder."""
    made = []
    for k, value in enumerate(config["pulses"]):
        try:
            made.append(configured_pulse(value, folder))
        except InvalidArgumentError as error:
            stated = f" = {value!r}: allowed: {error.allowed}" if isinstance(value, str) else f": {error}"
            yield f"pulses.{k}{stated}"
    try:
        different(made)
    except InvalidArgumentError as error:
        yield f"pulses: {error}"
    for figure, values in config.get("figures", {}).items():
        for section in values.values():
            for name in _listed(section.get("pulses", section.get("pulse", []))):
                if name not in PULSE_NAMES:
                    yield f"figures.{figure}: pulse = {name!r}; allowed: one of {', '.join(PULSE_NAMES)}"


def _of_grid(config: Mapping[str, Any]) -> Iterator[str]:
    """Axes of the data sets that are not in order."""
    grid, etas = config["grid"], config["restitution"]
    rows = grid["slenderness"]
    for key, values in (
        ("restitution", etas),
        ("grid.alpha_deg", grid["alpha_deg"]),
        ("grid.slenderness.breaks", rows["breaks"]),
    ):
        if not all(a < b for a, b in pairwise(values)):
            yield f"{key} = {reprlib.repr(values)}: allowed: 1 to 200 ascending values"
    if 0 not in grid["alpha_deg"]:
        yield f"grid.alpha_deg = {grid['alpha_deg']}: allowed: a list with 0, the slender limit, which figures need"
    for eta in etas:
        if round(eta, 2) != eta:
            yield f"restitution = {reprlib.repr(etas)}: {eta}; allowed: two decimals at most, they name the files"
    for name in grid.get("derived", ()):
        if name not in DERIVED_NAMES:
            yield f"grid.derived = {name!r}: allowed: one of {', '.join(DERIVED_NAMES)}"
    try:
        steps_between(rows["breaks"], rows["steps"])
    except ValueError as error:
        yield f"grid.slenderness: {error}"


def _suite(config: Mapping[str, Any], folder: Path) -> Iterator[str]:
    """Errors of a suite, whose keys `rocking.suites.configuration` describes."""
    try:
        suite = suite_configuration(config["suite"], folder)
        suite.records.paths()
        if not isinstance(suite.blocks, tuple):
            raise InvalidArgumentError("blocks", config["suite"]["blocks"], "bodies with equal edges")
    except InvalidArgumentError as error:
        yield f"suite.{error.parameter} = {reprlib.repr(error.value)}: allowed: {error.allowed}"


def chosen(config: Mapping[str, Any], figure: str) -> dict[str, Any]:
    """All values of a figure, those of the paper and those chosen here."""
    values = config["figures"][figure]
    return {**values.get("paper", {}), **values.get("ours", {})}


def restitutions(config: Mapping[str, Any], figure: str) -> list[float]:
    """The restitutions of a figure as a list, also if there is only one."""
    return _listed(chosen(config, figure)["restitution"])


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [value]


def nodes_of_cube(config: Mapping[str, Any]) -> int:
    """Nodes of the cube of one restitution."""
    return len(config["grid"]["alpha_deg"]) * _rows(config) * int(config["grid"]["frequency_ratio"]["points"])


def _rows(config: Mapping[str, Any]) -> int:
    return 1 + sum(steps_between(**config["grid"]["slenderness"]))


def _too_large(config: Mapping[str, Any]) -> Iterator[str]:
    """Grids that do not fit into memory, from their sizes."""
    grid, nodes = config["grid"], nodes_of_cube(config)
    if nodes > NODES:
        axes = f"{len(grid['alpha_deg'])} alpha_deg x {_rows(config)} slenderness"
        axes += f" x {grid['frequency_ratio']['points']} frequency_ratio"
        needed, most = (f"{count * BYTES / 1e9:.0f} GB" for count in (nodes, NODES))
        yield f"grid = {axes}: {nodes:,} nodes, {needed}; allowed: {NODES:,}, {most}"


def _of_figures(config: Mapping[str, Any]) -> Iterator[str]:
    """Figures that need data which the configuration does not compute, or values that do not go together."""
    for figure, pulses in DATA_OF_FIGURES.items():
        values = chosen(config, figure)
        for pulse in set(pulses) - {entry for entry in config["pulses"] if isinstance(entry, str)}:
            yield f"pulses = {config['pulses']}: {figure} needs {pulse}"
        for name, given, made in (
            ("restitution", restitutions(config, figure), config["restitution"]),
            ("alpha_deg", _listed(values.get("alpha_deg", 0)), config["grid"]["alpha_deg"]),
        ):
            for value in set(given) - set(made):
                yield f"figures.{figure}: {name} = {value}; allowed: {made}, of which there are data"
    for figure in ("figure-scale-law", "figure-scale-law-excitations"):
        law = chosen(config, figure)
        if law["reference"] not in law["restitution"]:
            yield f"figures.{figure}: reference = {law['reference']}; allowed: one of its {law['restitution']}"
        for name in set(law.get("records", ())) - set(MOTIONS):
            yield f"figures.{figure}: records = {name!r}; allowed: a file of workflow/motions, {', '.join(MOTIONS)}"
    for figure in ("figure-05", "figure-06"):
        blocks = chosen(config, figure)
        if len(blocks["slenderness_angle"]) != len(blocks["half_diagonal"]):
            yield f"figures.{figure}: slenderness_angle and half_diagonal; allowed: one of each for every block"
