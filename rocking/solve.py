"""The front door: `peak_response` and `time_history` check the question, broadcast it and pick the solver."""

from __future__ import annotations

import math
import os
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.compilation import Record
from rocking.errors import InvalidArgumentError, in_range
from rocking.pulses import AbstractPulse, SinusoidalPulse, get_pulse
from rocking.response import Response
from rocking.slender import rock_many
from rocking.slender_arcs import scratch

CHUNK = 4096
"""Cells handed to one thread at a time: some tenths of a millisecond of work, fine enough to balance the threads."""


@lru_cache(maxsize=256)
def prepared(pulse: SinusoidalPulse) -> Record:
    """The pulse in the layout of the kernels; each thread works on a copy."""
    record = np.zeros(1, scratch(len(pulse.terms)))[0]
    amplitude, multiple, shift = (np.array(column) for column in zip(*pulse.terms, strict=True))
    record["amplitude"], record["multiple"], record["shift"] = amplitude, multiple, shift
    phases = np.array([pulse.start, *pulse.stationary, pulse.end])
    count = len(phases)
    record["pieces"] = count - 1
    record["end_phase"][:count] = phases
    record["end_shape"][:count] = pulse.shape(phases)
    angles = multiple * phases[:, None] + shift
    record["end_cosine"][:count] = np.cos(angles)
    record["end_sine"][:count] = np.sin(angles)
    return record


def peak_response(
    pulse: str | AbstractPulse,
    *,
    slenderness: ArrayLike,
    frequency_ratio: ArrayLike,
    restitution: ArrayLike,
    alpha: ArrayLike | None = None,
    threads: int | None = None,
) -> Response:
    shape_arrays = np.broadcast_arrays(
        in_range("slenderness", slenderness, 0.0, math.inf, closed="neither"),
        in_range("frequency_ratio", frequency_ratio, 0.0, math.inf, closed="neither"),
        in_range("restitution", restitution, 0.0, 1.0),
    )
    shape = shape_arrays[0].shape
    s, w, e = (np.ascontiguousarray(x).ravel() for x in shape_arrays)
    n = s.size
    out = [np.empty(n, t) for t in (np.int8, float, np.int32, bool, float, float, float, np.int32)]
    sinus = prepared(get_pulse(pulse) if isinstance(pulse, str) else pulse)

    def work(start):
        sl = slice(start, start + CHUNK)
        rock_many(s[sl], w[sl], e[sl], sinus.copy(), *(o[sl] for o in out))

    threads = threads or os.cpu_count()
    starts = range(0, n, CHUNK)
    if threads == 1 or n <= CHUNK:
        for x in starts:
            work(x)
    else:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(work, starts))
    o, p, i, c, u, t, v, m = (x.reshape(shape) for x in out)
    return Response(p, o, i, c, (p > 1) | (o >= 2), u, t, v, m)
