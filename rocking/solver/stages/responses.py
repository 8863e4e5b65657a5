"""Responses of finished cells, and the memory into which they are written."""

from __future__ import annotations

import math

from rocking._numba.compilation import Record, kernel
from rocking._numba.memory import prefetch_for_write
from rocking._numba.simd import LANES, load, pack_integers, scatter_records, select, splat, store
from rocking.solver.rules import NO_UPLIFT
from rocking.solver.stages.state import (
    CHATTER,
    FIRST_IMPACT_TIME,
    FIRST_IMPACT_VELOCITY,
    IMPACTS,
    MODE,
    PEAK,
    UPLIFT_TIME,
)


@kernel
def write_empty_response(response: Record) -> None:
    """Write the response of a block without uplift."""
    response.outcome, response.chatter, response.impacts, response.peak_mode = NO_UPLIFT, 0, 0, -1
    response.exceeded_alpha = 0
    response.peak_rotation, response.uplift_time = 0.0, math.nan
    response.first_impact_time, response.first_impact_velocity = math.nan, math.nan
    response.end_rotation, response.end_velocity = 0.0, 0.0


@kernel
def write_responses(group: Record, done: int, responses: Record) -> None:
    """Write the responses of the lanes whose bits are set in `done`, each at once as the words of `RESPONSE_RECORD`."""
    columns, words = group.columns, group.words
    for lane in range(LANES):
        group.written[lane] = group.place[lane] if (done >> lane) & 1 else -1
    peak = load(columns, PEAK)
    exceeded = select(peak <= 1.0, splat(0.0), splat(1.0))  # also where it is nan
    store(words, 0, peak)
    store(words, 1, load(columns, UPLIFT_TIME))
    store(words, 2, load(columns, FIRST_IMPACT_TIME))
    store(words, 3, load(columns, FIRST_IMPACT_VELOCITY))
    store(words, 4, load(group.free_z, 0))
    store(words, 5, load(group.free_w, 0))
    store(words, 6, pack_integers(load(columns, IMPACTS), load(columns, MODE)))
    # bytes: outcome, chatter, exceeded_alpha
    flags = load(group.outcome, 0) + 256.0 * load(columns, CHATTER) + 65536.0 * exceeded
    store(words, 7, pack_integers(flags, splat(0.0)))
    scatter_records(words, group.written, responses)


@kernel
def prefetch_responses(responses: Record, first: int, last: int) -> None:
    """Prefetch the memory of responses of the next block, which is written in the order of the ends of the cells."""
    for cell in range(first, min(last, len(responses))):
        prefetch_for_write(responses.ctypes.data + cell * responses.itemsize)
