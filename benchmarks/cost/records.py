"""Cost of responses under recorded motions: `python -m benchmarks.cost.records`.

A suite of made-up records of 2,000 to 18,000 samples, amplitudes PGA/(g tan(alpha)) from 0.5 to 10, blocks of R from
0.5 to 4 m, restitution 0.9, on one thread: runs per second, the share of the samples that is stepped through, and how
time depends on the number of samples. SciPy's DOP853 is restarted at every sample, with the events of the block, on a
few of the same runs (`reference_problems`); both are measured in the same process.
"""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from benchmarks.accuracy.reference_problems import by_scipy
from benchmarks.cost.made_up_records import made_up_record, made_up_suite
from benchmarks.measure import arguments, finish, progress, shortest, versions
from rocking._base.constants import STANDARD_GRAVITY
from rocking._excitation.records.record import Record
from rocking._numba.cancellation import NEVER_STOPPED
from rocking._numba.simd import LANES
from rocking._solver.records.batch import solve_by_steps, solve_slender
from rocking._solver.records.record_response import record_response
from rocking._solver.records.samples import motion_samples
from rocking._solver.records.state import body_states, step_state
from rocking._solver.state import EDGE_COLUMNS, RESPONSE_RECORD, block_cells

HALF_DIAGONAL = np.array([0.5, 1.0, 2.0, 4.0])
FREQUENCY_PARAMETER = np.sqrt(0.75 * STANDARD_GRAVITY / HALF_DIAGONAL)
AMPLITUDE = 0.5, 10.0
RESTITUTION = 0.9
ALPHA = {"slender": 0.0, "rigid": 0.25}


def blocks(scales: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return p [rad/s] and slenderness of all runs under one record, flat: the sizes by the scales."""
    p, s = np.broadcast_arrays(FREQUENCY_PARAMETER[:, None], 1.0 / np.geomspace(*AMPLITUDE, scales))
    return p.ravel(), s.ravel()


def respond(motion: Record, kind: str, scales: int) -> NDArray[np.float64]:
    """Return the peaks of all runs under one record."""
    p, s = blocks(scales)
    groups = {"frequency_parameter": p, "slenderness": s, "restitution": RESTITUTION, "alpha": ALPHA[kind]}
    return record_response(motion, **groups, threads=1).peak_rotation


def stepped(motion: Record, kind: str, scales: int) -> int:
    """Return the number of sample intervals that the solver steps through."""
    p, s = blocks(scales)
    eta, found = np.full(s.size, RESTITUTION), np.empty(s.size, RESPONSE_RECORD)
    step, samples = p * motion.time_step, motion_samples(motion)
    cells = block_cells(step, s, eta, np.full(s.size, ALPHA[kind] or 0.0))
    if kind == "slender":
        return int(solve_slender(samples, cells, body_states(samples, 1)[0], NEVER_STOPPED, found))
    lanes, steps = body_states(samples, LANES), step_state(samples, cells)
    return int(solve_by_steps(samples, cells, lanes, steps, NEVER_STOPPED, found, np.empty((0, EDGE_COLUMNS))))


def dop853_peak(motion: Record, p: float, slenderness: float, eta: float, alpha: float) -> float:
    """Return the peak of one run by DOP853 restarted at every sample, as many scripts do."""
    edge = {"alpha": alpha or 0.1, "p": p, "restitution": eta}
    resisted = math.tan(alpha) if alpha else edge["alpha"]  # the peak is relative to alpha, which slender blocks lack
    body = {
        "equation": "rigid" if alpha else "slender",
        "edges": {"left": edge, "right": edge},
        "gravity": slenderness * motion.peak_acceleration / resisted,
    }
    samples = {"kind": "samples", "horizontal": motion.acceleration.tolist(), "vertical": None}
    found = by_scipy({"body": body, "motion": samples | {"time_step": motion.time_step}}, rest=1e-5, most=100_000)
    return float(found["peak_rotation"])


def measure(records: int, scales: int, rounds: int, reference_runs: int) -> dict[str, Any]:
    """Measure everything; return one record."""
    suite = made_up_suite(records)
    found: dict[str, Any] = {"versions": versions("numpy", "numba", "scipy")}
    runs = records * scales * len(HALF_DIAGONAL)
    total = sum(motion.samples - 1 for motion in suite) * scales * len(HALF_DIAGONAL)
    for kind in ALPHA:
        peaks = np.array([respond(motion, kind, scales) for motion in suite])  # loads the kernels
        seconds = shortest(lambda kind=kind: [respond(motion, kind, scales) for motion in suite], rounds)
        progress(f"{kind}: {runs / seconds:.0f} runs/s")
        found[kind] = {
            "runs": runs,
            "runs a second, one core": runs / seconds,
            "overturned": float(np.isnan(peaks).mean()),
            "no uplift": float((peaks == 0.0).mean()),
            "share of samples stepped": sum(stepped(motion, kind, scales) for motion in suite) / total,
        }
        for size in (2_000, 6_000, 18_000):
            motion = made_up_record(1, size, 20.0 / size)
            seconds = shortest(lambda motion=motion, kind=kind: respond(motion, kind, scales), rounds)
            found[kind][f"us a run, {size} samples"] = 1e6 * seconds / (4 * scales)
        found[kind] |= compare(suite, kind, reference_runs)
    return found


def compare(suite: list[Record], kind: str, count: int) -> dict[str, float]:
    """Compare the package with DOP853 on some surviving runs."""
    random = np.random.default_rng(5)
    theirs, ratios, errors = [], [], []
    while len(theirs) < count:
        motion = suite[int(random.integers(len(suite) // 2))]
        p, s = float(random.choice(FREQUENCY_PARAMETER)), 1.0 / random.uniform(1.2, 3.0)
        groups = {"frequency_parameter": p, "slenderness": s, "restitution": RESTITUTION, "alpha": ALPHA[kind]}
        exact = float(record_response(motion, **groups).peak_rotation)
        if not exact > 0.0:
            continue
        start = time.process_time()
        errors.append(abs(dop853_peak(motion, *groups.values()) / exact - 1.0))
        theirs.append(time.process_time() - start)
        groups["slenderness"] = np.full(200, s)
        ours = shortest(lambda groups=groups, motion=motion: record_response(motion, **groups, threads=1), 3) / 200
        ratios.append(theirs[-1] / ours)
        progress(f"{kind}: DOP853 run {len(theirs)} of {count}")
    return {
        "DOP853, s a run": float(np.median(theirs)),
        "DOP853 over package": float(np.median(ratios)),
        "median difference of the peaks": float(np.median(errors)),
    }


def table(found: dict[str, Any]) -> str:
    """Format the record as text."""
    return pd.DataFrame({kind: found[kind] for kind in ALPHA}).to_string(float_format="{:.4g}".format)


if __name__ == "__main__":
    out = Path("results/benchmarks/records.json")
    options = arguments(__doc__, records=72, scales=150, rounds=3, reference_runs=6, out=out)
    found = measure(options.records, options.scales, options.rounds, options.reference_runs)
    finish(found, options.out, table)
