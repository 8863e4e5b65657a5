"""Random mutations of accelerogram files for the readers.

A reader returns a record or raises `RecordFileError`; anything else is a defect, and so is a file that takes long.
What a mutation of a digit does cannot be noticed; lines that are missing or repeated in a file with times can, and are.
"""

from __future__ import annotations

import random
import time

import numpy as np

from rocking._base.errors import RecordFileError
from rocking._excitation.records.readers.read_record import parse_record
from rocking._excitation.records.record import UNITS, Record
from tests.excitation.record_files import DAMAGED, GOOD, ODD, pairs, values

FILES = [*GOOD.values(), *ODD.values(), *DAMAGED.values()]

TOKENS = [
    b"nan", b"inf", b"-", b".", b"E", b"1e999", b"1e308", b"-0", b"NPTS=", b"DT=", b"unit: g", b"gal", b"\xff", b"\0",
    b"\r", b"\n\n", b"\t", b",", b";", b"(", b"[", b"\xc2\xb2", b"9" * 400, b"UNITS OF", b"Scale Factor", b"= : =",
]  # fmt: skip

SLOW = 2.0
"""Processor time that reading a small file may take [s]."""


def mutated(content: bytes, dice: random.Random) -> bytes:
    """Return the content with one to four random changes."""
    data = bytearray(content)
    for _ in range(dice.randint(1, 4)):
        place = dice.randrange(len(data) + 1)
        length = dice.choice([1, 1, 2, 8, 60])
        kind = dice.randrange(7)
        if kind == 0 and data:
            data[min(place, len(data) - 1)] = dice.randrange(256)
        elif kind == 1:
            del data[place : place + length]
        elif kind == 2:
            data[place:place] = dice.choice(TOKENS)
        elif kind == 3:
            data[place:place] = data[place : place + length]
        elif kind == 4:
            del data[place:]
        elif kind == 5:
            lines = bytes(data).split(b"\n")
            first, second = dice.randrange(len(lines)), dice.randrange(len(lines))
            lines[first], lines[second] = lines[second], lines[first]
            data = bytearray(b"\n".join(lines))
        else:
            other = dice.choice(FILES).data
            cut = dice.randrange(len(other) + 1)
            data[place:] = other[cut:]
    return bytes(data)


def read_mutation(dice: random.Random) -> bool:
    """Read one mutated file; returns whether it was read. Raises AssertionError for a defect."""
    file = dice.choice(FILES)
    content = mutated(file.data, dice)
    arguments = dice.choice([file.arguments, {}, {"unit": dice.choice(list(UNITS)), "time_step": 0.01}])
    start = time.process_time()
    try:
        record = parse_record(content, "mutated", **arguments)
    except RecordFileError:
        return False
    finally:
        assert time.process_time() - start < SLOW, content
    assert isinstance(record, Record)
    assert np.isfinite(record.acceleration).all()
    return True


def remove_or_repeat_a_row(dice: random.Random) -> None:
    """Remove or repeat a row of a file with times: it is refused, except for the first or the last row."""
    lines = pairs().splitlines(keepends=True)
    k = dice.randrange(1, len(lines))
    lines[k : k + 1] = [] if dice.random() < 0.5 else [lines[k]] * 2
    try:
        record = parse_record("".join(lines).encode(), "rows")
    except RecordFileError:
        return
    known = values() * UNITS["g"]
    assert any(np.array_equal(part, record.acceleration) for part in (known[1:], known[:-1])), lines


def fuzz(dice: random.Random) -> bool:
    """One round of all kinds; returns whether the mutated file was read."""
    remove_or_repeat_a_row(dice)
    return read_mutation(dice)
