"""Integrals of a pulse shape: the ground velocity that it makes."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from rocking._excitation.shapes import AbstractPulse

NODES = 40  # Gauss points on each monotone piece [-]: exact to rounding for the pulses by name
HALVINGS = 60  # halvings of the bracket of a zero of f [-]
STILL = 1e-9  # largest final velocity over the largest one of a pulse that leaves the ground at rest [-]


@dataclass(frozen=True)
class Impulse:
    """Integrals of f(phi); times a_g T_p/(2 pi) they are ground velocities."""

    largest: float  # largest absolute value of the integral of f from the start [-]
    final: float  # the integral over the whole window [-]
    total: float  # integral of the absolute value [-]

    @property
    def ends_at_rest(self) -> bool:
        """True if the ground has no velocity after the pulse."""
        return abs(self.final) <= STILL * self.largest


@lru_cache(maxsize=64)
def impulse_of(pulse: AbstractPulse) -> Impulse:
    """Integrate a pulse, split where f' or f is zero: between them the velocity is monotone."""
    samples = pulse.samples
    ends = np.array([pulse.start, *pulse.stationary, pulse.end]) if samples is None else samples[0]
    low, high = ends[:-1].copy(), ends[1:].copy()
    below = pulse.shape(low) < 0.0
    crossed = below != (pulse.shape(high) < 0.0)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        before = (pulse.shape(middle) < 0.0) == below
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    ends = np.union1d(ends, high[crossed])
    x, weight = np.polynomial.legendre.leggauss(NODES if samples is None else 2)
    half = 0.5 * np.diff(ends)[:, None]
    parts = (pulse.shape(0.5 * (ends[1:] + ends[:-1])[:, None] + half * x) * half * weight).sum(axis=1)
    velocity = np.cumsum(parts)
    return Impulse(float(np.abs(velocity).max()), float(velocity[-1]), float(np.abs(parts).sum()))
