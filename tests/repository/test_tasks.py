"""The six tasks of docs/tasks.md, performed on a copy of the repository as they are written."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from rocking import precompile
from rocking._base.source_tree import SourceTree
from rocking._numba import kernel_cache

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "tasks.md").read_text()
TASKS = dict(re.findall(r"^## Add a (\w+)\n(.*?)(?=^\(add-a-|\Z)", PAGE, re.MULTILINE | re.DOTALL))
STEP = re.compile(
    r"^(?:(?P<how>New file|In) `(?P<path>[^`]+)`(?:, (?P<where>after|before|in place of) `(?P<line>[^`]+)`)?:\n\n)?"
    r"```(?P<language>\w+)\n(?P<text>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)
COPIED = ("api", "assessment", "profiles", "rocking", "workflow")

pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the repository with all six changes; none is to a kernel, so those of this checkout serve it too."""
    folder = tmp_path_factory.mktemp("tasks") / "repository"
    for name in COPIED:
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "Snakefile", folder)
    for text in TASKS.values():
        for step in STEP.finditer(text):
            if step["path"]:
                perform(folder / step["path"], step)
    install = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", "--no-build-isolation"]
    subprocess.run([*install, "--target", folder / "build/packages", folder / "towers"], check=True)
    precompile.main()
    compiled = kernel_cache.cache_folder()
    assert compiled is not None
    # under another name: the digest is of all files that kernels import, among them the list of the pulses
    own_name = f"kernels-{kernel_cache.kernel_digest(SourceTree(folder, {'rocking'}))}"
    shutil.copytree(compiled, folder / "rocking" / "__pycache__" / own_name)
    return folder


def perform(path: Path, step: re.Match[str]) -> None:
    if step["how"] == "New file":
        assert not path.exists(), path
        path.parent.mkdir(exist_ok=True)
        path.write_text(step["text"])
        return
    before, line, after = path.read_text().partition(f"\n{step['line']}\n")
    assert line, f"{path} has no line {step['line']}"
    line = line.removeprefix("\n")
    parts = {"after": line + step["text"], "before": step["text"] + line, "in place of": step["text"]}
    path.write_text(f"{before}\n{parts[step['where']]}{after}")


@pytest.mark.parametrize("task", TASKS)
def test_task(copy: Path, task: str) -> None:
    folders = [copy, copy / "api", copy / "assessment", *([copy / "build/packages"] if task == "package" else [])]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(map(str, folders)), "PYTHONWARNINGS": "error"}
    (step,) = [step for step in STEP.finditer(TASKS[task]) if not step["path"]]
    command = ["-c", step["text"]] if step["language"] == "python" else ["-m", *shlex.split(step["text"])]
    if task == "figure":
        environment["PYTHONWARNINGS"] = "default"  # those of Snakemake are not ours
    done = subprocess.run(
        [sys.executable, *command], cwd=copy, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    if task == "figure":
        assert (copy / "build/one-figure/results/figures/figure-lowest.png").stat().st_size > 10_000
