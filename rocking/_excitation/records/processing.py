"""Processing of a record, each step on request only: baseline correction, band-limited resampling."""

import math
from fractions import Fraction

import numpy as np

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, integer, positive
from rocking._base.units import Scalar

MAX_BASELINE_ORDER = 6  # largest degree of a baseline [-]: higher ones follow the motion itself
MAX_RATIO = 1000  # largest numerator and denominator of the ratio of two time steps [-]
MAX_SAMPLES = 10_000_000  # most samples of a resampled record [-], as of one that is read
ZEROS = 10  # zeros of the interpolation filter on either side [-]

RATIO_TOLERANCE = 1e-9
"""Relative difference of a ratio of time steps from a fraction [-]: steps are often given in a few digits."""

STOP_BAND = 8.0
"""Parameter of the Kaiser window of the interpolation filter [-]: about 80 dB of attenuation in the stop band."""

OFFSET_SHARE = 0.02
"""Offset over the shaking about it from which the PGA is not that of the shaking [-]: 50 processed records have means
up to 0.0012 and levels before the shaking up to 0.012."""

QUIET = 50, 0.05
"""Fewest samples before the shaking that have a level [-]; their largest departure from the first, as a share of the
shaking [-]."""


def offset_remark(a: Array) -> str | None:
    """Return a remark for `a` (samples,) [m/s2] that is scaled by its PGA; None if its offset is small.

    The offset is the mean, or the level before the shaking, whichever is larger beside the largest acceleration about
    it.
    """
    levels = {"mean": float(a.mean())}
    quiet = np.abs(a - a[0]) > QUIET[1] * np.abs(a - levels["mean"]).max()
    count = int(quiet.argmax()) if quiet.any() else 0
    if count >= QUIET[0]:
        levels["level before the shaking"] = float(a[:count].mean())
    name = max(levels, key=lambda key: abs(levels[key]))
    shaking = float(np.abs(a - levels[name]).max())
    if abs(levels[name]) <= OFFSET_SHARE * shaking:
        return None
    return (
        f"its {name} of {levels[name]:.4g} m/s2 is part of its PGA of {np.abs(a).max():.4g} m/s2, which is "
        f"{shaking:.4g} m/s2 about it: remove the baseline (`baseline_order`) before it is scaled"
    )


def baseline(a: Array, v: Array, duration: float, order: int) -> Array:
    """Return the acceleration `a` (samples,) less the derivative of a polynomial fitted to the velocity `v` (samples,).

    The polynomial of degree `order` + 1 is zero at the first sample, as the velocity. Time is divided by the `duration`
    [s]: the least-squares problem is then well conditioned for the degrees allowed. At least `order` + 2 samples are
    needed.
    """
    order = integer("order", order, 0, MAX_BASELINE_ORDER)
    if a.size < order + 2:
        raise InvalidArgumentError("order", order, f"an integer, at least 2 smaller than the {a.size} samples")
    time = np.linspace(0.0, 1.0, a.size)
    powers = np.arange(1, order + 2)
    coefficients = np.linalg.lstsq(time[:, None] ** powers, v, rcond=None)[0]
    slope = time[:, None] ** (powers - 1) @ (powers * coefficients)
    return np.asarray(a - slope / duration)


def resample(a: Array, dt: float, time_step: Scalar) -> Array:
    """Return the samples of the band-limited signal at the step `time_step`, zero outside of the record."""
    step = positive("time_step", time_step, "s")
    ratio = Fraction(dt / step).limit_denominator(MAX_RATIO)
    if not 1 <= ratio.numerator <= MAX_RATIO or abs(float(ratio) * step / dt - 1.0) > RATIO_TOLERANCE:
        raise InvalidArgumentError(
            "time_step", step, f"{dt:g} s times a fraction of integers up to {MAX_RATIO} in numerator and denominator"
        )
    count = math.floor((a.size - 1) * ratio * (1.0 + RATIO_TOLERANCE)) + 1
    if count < 2:
        raise InvalidArgumentError("time_step", step, f"at most the duration, {(a.size - 1) * dt:g} s")
    if count > MAX_SAMPLES:
        raise InvalidArgumentError("time_step", step, f"a step that gives at most {MAX_SAMPLES} samples, not {count}")
    return a if ratio == 1 else _interpolated(a, ratio.numerator, ratio.denominator, count)


def _interpolated(a: Array, up: int, down: int, count: int) -> Array:
    """Convolve with a windowed sinc: values (count,) of the band-limited signal at multiples of down/up steps.

    As `scipy.signal.resample_poly`, which takes longer to load than all other parts of a response to a record. The
    filter is stated at 1/up of a step and cuts off at the lower of the two Nyquist frequencies.
    """
    half = ZEROS * max(up, down)
    h = np.sinc(np.arange(-half, half + 1) / max(up, down)) * np.kaiser(2 * half + 1, STOP_BAND)
    taps = 2 * half // up + 1
    h = np.pad(up / h.sum() * h, (0, taps * up - h.size))
    windows = np.lib.stride_tricks.sliding_window_view(np.pad(a, taps), taps)
    values = np.empty(count)
    for i in range(min(up, count)):  # every up-th value has the same part of the filter
        last, part = divmod(i * down + half, up)
        values[i::up] = windows[last + 1 :: down][: values[i::up].size] @ h[part::up][::-1]
    return values
