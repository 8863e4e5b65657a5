"""Wavelets fitted to a ground velocity by variable projection.

A velocity pulse is a sum of one or two basis functions of the phase phi = 2 pi (t - t_0)/T_p. Its amplitude and its
phase nu are linear in them and follow from T_p, t_0 and gamma by linear least squares, so that only these three are
searched (Golub & Pereyra 1973). The basis functions have the same scalar products wherever they are centred; the scan
over t_0 is a correlation, by fast Fourier transforms. The best cells of the scan are refined by nonlinear least
squares.

| pulse | velocity | acceleration |
|---|---|---|
| mavroeidis_papageorgiou | (1 + cos(phi/gamma))/2 cos(phi + nu), abs(phi) <= pi gamma | Mavroeidis & Papageorgiou 2003,
eq. 3 |
| ricker | phi exp(-phi^2/4) | symmetric Ricker wavelet |
| ricker_antisymmetric | (1 - phi^2/3) exp(-phi^2/6) | antisymmetric Ricker wavelet |

References
----------
Mavroeidis G. P., Papageorgiou A. S. (2003), A mathematical representation of near-fault ground motions, Bulletin of the
Seismological Society of America 93(3), 1099-1131. Golub G. H., Pereyra V. (1973), The differentiation of
pseudo-inverses and nonlinear least squares problems whose variables separate, SIAM Journal on Numerical Analysis 10(2),
413-432.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft
from scipy.optimize import least_squares

from rocking._base.arrays import Array
from rocking._base.equality import EqualByValue
from rocking._base.errors import InvalidArgumentError, float_array
from rocking._excitation import pulses
from rocking._excitation.pulses import AbstractPulse, SinusoidalPulse

MAX_CYCLES = 10.0  # largest gamma of a fit [-]. Pulses of the cited study have 1 to 3
MIN_CYCLES = 1.0 + 1e-6  # smallest gamma of a fit [-]; at 1 a term of the acceleration vanishes
SHORTEST_PERIOD = 8  # shortest period of a fit, in samples

PERIOD_RATIO = 1.08
"""Ratio of the periods of the scan [-]; the correlation with a pulse falls by a few percent between them."""

SCANNED_CYCLES = (1.1, 1.4, 1.8, 2.4, 3.2, 4.5, 6.5, 9.5)  # values of gamma of the scan [-]
SAMPLES_PER_PERIOD = 24  # samples to which the velocity is averaged for the scan; the refinement uses all samples
STARTS = 4  # refined cells of the scan, with periods that differ by `PERIOD_SEPARATION`
PERIOD_SEPARATION = 0.15  # smallest difference of ln(T_p) between refined cells [-]


@dataclass(frozen=True)
class Family:
    """A kind of velocity pulse."""

    name: str  # of the pulse of `rocking._excitation.pulses` whose acceleration is its derivative
    basis: Callable[[Array, float], Array]  # from phi [rad], (n,), and gamma [-]: the basis functions, (1 or 2, n)
    half_window: Callable[[float], float]  # from gamma: largest abs(phi) [rad] at which they do not vanish
    # values of gamma of the scan; one, without meaning, for a family that has none
    cycles: tuple[float, ...] = (math.nan,)

    @property
    def has_cycles(self) -> bool:
        """True if gamma is a parameter."""
        return len(self.cycles) > 1


def _enveloped(phi: Array, cycles: float) -> Array:
    envelope = np.where(np.abs(phi) <= math.pi * cycles, 0.5 + 0.5 * np.cos(phi / cycles), 0.0)
    return np.stack([envelope * np.cos(phi), -envelope * np.sin(phi)])


FAMILIES = {
    family.name: family
    for family in (
        Family("mavroeidis_papageorgiou", _enveloped, lambda cycles: math.pi * cycles, SCANNED_CYCLES),
        Family("ricker", lambda phi, _: (phi * np.exp(-phi * phi / 4.0))[None], lambda _: 4.0 * math.pi),
        Family(
            "ricker_antisymmetric",
            lambda phi, _: ((1.0 - phi * phi / 3.0) * np.exp(-phi * phi / 6.0))[None],
            lambda _: 4.0 * math.pi,
        ),
    )
}


@dataclass(frozen=True, eq=False)
class VelocityPulse(EqualByValue):
    """A fitted pulse."""

    family: str  # name of its family
    period: float  # T_p [s]
    centre: float  # t_0 [s] from the first sample
    # cycles, phase: gamma [-] and nu [rad], (-pi, pi], of Mavroeidis & Papageorgiou; nan for the others
    cycles: float
    phase: float
    amplitude: float  # of the velocity [m/s]; positive with a phase, of either sign without
    # share, 0 to 1, of the sum of squares of the velocity, zero before and after the record, that the pulse takes away
    explained: float

    def velocity(self, time: Array) -> Array:
        """Return the velocity [m/s] at times [s] from the first sample."""
        phi = 2.0 * math.pi / self.period * (float_array("time", time, unit="s") - self.centre)
        basis = FAMILIES[self.family].basis(phi, self.cycles)
        if basis.shape[0] == 1:
            return np.asarray(self.amplitude * basis[0])
        return np.asarray(self.amplitude * (math.cos(self.phase) * basis[0] + math.sin(self.phase) * basis[1]))

    def acceleration_pulse(self) -> tuple[AbstractPulse, float]:
        """Return the acceleration: a pulse of unit peak, and its peak a_g [m/s2], > 0."""
        rate = 2.0 * math.pi / self.period  # d phi/dt
        if FAMILIES[self.family].has_cycles:
            pulse = pulses.pulse(self.family, cycles=self.cycles, phase=self.phase)
            assert isinstance(pulse, SinusoidalPulse)
            # the first term of the acceleration over rate/(2 gamma) is gamma, that of the pulse gamma/peak
            return pulse, self.amplitude * rate / (2.0 * pulse.terms[0][0])
        pulse = pulses.pulse(self.family if self.amplitude > 0.0 else f"-{self.family}")
        # the derivative of the first velocity is the symmetric wavelet, of unit peak
        peak = 1.0 if self.family == "ricker" else _slope_peak(pulse)
        return pulse, abs(self.amplitude) * rate * peak


def _slope_peak(pulse: AbstractPulse) -> float:
    """Return the largest slope of (1 - phi^2/3) exp(-phi^2/6) [-], which the antisymmetric wavelet has as its unit."""
    phi = np.array(pulse.stationary)
    z = phi / math.sqrt(3.0)
    return float(np.abs((z**3 - 3.0 * z) * np.exp(-0.5 * z * z)).max() / math.sqrt(3.0))


def fit_velocity(velocity: Array, time_step: float, family: str) -> VelocityPulse:
    """Fit the pulse of a family that takes most of the energy of a velocity.

    `velocity` (n,): [m/s], at n >= 2 `SHORTEST_PERIOD` uniform times; not all zero. `time_step`: [s], > 0. `family`:
    one of `FAMILIES`. Raises `InvalidArgumentError` if the velocity is too short or zero.
    """
    kind, values = FAMILIES[family], np.asarray(velocity, dtype=np.float64)
    if values.size < 2 * SHORTEST_PERIOD:
        raise InvalidArgumentError("record", f"{values.size} samples", f"at least {2 * SHORTEST_PERIOD} samples")
    scale = float(np.abs(values).max())
    if not 0.0 < scale < math.inf:
        raise InvalidArgumentError("record", f"largest velocity {scale} m/s", "a motion whose velocity is not zero")
    cells = sorted(_scan(values / scale, time_step, kind), reverse=True)
    starts: list[tuple[float, float, float, float]] = []
    for cell in cells:
        separations = [abs(math.log(cell[1] / start[1])) for start in starts]
        if len(starts) < STARTS and min(separations, default=math.inf) > PERIOD_SEPARATION:
            starts.append(cell)
    fits = [_refined(values / scale, time_step, kind, start[1:]) for start in starts]
    best = max(fits, key=lambda fit: fit.explained)
    return replace(best, amplitude=scale * best.amplitude)


def _scan(velocity: Array, time_step: float, family: Family) -> Iterator[tuple[float, float, float, float]]:
    """Yield the share of energy, T_p [s], t_0 [s] and gamma at the best t_0 for each T_p and gamma of the scan."""
    shortest, longest = SHORTEST_PERIOD * time_step, velocity.size * time_step
    count = math.ceil(math.log(longest / shortest) / math.log(PERIOD_RATIO)) + 1
    energy = float(velocity @ velocity)
    for period in np.geomspace(shortest, longest, count):
        # the pulse is resolved by far fewer samples than a record has
        merged = max(1, int(period / (SAMPLES_PER_PERIOD * time_step)))
        used = velocity.size // merged * merged
        averaged = velocity[:used].reshape(-1, merged).mean(axis=1)
        step = merged * time_step
        per_phase = period / (2.0 * math.pi * step)
        half = {cycles: math.ceil(family.half_window(cycles) * per_phase) for cycles in family.cycles}
        length = next_fast_len(averaged.size + max(half.values()) + 1, real=True)
        spectrum = rfft(averaged, length)
        for cycles in family.cycles:
            offsets = np.arange(-half[cycles], half[cycles] + 1)
            basis = family.basis(2.0 * math.pi * step / period * offsets, cycles)
            wrapped = np.zeros((basis.shape[0], max(length, offsets.size)))
            wrapped[:, offsets] = basis
            if offsets.size > length:  # longer than the record with its zeros: it wraps around
                continue
            products = irfft(spectrum * np.conj(rfft(wrapped[:, :length], axis=1)), length, axis=1)[:, : averaged.size]
            explained = np.einsum("kn,kn->n", products, np.linalg.solve(basis @ basis.T, products))
            best = int(explained.argmax())
            # the mean of a cell is the velocity at its middle
            centre = (best * merged + 0.5 * (merged - 1)) * time_step
            yield float(explained[best]) * merged / energy, float(period), centre, cycles


def _refined(velocity: Array, time_step: float, family: Family, start: tuple[float, float, float]) -> VelocityPulse:
    """Return the local minimum of the residual that belongs to a cell of the scan.

    The velocity is zero before and after the record, as in the scan: else a pulse could lie outside for the most part,
    with any amplitude.
    """
    period, centre, cycles = start
    outside = min(velocity.size, math.ceil(2.0 * family.half_window(cycles) * period / (2.0 * math.pi * time_step)))
    time = np.arange(-outside, velocity.size + outside) * time_step
    padded = np.pad(velocity, outside)
    energy = float(velocity @ velocity)

    def residual_of(parameters: Array) -> Array:
        return projected(parameters)[1]

    def projected(parameters: Array) -> tuple[Array, Array]:
        """Return the coefficients of the basis functions, and the residual."""
        gamma = float(parameters[2]) if family.has_cycles else math.nan
        basis = family.basis(2.0 * math.pi * math.exp(-parameters[0]) * (time - parameters[1] * period), gamma)
        coefficients: Array = np.linalg.lstsq(basis.T, padded, rcond=None)[0].astype(np.float64)
        return coefficients, padded - coefficients @ basis

    shortest, longest = SHORTEST_PERIOD * time_step, 2.0 * velocity.size * time_step
    span = velocity.size * time_step / period
    first = np.array([math.log(period), centre / period, *([cycles] if family.has_cycles else [])])
    low = np.array([math.log(shortest), 0.0, MIN_CYCLES])[: first.size]
    high = np.array([math.log(longest), span, MAX_CYCLES])[: first.size]
    minimum = least_squares(
        residual_of,
        np.clip(first, low + 1e-9, high - 1e-9),
        bounds=(low, high),
        jac="3-point",
        xtol=1e-12,
        ftol=1e-14,
        gtol=1e-14,
        max_nfev=100,
    )
    coefficients, residual = projected(minimum.x)
    explained = max(0.0, 1.0 - float(residual @ residual) / energy)
    period, centre = math.exp(minimum.x[0]), float(minimum.x[1]) * period
    if not family.has_cycles:
        return VelocityPulse(family.name, period, centre, math.nan, math.nan, float(coefficients[0]), explained)
    amplitude, phase = math.hypot(*coefficients), math.atan2(coefficients[1], coefficients[0])
    return VelocityPulse(family.name, period, centre, float(minimum.x[2]), phase, amplitude, explained)
