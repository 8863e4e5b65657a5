"""Simulated wall time of the workflow on more cores: `python -m benchmarks.cost.scaling FOLDER [FOLDER ...]`.

The times of the jobs are those of a finished run with at most one job for each core, from Snakemake's records in
`logs/benchmarks`. The simulation starts a waiting job whenever a core is free, first those of higher priority, then the
longer ones. In the column of Slurm each job sent to the cluster takes `SLURM_OVERHEAD` more, and the jobs that the
rules keep local run on a core of their own without it, as with `profiles/slurm`. Figures follow all data sets that they
may read.
"""

from __future__ import annotations

import argparse
import heapq
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.cost.stages import record_of
from benchmarks.measure import save
from rocking._interpolation.slices import windows_of
from workflow.configuration import tenths

CORES = (1, 2, 4, 16, 64, 256)

SLURM_OVERHEAD = 12.0
"""Time that a job takes more on a cluster of one node, measured with `make slurm` [s]."""


class Job(NamedTuple):
    """A job: its time [s], the jobs that it waits for, its priority, and whether it runs where the command runs."""

    seconds: float
    after: frozenset[str]
    priority: int
    local: bool


def jobs_of(times: Mapping[str, float]) -> dict[str, Job]:
    """Jobs by name, with the dependences that follow from their names.

    Parameters
    ----------
    times : mapping
        Time of each job [s] by the name of its record, such as `overturning-sine-0.85`.
    """

    def named(pattern: str) -> frozenset[str]:
        return frozenset(name for name in times if re.fullmatch(pattern, name))

    boundaries, cubes = named(r"overturning-.*-\d\.\d\d"), named(r"spectra-.*-\d\.\d\d")
    drawn = named("(figure|table)-.*")
    products = boundaries | cubes | drawn | named("claims")
    restitution = sorted({float(name.rpartition("-")[2]) for name in boundaries})
    of_tenth = tenths({"restitution": restitution})
    found: dict[str, Job] = {}
    for name, seconds in times.items():
        kind, _, rest = name.partition("-")
        pulse, _, which = rest.partition("-")
        after, priority = frozenset[str](), 0
        if name in boundaries:
            after, priority = named(f"pulses-{pulse}-.*"), 3
        elif name in cubes:
            place = restitution.index(float(which))
            window = {*restitution[slice(*windows_of(len(restitution), place, place + 1))]}
            read = "|".join(tenth for tenth, some in of_tenth.items() if window & {*some})
            after, priority = named(rf"spectra-{pulse}-({read})\.[0-9a-f]{{16}}"), 3
        elif kind == "spectra":
            read = "|".join(f"{eta:.2f}" for eta in of_tenth[which.rpartition(".")[0]])
            after, priority = named(f"overturning-{pulse}-({read})"), 2
        elif name in drawn:
            after = named(".*-(sine|cosine)-.*") & (cubes if name == "figure-scale-law" else boundaries)
        elif kind == "checks":
            after = named(f".*-{rest}-.*") & (boundaries | cubes)
        elif name in ("claims", "manifest", "check_results"):
            after = (products | (named("manifest|checks-.*") if name == "check_results" else set())) - {name}
            priority = int(name == "claims")
        local = name in drawn or kind in ("pulses", "manifest")
        found[name] = Job(seconds, after, priority, local)
    return found


def wall_time(jobs: Mapping[str, Job], cores: int, overhead: float = 0.0) -> float:
    """Time until all jobs have ended [s].

    Parameters
    ----------
    jobs : mapping
        Jobs by name.
    cores : int
        Cores for jobs, >= 1; with `overhead` > 0 local jobs use one core besides these.
    overhead : float
        Time that a job which is not local takes more [s].
    """
    waiting, done, now = dict(jobs), set[str](), 0.0
    free = {False: cores, True: 1 if overhead else 0}
    running: list[tuple[float, str, bool]] = []
    while waiting or running:
        ready = [name for name, job in waiting.items() if job.after <= done]
        for name in sorted(ready, key=lambda name: (-jobs[name].priority, -jobs[name].seconds)):
            on_head = jobs[name].local and overhead > 0.0
            if free[on_head]:
                free[on_head] -= 1
                more = 0.0 if jobs[name].local else overhead
                heapq.heappush(running, (now + waiting.pop(name).seconds + more, name, on_head))
        now, name, on_head = heapq.heappop(running)
        free[on_head] += 1
        done.add(name)
    return now


def longest_chain(jobs: Mapping[str, Job]) -> tuple[float, list[str]]:
    """Largest sum of the times of jobs that follow each other [s], and these jobs: no number of cores shortens it."""
    known: dict[str, tuple[float, list[str]]] = {}

    def until(name: str) -> tuple[float, list[str]]:
        if name not in known:
            before, chain = max((until(one) for one in jobs[name].after), default=(0.0, []))
            known[name] = before + jobs[name].seconds, [*chain, name]
        return known[name]

    return max(until(name) for name in jobs)


def measure(folders: Iterable[Path]) -> dict[str, Any]:
    """Simulate the run whose records lie in some folders; times [s]."""
    paths = (path for folder in folders for path in sorted(folder.glob("*.tsv")))
    times = {path.stem: float(record_of(path)["s"]) for path in paths}
    jobs = jobs_of(times)
    chain, names = longest_chain(jobs)
    rows = [
        {"cores": cores, "local": wall_time(jobs, cores), "slurm": wall_time(jobs, cores, SLURM_OVERHEAD)}
        for cores in CORES
    ]
    return {"jobs": len(jobs), "seconds": sum(times.values()), "chain": chain, "chain_jobs": names, "rows": rows}


def table(found: Mapping[str, Any]) -> str:
    """The simulation as text."""
    lines = [f"{found['jobs']} jobs, {found['seconds']:.0f} s on one core", "cores   local s   Slurm s"]
    lines += [f"{row['cores']:5}{row['local']:10.0f}{row['slurm']:10.0f}" for row in found["rows"]]
    return "\n".join([*lines, f"longest chain {found['chain']:.0f} s: " + ", ".join(found["chain_jobs"])])


def main() -> None:
    """Print the table and save it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", type=Path, nargs="+", help="logs/benchmarks of a finished run")
    parser.add_argument("--out", type=Path, default=Path("results/benchmarks/scaling.json"))
    options = parser.parse_args()
    found = measure(options.folders)
    save(found, options.out)
    print(table(found))


if __name__ == "__main__":
    main()
