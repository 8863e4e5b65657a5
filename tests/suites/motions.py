"""Records with known answers: pulses, sampled finely."""

from __future__ import annotations

import numpy as np

import rocking
from rocking import Block, Record

BLOCK = Block.from_slenderness_angle(0.2, 1.0)


def sampled(pulse: str, frequency_ratio: float, block: Block = BLOCK, samples: int = 2000, name: str = "") -> Record:
    """A pulse of unit peak [m/s2] with omega_g/p of a block."""
    shape = rocking.pulse(pulse)
    phi = np.linspace(shape.start, shape.end, samples)
    step = (phi[1] - phi[0]) / (frequency_ratio * block.frequency_parameter)
    return Record(shape.acceleration(phi), step, "m/s2", name=name or f"{pulse} {frequency_ratio:.3g}")


def noise(seed: int, samples: int = 1500, step: float = 0.01) -> Record:
    """Filtered noise in an envelope, about 0.3 g."""
    draw = np.random.default_rng(seed)
    time = np.arange(samples) * step
    spectrum = np.fft.rfft(draw.standard_normal(samples))
    frequency = np.fft.rfftfreq(samples, step)
    band = np.exp(-0.5 * (np.log(np.maximum(frequency, 1e-3) / draw.uniform(0.8, 2.0)) / 0.6) ** 2)
    envelope = np.exp(-0.5 * ((time - 0.4 * time[-1]) / (0.15 * time[-1])) ** 2)
    acceleration = envelope * np.fft.irfft(spectrum * band, samples)
    return Record(3.0 * acceleration / np.abs(acceleration).max(), step, "m/s2", name=f"noise {seed}")
