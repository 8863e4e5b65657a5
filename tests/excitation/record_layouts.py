"""Random layouts of a known motion: read right when all is stated, never differently when something is not."""

from __future__ import annotations

import random
from typing import Any

import numpy as np

from rocking._base.errors import InvalidArgumentError
from rocking._excitation.records.readers.read_record import parse_record
from rocking._excitation.records.record import UNITS

NAMES = ["NS", "EW", "UD", "acc", "acceleration", "a_x", "Accel 4711", "1", "2", "Kanal", "x"]
TITLES = [
    "Made-up record, east",
    "STATION: XX01",
    "Sampling rate: 100 Hz",
    "# unit: furlong",
    "The (made-up) shock",
    "",
]


def check_layout(dice: random.Random) -> None:
    """Write a random layout, read it with all and with some of what states it."""
    content, arguments, expected, step = random_layout(dice)
    record = parse_record(content, "motion", **arguments)
    np.testing.assert_allclose(record.acceleration, expected, rtol=1e-9, err_msg=f"{content[:400]!r}, {arguments}")
    assert abs(record.time_step / step - 1.0) < 1e-6, (content[:400], arguments)
    some_arguments = {name: value for name, value in arguments.items() if dice.random() < 0.6}
    try:
        other = parse_record(content, "motion", **some_arguments)
    except InvalidArgumentError:
        return
    same = other.samples == expected.size and np.allclose(other.acceleration, expected, rtol=1e-9)
    assert same and abs(other.time_step / step - 1.0) < 1e-6, (content[:400], some_arguments)  # noqa: PT018  # one defect


def random_layout(dice: random.Random) -> tuple[bytes, dict[str, Any], np.ndarray, float]:
    """Return a file, the arguments that state it, its accelerations [m/s2] and its time step [s]."""
    count = dice.randint(12, 60)
    unit = dice.choice(["g", "m/s2", "gal", "mm/s2"])
    k = np.arange(count)
    values = np.round(np.sin(dice.uniform(0.2, 0.9) * k + 1.0) * 0.5 / UNITS[unit], 4)
    step = dice.choice([0.005, 0.01, 0.02])
    decimal = dice.choice([".", ".", ","])
    delimiter = dice.choice([";", "\t", " "] if decimal == "," else [",", ";", "\t", " "])
    arguments: dict[str, Any] = {"unit": unit}
    if decimal == ",":
        arguments["decimal"] = ","
    titles = dice.choices(TITLES, k=dice.randint(0, 3))
    if dice.random() < 0.25:
        arguments |= {"wrapped": True, "time_step": step}
        width = dice.randint(2, 8)
        table = [list(values[start : start + width]) for start in range(0, count, width)]
        names: list[str] = []
    else:
        columns, names, chosen = _columns(dice, values, step, arguments)
        table = [list(row) for row in zip(*columns, strict=True)]
        if dice.random() < 0.4 or all(name.isdecimal() for name in names):  # a line of numbers is no header
            names = []
        arguments["acceleration"] = chosen + 1 if not names or dice.random() < 0.4 else names[chosen]
    if delimiter == " " or len(table[0]) == 1:
        names = [name.replace(" ", "_") for name in names]
        arguments = {
            key: value.replace(" ", "_") if isinstance(value, str) else value for key, value in arguments.items()
        }
    quoted = '"' if dice.random() < 0.15 and not arguments.get("wrapped") else ""
    rows = [delimiter.join(f"{quoted}{value:.4f}{quoted}".replace(".", decimal) for value in row) for row in table]
    lines = [*titles, *([delimiter.join(names)] if names else []), *rows]
    if titles:
        arguments["skip"] = len(titles)
    if len(table[0]) > 1 and (quoted or dice.random() < 0.5):
        arguments["delimiter"] = delimiter
    end = dice.choice(["\n", "\r\n", "\r"])
    return (end.join(lines) + end).encode(dice.choice(["utf-8", "utf-16"])), arguments, values * UNITS[unit], step


def _columns(
    dice: random.Random, values: np.ndarray, step: float, arguments: dict[str, Any]
) -> tuple[list[np.ndarray], list[str], int]:
    """Return columns, their names and the place of the accelerations; what states the times is added to `stated`."""
    extra_columns = dice.randint(0, 2)
    names = dice.sample(NAMES, extra_columns + 1)
    columns = [values, *(values[::-1] * factor for factor in (2.0, 3.0)[:extra_columns])]
    if dice.random() < 0.5:
        arguments["time_step"] = step
    else:
        factor = dice.choice([("s", 1.0), ("ms", 1000.0)])
        position = dice.randint(0, extra_columns + 1)
        columns.insert(position, np.arange(values.size) * step * factor[1])
        names.insert(position, dice.choice(["time", "t", f"time [{factor[0]}]"]))
        arguments |= {"time": position + 1, "time_unit": factor[0]}
    chosen = next(k for k, column in enumerate(columns) if column is values)
    return columns, names, chosen
