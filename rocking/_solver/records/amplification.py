"""Conditioning of responses under records: how much the peak changes with the amplitude of the motion."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._base.errors import broadcast
from rocking._excitation.records.record import Record
from rocking._model.response import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.records.record_response import check_record_groups, record_response

CHANGE = 1e-9
"""Relative change of the amplitude [-]. The rounding error of a peak is some 1e-16 times the amplification, so that the
difference has six digits or more; a larger change would mix in the curvature where the amplification is large."""


def record_amplification(
    motion: Record,
    *,
    frequency_parameter: ArrayLike,
    slenderness: ArrayLike,
    restitution: ArrayLike,
    alpha: ArrayLike | None = None,
    vertical_scale: ArrayLike | None = 1.0,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> NDArray[np.float64]:
    """Relative change of the peak rotation per relative change of the amplitude of the horizontal motion [-].

    By a central difference with amplitudes changed by 1e-9, which costs two more responses. A value A says that samples
    known to n digits leave n - log10(A) digits of the peak. A vertical component is not changed.

    Parameters
    ----------
    motion, frequency_parameter, restitution, alpha, vertical_scale, threads, stop
        As for `peak_response`.
    slenderness : array_like
        g tan(alpha)/PGA [-], [1e-12, inf): depends on the motion, unlike h/b.

    Returns
    -------
    float64 array
        Of the broadcast shape, >= 0; infinite where the outcome changes within 1e-9 of the amplitude, nan where the
        block overturns or does not uplift.
    """
    given = {
        "frequency_parameter": frequency_parameter,
        "slenderness": slenderness,
        "restitution": restitution,
        "alpha": alpha,
        "vertical_scale": vertical_scale,
    }
    p, s, eta, angle, vertical = broadcast(given, [*check_record_groups(motion, **given).values()])
    less, more = (
        record_response(
            motion,
            frequency_parameter=p,
            slenderness=s / (1.0 + change),
            restitution=eta,
            alpha=angle,
            vertical_scale=None if motion.vertical is None else vertical,
            threads=threads,
            stop=stop,
        )
        for change in (-CHANGE, CHANGE)
    )
    middle = 0.5 * (more.peak_rotation + less.peak_rotation)
    rocks = (less.outcome == Outcome.RECOVERS) & (more.outcome == Outcome.RECOVERS)
    relative = np.abs(more.peak_rotation - less.peak_rotation) / np.where(rocks, middle, 1.0) / (2.0 * CHANGE)
    return np.where(less.outcome != more.outcome, np.inf, np.where(rocks, relative, np.nan))
