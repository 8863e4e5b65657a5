"""Random dialects of files of records and of traces: a known motion in a layout that people use.

What is read is the motion, or it is refused.
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking._base.errors import InvalidArgumentError
from rocking._base.units import UNITS
from rocking._excitation.records.readers.columns import read_rotations
from rocking._excitation.records.readers.lines import TextFile
from rocking._excitation.records.readers.read_record import parse_record

TIMES = [
    "time", "Time", "t", "Zeit", "temps", "tempo", "tiempo", "Elapsed time", "TIME", "rel. time", "Time since trigger",
]  # fmt: skip
SAMPLES = [
    "acc", "a", "acceleration", "Accel", "Beschleunigung", "aceleración", "accélération", "acc_NS", "ag", "Acc. X",
]  # fmt: skip
OTHERS = ["NS", "EW", "UD", "N-S", "E-W", "U-D", "H1", "H2", "V", "acc EW", "Chan 2", "x", "y"]
COUNTERS = [
    "frame", "index", "sample #", "Frame no", "no", "n", "Sample", "i", "#", "Point", "Messwert Nr", "idx", "Bild",
]  # fmt: skip
ROTATIONS = ["rotation", "theta", "angle", "Winkel", "rotazione", "θ"]
TITLES = [
    "Made-up shock, scaled to 0.4 g", "The (XX) shock of May 3, 2001", "Station 12; north, 45 deg", "Run 7\tblock B",
    "Shaking table, sensor A3 (MEMS)", "El Centro 1940", "filtered 0.2, 25 Hz", "Versuch 3, 2 Blöcke", "g", "Test (g)",
    "PGA 0.35 g, PGV 20 cm/s", "corner frequencies 0.1 - 30 Hz, order 4", "Acc, scaled", "M 6.9, R 10 km", "max 0.3 g",
    "Kobe, JMA", "35.1, 139.2", "channel 1; range 2 g", "2001-02-03 04:05:06", "time to failure, 3 runs",
    "Sensor, in g",
]  # fmt: skip
DECOYS = [
    "Frequency high-pass: 0.2 Hz", "Frequency range: 0.2-25.0 Hz", "original dt = 0.02 s", "velocity unit: cm/s",
    "time unit: s", "PGA: 0.35 g", "Sampling rate of the digitizer: 500 Hz", "number of channels: 3",
    "frequency: 5 Hz", "Pre-event time: 10 s", "sensitivity unit: V/g", "Filter step: 3", "Duration = 12.5 s",
    "Natural period = 0.5 s", "Date: 1.2.2003",
    "start time: 12:30:05.25", "raw sampling rate: 1000 Hz", "Corner frequency, low = 0.05 Hz", "units of distance: km",
    "dt of the filter = 0.5 s", "sps: 200 (raw)", "time step of output files: 0.1 s", "site: rock, unit B",
]  # fmt: skip
STEPS = [
    "dt = {s:g} s", "dt: {s:g}", "time step: {ms:g} ms", "Sampling rate: {hz:g} Hz", "SAMPLING INTERVAL (sec) : {s:g}",
    "# fs = {hz:g}", "Abtastrate: {hz:g} Hz", "sample_rate_hz: {hz:g}", "DT={s:g}, station = X1",
    "frequency range: 1-2 Hz, dt = {s:g}",
    "time_step_ms = {ms:g}", "NO. OF POINTS: {n}  EQUALLY SPACED INTERVALS OF: {s:g} SEC",
    "{n} points at equal spacing of {s:g} sec", "Tasa de muestreo: {hz:g} Hz", "Passo di campionamento [ms] = {ms:g}",
    "Fréquence d'échantillonnage : {hz:g} Hz", "Zeitschritt: {s:g} s", "Taxa de amostragem = {hz:g}",
]  # fmt: skip
UNIT_LINES = [
    "unit: {u}", "Units = {u}", "UNCORRECTED ACCELERATION   UNIT: {u}", "The units are ({u})", "Acceleration in {u}",
    "ACCELERATION TIME HISTORY IN UNITS OF {u}", "unit: {u}, station: B2", "units: s, {u}", "Einheit: {u}",
]  # fmt: skip
SPELLINGS = {
    "g": ["g", "G"], "gal": ["gal", "Gal", "gal(cm/s/s)"], "cm/s2": ["cm/s2", "cm/s^2", "cm/sec/sec", "cm/s²"],
    "m/s2": ["m/s2", "m/s^2", "m s-2", "m/s²", "m/sec2"], "mg": ["mg"], "%g": ["%g"],
}  # fmt: skip
LONGEST = 60


@dataclass(frozen=True)
class Case:
    """A file, what it holds in SI units, and the arguments that a person who knows the file may state."""

    content: bytes
    samples: np.ndarray
    step: float
    stated: dict[str, Any]
    needed: dict[str, Any]
    trace: bool = False


def make(dice: random.Random) -> Case:
    """A random file."""
    trace = dice.random() < 0.25
    n = dice.randint(24, LONGEST)
    step = dice.choice([0.005, 0.01, 0.02, 0.004, 0.0078125])
    rng = np.random.default_rng(dice.randrange(2**32))
    unit = dice.choice(["deg", "rad", "mrad"]) if trace else dice.choice(list(SPELLINGS))
    size = {
        "g": 0.3, "gal": 200.0, "cm/s2": 200.0, "m/s2": 3.0, "mg": 300.0, "%g": 30.0, "deg": 6.0, "rad": 0.1,
        "mrad": 90.0,
    }  # fmt: skip
    k = np.arange(n)

    def motion() -> np.ndarray:
        wave = np.sin(0.4 * k * rng.uniform(0.5, 1.2) + rng.uniform(0.3, 6.0)) * np.exp(-k / n)
        rising = np.minimum(1.0, 0.1 + k / 8.0)
        return size[unit] * rng.uniform(0.5, 1.2) * (wave + 0.05 * rng.standard_normal(n)) * rising

    comma = dice.random() < 0.2
    separator = dice.choice([";", "\t", "  "]) if comma else dice.choice([",", ", ", ";", "\t", " ", "   "])
    form = dice.choice(["{:.6f}", "{:.5e}", "{:12.5f}", "{:.7g}", "{:.8f}"])
    written = [form.format(value) for value in motion()]
    truth = np.array([float(text) for text in written])

    shape = dice.choice(["one", "pair", "pair", "counter", "both", "components", "no time", "each", "wrapped", "more"])
    if trace:
        shape = dice.choice(["pair", "pair", "counter", "both"])
    time_unit = dice.choice(["s", "s", "s", "" if trace else "ms", ""])
    scale = 1000.0 if time_unit == "ms" else 1.0
    times = [f"{scale * step * j:.{2 if scale > 1 else 7}f}" for j in k]
    if time_unit == "s" and dice.random() < 0.2:  # of day, from before midnight on
        date, zone = dice.choice(["", "2019-02-03T"]), dice.choice(["", "Z"])
        ends = [divmod(round(86399.5 + step * j, 7), 60.0) for j in k]
        times = [f"{date}{int(m) // 60 % 24:02d}:{int(m) % 60:02d}:{second:010.7f}{zone}" for m, second in ends]
        time_unit = ""
    start = dice.choice([0, 1])
    name = dice.choice(ROTATIONS if trace else SAMPLES)
    own = name, unit, written
    spare = dice.sample(OTHERS, 2)
    others = [(one, unit, [form.format(value) for value in motion()]) for one in spare]
    time = dice.choice(TIMES), time_unit, times
    counter = dice.choice(COUNTERS), "", [str(start + j) for j in k]
    velocity = "vel", "cm/s" if unit != "m/s2" else "m/s", [form.format(v / 9.0) for v in motion()]
    columns: list[tuple[str, str, list[str]]] = {  # name, unit of its own, texts
        "one": [own],
        "pair": [time, own],
        "counter": [counter, own],
        "both": [counter, time, own],
        "components": [time, own, *others],
        "no time": [own, *others],
        "each": [time, own, time, others[0]],
        "more": [time, own, velocity],
    }.get(shape, [])

    named = shape != "wrapped" and dice.random() < (0.9 if shape in ("both", "each", "more", "counter") else 0.7)
    where = dice.choice(["name", "name", "row", "line", "none"]) if named else dice.choice(["line", "none"])
    if trace:
        where = ("name" if unit != "rad" else dice.choice(["name", "none"])) if named else "none"
        unit = unit if where == "name" else dice.choice(["rad", "deg"])
    spelt = dice.choice(SPELLINGS.get(unit, [unit]))
    has_time = any(one is time for one in columns)
    step_line = dice.choice(STEPS) if dice.random() < (0.1 if has_time else 0.5) and not trace else None
    if shape == "components" and not named:
        where = "line" if where == "row" else where
    if not named and time_unit == "ms":  # times whose unit is nowhere
        times[:] = [f"{step * j:.7f}" for j in k]
        time_unit = ""

    notes = dice.choice([0, 1, 1, 2, 4])
    header = [dice.choice(TITLES if dice.random() < 0.5 else DECOYS) for _ in range(notes)]
    about = {"u": spelt, "s": step, "ms": 1000.0 * step, "hz": 1.0 / step, "n": n}
    if where == "line" and not trace:
        header.insert(dice.randint(0, len(header)), dice.choice(UNIT_LINES).format(**about))
    if step_line:
        header.insert(dice.randint(0, len(header)), step_line.format(**about))
    prefix = dice.choice(["", "", "# ", "% "])
    header = [line if line.startswith("#") else prefix + line for line in header]
    blank = dice.random() < 0.15
    mark = dice.choice([separator, separator, separator, "   "]) if named else separator
    if named:
        names = [_named(dice, one, where, spelt if one is not time else one[1], mark) for one in columns]
        header.append(dice.choice(["", prefix]) + mark.join(names))
        if where == "row":
            own_unit = {id(time): time[1] or "s", id(velocity): velocity[1]}
            units = [own_unit.get(id(one)) or (spelt if one[1] else "-") for one in columns]
            header.append(mark.join(f"[{text}]" for text in units))
    if dice.random() < 0.1:
        header.append("-" * 30)
    leading: list[str] = []
    if shape in ("one", "wrapped") and dice.random() < 0.3:
        leading = dice.choice(
            [["1", f"{step:g}"], [str(n)], [f"{step:g}"], [str(n), f"{step:g}"], [f"{n} {step:g}"], ["9.81"]]
        )
    if shape == "wrapped":
        width = dice.choice([4, 5, 8])
        body = [separator.join(written[j : j + width]) for j in range(0, n, width)]
    else:
        body = [separator.join(texts) for texts in zip(*(one[2] for one in columns), strict=True)]
    if comma:
        body = [line.replace(".", ",") for line in body]
    lines = [*header, *([""] if blank else []), *leading, *body, *([""] * dice.choice([0, 0, 1, 3]))]
    if dice.random() < 0.05:
        lines.append("*** End of data ***")
    end = dice.choice(["\n", "\n", "\r\n", "\r\r\n"])
    content = (end.join(lines) + end).encode(dice.choice(["utf-8", "utf-8", "utf-8-sig", "utf-16"]))

    needed: dict[str, Any] = {}
    if trace:
        stated: dict[str, Any] = {"degrees": unit == "deg"} if where == "none" else {}
        needed = stated if unit == "deg" else {}
        if not has_time or not named:
            stated = {**stated, "time_step": step}
    else:
        stated = {"unit": unit}
        if not has_time or not named or (time_unit == "ms" and where not in ("name", "row")):
            stated["time_step"] = step
        if len(columns) > 1:
            stated["component"] = name if named else f"column {columns.index(own) + 1}"
        if shape == "wrapped":
            stated["component"] = "rows"
        numbers = sum(line.strip() == "35.1, 139.2" for line in header)
        if leading or numbers:
            stated["skip"] = len(leading) + numbers
    return Case(content, truth * UNITS["rad" if trace else "m/s2"][unit], step, stated, needed, trace)


def _named(dice: random.Random, column: tuple[str, str, list[str]], where: str, spelt: str, mark: str) -> str:
    """The name of a column, with its unit."""
    name, unit, _ = column
    joined = name.replace(" ", "_") if not mark.strip() and "\t" not in mark else name
    if name != "vel" and (where != "name" or not unit):
        return joined
    text = unit if name == "vel" else spelt
    return dice.choice(
        [f"{joined} [{text}]", f"{joined} ({text})", f"{joined}[{text}]", f"{joined}_{text.replace(' ', '')}"]
    )


def outcome(case: Case, arguments: dict[str, Any]) -> str:
    """Read a case: "read", or the reason of its refusal.

    Raises
    ------
    AssertionError
        If another motion is read than that of the case.
    """
    try:
        if case.trace:
            file = TextFile("x", case.content)
            time, samples = read_rotations(file, 10_000, arguments.get("degrees"), arguments.get("time_step"))
            step = float(time[1] - time[0])
        else:
            found = parse_record(case.content, "x", **arguments)
            step, samples = found.time_step, found.acceleration
    except InvalidArgumentError as error:
        return str(error)
    right = samples.shape == case.samples.shape and np.allclose(samples, case.samples, rtol=1e-9, atol=0.0)
    if not right or abs(step / case.step - 1.0) > 1e-3:
        shown = case.content.decode("utf-16" if case.content[:2] == b"\xff\xfe" else "utf-8-sig")
        raise AssertionError(
            f"{arguments}, step {step} for {case.step}, {samples.size} samples of {case.samples.size}\n{shown[:900]}"
        )
    return "read"


def try_case(case: Case) -> str:
    """Read a case with all arguments, without each of them, and with few of them; returns the outcome with all."""
    every = case.needed | case.stated
    for left in case.stated.keys() - case.needed.keys():
        outcome(case, {key: value for key, value in every.items() if key != left})
    outcome(case, case.needed)
    return outcome(case, every)


def run(count: int, seed: int) -> int:
    """Try as many cases; how many were read with all arguments."""
    found = 0
    for k in range(count):
        try:
            found += try_case(make(random.Random(f"{seed}-{k}"))) == "read"
        except AssertionError as error:
            raise AssertionError(f"case {seed}-{k}: {error}") from None
    return found
