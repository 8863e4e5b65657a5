"""How long an assessment takes: `python -m benchmarks.cost.assessment` prints wall-clock and processor times.

The lowest factors of made-up objects in two directions, under seven pulse shapes at 0.3 g and 0.3 m/s and under a suite
of made-up records at 0.3 g; both use all cores. Kernels are compiled before.

With `--scan 2000` it compares the lowest factors under three suites with scans of so many factors, in equal ratios or
steps from uplift up to them. It prints in how many pairs of an object and a record the body overturns at a lower one.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import rocking_assessment
from rocking_assessment._objects.objects import Bodies
from rocking_assessment._objects.search import HIGHEST_FACTOR, factors_of, overturned_by
from scipy.signal import butter, sosfiltfilt

import rocking
from benchmarks.cost.made_up_records import made_up_record
from benchmarks.measure import arguments
from rocking._boundary.scan import RESOLUTION

SAMPLES, STEP = 3_000, 0.01
"""Of each record [-, s]."""

MOTIONS = Path(__file__).parents[2] / "workflow/motions"


def made_up_objects(count: int, seed: int = 17) -> list[rocking_assessment.Object]:
    """Return objects of 0.3 to 2.5 m whose bases are 0.12 to 0.5 times as wide and as deep."""
    random = np.random.default_rng(seed)
    heights, shares = np.exp(random.uniform(np.log(0.3), np.log(2.5), count)), random.uniform(0.12, 0.5, (count, 2))
    return [
        rocking_assessment.Object(f"object {k}", width=h * w, depth=h * d, height=h)
        for k, (h, (w, d)) in enumerate(zip(heights.tolist(), shares.tolist(), strict=True))
    ]


def noise_record(seed: int, samples: int = 2000) -> rocking.Record:
    """Return band-passed noise of 20 s that rises in 1 to 3 s, stays for 3 to 9 s and decays."""
    random = np.random.default_rng(seed)
    band = [random.uniform(0.1, 0.5), random.uniform(3.0, 12.0)]
    noise = sosfiltfilt(butter(2, band, "bandpass", fs=1.0 / STEP, output="sos"), random.standard_normal(samples))
    time_ = np.arange(samples) * STEP
    rise, hold = random.uniform(1.0, 3.0), random.uniform(3.0, 9.0)
    decay = np.exp(-np.maximum(time_ - rise - hold, 0.0) / random.uniform(1.0, 4.0))
    return rocking.Record(np.minimum(time_ / rise, 1.0) ** 2 * decay * noise, STEP, "m/s2", f"noise {seed}")


def compare(name: str, suite: Sequence[rocking.Record], objects: int, count: int, resolution: float, seed: int) -> None:
    """Print in how many pairs a scan of `count` factors finds a lower one, and how much lower at most."""
    site = rocking_assessment.Site(pga="0.3 g", records=suite)
    body = Bodies.of(made_up_objects(objects, seed)).scaled()
    processor = time.process_time()
    found = factors_of(body, site.motions, resolution=resolution)
    processor = time.process_time() - processor
    print(f"{name}: {found.size} pairs, {1e3 * processor / found.size:.1f} ms of processor time a pair", flush=True)
    share = (np.arange(count) + 0.5) / count
    for scan in ("equal ratios", "equal steps"):
        lower = []
        for motion, factor in zip(site.motions, np.nan_to_num(found.T, nan=HIGHEST_FACTOR), strict=True):
            start = np.asarray(body.uplift_acceleration) / motion.peak_acceleration
            start, end = np.minimum(start, factor)[:, None], factor[:, None]
            tried = start + (end - start) * share if scan == "equal steps" else start * (end / start) ** share
            tried = np.where(tried < end, tried, 0.5 * start)  # without uplift
            hits = overturned_by(body.column, motion, None, tried * motion.peak_acceleration)
            first = np.where(hits.any(axis=1), tried[np.arange(factor.size), hits.argmax(axis=1)], factor)
            lower.append(1.0 - first / factor)
        all_of = np.array(lower)
        print(
            f"    {scan}: lower in {np.sum(all_of > 2e-6)}, by more than 1 % in {np.sum(all_of > 0.01)}, at most "
            f"{100 * all_of.max():.2g} %",
            flush=True,
        )


def main() -> None:
    """Command line."""
    options = arguments(__doc__, objects=2000, records=40, scan=0, resolution=RESOLUTION, seed=0)
    if options.scan:
        suites = {
            "made-up records": [made_up_record(options.seed + k, SAMPLES, STEP) for k in range(8)],
            "noise": [noise_record(1000 + options.seed + k) for k in range(8)],
            "records of the workflow": [rocking.read_record(path) for path in sorted(MOTIONS.glob("*.csv"))],
        }
        for name, suite in suites.items():
            compare(name, suite, round(48 / len(suite)), options.scan, options.resolution, options.seed + 17)
        return
    suite = [made_up_record(seed, SAMPLES, STEP) for seed in range(options.records)]
    body = Bodies.of(made_up_objects(options.objects)).scaled()
    for site in (
        rocking_assessment.Site(pga="0.3 g", pgv="0.3 m/s"),
        rocking_assessment.Site(pga="0.3 g", records=suite),
    ):
        factors_of(Bodies.of(made_up_objects(1)).scaled(), site.motions[-1:])
        wall, processor = time.perf_counter(), time.process_time()
        found = factors_of(body, site.motions)
        wall, processor = time.perf_counter() - wall, time.process_time() - processor
        about = f"{options.objects} objects, {len(site.motions)} {'records' if site.records else 'pulses'}"
        print(f"{about}: {found.size} factors in {wall:.1f} s, {processor:.1f} s of processor time", flush=True)


if __name__ == "__main__":
    main()
