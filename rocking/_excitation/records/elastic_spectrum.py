"""Elastic response spectrum of a record, exact for an acceleration that is linear between samples."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, in_range, one_of
from rocking._excitation.records.floor import PERIODS, oscillator_root, oscillator_states, refined
from rocking._excitation.records.record import Record

if TYPE_CHECKING:
    import xarray as xr

    from rocking._numba.cancellation import StopFlag

STEPS_PER_PERIOD = 8
"""Steps of a period at least [-]: a largest displacement between samples exceeds these by at most 1/cos(pi/8) = 1.08,
and Newton's method from the secant of the velocity finds it."""

NEAR_LARGEST = 0.8  # steps from this share of the largest displacement at samples on are searched [-]
ITERATIONS = 5  # of Newton's method for the time of zero velocity [-]; four reach 1e-15 of a step in the tests
TERMS = 24  # terms of the series of phi_1 and phi_2, abs(w) <= 2 pi/STEPS_PER_PERIOD [-]


def elastic_spectrum(
    record: Record,
    periods: ArrayLike,
    damping: ArrayLike = 0.05,
    *,
    component: Literal["horizontal", "vertical"] = "horizontal",
    stop: StopFlag | None = None,
) -> xr.Dataset:
    """Compute the largest displacement and pseudo-acceleration of linear oscillators under a record over the period.

    The oscillator q'' + 2 zeta omega q' + omega^2 q = -a_g is solved exactly for an acceleration that is linear between
    samples (Nigam & Jennings 1969; `floor_motion`). The largest displacement is that of all times, between the samples
    and in the free vibration after the last one, not of the samples alone.

    Parameters
    ----------
    record : Record
        The motion.
    periods : array_like (periods,)
        Periods 2 pi/omega [s], [1e-3, 100].
    damping : array_like (dampings,)
        Ratios zeta [-], [0, 1).
    component : {"horizontal", "vertical"}
        Which component of the record.
    stop : StopFlag, optional
        Cancels the work, which then raises `StoppedError`.

    Returns
    -------
    xarray.Dataset
        Over `damping` and `period` [s]: `displacement`, S_D = max abs(q) [m]; `pseudo_acceleration`,
        omega^2 S_D [m/s2].

    Raises
    ------
    InvalidArgumentError
        If an argument is not as described, or the record has no vertical component.

    References
    ----------
    Nigam N. C., Jennings P. C. (1969), Calculation of response spectra from strong-motion earthquake records, Bulletin
    of the Seismological Society of America 59(2), 909-922.
    """
    import xarray as xr  # noqa: PLC0415  # takes longer to load than the package

    one_of("component", component, ("horizontal", "vertical"))
    samples = record.acceleration if component == "horizontal" else record.vertical
    if samples is None:
        raise InvalidArgumentError("component", component, "horizontal: the record has no vertical component")
    ranges = {"periods": (periods, *PERIODS, "both", "s"), "damping": (damping, 0.0, 1.0, "left", "-")}
    checked = {}
    for name, (value, low, high, closed, unit) in ranges.items():
        checked[name] = np.atleast_1d(in_range(name, value, low, high, closed=closed, unit=unit))
        if checked[name].ndim != 1 or not checked[name].size:
            raise InvalidArgumentError(name, checked[name].shape, "one dimension, one value or more")
    period, zeta = checked.values()
    displacement = np.empty((zeta.size, period.size))
    for k, ratio in enumerate(zeta.tolist()):
        for n, oscillator_period in enumerate(period.tolist()):
            displacement[k, n] = largest_displacement(samples, record.time_step, oscillator_period, ratio, stop)
    omega = 2.0 * math.pi / period
    names = "damping", "period"
    return xr.Dataset(
        {
            "displacement": (names, displacement, {"units": "m", "long_name": "spectral displacement S_D"}),
            "pseudo_acceleration": (names, omega**2 * displacement, {"units": "m s-2", "long_name": "omega^2 S_D"}),
        },
        {
            "damping": ("damping", zeta, {"units": "1", "long_name": "damping ratio zeta"}),
            "period": ("period", period, {"units": "s", "long_name": "natural period 2 pi/omega"}),
        },
        {"record": record.name, "component": component},
    )


def largest_displacement(a: Array, h: float, period: float, ratio: float, stop: StopFlag | None = None) -> float:
    """Return the largest |q| [m] of an oscillator under samples `a` [m/s2] of step h [s], of all times."""
    if stop is not None:
        stop.check()
    root = oscillator_root(2.0 * math.pi / period, ratio)
    parts = math.ceil(STEPS_PER_PERIOD * h / period)
    a, h = refined(a, parts), h / parts
    z = oscillator_states(a, h, root)
    # q = -Im(z)/omega_d, q' = -Im(lambda z)/omega_d, q'' = -Im(lambda^2 z)/omega_d - a
    displacement, velocity = np.abs(z.imag) / root.imag, (root * z).imag
    largest = float(displacement.max())
    ends = np.maximum(displacement[1:], displacement[:-1])
    k = np.flatnonzero((velocity[1:] * velocity[:-1] < 0.0) & (ends >= NEAR_LARGEST * largest))
    slope, time = (a[k + 1] - a[k]) / h, h * velocity[k] / (velocity[k] - velocity[k + 1])
    for _ in range(ITERATIONS):
        state, push = _after(root, z[k], a[k], slope, time), a[k] + slope * time
        rate = (root * root * state).imag + root.imag * push
        change = (root * state).imag / np.where(rate == 0.0, np.inf, rate)
        time = np.clip(time - change, 0.0, h)
    within = np.abs(_after(root, z[k], a[k], slope, time).imag) / root.imag
    # free: q' = 0 where the angle of lambda z e^(lambda t) is a multiple of pi
    wait = (-np.angle(root * z[-1]) % np.pi) / root.imag
    after = abs((z[-1] * np.exp(root * wait)).imag) / root.imag
    return float(max(largest, after, *within))


def _after(root: complex, z: NDArray[np.complex128], a: Array, slope: Array, time: Array) -> NDArray[np.complex128]:
    """Return z after a time within a step: e^w z + t phi_1(w) a + t^2 phi_2(w) a', w = lambda t."""
    w = root * time
    first, second = np.zeros_like(w), np.zeros_like(w)
    for k in range(TERMS, -1, -1):
        first, second = first * w + 1.0 / math.factorial(k + 1), second * w + 1.0 / math.factorial(k + 2)
    state: NDArray[np.complex128] = np.exp(w) * z + time * first * a + time * time * second * slope
    return state
