"""Peak rotation of a block that survives and whose first impact is after the pulse, (4.12) to (4.16)."""

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.errors import in_range
from rocking.paper.arguments import Array, checked
from rocking.paper.overturning import case_2_margin, impact_velocity_squared


def peak_of_velocity(velocity: ArrayLike) -> Array:
    """Peak rotation theta_m/alpha of free rocking from theta = 0 with a given velocity, (4.12).

    Parameters
    ----------
    velocity : array_like
        eta v_i, d(theta/alpha)/d tau just after the impact [-], [0, inf).

    Returns
    -------
    ndarray
        [-], [0, 1]: the root of (4.12) with the minus sign (the plus sign gives a point beyond the unstable
        equilibrium); nan above velocity 1, where the block overturns.

    Notes
    -----
    The first form of (4.12) is printed with mgR [1 - cos(alpha - theta_m)]. The potential energy gained in free rocking
    is mgR [cos(alpha - theta_m) - cos alpha], and only its linearisation yields the second form.
    """
    with np.errstate(over="ignore"):
        squared = in_range("velocity", velocity, 0.0, np.inf, closed="left") ** 2
    return _peak(squared)


def _peak(squared: Array) -> Array:
    with np.errstate(invalid="ignore"):
        # (4.12): 1 - sqrt(1 - x^2), without cancellation
        return np.asarray(np.where(squared <= 1, squared / (1 + np.sqrt(1 - np.minimum(squared, 1))), np.nan))


def case_1_2_peak(amplitude: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike) -> Array:
    """Peak rotation theta_m/alpha after the first impact, (4.13): closed-form rocking spectrum of the sine.

    [-], [0, 1]; nan where (4.13) has no real root, i.e. where the block overturns by case 1.2, and above (3.10), where
    it overturns without impact. Exact where the first impact is after the pulse (above (3.31)) and the rotation before
    it is smaller; approximate elsewhere.
    """
    a, omega, eta = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, restitution=restitution)
    return _peak(_velocity_squared(a, omega, eta))  # (4.13), first form


def case_1_2_peak_by_pulse(amplitude: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike) -> Array:
    """Peak rotation g theta_m/a_g after the first impact [-], second form of (4.13), as in figure 8.

    [-]; nan as in `case_1_2_peak`.
    """
    peak = case_1_2_peak(amplitude, frequency_ratio, restitution)
    return np.asarray(peak / np.asarray(amplitude))  # (4.13), second form


def scale_function(amplitude: ArrayLike, frequency_ratio: ArrayLike) -> Array:
    """f(a, omega) of the scale law (4.16) [-] in case 1.2: 1 - D0*.

    [-], >= 0; nan above (3.10), where the block overturns without impact.

    Notes
    -----
    The paper prints sqrt(1 - D0*) here and in (4.14) and (4.15). Since 1 - sqrt(1 - x^2) = x^2/2 + ... with
    x = eta sqrt(1 - D0*), the leading term has no square root.
    """
    squared = impact_velocity_squared(amplitude, frequency_ratio)
    has_impact = case_2_margin(amplitude, frequency_ratio) <= 0  # (3.10)
    return np.asarray(np.where(has_impact & (squared >= 0), squared, np.nan))  # (4.16), f without the square root


def small_peak(amplitude: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike) -> Array:
    """Leading term of the peak rotation theta_m/alpha [-] for small eta v_i2, (4.14) corrected, scale law (4.16).

    nan above (3.10), as `scale_function`.
    """
    a, omega, eta = checked(amplitude=amplitude, frequency_ratio=frequency_ratio, restitution=restitution)
    return np.asarray(eta**2 / 2 * scale_function(a, omega))  # (4.14), (4.16), with 1 - D0*, not its square root


def small_peak_by_pulse(amplitude: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike) -> Array:
    """Leading term of g theta_m/a_g [-] for small eta v_i2, (4.15) corrected; nan above (3.10)."""
    return np.asarray(small_peak(amplitude, frequency_ratio, restitution) / np.asarray(amplitude))  # (4.15)


def _velocity_squared(amplitude: ArrayLike, frequency_ratio: ArrayLike, eta: Array) -> Array:
    """(eta v_i2)^2 [-]; nan where the product is zero times infinity."""
    with np.errstate(invalid="ignore"):
        return np.asarray(eta**2 * scale_function(amplitude, frequency_ratio))
