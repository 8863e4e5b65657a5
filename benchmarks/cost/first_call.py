"""What a user waits for after the installation: `python -m benchmarks.cost.first_call`.

All is measured in an installation of the wheel (`benchmarks.installation`): the first response of a process and the
README's first command, each with kernels that must be compiled, and with those on disk. Then the bytes of the wheel,
the packages and the kernels, and the memory of a process after its first response.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

import pandas as pd

from benchmarks.installation import build_wheel, copy_source, install
from benchmarks.measure import arguments, finish, versions

SIZE = ("--width", "0.4m", "--height", "1.6m")
README_COMMAND = ("response", "--pulse", "sine", *SIZE, "--peak-acceleration", "0.6g", "--period", "0.5s")

FIRST_CALL = """
import json, resource, time
begin = time.perf_counter()
import rocking
imported = time.perf_counter()
rocking.peak_response("sine", slenderness=0.4, frequency_ratio=5.0, restitution=0.85)
first = time.perf_counter()
rocking.peak_response("sine", slenderness=0.4, frequency_ratio=5.0, restitution=0.85)
times = {"import": imported - begin, "first_call": first - imported, "second_call": time.perf_counter() - first}
print(json.dumps([times, 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss]))
"""


def measured(programs: Path, packages: Path, folder: Path) -> dict[str, Any]:
    """Times of new processes [s] with kernels compiled and cached, and bytes; the programs are in a folder."""
    hidden = ("PYTHONPATH", "NUMBA_CACHE_DIR")
    environment = {name: value for name, value in os.environ.items() if name not in hidden}
    python, rocking = str(programs / "python"), str(programs / "rocking")

    def run(*command: str) -> str:
        return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=True).stdout

    found: dict[str, Any] = {
        "packages_bytes": size(packages / "rocking") + size(packages / "rocking_api"),
        "seconds": {},
    }
    for state in ("compiled", "cached"):
        if state == "cached":
            run(python, "-m", "rocking.precompile")
        times, found["memory_bytes"] = json.loads(run(python, "-c", FIRST_CALL))
        if state == "compiled":
            for path in kernels_of(packages):  # the next process compiles
                shutil.rmtree(path)
        began = time.perf_counter()
        run(rocking, *README_COMMAND)
        times["command"] = time.perf_counter() - began
        found["seconds"][state] = times
    return found | {"kernels_bytes": sum(size(path) for path in kernels_of(packages))}


def kernels_of(packages: Path) -> list[Path]:
    """The folders of the compiled kernels."""
    return [*(packages / "rocking" / "__pycache__").glob("kernels-*")]


def size(folder: Path) -> int:
    """Bytes of the files of a folder without what was compiled from them, or of the folder of kernels."""
    files = (path for path in folder.rglob("*") if "__pycache__" not in path.relative_to(folder).parts)
    return sum(path.stat().st_size for path in files if path.is_file())


def table(found: dict[str, Any]) -> str:
    """The measurements as text: times [s] with kernels compiled and cached, and sizes."""
    times = pd.DataFrame(found["seconds"]).T.to_string(float_format="{:.4f}".format)
    sizes = (f"{name} {found[f'{name}_bytes'] / 1e6:.3g} MB" for name in ("wheel", "packages", "kernels", "memory"))
    return f"{times}\n{', '.join(sizes)}"


if __name__ == "__main__":
    out = arguments(__doc__, out=Path("results/benchmarks/first-call.json")).out
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        copy_source(folder / "source")
        wheel = build_wheel(folder / "source", folder / "dist")
        packages = install(wheel, folder / "installed")
        found = measured(folder / "installed" / "bin", packages, folder) | {"wheel_bytes": wheel.stat().st_size}
    finish(found | {"versions": versions("numpy", "numba")}, out, table)
