"""Cost of bodies with two edges beside that of blocks: `python -m benchmarks.cost.bodies`.

Blocks, bodies with the same right edge and another left one, and these with vertical motion of the ground, in turns and
on one thread: processor time of a response, and the rate of the bodies over that of the blocks. Sizes are R about 1 m,
alpha 0.1 to 0.4, peak accelerations up to five times that of uplift.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import rocking
from benchmarks.cost.made_up_records import made_up_record
from benchmarks.measure import progress, save, spread, versions
from rocking._base.constants import STANDARD_GRAVITY
from rocking._dimensional.rigid_body import RigidBody

TRIANGLE = rocking.SampledPulse([0.0, 1.0, 0.0], name="triangle")


def calls(count: int) -> dict[str, dict[str, Callable[[], Any]]]:
    """Return the calls of each motion by the kind of body; each solves `count` bodies, a fiftieth under records."""
    random = np.random.default_rng(3)
    found: dict[str, dict[str, Callable[[], Any]]] = {}
    for motion in ("sine", "ricker", TRIANGLE, "record"):
        size = max(count // 50, 1) if motion == "record" else count
        radius, alpha = random.uniform(0.5, 2.0, size), np.sort(random.uniform(0.1, 0.4, size))
        right, height = radius * np.sin(alpha), radius * np.cos(alpha)
        left = right * random.uniform(0.7, 1.4, size)
        strength = random.uniform(1.0, 5.0, size)
        p = np.sqrt(0.75 * STANDARD_GRAVITY / radius)
        block, body = RigidBody(right, right, height), RigidBody(left, right, height)
        if motion == "record":
            plain = made_up_record(1, 4000, 0.005)
            upwards = 0.2 * made_up_record(2, 4000, 0.005).acceleration / plain.peak_acceleration * STANDARD_GRAVITY
            both = rocking.Record(plain.acceleration, 0.005, "m/s2", vertical=upwards)
            uplift = STANDARD_GRAVITY * np.tan(alpha)
            scale = np.minimum(strength * uplift / plain.peak_acceleration, 0.9 * STANDARD_GRAVITY / -upwards.min())
            found["record"] = {
                "block": lambda p=p, scale=scale, uplift=uplift, alpha=alpha, plain=plain: rocking.peak_response(
                    plain,
                    frequency_parameter=p,
                    slenderness=uplift / (scale * plain.peak_acceleration),
                    restitution=0.9,
                    alpha=alpha,
                    threads=1,
                ),
                "two edges": _body_call(body, plain, scale=scale),
                "two edges, vertical": _body_call(body, both, scale=scale),
            }
            continue
        period = random.uniform(0.2, 2.0, size)
        given = {"peak_acceleration": strength * STANDARD_GRAVITY * np.tan(alpha), "period": period}
        found[motion if isinstance(motion, str) else motion.name] = {
            "block": lambda p=p, motion=motion, strength=strength, period=period, alpha=alpha: rocking.peak_response(
                motion,
                slenderness=1.0 / strength,
                frequency_ratio=2.0 * np.pi / (period * p),
                restitution=0.9,
                alpha=alpha,
                threads=1,
            ),
            "equal edges": _body_call(block, motion, **given),
            "two edges": _body_call(body, motion, **given),
        }
    return found


def _body_call(body: RigidBody, motion: Any, **given: Any) -> Callable[[], Any]:
    return lambda: body.response(motion, **given, restitution=0.9, threads=1)


def measure(count: int, rounds: int) -> dict[str, Any]:
    """Measure all calls in turns; return one record, with processor times [s] of one response."""
    found: dict[str, Any] = {"bodies": count, "versions": versions("numpy", "numba")}
    for motion, kinds in calls(count).items():
        sizes = {kind: call().shape[0] for kind, call in kinds.items()}  # compiles
        times: dict[str, list[float]] = {kind: [] for kind in kinds}
        for _ in range(rounds):
            for kind, call in kinds.items():
                start = time.process_time()
                call()
                times[kind].append((time.process_time() - start) / sizes[kind])
        part = {kind: spread(values) for kind, values in times.items()}
        found[motion] = {
            kind: one | {"rate": part["block"]["smallest"] / one["smallest"]} for kind, one in part.items()
        }
        progress(f"{motion}: " + ", ".join(f"{kind} {one['rate']:.2f}" for kind, one in found[motion].items()))
    return found


def table(found: dict[str, Any]) -> str:
    """Format the record as text."""
    lines = [f"{'motion':12}{'body':24}{'us a response':>16}{'rate over block':>18}"]
    for motion, kinds in found.items():
        if motion in ("bodies", "versions"):
            continue
        for kind, one in kinds.items():
            lines.append(f"{motion:12}{kind:24}{1e6 * one['smallest']:>16.3f}{one['rate']:>18.2f}")
    return "\n".join(lines)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bodies", type=int, default=50_000)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--out", type=Path, default=Path("results/benchmarks/bodies.json"))
    options = parser.parse_args()
    found = measure(options.bodies, options.rounds)
    save(found, options.out)
    print(table(found))
    print(f"\nwritten to {options.out}")


if __name__ == "__main__":
    main()
