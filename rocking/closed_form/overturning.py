"""Overturning amplitudes of one full sine from all closed forms of section 3 (figure 4)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from rocking.closed_form.arguments import Array
from rocking.closed_form.case_1_1 import case_1_1_amplitudes
from rocking.closed_form.case_1_2 import case_1_2_amplitudes
from rocking.closed_form.case_2 import case_2_amplitude


class OverturningAmplitudes(NamedTuple):
    """Amplitudes a [-] at which the outcome changes.

    The block overturns for falls_from < a < safe_again, but for the gap of the notes, and for a > direct.
    """

    falls_from: Array
    safe_again: Array
    direct: Array


def overturning_amplitudes(frequency_ratio: ArrayLike, restitution: ArrayLike) -> OverturningAmplitudes:
    """Overturning thresholds of one full sine by the closed forms of the paper.

    Parameters
    ----------
    frequency_ratio : array_like
        omega [-], [1e-12, 1e12].
    restitution : array_like
        eta [-], [0, 1].

    Returns
    -------
    OverturningAmplitudes
        Of the broadcast shape. `falls_from` and `safe_again` are the limits of overturning after one impact (cases 1.1
        and 1.2), nan where there is none; from `direct` on the block overturns without impact (case 2).

    Notes
    -----
    Between the two ends a block may survive all the same, near the tip of the region: for eta = 0.72 with omega from
    3.4336 to 3.4395, where a gap reaches into it (2.389 < a < 2.515 at 3.4372). `case_1_1_margin` and
    `case_1_2_margin` are negative there.

    These curves are not complete, contrary to the paper. Near the tip of the safe region (1/a > 0.897, omega < 1.1)
    there are islands in which the block overturns after three, five or more impacts (always an odd number), all within
    the pulse. Outside these islands the solver gave the outcome predicted by the curves for all of 900 000 random
    blocks with eta from 0.3 to 1.
    """
    during = case_1_1_amplitudes(frequency_ratio, restitution)
    after = case_1_2_amplitudes(frequency_ratio, restitution)
    direct = np.broadcast_to(case_2_amplitude(frequency_ratio), during.lower.shape).copy()
    return OverturningAmplitudes(np.fmin(during.lower, after.lower), np.fmax(during.upper, after.upper), direct)
