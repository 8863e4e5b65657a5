"""Simulated wall time of the workflow on more cores: `python -m benchmarks.cost.scaling FOLDER [FOLDER ...]`.

The job times are those of a finished run, from Snakemake's records in `logs/benchmarks`: processor time, one core for
each job. The simulation starts a waiting job whenever a core is free, first those of the higher priority of the
rules, then the longer ones. In the column of Slurm each job sent to the cluster takes `SLURM_OVERHEAD` more, and the
jobs that the rules keep local run on a core of their own without it, as with `profiles/slurm`. Figures follow the
boundaries of the sine and the cosine, the claims all data sets and figures, the manifest all of these.
"""

from __future__ import annotations

import argparse
import heapq
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.cost.stages import number, record_of
from benchmarks.measure import save

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
        Processor time of each job [s] by the name of its record, such as `overturning-sine-20`.
    """

    def named(pattern: str) -> frozenset[str]:
        return frozenset(name for name in times if re.fullmatch(pattern, name))

    curves, cubes = named("overturning-[a-z0-9_]+"), named("spectra-[a-z0-9_]+")
    drawn = named("(figure|table)-.*")
    found: dict[str, Job] = {}
    for name, seconds in times.items():
        kind, _, rest = name.partition("-")
        if re.fullmatch("overturning-.*-.*", name):
            job = Job(seconds, frozenset(), 3, local=False)
        elif kind == "overturning":
            job = Job(seconds, named(f"{name}-.*"), 3, local=True)
        elif "-rows-" in name:
            job = Job(seconds, named(f"overturning-{rest.partition('-')[0]}"), 2, local=False)
        elif kind == "spectra":
            job = Job(seconds, named(f"{name}-rows-.*"), 3, local=False)
        elif name in drawn:
            read = named("spectra-sine") if name == "figure-scale-law" else named("overturning-(sine|cosine)")
            job = Job(seconds, read, 0, local=True)
        elif kind == "checks":
            job = Job(seconds, named(f"(overturning|spectra)-{rest}"), 0, local=False)
        elif name == "claims":
            job = Job(seconds, curves | cubes | drawn, 0, local=True)
        else:
            before = curves | cubes | drawn | named("claims")
            if name == "check_results":
                before |= named("manifest|checks-.*")
            job = Job(seconds, before - {name}, 0, local=True)
        found[name] = job
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
    times = {path.stem: number(record_of(path)["cpu_time"]) for path in paths}
    jobs = jobs_of(times)
    chain, names = longest_chain(jobs)
    rows = [
        {"cores": cores, "local": wall_time(jobs, cores), "slurm": wall_time(jobs, cores, SLURM_OVERHEAD)}
        for cores in CORES
    ]
    return {"jobs": len(jobs), "processor": sum(times.values()), "chain": chain, "chain_jobs": names, "rows": rows}


def table(found: Mapping[str, Any]) -> str:
    """The simulation as text."""
    lines = [f"{found['jobs']} jobs, {found['processor']:.0f} s of processor time", "cores   local s   Slurm s"]
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
