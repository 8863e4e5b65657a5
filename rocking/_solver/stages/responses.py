"""Responses of finished cells, and the memory into which they are written."""

from __future__ import annotations

from rocking._numba.compilation import Record, kernel
from rocking._numba.memory import prefetch_for_write
from rocking._numba.records import scatter_records
from rocking._numba.simd import LANES, load, select, splat, store
from rocking._solver.stages.state import (
    CHATTER,
    FIRST_IMPACT_TIME,
    FIRST_IMPACT_VELOCITY,
    IMPACTS,
    MODE,
    PEAK,
    UPLIFT_TIME,
)


@kernel
def write_responses(group: Record, done: int, responses: Record) -> None:
    """Write the responses of the lanes whose bits are set in `done`, each at once."""
    columns, response = group.columns, group.response
    for lane in range(LANES):
        group.written[lane] = group.place[lane] if (done >> lane) & 1 else -1
    peak = load(columns, PEAK)
    store(response.peak_rotation, 0, peak)
    store(response.exceeded_alpha, 0, select(peak <= 1.0, splat(0.0), splat(1.0)))  # also where it is nan
    store(response.peak_mode, 0, load(columns, MODE))
    store(response.outcome, 0, load(group.outcome, 0))
    store(response.impacts, 0, load(columns, IMPACTS))
    store(response.chatter, 0, load(columns, CHATTER))
    store(response.uplift_time, 0, load(columns, UPLIFT_TIME))
    store(response.first_impact_time, 0, load(columns, FIRST_IMPACT_TIME))
    store(response.first_impact_velocity, 0, load(columns, FIRST_IMPACT_VELOCITY))
    store(response.end_rotation, 0, load(group.free_z, 0))
    store(response.end_velocity, 0, load(group.free_w, 0))
    scatter_records(response, group.written, responses)


@kernel
def prefetch_responses(responses: Record, first: int, last: int) -> None:
    """Prefetch the memory of responses of the next block, which is written in the order of the ends of the cells."""
    for cell in range(first, min(last, len(responses))):
        prefetch_for_write(responses.ctypes.data + cell * responses.itemsize)
