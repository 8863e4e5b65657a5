"""Measures of a ground motion that is linear between its samples. Arrays (samples,), SI units."""

import math

import numpy as np

from rocking._base.arrays import Array
from rocking._base.constants import STANDARD_GRAVITY

MEAN_PERIOD_BAND = 0.25, 20.0  # frequencies of the mean period [Hz]
MEAN_PERIOD_RESOLUTION = 0.05  # largest spacing of the frequencies of the mean period [Hz] (Rathje et al. 2004)
MAX_PADDING = 16  # samples with appended zeros over those of the record up to which a whole transform is computed [-]


def _from_zero(increments: Array) -> Array:
    """Return the cumulative sums of increments (samples - 1,), zero at the first sample, read-only."""
    sums = np.concatenate([[0.0], np.cumsum(increments)])
    sums.flags.writeable = False
    return sums


def velocity(a: Array, dt: float) -> Array:
    """Return the velocity at the samples, zero at the first: exact integral of the piecewise linear acceleration."""
    return _from_zero(0.5 * dt * (a[1:] + a[:-1]))


def displacement(a: Array, v: Array, dt: float) -> Array:
    """Return the displacement at the samples, zero at the first: exact integral of the quadratic velocity `v`."""
    return _from_zero(dt * v[:-1] + dt * dt / 6.0 * (2.0 * a[:-1] + a[1:]))


def _energy_increments(a: Array, dt: float) -> Array:
    """Return the integral of a^2 over each sample interval [m2/s3]."""
    left, right = a[:-1], a[1:]
    return dt / 3.0 * (left * left + left * right + right * right)


def arias_intensity(a: Array, dt: float) -> float:
    """Return pi/(2 g) integral of a^2 dt [m/s] (Arias 1970)."""
    return float(math.pi / (2.0 * STANDARD_GRAVITY) * _energy_increments(a, dt).sum())


def significant_duration(a: Array, dt: float, first: float = 0.05, last: float = 0.95) -> float:
    """Return the time between two fractions of Arias intensity [s], linear in an interval (Trifunac & Brady 1975)."""
    energy = _from_zero(_energy_increments(a, dt))
    times = np.interp([first * energy[-1], last * energy[-1]], energy, np.arange(a.size) * dt)
    return float(times[1] - times[0])


def mean_period(a: Array, dt: float) -> float:
    """Return T_m = (sum of C^2/f)/(sum of C^2) [s] over Fourier amplitudes C from 0.25 to 20 Hz (Rathje et al. 1998).

    Zeros are appended until the frequencies are at most 0.05 Hz apart; nan if none lies in the band. Of a record much
    shorter than 20 s only the frequencies of the band are computed, so that the memory is that of the record.
    """
    size = max(a.size, math.ceil(1.0 / (MEAN_PERIOD_RESOLUTION * dt)))
    spacing = 1.0 / (size * dt)
    lowest, highest = MEAN_PERIOD_BAND
    k = np.arange(math.floor(lowest / spacing), min(math.ceil(highest / spacing), size // 2) + 1)
    k = k[(k * spacing >= lowest) & (k * spacing <= highest)]
    if k.size == 0:
        return math.nan
    if size <= MAX_PADDING * a.size:
        amplitude = np.fft.rfft(a, size)[k]
    else:
        from scipy.signal import zoom_fft  # noqa: PLC0415  # takes longer to load than the package

        amplitude = np.asarray(zoom_fft(a, [k[0] / size, (k[-1] + 1) / size], m=k.size, fs=1.0), np.complex128)
    power = np.abs(amplitude) ** 2
    total = float(power.sum())
    return float((power / (k * spacing)).sum() / total) if total > 0.0 else math.nan
