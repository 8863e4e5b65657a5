"""The tutorials are performed in an empty folder as they are written, and their output is compared with the page.

A line `...` of the page stands for any lines. No environment is made and the paper is not reproduced: test_readme.py
and the tests of the workflow do that.
"""

import os
import re
import shutil
import subprocess
import sys
from contextlib import nullcontext
from pathlib import Path

import pytest

from tests.api.servers import serving

ROOT = Path(__file__).parents[2]
PAGES = sorted((ROOT / "docs/tutorials").glob("*.md"))
STEP = re.compile(
    r"(?:^New file `(?P<path>[^`]+)`:\n\n)?^```(?P<language>\w+)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL
)
COMMAND = re.compile(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", re.MULTILINE)
NOT_RUN = ("python3 -m venv", "pip install", ". ", "make ", "snakemake", "cp ", "git ")
"""Starts of commands that are not run; of `snakemake`, `snakemake -n` is."""

pytestmark = pytest.mark.long


def printed(shown: str) -> re.Pattern[str]:
    return re.compile("".join("(?s:.*)" if line == "..." else f"{re.escape(line)}\n" for line in shown.splitlines()))


def run(command: str, folder: Path, port: int | None) -> str:
    """What a command prints, in a shell where `rocking`, `python` and `snakemake` are those of this checkout."""
    place = ROOT if command.startswith("snakemake") else folder
    if command.startswith("snakemake"):
        command = command.replace("snakemake", f"snakemake --directory {folder}", 1)
    paths = {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}", "PYTHONPATH": f"{ROOT}:{ROOT / 'api'}"}
    environment = os.environ | paths | {"COLUMNS": "400"}
    output = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    shown = command.replace(":8000", f":{port}")
    done = subprocess.run(shown, cwd=place, env=environment, shell=True, check=False, **output)
    assert done.returncode == 0, f"{command}: {done.stdout}"
    return done.stdout


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.stem)
def test_tutorial(page, tmp_path):
    steps = [step for step in STEP.finditer(page.read_text()) if step["path"] or step["language"] == "console"]
    for step in steps:
        if step["path"]:
            (tmp_path / step["path"]).write_text(step["text"])
    commands = [found for step in steps if not step["path"] for found in COMMAND.findall(step["text"])]
    if any(command.startswith("curl") for command, _ in commands) and shutil.which("curl") is None:
        pytest.skip("a machine without curl")
    (tmp_path / "results").mkdir()
    served = any(command.startswith("rocking serve") for command, _ in commands)
    with serving(tmp_path / "results", tmp_path / "log") if served else nullcontext() as server:
        for command, shown in commands:
            if command.startswith("rocking serve"):
                log = re.sub(r"^\S+ \S+ ", "", server.log.read_text(), flags=re.MULTILINE)
                for line in shown.splitlines():
                    assert line.replace(":8000", f":{server.port}").split(" in ")[0] in log
            elif command.startswith("snakemake -n") or not command.startswith(NOT_RUN):
                output = run(command, tmp_path, server and server.port)
                assert printed(shown).fullmatch(output), f"{command}:\n{output}"


def test_every_command_that_is_not_run_exists():
    text = "".join(page.read_text() for page in PAGES)
    targets = set(re.findall(r"^\$ make (\S+)", text, re.MULTILINE))
    assert targets <= set(re.findall(r"^(\S+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    configurations = set(re.findall(r"workflow/config/\w+\.yaml", text))
    assert [name for name in configurations if not (ROOT / name).is_file()] == []
