"""Accelerogram files made up for the tests of the readers."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

COUNT = 24
STEP = 0.01


def values(count: int = COUNT) -> NDArray[np.float64]:
    """Return the samples of all files, six digits."""
    k = np.arange(count)
    return np.round(0.2 * np.sin(0.7 * k) * np.exp(-0.05 * k), 6)


def rows(width: int = 5, form: str = "{:15.6E}", count: int = COUNT) -> str:
    """Return the samples as rows of numbers."""
    x = values(count)
    return "\n".join("".join(form.format(v) for v in x[k : k + width]) for k in range(0, count, width)) + "\n"


TITLE = "PEER STRONG MOTION DATABASE RECORD\nTEST VALLEY 05/05/90, STATION 1, 090\n"


def at2(header: str = "NPTS=    24, DT=  .01000 SEC", units: str = "UNITS OF G", body: str = rows()) -> str:
    return f"{TITLE}ACCELERATION TIME HISTORY IN {units}\n{header}\n{body}"


ESM_KEYS = {
    "EVENT_NAME": "Test valley", "EVENT_ID": "IT-1990-0001", "NETWORK": "IT", "STATION_CODE": "ABC", "STREAM": "HNE",
    "SAMPLING_INTERVAL_S": "0.010000", "NDATA": "24", "DURATION_S": "0.230000", "UNITS": "cm/s^2",
    "DATA_TYPE": "ACCELERATION", "PROCESSING": "none", "HEADER_FORMAT": "DYNA 1.2",
}  # fmt: skip


def esm(changes: dict[str, str | None] | None = None, body: str = rows(1)) -> str:
    keys: dict[str, str | None] = ESM_KEYS | (changes or {})
    lines = [f"{key}: {value}" for key, value in keys.items() if value is not None]
    lines += [f"USER{k}: " for k in range(64 - len(lines))]
    return "\n".join(lines) + "\n" + body


COUNTS = np.round(values() * 8388608 / 2000 * 980.665)
KNET_HEADER = (
    "Origin Time       1990/05/05 12:00:00\nLat.              37.000\nLong.             138.000\nDepth. (km)       10\n"
    "Mag.              6.0\nStation Code      ABC001\nStation Lat.      37.1\nStation Long.     138.1\n"
    "Station Height(m) 10\nRecord Time       1990/05/05 12:00:10\nSampling Freq(Hz) 100Hz\nDuration Time(s)  0.24\n"
    "Dir.              N-S\nScale Factor      2000(gal)/8388608\nMax. Acc. (gal)   190.0\n"
    "Last Correction   1990/05/05 12:00:00\nMemo.\n"
)
KNET_ROWS = "\n".join("".join(f"{int(v):9d}" for v in COUNTS[k : k + 8]) for k in range(0, COUNT, 8)) + "\n"
KNET_VALUES = (COUNTS - COUNTS.mean()) * 2000 / 8388608


def knet(old: str = "", new: str = "") -> str:
    assert old in KNET_HEADER
    return KNET_HEADER.replace(old, new, 1) + KNET_ROWS


def pairs(header: str = "time [s],acceleration [g]\n") -> str:
    return header + "".join(f"{k * STEP:.3f},{v:.6f}\n" for k, v in enumerate(values()))
