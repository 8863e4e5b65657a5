"""Random blocks under random recorded motions against the multi-precision integration: `python -m stress.records`.

Motions of 20 to 300 samples: noise, bursts, sampled sines, motions that start or end with a jump, and spikes, sample
intervals of 0.003 to 0.5 in p t; restitution 0 and 1 included. A peak is right if its error is at most 1000 roundings
times max(1, amplification), where the amplification is the relative change of the peak per relative change of the
amplitude. Cases whose amplification is beyond `LARGEST_AMPLIFICATION` are counted, not judged: the last bits of the
input decide there.
"""

from __future__ import annotations

import math
import sys
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.measure import arguments, progress
from reference.exact_response import CAPPED
from reference.records import response_and_amplification
from rocking._excitation.records.record import Record
from rocking._solver.records.record_response import record_response

ROUNDING = 2.2e-16
ALLOWED = 1000
LARGEST_AMPLIFICATION = 1e9


class Verdict(NamedTuple):
    """Comparison of one case; `error` is relative to what is allowed, nan where no peak is compared."""

    right: bool
    judged: bool
    error: float
    outcome: int
    amplification: float


def random_case(seed: int) -> tuple[Record, dict[str, float | None]]:
    """Return the motion of a seed, and the groups of its block."""
    random = np.random.default_rng(seed)
    interval = 10.0 ** random.uniform(-2.5, -0.3)
    p = random.uniform(1.0, 6.0)
    samples = _random_motion(random, int(random.integers(20, 300)), interval)
    special = random.uniform()
    eta = 0.0 if special < 0.05 else 1.0 if special < 0.1 else random.uniform() if special < 0.4 else None
    rigid = random.uniform() < 0.4
    groups = {
        "frequency_parameter": p,
        "slenderness": random.uniform(0.08, 0.98),
        "restitution": random.uniform(0.7, 1.0) if eta is None else eta,
        "alpha": 10.0 ** random.uniform(-2.0, 0.1) if rigid else None,
    }
    return Record(samples, interval / p, unit="m/s2", name=f"random {seed}"), groups


def _random_motion(random: np.random.Generator, count: int, interval: float) -> NDArray[np.float64]:
    tau = np.arange(count) * interval
    kind = random.integers(5)
    if kind == 0:
        walk = np.convolve(random.standard_normal(count), np.ones(int(random.integers(1, 8))), "same")
        return np.asarray(walk * np.exp(-(((tau / tau[-1] - 0.4) / 0.3) ** 2)))
    if kind == 1:
        burst = random.uniform(size=count) < 0.1
        return np.asarray(np.where(burst, random.standard_normal(count), 0.01 * random.standard_normal(count)))
    if kind == 2:
        return np.asarray(np.sin(random.uniform(1.0, 8.0) * tau + random.uniform(0.0, 6.3)) + 1e-3)
    if kind == 3:
        return np.asarray(np.cumsum(random.standard_normal(count)) + random.uniform(-3.0, 3.0))
    spikes = np.zeros(count)
    spikes[random.integers(0, count, 6)] = random.standard_normal(6)
    return spikes


def judge(motion: Record, groups: dict[str, float | None]) -> Verdict:
    """Compare the solver with the reference."""
    exact, amplification = response_and_amplification(motion.acceleration.tolist(), motion.time_step, **groups)
    response = record_response(motion, **groups)  # type: ignore[arg-type]  # alpha may be None
    outcome = int(response.outcome)
    if exact.outcome == CAPPED or amplification > LARGEST_AMPLIFICATION:
        return Verdict(True, False, math.nan, exact.outcome, amplification)
    if outcome != exact.outcome:
        return Verdict(False, True, math.inf, exact.outcome, amplification)
    if exact.peak_rotation is None or exact.uplift_time is None:
        return Verdict(True, True, math.nan, outcome, amplification)
    # the reference has more digits than a double
    difference = abs(float((exact.peak_rotation - float(response.peak_rotation)) / exact.peak_rotation))
    error = difference / (ALLOWED * ROUNDING * max(1.0, amplification))
    return Verdict(error <= 1.0, True, error, outcome, amplification)


def summary(verdicts: list[Verdict]) -> dict[str, Any]:
    """Return the counts and the largest error."""
    return {
        "cases": len(verdicts),
        "wrong": sum(not verdict.right for verdict in verdicts),
        "not judged": sum(not verdict.judged for verdict in verdicts),
        "overturned": sum(verdict.outcome >= 2 for verdict in verdicts),
        "largest error over allowed": max((one.error for one in verdicts if not math.isnan(one.error)), default=0.0),
    }


if __name__ == "__main__":
    options = arguments(__doc__, cases=1000, seed=1)
    verdicts = []
    for seed in range(options.seed, options.seed + options.cases):
        verdicts.append(judge(*random_case(seed)))
        if not verdicts[-1].right:
            print(f"seed {seed}: {verdicts[-1]}, {random_case(seed)[1]}", flush=True)
        if len(verdicts) % 100 == 0:
            progress(f"{len(verdicts)} cases")
    found = summary(verdicts)
    for name, value in found.items():
        print(f"{name:28} {value:.6g}")
    sys.exit(int(found["wrong"] > 0))
