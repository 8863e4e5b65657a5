"""Random mutations of accelerogram files for the readers.

A reader returns a record or raises `RecordFileError`; anything else is a defect, and so is a file that takes long.
"""

from __future__ import annotations

import random
import time
from typing import Any

import numpy as np

from rocking._base.errors import InvalidArgumentError, RecordFileError
from rocking._excitation.records.readers.read_record import parse_record
from rocking._excitation.records.record import Record
from tests.excitation.record_files import at2, esm, knet, pairs, rows
from tests.excitation.test_volume_files import cosmos, csmip, geonet

COLUMNS = {"format": "columns", "unit": "g", "time_step": 0.01}
FILES: list[tuple[bytes, dict[str, Any]]] = [
    (at2().encode(), {}),
    (esm().encode(), {}),
    (knet().encode(), {}),
    (csmip().encode(), {"acceleration": "1"}),
    (cosmos().encode(), {}),
    (geonet(1).encode(), {"acceleration": 1}),
    (geonet(2).encode(), {"acceleration": "Up"}),
    (pairs().encode(), {}),
    (pairs("").encode(), COLUMNS | {"acceleration": 2}),
    (pairs("").replace(".", ",").replace(",0", ";0").encode(), COLUMNS | {"acceleration": 1, "decimal": ","}),
    (rows().encode(), COLUMNS | {"wrapped": True}),
    (rows(8, "{:9.6f}").encode(), COLUMNS | {"wrapped": True, "delimiter": "8f9.6"}),
]

TOKENS = [
    b"nan", b"inf", b"-", b".", b"E", b"1e999", b"1e308", b"-0", b"NPTS=", b"DT=", b"[g]", b"gal", b"\xff", b"\0",
    b"\r", b"\n\n", b"\t", b",", b";", b"(", b"(1i1000000000)", b"(8f0.6)", b"\xc2\xb2", b"9" * 400, b"9" * 5000,
    b"UNITS OF", b"Scale Factor", b'"', b"`",
]  # fmt: skip

SLOW = 2.0
"""Processor time that reading a small file may take [s]."""


def mutated(content: bytes, dice: random.Random) -> bytes:
    """Return the content with one to four random changes."""
    data = bytearray(content)
    for _ in range(dice.randint(1, 4)):
        position = dice.randrange(len(data) + 1)
        length = dice.choice([1, 1, 2, 8, 60])
        kind = dice.randrange(6)
        if kind == 0:
            data[position : position + 1] = bytes([dice.randrange(256)])
        elif kind == 1:
            del data[position : position + length]
        elif kind == 2:
            data[position : position + dice.choice([0, 0, 4])] = dice.choice(TOKENS)
        elif kind == 3:
            data[position:position] = data[position : position + length]
        elif kind == 4:
            del data[position:]
        else:
            other = dice.choice(FILES)[0]
            data[position:] = other[dice.randrange(len(other) + 1) :]
    return bytes(data)


def fuzz(dice: random.Random) -> bool:
    """Read one mutated file; returns whether it was read. Raises AssertionError for a defect."""
    original, arguments = dice.choice(FILES)
    content = mutated(original, dice)
    arguments = dice.choice([arguments, {}, arguments | COLUMNS, {"unit": "g", "time_step": 0.01}])
    start = time.process_time()
    try:
        record = parse_record(content, "mutated", **arguments)
    except RecordFileError:
        return False
    except InvalidArgumentError as error:
        if error.parameter in ("wrapped", "time_step"):  # arguments that exclude each other
            return False
        raise
    finally:
        assert time.process_time() - start < SLOW, content
    assert isinstance(record, Record)
    assert np.isfinite(record.acceleration).all()
    return True
