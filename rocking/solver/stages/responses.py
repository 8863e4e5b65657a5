"""Responses of finished cells, and the memory into which they are written."""

from __future__ import annotations

import math

from rocking._numba.compilation import Record, kernel
from rocking._numba.memory import prefetch_for_write
from rocking.solver.kernels.event_loop import NO_UPLIFT
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
def write_lane(group: Record, lane: int, response: Record) -> None:
    """Write the response of the cell of a lane."""
    columns = group.columns
    response.outcome, response.chatter = int(group.outcome[lane]), int(columns[CHATTER, lane])
    response.impacts, response.peak_mode = int(columns[IMPACTS, lane]), int(columns[MODE, lane])
    response.exceeded_alpha = not (columns[PEAK, lane] <= 1.0)  # also where it is nan
    response.peak_rotation, response.uplift_time = columns[PEAK, lane], columns[UPLIFT_TIME, lane]
    response.first_impact_time = columns[FIRST_IMPACT_TIME, lane]
    response.first_impact_velocity = columns[FIRST_IMPACT_VELOCITY, lane]
    response.end_rotation, response.end_velocity = group.free_z[lane], group.free_w[lane]


@kernel
def prefetch_responses(responses: Record, first: int, last: int) -> None:
    """Prefetch the memory of responses of the next block, which is written in the order of the ends of the cells."""
    for cell in range(first, min(last, len(responses))):
        prefetch_for_write(responses.ctypes.data + cell * responses.itemsize)
