"""Made-up accelerograms for benchmarks: filtered noise in an envelope, some with a pulse, in the style of real ones."""

from __future__ import annotations

import numpy as np
from scipy.signal import butter, sosfiltfilt

from rocking._excitation.records.record import Record

SAMPLES = 2_000, 18_000
"""Smallest and largest number of samples of a suite."""


def made_up_record(seed: int, samples: int, time_step: float) -> Record:
    """Return noise of a corner period of 0.2 to 1 s, band-passed, under an envelope that rises fast and decays slowly.

    The strong motion fills a tenth to a third of the record, as in records with a coda. Every other record has a
    velocity pulse of 0.8 to 4 s.
    """
    random = np.random.default_rng(seed)
    time = np.arange(samples) * time_step
    duration = samples * time_step
    low, high = random.uniform(0.05, 0.2), min(random.uniform(8.0, 25.0), 0.45 / time_step)
    white = random.standard_normal(samples)
    noise = sosfiltfilt(butter(2, [low, high], "bandpass", fs=1.0 / time_step, output="sos"), white)
    corner = 1.0 / random.uniform(0.2, 1.0)
    noise = sosfiltfilt(butter(1, corner, fs=1.0 / time_step, output="sos"), noise)
    rise, width = random.uniform(0.05, 0.2) * duration, random.uniform(0.1, 0.33) * duration
    later = np.maximum(time - rise, 0.0) / width
    envelope = np.where(time < rise, (time / rise) ** 2, (1.0 + later) * np.exp(-2.0 * later))
    a = envelope * noise / np.abs(envelope * noise).max()
    if seed % 2:
        period, arrival = random.uniform(0.8, 4.0), rise + random.uniform(0.2, 1.0)
        phase = 2.0 * np.pi * (time - arrival) / period
        a += random.uniform(0.3, 1.0) * np.exp(-((phase / 4.0) ** 2)) * np.sin(phase)
    return Record(a / np.abs(a).max() * random.uniform(0.1, 0.8), time_step, unit="g", name=f"made-up {seed}")


def made_up_suite(count: int, seed: int = 0) -> list[Record]:
    """Return `count` records whose numbers of samples are log-spaced over `SAMPLES`, at 0.005 or 0.01 s."""
    sizes = np.geomspace(*SAMPLES, count).round().astype(int)
    return [made_up_record(seed + k, int(size), 0.005 if size > 6000 else 0.01) for k, size in enumerate(sizes)]
