"""Motion of a floor: the absolute acceleration of a structure under a recorded ground motion."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, broadcast, in_range, number, one_of
from rocking._base.units import Scalar
from rocking._excitation.records.record import TIME_STEP, Record

if TYPE_CHECKING:
    from rocking._numba.cancellation import StopFlag

MAX_SAMPLES = 2_000_000  # most samples of a result [-]
PERIODS = 1e-3, 100.0  # shortest and longest period of a mode [s]
TAIL_PERIODS = 10.0  # time that is appended to the record, over the longest period [-]
SERIES_TERMS = 20  # terms of the series of phi_2 where abs(w) <= 1 [-]: the first one left out is below 1e-21


def floor_motion(
    record: Record,
    *,
    periods: ArrayLike,
    damping: ArrayLike = 0.05,
    participation: ArrayLike = 1.0,
    vertical: Literal["pass", "filter"] = "pass",
    relative_tolerance: Scalar = 1e-3,
    tail: Scalar | None = None,
    stop: StopFlag | None = None,
) -> Record:
    """Compute the motion of a floor of a linear structure under a record, as a record of its absolute acceleration.

    Each mode n is an oscillator q'' + 2 zeta omega q' + omega^2 q = -a_g, and the floor has the acceleration
    a_g + sum of Gamma_n q_n'' (Chopra 2017, section 13.1), so that what the modes leave of the sum of Gamma_n to 1
    follows the ground. The oscillators are solved exactly for a ground acceleration that is linear between samples
    (Nigam & Jennings 1969), in the complex form z' = lambda z + a_g, lambda = -zeta omega + i omega_d, in which
    q'' + a_g = 2 Re(r z) with r = (omega^2 + 2 zeta omega lambda)/(2 i omega_d).

    Parameters
    ----------
    record : Record
        Motion of the ground.
    periods : array_like (modes,)
        Periods 2 pi/omega [s], [1e-3, 100].
    damping : array_like (modes,)
        Ratios zeta [-], [0, 1).
    participation : array_like (modes,)
        Participation factor times mode shape at the floor, Gamma_n [-], [-100, 100].
    vertical : {"pass", "filter"}
        Whether the floor has the vertical acceleration of the ground, or that of the same modes.
    relative_tolerance : float
        Largest interpolation error of the result over its peak acceleration [-], [1e-6, 0.1]. The step of the result is
        that of the record over a power of two, the largest at which the error, measured against the exact acceleration
        in the middle of every step, is not above it. The `source` of the result states step and error. Not counted is
        the step after the last sample of the record, in which what follows the ground falls to zero.
    tail : float, optional
        Time appended, in which the structure vibrates freely above a ground at rest [s], [0, 1e4]; by default ten times
        the longest period. The result is zero after it.
    stop : StopFlag, optional
        Cancels the work: it raises `StoppedError` soon after another thread sets the flag.

    Returns
    -------
    Record
        The motion of the floor, to which every function for records applies.

    Raises
    ------
    InvalidArgumentError
        If an argument is not as described, or the result would have more than 2 million samples or a step below 1 us.

    References
    ----------
    Chopra A. K. (2017), Dynamics of structures, 5th edition, Pearson. Nigam N. C., Jennings P. C. (1969), Calculation
    of response spectra from strong-motion earthquake records, Bulletin of the Seismological Society of America 59(2),
    909-922.
    """
    period = np.atleast_1d(in_range("periods", periods, *PERIODS, unit="s"))
    zeta = in_range("damping", damping, 0.0, 1.0, closed="left")
    gamma = in_range("participation", participation, -100.0, 100.0)
    arguments = {"periods": periods, "damping": damping, "participation": participation}
    period, zeta, gamma = broadcast(arguments, (period, zeta, gamma))
    if period.ndim != 1 or not period.size:
        raise InvalidArgumentError("periods", period.shape, "one dimension, one period or more")
    modes = 2.0 * math.pi / period, zeta, gamma
    one_of("vertical", vertical, ("pass", "filter"))
    allowed = number("relative_tolerance", relative_tolerance, 1e-6, 0.1)
    after = TAIL_PERIODS * float(period.max()) if tail is None else number("tail", tail, 0.0, 1e4, unit="s")
    parts = 1
    while True:
        step = record.time_step / parts
        extra = math.ceil(after / step)
        if step < TIME_STEP[0] or record.samples * parts + extra > MAX_SAMPLES:
            raise InvalidArgumentError(
                "relative_tolerance",
                allowed,
                f"more: a step of {step:g} s over {record.duration + after:g} s is not fine enough",
            )
        exact = _floor(refined(record.acceleration, 2 * parts), step / 2.0, 2 * extra, *modes, stop)
        horizontal = exact[::2]
        errors = np.abs(exact[1::2] - 0.5 * (horizontal[:-1] + horizontal[1:]))
        errors[(record.samples - 1) * parts :][:1] = 0.0  # there the ground stops at once
        error = float(errors.max())
        if error <= allowed * np.abs(horizontal).max():
            break
        parts *= 2
    upwards = None
    if record.vertical is not None and vertical == "filter":
        upwards = _floor(refined(record.vertical, parts), step, extra, *modes, stop)
    elif record.vertical is not None:
        upwards = np.pad(refined(record.vertical, parts), (0, extra))
    periods_text = ", ".join(f"{value:g}" for value in period)
    remark = f"floor motion of periods {periods_text} s, step {step:g} s"
    source = f"{record.source}; {remark}, linear between samples to {error:.2g} m/s2".removeprefix("; ")
    return Record(horizontal, step, "m/s2", record.name, source, record.remarks, vertical=upwards)


def isolated_motion(
    record: Record,
    *,
    period: Scalar,
    damping: Scalar,
    vertical: Literal["pass", "filter"] = "pass",
    relative_tolerance: Scalar = 1e-3,
) -> Record:
    """Compute the motion above a linear base isolation, as a record: `floor_motion` of one mode with the whole mass.

    Parameters
    ----------
    record : Record
        Motion of the ground.
    period : float
        Of the isolated structure [s], [1e-3, 100].
    damping : float
        Ratio zeta [-], [0, 1).
    vertical, relative_tolerance
        As for `floor_motion`.

    Raises
    ------
    InvalidArgumentError
        As for `floor_motion`.
    """
    checked_period = number("period", period, *PERIODS, unit="s")
    zeta = number("damping", damping, 0.0, 1.0, closed="left")
    return floor_motion(
        record, periods=checked_period, damping=zeta, vertical=vertical, relative_tolerance=relative_tolerance
    )


def refined(a: Array, parts: int) -> Array:
    """Interpolate the samples at 1/parts of the step."""
    return np.interp(np.arange((a.size - 1) * parts + 1) / parts, np.arange(a.size), a)


def _floor(a: Array, h: float, extra: int, omega: Array, zeta: Array, gamma: Array, stop: StopFlag | None) -> Array:
    """Return the acceleration of the floor at the samples of `a`, of step h [s], and `extra` ones of free vibration."""
    acceleration = np.pad((1.0 - gamma.sum()) * a, (0, extra))
    for frequency, ratio, factor in zip(omega, zeta, gamma, strict=True):
        if stop is not None:
            stop.check()
        root = oscillator_root(frequency, ratio)
        z = oscillator_states(a, h, root)
        free = z[-1] * np.exp(root * h * np.arange(1, extra + 1))
        residue = (frequency**2 + 2.0 * ratio * frequency * root) / (2j * root.imag)
        acceleration += factor * 2.0 * (residue * np.concatenate([z, free])).real
    return acceleration


def oscillator_root(frequency: float, ratio: float) -> complex:
    """Return lambda = -zeta omega + i omega_d [1/s] of an oscillator with omega [rad/s] and zeta [-]."""
    return complex(-ratio * frequency, frequency * math.sqrt(1.0 - ratio * ratio))


def oscillator_states(a: Array, h: float, root: complex) -> NDArray[np.complex128]:
    """Return the state z of z' = lambda z + a at the samples of `a`, linear over steps of h [s]; exact."""
    from scipy.signal import lfilter  # noqa: PLC0415  # takes longer to load than the package

    w = root * h
    if abs(w) <= 1.0:
        second = sum(w**k / math.factorial(k + 2) for k in range(SERIES_TERMS))
    else:
        second = (np.expm1(w) - w) / w**2
    # z(h) = e^w z(0) + h ((phi_1 - phi_2) a(0) + phi_2 a(h)), phi_1 = (e^w - 1)/w, phi_2 = (phi_1 - 1)/w
    start, end = h * (np.expm1(w) / w - second), h * second
    states: NDArray[np.complex128] = lfilter([end, start], [1.0, -np.exp(w)], a, zi=[-end * a[0]])[0]
    return states
