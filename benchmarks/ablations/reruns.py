"""Jobs of the workflow that are not repeated: the smallest configuration runs once, then something is changed.

The project is copied, so that this checkout is not changed; Snakemake's dry runs list the jobs that would run again.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from benchmarks.ablations.ablation import Ablation
from benchmarks.measure import progress

PROJECT = Path(__file__).parents[2]
COPIED = ("Snakefile", "environment.lock", "README.md", "rocking", "workflow", "profiles", "docs")
SMOKE = "workflow/config/smoke.yaml"


def appended(path: str, text: str = "\n# a change\n") -> Callable[[Path], None]:
    """Return a change that appends a line to a file of the project."""

    def change(project: Path) -> None:
        with (project / path).open("a") as stream:
            stream.write(text)

    return change


def replaced(before: str, after: str) -> Callable[[Path], None]:
    """Return a change of a setting of the configuration."""

    def change(project: Path) -> None:
        text = (project / SMOKE).read_text()
        if before not in text:
            raise ValueError(f"{SMOKE} has no {before}")
        (project / SMOKE).write_text(text.replace(before, after))

    return change


CHANGES: dict[str, Callable[[Path], None]] = {
    "nothing": lambda _: None,
    "a page of docs/": appended("docs/numerics.md", "\nA change.\n"),
    "the service side: rocking/_lookup/cube.py": appended("rocking/_lookup/cube.py"),
    "a setting of figure 7": replaced(
        "slenderness: 0.45, frequency_ratio: 5.5", "slenderness: 0.46, frequency_ratio: 5.5"
    ),
    "the script of figure 7": appended("workflow/figures/figure_07.py"),
    "the claims' settings": replaced("claims:\n  restitution: [0.85, 0.90]", "claims:\n  restitution: [0.85]"),
    "rocking/paper/scale_law.py": appended("rocking/paper/scale_law.py"),
    "rocking/_history/time_history.py": appended("rocking/_history/time_history.py"),
    "the grid of the cubes": replaced("points: 161}", "points: 171}"),
    "one restitution more": replaced("restitution: [0.85, 0.90]\n\ngrid", "restitution: [0.85, 0.88, 0.90]\n\ngrid"),
    "rocking/_spectra/cubes.py": appended("rocking/_spectra/cubes.py"),
    "rocking/_boundary/tracing.py": appended("rocking/_boundary/tracing.py"),
    "a kernel: rocking/_solver/kernels/chatter.py": appended("rocking/_solver/kernels/chatter.py"),
}
"""The changes, from few to many repeated jobs."""


def snakemake(project: Path, directory: Path, *arguments: str) -> str:
    """Run the workflow of a project; return its output."""
    command = [
        sys.executable, "-m", "snakemake", "--snakefile", str(project / "Snakefile"), "--directory", str(directory),
        "--configfile", str(project / SMOKE), "--nocolor", *arguments,
    ]  # fmt: skip
    done = subprocess.run(
        command, cwd=project, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False
    )
    if done.returncode != 0:
        raise RuntimeError(done.stdout)
    return done.stdout


def jobs(output: str) -> dict[str, int]:
    """Return the number of jobs of each rule in the job table of a run, without the target rule."""
    table = output.partition("Job stats:")[2].partition("total")[0]
    found = re.findall(r"^(\w+) +(\d+)$", table, flags=re.MULTILINE)
    return {rule: int(count) for rule, count in found if rule != "all"}


def copied(folder: Path) -> Path:
    """Copy what the workflow reads."""
    project = folder / "project"
    project.mkdir()
    for name in COPIED:
        source = PROJECT / name
        if source.is_dir():
            shutil.copytree(source, project / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy2(source, project / name)
    kernels = PROJECT / "rocking/__pycache__"  # otherwise the first job compiles them
    if kernels.exists():
        shutil.copytree(kernels, project / "rocking/__pycache__")
    return project


def reruns(changes: dict[str, Callable[[Path], None]], rounds: int) -> Iterator[Ablation]:
    """Yield the repeated jobs after each change, of all; and the time of a run with nothing to do."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        project, directory = copied(folder), folder / "run"
        directory.mkdir()
        progress("workflow: the whole of the smallest configuration")
        start = time.perf_counter()
        total = jobs(snakemake(project, directory))
        whole = time.perf_counter() - start
        idle = []
        for _ in range(rounds):
            start = time.perf_counter()
            snakemake(project, directory)
            idle.append(time.perf_counter() - start)
        before = {path: path.read_bytes() for path in project.rglob("*") if path.suffix in (".py", ".md", ".yaml")}
        for what, change in changes.items():
            progress(f"workflow: {what}")
            change(project)
            again = jobs(snakemake(project, directory, "--dry-run"))
            times = (idle, [whole]) if not again else ([], [])
            yield Ablation(
                f"jobs after a change of {what}", "jobs", sum(again.values()), sum(total.values()), *times,
                note=", ".join(f"{rule} {count}" if count > 1 else rule for rule, count in again.items()),
            )  # fmt: skip
            for path, content in before.items():
                if path.read_bytes() != content:
                    path.write_bytes(content)
