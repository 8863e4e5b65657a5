"""How long an assessment takes: `python -m benchmarks.cost.assessment` prints wall-clock and processor times.

The lowest factors of made-up objects in two directions, under seven pulse shapes at 0.3 g and 0.3 m/s and under a suite
of made-up records at 0.3 g; both use all cores. Kernels are compiled before.
"""

from __future__ import annotations

import time

import numpy as np

import rocking
from benchmarks.cost.made_up_records import made_up_record
from benchmarks.measure import arguments
from rocking._assessment.objects import Bodies
from rocking._assessment.search import factors_of

SAMPLES, STEP = 3_000, 0.01
"""Of each record [-, s]."""


def made_up_objects(count: int) -> list[rocking.Object]:
    """Return objects of 0.3 to 2.5 m whose bases are 0.12 to 0.5 times as wide and as deep."""
    random = np.random.default_rng(17)
    heights, shares = np.exp(random.uniform(np.log(0.3), np.log(2.5), count)), random.uniform(0.12, 0.5, (count, 2))
    return [
        rocking.Object(f"object {k}", width=h * w, depth=h * d, height=h)
        for k, (h, (w, d)) in enumerate(zip(heights.tolist(), shares.tolist(), strict=True))
    ]


def main() -> None:
    """Command line."""
    options = arguments(__doc__, objects=2000, records=40)
    suite = [made_up_record(seed, SAMPLES, STEP) for seed in range(options.records)]
    body = Bodies.of(made_up_objects(options.objects)).scaled()
    for site in (rocking.Site(pga="0.3 g", pgv="0.3 m/s"), rocking.Site(pga="0.3 g", records=suite)):
        factors_of(Bodies.of(made_up_objects(1)).scaled(), site.motions[-1:])
        wall, processor = time.perf_counter(), time.process_time()
        found = factors_of(body, site.motions)
        wall, processor = time.perf_counter() - wall, time.process_time() - processor
        about = f"{options.objects} objects, {len(site.motions)} {'records' if site.records else 'pulses'}"
        print(f"{about}: {found.size} factors in {wall:.1f} s, {processor:.1f} s of processor time", flush=True)


if __name__ == "__main__":
    main()
