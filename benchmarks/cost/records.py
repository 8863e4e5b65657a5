"""Cost of responses under recorded motions: `python -m benchmarks.cost.records`.

A suite of made-up records of 2,000 to 18,000 samples, amplitudes PGA/(g tan(alpha)) from 0.5 to 10, blocks of R from
0.5 to 4 m, restitution 0.9, on one thread: runs per second, the share of the samples that is stepped through, and what
time and memory depend on. SciPy's DOP853 is restarted at every sample, with the events of the block, on a few of the
same runs; both are measured in the same process.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from benchmarks.cost.growth import memory
from benchmarks.cost.made_up_records import made_up_record, made_up_suite
from benchmarks.measure import progress, save, spread, versions
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
DOP853_TOLERANCE = 1e-8


def blocks(scales: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return p [rad/s] and slenderness of all runs under one record, flat: the sizes by the scales."""
    p, s = np.broadcast_arrays(FREQUENCY_PARAMETER[:, None], 1.0 / np.geomspace(*AMPLITUDE, scales))
    return p.ravel(), s.ravel()


def respond(motion: Record, kind: str, scales: int, threads: int = 1) -> NDArray[np.float64]:
    """Return the peaks of all runs under one record."""
    p, s = blocks(scales)
    return record_response(
        motion,
        frequency_parameter=p,
        slenderness=s,
        restitution=RESTITUTION,
        alpha=ALPHA[kind],
        threads=threads,
    ).peak_rotation


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


def processor_time(call: Callable[[], Any], rounds: int) -> dict[str, float]:
    """Return the processor time of a call [s] over some rounds."""
    found = []
    for _ in range(rounds):
        start = time.process_time()
        call()
        found.append(time.process_time() - start)
    return spread(found)


def dop853_peak(motion: Record, p: float, slenderness: float, eta: float, alpha: float) -> float:
    """Return the peak of one run by DOP853 restarted at every sample; nan where |theta| passes 4 alpha or pi/2.

    What many scripts do, without the decision on overturning: free rocking after the record is followed for 8/p.
    """
    u = motion.acceleration / (motion.peak_acceleration * slenderness)
    h = p * motion.time_step
    most = min(4.0, 0.5 * math.pi / alpha) if alpha else 4.0
    sign, z, w, peak, resting = 1.0, 0.0, 0.0, 0.0, True
    tail = math.ceil(8.0 / h)
    padded = np.concatenate([u, np.zeros(tail)])
    scale, slope = (math.tan(alpha) / alpha, alpha) if alpha else (1.0, 0.0)
    for k in range(padded.size - 1):
        t, left, rate = 0.0, padded[k], (padded[k + 1] - padded[k]) / h if k != u.size - 1 else 0.0
        while t < h:
            if resting:
                crossing = _unit_crossing(left, rate, t, h)
                if crossing is None:
                    break
                t, resting, z, w = crossing, False, 1e-14, 0.0
                sign = -math.copysign(1.0, left + rate * min(t + 1e-9 * h, h))

            def motion_rate(at: float, y: NDArray[np.float64], sign=sign, left=left, rate=rate) -> list[float]:
                force = sign * (left + rate * at)
                if slope == 0.0:
                    return [y[1], y[0] - 1.0 - force]
                fall = slope * (1.0 - y[0])
                return [y[1], -math.sin(fall) / slope - force * scale * math.cos(fall)]

            impact = _falling_zero()
            found = solve_ivp(motion_rate, (t, h), [z, w], "DOP853", None, False, [impact],
                              rtol=DOP853_TOLERANCE, atol=1e-12)  # fmt: skip
            peak = max(peak, float(found.y[0].max()))
            z, w, t = float(found.y[0, -1]), float(found.y[1, -1]), float(found.t[-1])
            if z >= most:
                return math.nan
            if found.status == 1:
                sign, z, w = -sign, 1e-14, -eta * w
                resting = w < 1e-5 and abs(left + rate * t) < 1.0
    return peak


def _falling_zero() -> Callable[..., float]:
    def event(_: float, y: NDArray[np.float64]) -> float:
        return float(y[0])

    event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]  # as solve_ivp reads them
    return event


def _unit_crossing(left: float, rate: float, start: float, h: float) -> float | None:
    if abs(left + rate * start) > 1.0:
        return start
    right = left + rate * h
    if abs(right) <= 1.0:
        return None
    return max(start, (math.copysign(1.0, right) - left) / rate)


def measure(records: int, scales: int, rounds: int, reference_runs: int) -> dict[str, Any]:
    """Measure everything; return one record."""
    suite = made_up_suite(records)
    found: dict[str, Any] = {"records": records, "scales": scales, "versions": versions("numpy", "numba", "scipy")}
    for kind, alpha in ALPHA.items():
        respond(suite[0], kind, 2)  # load the kernels
        before = memory()
        runs = len(suite) * scales * len(HALF_DIAGONAL)
        times = processor_time(lambda kind=kind: [respond(motion, kind, scales) for motion in suite], rounds)
        peaks = np.array([respond(motion, kind, scales) for motion in suite])
        total = sum(motion.samples - 1 for motion in suite) * scales * len(HALF_DIAGONAL)
        progress(f"{kind}: {runs / times['smallest']:.0f} runs/s")
        part = {
            "runs": runs,
            "seconds": times,
            "runs_per_second": runs / times["smallest"],
            "overturned": float(np.isnan(peaks).mean()),
            "no_uplift": float((peaks == 0.0).mean()),
            "share_of_samples_stepped": sum(stepped(motion, kind, scales) for motion in suite) / total,
            "memory_growth_bytes": memory() - before,
            "samples": {
                str(size): 1e6 * processor_time(lambda size=size, kind=kind: respond(
                    made_up_record(1, size, 20.0 / size), kind, scales), rounds)["smallest"] / (4 * scales)
                for size in (2_000, 6_000, 18_000)
            },
            "scales": {
                str(count): 1e6 * processor_time(lambda count=count, kind=kind: respond(
                    suite[len(suite) // 2], kind, count), rounds)["smallest"] / (4 * count)
                for count in (10, 100, 1000)
            },
            "threads": {str(count): _wall(lambda count=count, kind=kind: respond(suite[0], kind, 2000, count), rounds)
                        for count in (1, 2)},
        }  # fmt: skip
        part["reference"] = compare(suite, alpha, kind, reference_runs)
        found[kind] = part
    return found


def _wall(call: Callable[[], Any], rounds: int) -> float:
    found = []
    for _ in range(rounds):
        start = time.perf_counter()
        call()
        found.append(time.perf_counter() - start)
    return min(found)


def compare(suite: list[Record], alpha: float, kind: str, count: int) -> dict[str, Any]:
    """Return the times per run of DOP853 and of the package on some surviving runs [s], and how the peaks differ."""
    random = np.random.default_rng(5)
    theirs, ours, errors = [], [], []
    while len(theirs) < count:
        motion = suite[int(random.integers(len(suite) // 2))]
        p, s = float(random.choice(FREQUENCY_PARAMETER)), 1.0 / random.uniform(1.2, 3.0)
        groups = {"frequency_parameter": p, "slenderness": s, "restitution": RESTITUTION, "alpha": alpha}
        exact = float(record_response(motion, **groups).peak_rotation)
        if not exact > 0.0:
            continue
        start = time.process_time()
        peak = dop853_peak(motion, p, s, RESTITUTION, alpha)
        theirs.append(time.process_time() - start)
        many = groups | {"slenderness": np.full(200, s)}
        ours.append(
            processor_time(lambda many=many, motion=motion: record_response(motion, **many, threads=1), 3)["smallest"]
            / 200
        )
        errors.append(abs(peak / exact - 1.0))
        progress(f"{kind}: DOP853 run {len(theirs)} of {count}")
    return {
        "runs": count,
        "dop853_seconds": spread(theirs),
        "package_seconds": spread(ours),
        "ratio": float(np.median(np.array(theirs) / np.array(ours))),
        "median_difference_of_peak": float(np.median(errors)),
    }


def table(found: dict[str, Any]) -> str:
    """Format the record as text."""
    lines = [f"{'':28}{'slender':>12}{'rigid':>12}"]

    def line(title: str, value: Callable[[dict[str, Any]], float], form: str) -> None:
        lines.append(f"{title:28}" + "".join(f"{value(found[kind]):>12{form}}" for kind in ALPHA))

    line("runs", lambda part: part["runs"], ",.0f")
    line("runs a second, one core", lambda part: part["runs_per_second"], ",.0f")
    line("overturned", lambda part: part["overturned"], ".0%")
    line("no uplift", lambda part: part["no_uplift"], ".0%")
    line("samples stepped", lambda part: part["share_of_samples_stepped"], ".1%")
    line("memory growth, MB", lambda part: part["memory_growth_bytes"] / 1e6, ".1f")
    for name in ("2000", "6000", "18000"):
        line(f"us a run, {name} samples", lambda part, name=name: part["samples"][name], ".1f")
    for name in ("10", "100", "1000"):
        line(f"us a run, {name} scales", lambda part, name=name: part["scales"][name], ".1f")
    for name in ("1", "2"):
        line(f"s on {name} thread(s)", lambda part, name=name: part["threads"][name], ".3f")
    line("DOP853, s a run", lambda part: part["reference"]["dop853_seconds"]["median"], ".2f")
    line("DOP853 over package", lambda part: part["reference"]["ratio"], ",.0f")
    line("their median difference", lambda part: part["reference"]["median_difference_of_peak"], ".1e")
    return "\n".join(lines)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--records", type=int, default=72)
    parser.add_argument("--scales", type=int, default=150)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--reference-runs", type=int, default=6)
    parser.add_argument("--out", type=Path, default=Path("results/benchmarks/records.json"))
    options = parser.parse_args()
    found = measure(options.records, options.scales, options.rounds, options.reference_runs)
    save(found, options.out)
    print(table(found))
    print(f"\nwritten to {options.out}")


if __name__ == "__main__":
    main()
