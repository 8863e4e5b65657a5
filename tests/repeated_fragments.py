"""Texts of repeated fragments for every reader of text: the processor time grows in proportion to their length.

A text is a template of the reader with prefix + fragment * k + suffix in it, of tokens of the grammars that are read.
"""

from __future__ import annotations

import asyncio
import random
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import typer
from pydantic import ValidationError
from rocking_api.app import create_app
from rocking_api.models.batch import parse_csv
from rocking_api.models.blocks import BlockRows
from rocking_api.models.pulses import BatchBody, MapBody
from rocking_api.settings import Settings

from rocking._base.cells import name_and_unit
from rocking._base.errors import InvalidArgumentError, positive
from rocking._cli.fragility import read_suite
from rocking._dimensional.table import read_table
from rocking._excitation.records.readers.read_record import parse_record
from rocking._excitation.sampled import SampledPulse
from rocking._numba.cancellation import StopFlag
from rocking.suites.configuration import suite_configuration
from tests.api.in_process import answer_in_process

LINES = (2_000, 16_000)
"""Lengths for what is one line, or a file of the user [characters]."""

GRANTED = 0.1
"""Processor time that every text may take [s]."""

PLACE, NUMBER = "@", "№"
"""Where the repeated fragments are in a template, and where the number of a repetition is in a fragment."""

GROWTH = 8.0
"""Largest ratio of the processor times of a text and of one of a quarter of its length [-]; 16 if it is quadratic."""

TOKENS = [
    *("0", "1", "9.5", ".", "e", "E", "d", "-", "+", "1e5", ":", "=", ",", ";", "\t", " ", "  ", "(", ")", "[", "]"),
    *("{", "}", '"', "'", "_", "/", "*", "^", "#", "&", "%", "!", "|", "<", "?", "\\", "\n", "\r\n", "\n\n", "a", "b"),
    *("a b", "a:b", "a=b", "é", "²", "\0", NUMBER),
]

RECORD = [
    "unit", "units", "UNITS OF", "dt", "time", "time step", "acc", "NPTS", "DT", "VELOCITY", "sampling rate", "Hz",
]  # fmt: skip
RECORD += ["g", "gal", "cm/s2", "SEC", "s", "Scale Factor", "NDATA", "vel", "m"]
UNIT = ["m", "cm", "g", "gal", "s", "ms", "s2", "deg", "rad", "percent"]
TABLE = ["name", "width", "height [m]", "period", "peak_acceleration [g]", "restitution", *UNIT]
SUITE = [
    f"a{NUMBER}: 1\n", f"[a{NUMBER}]\n", "name", "records", "folder", "intensity", "hazard", "&a", "*a", "- ", ": ",
    "a.", '"""', "null", "true",
]  # fmt: skip
QUERY = [
    f"a{NUMBER}=1&", "pulse", "sine", "slenderness", "&", "=", "%41", "%", "+", "a=1&", "&&", "unit", "restitution",
]  # fmt: skip
BODY = ["slenderness", '"slenderness"', '"slenderness":[', "restitution", "null", "{", "[1,", "]", "\\u0041"]
PULSE = ['"acceleration":', '"time":', '"period":', '"name":', "[1,", "[0,1]", "null", "{", "1e999", "NaN", "9" * 400]
HEADER = ["text/csv", "application/json", "q=0", "bytes=", "0-", "1-2", "W/", '"a"', "*", ";", ",", "utf-8"]

AT2 = "PEER\nTitle\nACCELERATION TIME HISTORY IN UNITS OF G\nNPTS= 3, DT= .01\n1 2 3\n"
ESM = "SAMPLING_INTERVAL_S: 0.01\nNDATA: 3\nUNITS: gal\n1\n2\n3\n"
KNET = (
    "Origin Time 1\nLat. 1\nLong. 1\nDepth. (km) 1\nMag. 6.0\nStation Code ABC\nStation Lat. 1\nStation Long. 1\n"
    "Station Height(m) 1\nRecord Time 1\nSampling Freq(Hz) 100\nDuration Time(s) 0.03\nDir. N-S\n"
    "Scale Factor 1(gal)/1\nMax. Acc. (gal) 1\nLast Correction 1\nMemo.\n1 2 3\n"
)


class Reader(NamedTuple):
    """A reader, the templates of its texts, the words of its grammar, and the lengths of the shorter texts.

    By default these are a quarter of a line that is admitted, and a quarter of a large body.
    """

    read: Callable[[str], Any]
    templates: list[str]
    words: list[str]
    lengths: tuple[int, ...] = (2_000, 250_000)


def record(text: str) -> None:
    """Read a record without arguments, with those of one column, and as one of several components."""
    for arguments in ({}, {"unit": "g", "time_step": 0.01}, {"acceleration": "a", "format": "columns"}):
        with suppress(InvalidArgumentError):
            parse_record(text.encode(), "x", **arguments)  # type: ignore[arg-type]


def from_file(text: str, read: Callable[[Path], Any], suffix: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"text.{suffix}"
        path.write_text(text, encoding="utf-8", newline="")
        read(path)


def quantity(text: str) -> None:
    for unit in ("m", "m/s2", "s", "rad"):
        with suppress(InvalidArgumentError):
            positive("x", text, unit)


def suite_values(text: str) -> None:
    """Check a configuration with the text in place of each of its values."""
    good: dict[str, Any] = {
        "name": "a", "measure": "pga", "intensity": [1.0, 2.0], "records": {"folder": "a", "pattern": "*.csv"},
        "blocks": [{"width": "1 m", "height": "4 m"}], "hazard": {"intensity": [1.0, 2.0], "rate": [0.1, 0.01]},
        "demand": ["overturning"], "restitution": "momentum",
    }  # fmt: skip
    nested: list[tuple[str, dict[str, Any]]] = [
        ("records", {"folder": text, "pattern": text, "unit": text}),
        ("hazard", {"intensity": [text], "rate": [text]}),
        ("blocks", [{"width": text, "height": "4 m"}]),  # type: ignore[list-item]
    ]
    for key, value in [*((key, text) for key in good), *nested]:
        with suppress(InvalidArgumentError):
            suite_configuration(good | {key: value}, Path())


@cache
def service() -> Any:
    return create_app(Settings(results=Path(tempfile.gettempdir()) / "rocking-no-results", access_log=False))


def request(text: str, path: str, header: str = "") -> None:
    line = text.translate(dict.fromkeys(b"\r\n\0 ", "+")).encode().decode("latin-1")
    headers = [(header, line)] if header else []
    asyncio.run(answer_in_process(service(), path, "" if header else line, headers))


def body(text: str, form: str) -> None:
    if form == "csv":
        parse_csv(text.encode(), 10_000, StopFlag())
    else:
        with suppress(ValidationError):
            {"blocks": BlockRows, "pulse": MapBody, "json": BatchBody}[form].model_validate_json(text.encode())


def places(text: str, *parts: str) -> list[str]:
    """Templates: a text with `PLACE` in place of each of some parts."""
    assert all(part in text for part in parts)
    return [text.replace(part, PLACE, 1) for part in parts]


ROWS = "\n0,1\n1,2\n2,1\n"
PULSE_FILE = partial(from_file, read=SampledPulse.from_file, suffix="csv")
SUITE_FILE = partial(from_file, read=lambda path: read_suite(str(path)))

READERS = {
    "columns": Reader(
        record,
        [f"@{ROWS}", "@\n1\n2\n3\n", f"time @,a @{ROWS}", f"a,@{ROWS}", f"time [s],acc [g]{ROWS}@\n3,1\n"],
        RECORD,
    ),
    "AT2": Reader(
        record, places(AT2, "Title", "ACC", "UNITS OF G", "NPTS= 3, DT= .01", "3, DT", ".01", "1 2 3"), RECORD
    ),
    "ESM": Reader(record, places(ESM, "0.01", "NDATA: 3", "gal", "1\n2\n3\n"), RECORD),
    "K-NET": Reader(record, places(KNET, "1", "100", "0.03", "1(gal)/1", "gal", "1 2 3"), RECORD),
    "any record": Reader(record, ["@"], RECORD),
    "pulse in columns": Reader(PULSE_FILE, ["@", f"@{ROWS}", f"time,acc [@]{ROWS}", f"0,1{ROWS}@\n3,1\n"], RECORD),
    "pulse in JSON": Reader(PULSE_FILE, ["{@", '{"acceleration":[@]}', '{"acceleration":[0,1],"time":@}'], PULSE),
    "suite in YAML": Reader(partial(SUITE_FILE, suffix="yaml"), ["@", "name: @\n", "hazard: [@]\n"], SUITE, (1_000,)),
    "suite in TOML": Reader(partial(SUITE_FILE, suffix="toml"), ["@", "name = @\n", "@ = 1\n", "[@]\n"], SUITE, LINES),
    "suite in JSON": Reader(partial(SUITE_FILE, suffix="json"), ["@", '{"name": @}'], SUITE, LINES),
    "query string": Reader(partial(request, path="/v1/response"), ["@", "pulse=@", "@&a=1&a=2"], QUERY, LINES),
    "query of a block": Reader(partial(request, path="/v1/blocks/response"), ["@", "width=@"], QUERY, LINES),
    **{
        f"header {name}": Reader(partial(request, path=path, header=name), ["@", f"{prefix}@"], HEADER, LINES)
        for name, path, prefix in (
            ("accept", "/v1/map", "text/csv"),
            ("if-none-match", "/v1/pulses", '"a"'),
            ("range", "/static/explorer/main.js", "bytes="),
        )
    },
    "points in JSON": Reader(partial(body, form="json"), ["@", '{"slenderness":[@]}', '{"slenderness":[@'], BODY),
    "points in CSV": Reader(partial(body, form="csv"), ["@", "slenderness,restitution\n@"], BODY),
    "samples in JSON": Reader(
        partial(body, form="pulse"), ["@", '{"pulse":{"acceleration":[@]}}', '{"pulse":{@}}'], [*PULSE, '"pulse":']
    ),
    "cell of a header": Reader(name_and_unit, ["@", "[@", "width [@] x"], TABLE, (250,)),  # up to 12,000 cells of these
    "blocks in JSON": Reader(partial(body, form="blocks"), ["@", '{"blocks":[@]}'], BODY),
}
"""Readers of text, by what they read."""

BLOCKS = "name,width [m],height [m],peak_acceleration [g],period [s]\na,1,2,3,4\n"
TABLE_OF_BLOCKS = partial(read_table, pulse="sine")

MATCHED_UNITS = {
    "block table": Reader(TABLE_OF_BLOCKS, ["@", *places(BLOCKS, "name", "width [m]", "m", "1", "a,1,2,3,4")], TABLE),
    "quantity": Reader(quantity, ["@", "1 @", "1@m"], UNIT),
    "value of a suite": Reader(suite_values, ["@", "1 @"], [*SUITE, *UNIT]),
}
"""Those in which a unit may occur, which must be matched: evaluated as arithmetic, 9**9**9 does not end."""


class Fragments(NamedTuple):
    """A template, and what is repeated in it."""

    template: str
    prefix: str
    fragment: str
    suffix: str

    def text(self, length: int) -> str:
        count = length // len(self.fragment)
        if NUMBER in self.fragment:
            repeated = "".join(self.fragment.replace(NUMBER, str(k)) for k in range(count))
        else:
            repeated = self.fragment * count
        return self.template.replace(PLACE, self.prefix + repeated + self.suffix)


def fragments(name: str, reader: Reader, seed: int) -> Iterator[Fragments]:
    """Endless texts for a reader; first each token of the grammar alone."""
    dice = random.Random(f"{name} {seed}")
    tokens = [*TOKENS, *reader.words]
    for token in tokens:
        yield Fragments(dice.choice(reader.templates), "", token, "")
    while True:
        parts = ("".join(dice.choices(tokens, k=dice.randint(*size))) for size in ((0, 3), (1, 3), (0, 2)))
        yield Fragments(dice.choice(reader.templates), *parts)


def seconds(reader: Reader, text: str) -> float:
    start = time.process_time()
    with suppress(InvalidArgumentError, typer.BadParameter):
        reader.read(text)
    return time.process_time() - start


def excess(reader: Reader, given: Fragments) -> str | None:
    """How a text takes longer than in proportion to its length; None if it does not."""
    for length in reader.lengths:
        if seconds(reader, given.text(4 * length)) <= GRANTED:
            continue
        for _ in range(3):  # a busy machine can slow one of the two
            short, long = (min(seconds(reader, given.text(size)) for _ in range(3)) for size in (length, 4 * length))
            if long <= max(GRANTED, GROWTH * short):
                break
        else:
            return f"{given}: {short:.3f} s for {length} characters, {long:.3f} s for four times as many"
    return None
