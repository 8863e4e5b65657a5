"""Validation of the configuration before the first job: keys, types and ranges.

Every error is one line that names the key, its value and what is allowed.
"""

import reprlib
from collections.abc import Callable, Iterator, Mapping
from itertools import chain, pairwise
from pathlib import Path
from typing import Annotated, Any

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    PlainValidator,
    ValidationError,
    ValidationInfo,
    create_model,
    model_validator,
)

from rocking._base.errors import InvalidArgumentError
from rocking._excitation.pulses import PULSE_NAMES
from rocking._model.fields import DERIVED_FIELDS
from rocking.suites.configuration import suite_configuration
from workflow.pulses import configured_pulse, different
from workflow.scripts.axes import steps_between

NODES = 200_000_000  # largest number of nodes of the cubes of a tenth of the restitution, which are in memory together
BYTES = 95  # memory per node while cubes are solved [bytes], measured from 0.5 to 12 million nodes

DATA_OF_FIGURES = {
    "figure-04": ["sine"],
    "figure-09": ["sine", "cosine"],
    "figure-10": ["sine", "cosine"],
    "figure-master-spectra": ["sine", "cosine"],
    "figure-scale-law": ["sine"],
}
"""The pulses of the figures that are drawn from data sets."""


class ConfigurationError(ValueError):
    """An invalid configuration; the message is one line."""


class Section(BaseModel):
    """A mapping with exactly the keys of its fields."""

    model_config = ConfigDict(frozen=True)

    @model_validator(mode="before")
    @classmethod
    def _keys(cls, given: Any) -> Any:
        """Raise an error unless the keys are the fields, of which some may be missing."""
        keys, fields = set(given if isinstance(given, dict) else ()), cls.model_fields
        found = [f"unknown key {key}" for key in sorted(map(str, keys - set(fields)))]
        found += [f"missing key {key}" for key in sorted(fields) if fields[key].is_required() and key not in keys]
        if found:
            raise ValueError(f"{', '.join(found)}; the keys are {', '.join(cls.model_fields) or 'none'}")
        return given


def section(optional: Mapping[str, Any] | None = None, **fields: Any) -> Any:
    """A `Section` with these keys and types of values; `optional` ones may be missing."""
    kinds = {name: (kind, ...) for name, kind in fields.items()} | {
        name: (kind, None) for name, kind in (optional or {}).items()
    }
    return create_model("Section", __base__=Section, **kinds)


def leaf(allowed: str, accepts: Callable[[Any], bool]) -> Any:
    """A value for which `accepts` is true; `allowed` is the description of such values."""

    def check(value: Any) -> Any:
        if not accepts(value):
            raise ValueError(f"allowed: {allowed}")
        return value

    return Annotated[Any, PlainValidator(check)]


def number(low: float, high: float, *, zero: bool = False) -> Any:
    """A finite number in [low, high], or also 0."""

    def accepts(value: Any) -> bool:
        return type(value) in (int, float) and (low <= value <= high or (zero and value == 0))

    return leaf(f"a number from {low:g} to {high:g}{', or 0' if zero else ''}", accepts)


def integer(low: int, high: int) -> Any:
    """A whole number in [low, high]."""
    return leaf(f"a whole number from {low} to {high}", lambda value: type(value) is int and low <= value <= high)


def several(item: Any, least: int = 1, most: int = 200, *, ascending: bool = False) -> Any:
    """A list of different values."""

    def check(values: list[Any]) -> list[Any]:
        in_order = all(a < b for a, b in pairwise(values)) if ascending else len(set(values)) == len(values)
        if not in_order or not least <= len(values) <= most:
            count = f"{least}" if least == most else f"{least} to {most}"
            raise ValueError(f"allowed: {count} {'ascending' if ascending else 'different'} values")
        return values

    return Annotated[list[item], AfterValidator(check)]


# Sections are created from tables: their types are known to pydantic, but not to a type checker.
def _rising(limits: Any) -> Any:
    if not limits.low < limits.high:
        raise ValueError(f"low = {limits.low:g}, high = {limits.high:g}; allowed: low < high")
    return limits


def _whole_steps(stretches: Any) -> Any:
    steps_between(stretches.breaks, stretches.steps)
    return stretches


def _two_decimals(etas: list[float]) -> list[float]:
    for eta in etas:
        if round(eta, 2) != eta:
            raise ValueError(f"{eta}; allowed: two decimals at most, they name the files")
    return etas


def _with_slender_limit(angles: list[float]) -> list[float]:
    if 0 not in angles:
        raise ValueError("allowed: a list with 0, the slender limit, which figures and claims need")
    return angles


def _pairs(blocks: Any) -> Any:
    if len(blocks.slenderness_angle) != len(blocks.half_diagonal):
        raise ValueError("slenderness_angle and half_diagonal: allowed: one of each for every block")
    return blocks


PULSE = leaf(f"one of {', '.join(PULSE_NAMES)}", lambda value: value in PULSE_NAMES)
DERIVED_NAMES = [field.name for field in DERIVED_FIELDS]
DERIVED = leaf(f"one of {', '.join(DERIVED_NAMES)}", lambda value: value in DERIVED_NAMES)
ETA = number(0, 1)
OMEGA = number(1e-3, 1e3)
SLENDERNESS = number(1e-4, 10)
SLENDERNESS_OF_BOUNDARY = number(1e-4, 1)  # no block uplifts above
ANGLE = number(0.01, 89)  # [deg]
METRES = number(1e-3, 1e3)
SECONDS = number(1e-3, 1e3)
DURATION = number(1e-3, 100)  # of tau
POSITIVE = number(1e-3, 1e3)
NODES_OF_BOUNDARY = integer(16, 4001)

ETAS, PULSE_LIST, OMEGAS, ROWS, ANGLES = (several(item) for item in (ETA, PULSE, OMEGA, SLENDERNESS, ANGLE))


def _range(item: Any, **fields: Any) -> Any:
    return Annotated[section(low=item, high=item, **fields), AfterValidator(_rising)]


_CASE = section(frequency_ratio=OMEGA, amplitudes=several(POSITIVE, 2, 2))
_PULSE_AND_ETA = section(pulse=PULSE, restitution=ETA)
_TWO_BLOCKS = Annotated[
    section(
        slenderness=SLENDERNESS,
        frequency_ratio=OMEGA,
        slenderness_angle=several(number(1e-3, 1.5)),  # [rad]
        half_diagonal=several(METRES),
        duration=DURATION,
    ),
    AfterValidator(_pairs),
]
_HISTORIES = {"pulses": PULSE_LIST, "restitution": ETA, "alpha_deg": ANGLES, "frequency_ratio": OMEGA}
_AXIS = {"points": integer(4, 1000)}
_MASTER = {
    "alpha_deg": ANGLES,
    "slenderness": _range(SLENDERNESS_OF_BOUNDARY, **_AXIS),
    "frequency_ratio": _range(OMEGA, **_AXIS),
}

FIGURES = section(
    **{
        "figure-01": section(
            ours=section(
                pulse=PULSE,
                width=METRES,
                height=METRES,
                rotation=number(1e-3, 1),
                peak_acceleration=POSITIVE,
                period=SECONDS,
            )
        ),
        "figure-02": section(
            paper=section(pulse=PULSE),
            ours=section(restitution=ETA, cases=section(**{"2": _CASE, "1.2": _CASE, "1.1": _CASE})),
        ),
        "figure-03": section(
            ours=section(restitution=ETAS, frequency_ratio=_range(OMEGA, points=integer(4, 10_000))),
        ),
        "figure-04": section(ours=section(restitution=ETAS)),
        "figure-05": section(paper=_PULSE_AND_ETA, ours=_TWO_BLOCKS),
        "figure-06": section(paper=_PULSE_AND_ETA, ours=_TWO_BLOCKS),
        "figure-07": section(
            ours=section(
                pulses=PULSE_LIST, restitution=ETAS, slenderness=SLENDERNESS, frequency_ratio=OMEGA, duration=DURATION
            ),
        ),
        "figure-08": section(
            paper=section(restitution=ETAS), ours=section(slenderness=ROWS, frequency_ratio=_range(OMEGA))
        ),
        "figure-09": section(
            paper=section(alpha_deg=ANGLE, half_diagonal=several(METRES, 2, 2), restitution=ETA),
            ours=section(period=several(SECONDS)),
        ),
        "figure-10": section(paper=section(restitution=ETA), ours=section(alpha_deg=ANGLES)),
        "figure-11": section(ours=section(slenderness=SLENDERNESS, duration=DURATION, **_HISTORIES)),
        "figure-12": section(paper=section(slenderness=SLENDERNESS), ours=section(duration=DURATION, **_HISTORIES)),
        "figure-13": section(
            paper=section(restitution=ETA),
            ours=section(slenderness=ROWS, alpha_deg=ANGLES, frequency_ratio=_range(OMEGA)),
        ),
        "figure-S1": section(ours=section(slenderness=number(1e-4, 1), frequency_ratio=OMEGAS)),
        "figure-scale-law": section(ours=section(restitution=several(number(0.01, 1)), reference=ETA)),
        "figure-master-spectra": section(ours=section(restitution=ETA, **_MASTER)),
        "figure-master-housner": section(ours=section(**_MASTER)),
        "table-1": section(),
    }
)


def _pulse(value: Any, info: ValidationInfo) -> Any:
    """A pulse by its name, or made from samples; paths are relative to the context `folder`."""
    try:
        return configured_pulse(value, (info.context or {}).get("folder", Path()))
    except InvalidArgumentError as error:
        raise ValueError(str(error) if isinstance(value, dict) else f"allowed: {error.allowed}") from None


def _by_name(pulses: list[Any]) -> dict[str, Any]:
    return {**different(pulses)}


DATA_SETS = {
    "title": leaf("a text", lambda value: isinstance(value, str)),
    "pulses": Annotated[several(Annotated[Any, PlainValidator(_pulse)]), AfterValidator(_by_name)],
    "restitution": Annotated[several(ETA, ascending=True), AfterValidator(_two_decimals)],
    "grid": section(
        {"derived": several(DERIVED)},
        alpha_deg=Annotated[several(number(0.01, 89, zero=True), ascending=True), AfterValidator(_with_slender_limit)],
        slenderness=Annotated[
            section(breaks=several(SLENDERNESS, 2, ascending=True), steps=list[number(1e-6, 10)]),  # type: ignore[misc]
            AfterValidator(_whole_steps),
        ],
        frequency_ratio=_range(OMEGA, points=integer(4, NODES)),
    ),
    "boundary": section(
        nodes=NODES_OF_BOUNDARY,  # for the slender limit
        nodes_rigid=NODES_OF_BOUNDARY,  # for alpha > 0
        slenderness=_range(SLENDERNESS_OF_BOUNDARY),
        frequency_ratio=_range(OMEGA),
    ),
}

PAPER = {"figures": FIGURES, "claims": section(restitution=ETAS)}
"""Sections of a configuration that makes more than the data sets: both or none of them."""


def check(config: Mapping[str, Any], folder: Path = Path()) -> None:
    """Raise an error for a configuration that no run could finish.

    `config`: of data sets, with the figures and claims of the paper or without; or of a suite of records, with the keys
    `title` and `suite`. `folder`: folder of the file of the configuration. Raises `ConfigurationError`: one line for
    the first invalid value: key, value and what is allowed.
    """
    if "suite" in config:
        _check_suite(config, folder)
        return
    of_paper = not PAPER.keys().isdisjoint(config)
    try:
        section(**DATA_SETS, **(PAPER if of_paper else {})).model_validate(config, context={"folder": folder})
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key, value = ".".join(map(str, first["loc"])) or "configuration", first["input"]
        stated = key if isinstance(value, dict) else f"{key} = {reprlib.repr(value)}"
        raise ConfigurationError(f"{stated}: {first['msg'].removeprefix('Value error, ')}") from None
    for conflict in chain(_too_large(config), _not_made(config) if of_paper else ()):
        raise ConfigurationError(conflict)


def _check_suite(config: Mapping[str, Any], folder: Path) -> None:
    """The same for a suite, whose keys `rocking.suites.configuration` describes."""
    if {*config} != {"title", "suite"} or not isinstance(config["title"], str):
        raise ConfigurationError(f"configuration: keys {', '.join(config)}; allowed: title, a text, and suite")
    try:
        suite = suite_configuration(config["suite"], folder)
        suite.records.paths()
        if not isinstance(suite.blocks, tuple):
            raise InvalidArgumentError("blocks", config["suite"]["blocks"], "bodies with equal edges")
    except InvalidArgumentError as error:
        value = reprlib.repr(error.value)
        raise ConfigurationError(f"suite.{error.parameter} = {value}: allowed: {error.allowed}") from None


def chosen(config: Mapping[str, Any], figure: str) -> dict[str, Any]:
    """All values of a figure, those of the paper and those chosen here."""
    values = config["figures"][figure]
    return {**values.get("paper", {}), **values.get("ours", {})}


def restitutions(config: Mapping[str, Any], figure: str) -> list[float]:
    """The restitutions of a figure as a list, also if there is only one."""
    return _listed(chosen(config, figure)["restitution"])


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [value]


def tenths(config: Mapping[str, Any]) -> dict[str, list[float]]:
    """The restitutions by tenth, such as `0.8` for those from 0.80 to 0.89; 1 is in the last."""
    found: dict[str, list[float]] = {}
    for eta in config["restitution"]:
        found.setdefault(f"0.{min(round(100 * eta) // 10, 9)}", []).append(eta)
    return found


def nodes_of_part(config: Mapping[str, Any]) -> int:
    """Most nodes of the cubes of a tenth of the restitution."""
    return nodes_of_cube(config) * max(map(len, tenths(config).values()))


def nodes_of_cube(config: Mapping[str, Any]) -> int:
    """Nodes of the cube of one restitution."""
    return _rows(config) * _nodes_of_row(config)


def _rows(config: Mapping[str, Any]) -> int:
    return 1 + sum(steps_between(**config["grid"]["slenderness"]))


def _nodes_of_row(config: Mapping[str, Any]) -> int:
    return len(config["grid"]["alpha_deg"]) * int(config["grid"]["frequency_ratio"]["points"])


def _too_large(config: Mapping[str, Any]) -> Iterator[str]:
    """Grids that do not fit into memory, from their sizes."""
    grid, nodes = config["grid"], nodes_of_part(config)
    if nodes > NODES:
        axes = f"{len(grid['alpha_deg'])} alpha_deg x {_rows(config)} slenderness"
        axes += f" x {grid['frequency_ratio']['points']} frequency_ratio"
        together = max(map(len, tenths(config).values()))
        needed, most = (f"{count * BYTES / 1e9:.0f} GB" for count in (nodes, NODES))
        yield (
            f"grid = {axes}: {nodes:,} nodes with {together} restitution in one tenth, {needed}; "
            f"allowed: {NODES:,}, {most}"
        )


def _not_made(config: Mapping[str, Any]) -> Iterator[str]:
    """Figures that need data which the configuration does not compute."""
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
    law = chosen(config, "figure-scale-law")
    if law["reference"] not in law["restitution"]:
        yield f"figures.figure-scale-law: reference = {law['reference']}; allowed: one of its {law['restitution']}"
