"""Interval of amplitudes in which one mechanism overturns the block."""

from __future__ import annotations

from typing import NamedTuple

from rocking.closed_form.arguments import Array


class AmplitudeInterval(NamedTuple):
    """The block overturns for lower < a < upper [-]; both are nan where the mechanism does not occur."""

    lower: Array
    upper: Array
