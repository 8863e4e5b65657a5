"""What no schema can say of a configuration: order, sizes, and what one value requires of another.

`workflow/config/schema.yaml` holds keys, types and ranges. Every error is one line: key, value and what is allowed.
"""

import reprlib
from collections.abc import Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

from rocking._base.errors import InvalidArgumentError
from rocking.suites.configuration import suite_configuration
from workflow.pulses import configured_pulse, different
from workflow.scripts.axes import steps_between

NODES = 200_000_000  # largest number of nodes of a cube, which are in memory together
BYTES = 95  # memory per node while cubes are solved [bytes], measured from 0.5 to 12 million nodes


class ConfigurationError(ValueError):
    """An invalid configuration; the message is one line."""


def check(config: Mapping[str, Any], folder: Path = Path()) -> None:
    """Raise `ConfigurationError` for a configuration that fits the schema and that no run could finish.

    `config`: of data sets, with the figures and claims of the paper or without; or of a suite of records, with the keys
    `title` and `suite`. `folder`: folder of the file of the configuration.
    """
    for conflict in _conflicts(config, folder):
        raise ConfigurationError(conflict)


def _conflicts(config: Mapping[str, Any], folder: Path) -> Iterator[str]:
    if "suite" in config:
        yield from _of_suite(config["suite"], folder)
        return
    yield from _unordered(config)
    yield from _of_pulses(config["pulses"], folder)
    yield from _of_grid(config)
    if "figures" in config:
        yield from _of_figures(config)


def _unordered(config: Any, key: str = "") -> Iterator[str]:
    """Ranges whose low is not below their high."""
    items = dict(enumerate(config)) if isinstance(config, list) else config
    if not isinstance(items, dict):
        return
    for name, value in items.items():
        yield from _unordered(value, f"{key}.{name}" if key else name)
    if {"low", "high"} <= items.keys() and not items["low"] < items["high"]:
        yield f"{key}: low = {items['low']:g}, high = {items['high']:g}; allowed: low < high"


def _of_pulses(entries: list[Any], folder: Path) -> Iterator[str]:
    """Pulses that cannot be made; paths of samples are relative to the folder."""
    pulses = []
    for k, entry in enumerate(entries):
        try:
            pulses.append(configured_pulse(entry, folder))
        except InvalidArgumentError as error:
            yield f"pulses.{k}: {error}"
    try:
        different(pulses)
    except InvalidArgumentError as error:
        yield f"pulses: {error}"


def _of_grid(config: Mapping[str, Any]) -> Iterator[str]:
    """Axes of the data sets that are not in order, or too long for the memory."""
    grid, etas = config["grid"], config["restitution"]
    axes = {
        "restitution": etas,
        "grid.alpha_deg": grid["alpha_deg"],
        "grid.slenderness.breaks": grid["slenderness"]["breaks"],
    }
    for key, values in axes.items():
        if not all(a < b for a, b in pairwise(values)):
            yield f"{key} = {reprlib.repr(values)}: allowed: ascending values"
    for eta in etas:
        if round(eta, 2) != eta:
            yield f"restitution = {reprlib.repr(etas)}: {eta}; allowed: two decimals at most, they name the files"
    try:
        nodes = nodes_of_cube(config)
    except ValueError as error:
        yield f"grid.slenderness: {error}"
        return
    if nodes > NODES:
        yield f"grid: {nodes:,} nodes, {nodes * BYTES / 1e9:.0f} GB; allowed: {NODES:,}, {NODES * BYTES / 1e9:.0f} GB"


def _of_suite(suite: Mapping[str, Any], folder: Path) -> Iterator[str]:
    """Values of a suite that its functions refuse."""
    try:
        converted = suite_configuration(suite, folder)
        converted.records.paths()
        if not isinstance(converted.blocks, tuple):
            raise InvalidArgumentError("blocks", suite["blocks"], "bodies with equal edges")
    except InvalidArgumentError as error:
        yield f"suite.{error.parameter} = {reprlib.repr(error.value)}: allowed: {error.allowed}"


def _of_figures(config: Mapping[str, Any]) -> Iterator[str]:
    """Figures that need angles which the configuration does not compute, or values that do not go together.

    Snakemake names missing files of a pulse or a restitution.
    """
    angles = config["grid"]["alpha_deg"]
    for figure in ("figure-09", "figure-10", "figure-master-spectra"):
        for angle in set(_listed(chosen(config, figure)["alpha_deg"])) - set(angles):
            yield f"figures.{figure}: alpha_deg = {angle}; allowed: {angles}, of which there are data"
    for figure in ("figure-scale-law", "figure-scale-law-excitations"):
        law = chosen(config, figure)
        if law["reference"] not in law["restitution"]:
            yield f"figures.{figure}: reference = {law['reference']}; allowed: one of its {law['restitution']}"


def chosen(config: Mapping[str, Any], figure: str) -> dict[str, Any]:
    """All values of a figure, those of the paper and those chosen here."""
    values = config["figures"][figure]
    return {**values.get("paper", {}), **values.get("ours", {})}


def restitutions(config: Mapping[str, Any], figure: str) -> list[float]:
    """The restitutions of a figure as a list, also if there is only one."""
    return _listed(chosen(config, figure)["restitution"])


def nodes_of_cube(config: Mapping[str, Any]) -> int:
    """Nodes of the cube of one restitution; `ValueError` as `steps_between`."""
    grid = config["grid"]
    rows = 1 + sum(steps_between(**grid["slenderness"]))
    return len(grid["alpha_deg"]) * rows * int(grid["frequency_ratio"]["points"])


def _listed(value: Any) -> list[Any]:
    if isinstance(value, list):
        return value
    return [value]
