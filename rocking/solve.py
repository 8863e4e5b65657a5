"""The front door: `peak_response` and `time_history` check the question, broadcast it and pick the solver."""

from __future__ import annotations

import math
import os
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.errors import InvalidArgumentError, in_range
from rocking.pulses import AbstractPulse, SinusoidalPulse, get_pulse
from rocking.response import Response
from rocking.slender import rock_many
from rocking.slender_cuts import END

CHUNK = 4096
"""Cells handed to one thread at a time: some tenths of a millisecond of work, fine enough to balance the threads."""


@lru_cache(maxsize=256)
def as_arrays(pulse: SinusoidalPulse) -> tuple[NDArray[np.float64], NDArray[Any]]:
    """Its terms (terms, 3) and the ends of its monotone pieces, as the kernels take them."""
    terms = np.array(pulse.terms)
    phases = np.array([pulse.start, *pulse.stationary, pulse.end])
    ends = np.zeros(len(phases), END)
    ends["phase"] = phases
    ends["shape"] = pulse.shape(phases)
    angles = terms[:, 1] * phases[:, None] + terms[:, 2]
    ends["cosine"][:, : len(terms)] = np.cos(angles)
    ends["sine"][:, : len(terms)] = np.sin(angles)
    return terms, ends


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
    sinus = as_arrays(get_pulse(pulse) if isinstance(pulse, str) else pulse)

    def work(start):
        sl = slice(start, start + CHUNK)
        rock_many(s[sl], w[sl], e[sl], *sinus, *(o[sl] for o in out))

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
