"""Work that a new process avoids: modules of other commands, cubes that are not requested.

Each start is a separate process; its processor time includes the start of Python.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from benchmarks.ablations.ablation import Ablation
from benchmarks.measure import progress

GROUPS = "--pulse sine --slenderness 0.4 --frequency-ratio 5 --restitution 0.85"
STARTS = {
    "import rocking": "import rocking",
    **{
        f"rocking {command.split()[0]}": f"import sys; sys.argv[1:] = {command.split()}\n"
        "from rocking._cli.app import app\n"
        "try: app()\n"
        "except SystemExit: pass"
        for command in ("--help", f"response {GROUPS}")
    },
}
EVERYTHING = """
import importlib, pkgutil, rocking, rocking_api
for package in (rocking, rocking_api):
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
        if not module.name.endswith("__main__"):
            importlib.import_module(module.name)
"""
"""All modules of the package and the service, as a package with plain imports would load them."""

COUNT = "\nimport sys; print(len(sys.modules), file=sys.stderr)"

CUBES = """
import json, resource, sys, time
from pathlib import Path
from rocking._lookup.collection import CubeCollection
results, everything = Path(sys.argv[1]), sys.argv[2] == "all"
groups = dict(slenderness=0.5, frequency_ratio=5.0, restitution=0.85)
CubeCollection(results).response("sine", method="solver", **groups)  # load the kernels
memory = lambda: int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize() / 1e6
before, start = memory(), time.process_time()
cubes = CubeCollection(results)
if everything:
    for folder in (results / "spectra").iterdir():
        for eta in cubes.restitutions(folder.name):
            cubes.slice_at(folder.name, eta)
response, _ = cubes.response("sine", **groups)
print(json.dumps({"seconds": time.process_time() - start, "MB": memory() - before, "cubes": len(cubes._slices)}))
"""


def started(code: str, *arguments: str) -> tuple[subprocess.CompletedProcess[str], float]:
    """Run code in a new process; return its result and processor time [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def imports(rounds: int) -> Iterator[Ablation]:
    """Yield the commands as they are and after an import of everything: loaded modules, and time."""
    for name, code in STARTS.items():
        times: tuple[list[float], list[float]] = ([], [])
        for k in range(rounds):
            (one, seconds), (every, more) = (started(text + COUNT) for text in (code, EVERYTHING + code))
            times[0].append(seconds)
            times[1].append(more)
            progress(f"{name}: round {k + 1} of {rounds}")
        once, without = (int(done.stderr.split()[-1]) for done in (one, every))
        yield Ablation(f"imports: {name}", "modules", once, without, *times)


def cubes(results: Path, rounds: int) -> Ablation | None:
    """Compare the first response of a service with one cube and with all cubes opened; None if there are no cubes."""
    if not any(results.glob("spectra/sine/eta-0.85.nc")):
        return None
    found: dict[str, list[dict[str, Any]]] = {"requested": [], "all": []}
    for k in range(rounds):
        for which, rows in found.items():
            rows.append(json.loads(started(CUBES, str(results), which)[0].stdout))
        progress(f"cubes: round {k + 1} of {rounds}")
    one, every = (rows[0] for rows in found.values())
    times = ([row["seconds"] for row in rows] for rows in found.values())
    note = f"memory {one['MB']:.0f} MB and {every['MB']:.0f} MB, in addition to the solver"
    return Ablation("cubes that are not requested", "cubes opened", one["cubes"], every["cubes"], *times, note=note)
