"""Every command of README.md is run: Python blocks, requests, command line; the recipes of make are checked.

`make test` runs this file and the smoke configuration of the workflow, so that the make commands are not run again:
`make --dry-run` prints their recipes, and what they call is run here or in the tests of the workflow.
"""

import json
import re
import runpy
import shlex
import shutil
import socket
import subprocess
import sys
import time
import tomllib
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.repository.test_docs import PRINTED

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text()
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
PYTHON_BLOCKS = [code for language, code in BLOCKS if language == "python"]
COMMANDS = [
    shlex.split(line, comments=True)
    for language, code in BLOCKS
    if language == "bash"
    for line in code.replace("\\\n", " ").splitlines()
]
MAKE = [command for command in COMMANDS if command[0] == "make"]
CURL = [command for command in COMMANDS if command[0] == "curl"]
ROCKING = [command for command in COMMANDS if command[0] == "rocking"]
PIP = [command for command in COMMANDS if command[0] == "pip"]


def recipe(*arguments: str) -> str:
    done = subprocess.run(["make", "--dry-run", *arguments], cwd=ROOT, capture_output=True, text=True, check=True)
    return done.stdout.strip().splitlines()[-1]


def installed(program: str) -> str:
    return str(Path(sys.executable).with_name(program))


def free_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return int(listener.getsockname()[1])


@pytest.fixture(scope="module")
def server_port(smoke_results: Path) -> Iterator[int]:
    """Port of the server that `make serve` starts, here over the results of the smoke configuration."""
    port = free_port()
    program, *arguments = shlex.split(recipe("serve", f"PORT={port}"))
    place = smoke_results.parent
    with subprocess.Popen([installed(program), *arguments], cwd=place, stderr=subprocess.PIPE, text=True) as process:
        for _ in range(600):
            try:
                with urllib.request.urlopen(f"http://127.0.0.1:{port}/health", timeout=5):
                    break
            except OSError:
                assert process.poll() is None, process.stderr and process.stderr.read()
                time.sleep(0.1)
        yield port
        process.terminate()


def test_every_command_has_a_test() -> None:
    assert len(MAKE) + len(CURL) + len(ROCKING) + len(PIP) == len(COMMANDS)
    assert len(PYTHON_BLOCKS) == 1
    assert MAKE
    assert CURL
    assert ROCKING


@pytest.mark.parametrize(
    ("target", "program"),
    [
        ("environment", ":"),
        ("reproduce", "flock Snakefile snakemake --nolock" if shutil.which("flock") else "snakemake"),
        ("test", "pytest --numprocesses auto"),
        ("serve", "rocking serve --host 127.0.0.1 --port 8000 --results 'results'"),
    ],
)
def test_make_targets_of_the_readme(target: str, program: str) -> None:
    assert ["make", *target.split()] in MAKE
    assert len(MAKE) == 4
    assert recipe(*target.split()).startswith(program)


def test_the_long_run_is_that_of_the_tests_without_samples() -> None:
    tests = subprocess.run(["make", "--dry-run", "test"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    assert recipe("test-all").partition("pytest")[2] in tests
    assert recipe("test-all").startswith("FUZZ_ALL=1 ")


def test_a_folder_without_data_sets_is_not_served() -> None:
    done = subprocess.run(["make", "serve", "RESULTS=nowhere"], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "RESULTS=nowhere is not allowed" in done.stderr


def test_paths_with_blanks_are_one_argument(tmp_path: Path) -> None:
    results = tmp_path / "two words" / "results"
    results.mkdir(parents=True)
    (results / "manifest.json").touch()
    assert shlex.split(recipe("serve", f"RESULTS={results}"))[-1] == str(results)
    for target in ("verify", "deposit"):
        assert shlex.split(recipe(target, f"RESULTS={results}"))[-1] == f"$(dirname '{results}')"
    for target in ("reproduce", "bench"):
        assert "two words.yaml" in shlex.split(recipe(target, "CONFIG=two words.yaml"))


@pytest.mark.parametrize("command", ROCKING, ids=" ".join)
def test_command_line(command: list[str]) -> None:
    done = subprocess.run([installed("rocking"), *command[1:]], cwd=ROOT, capture_output=True, text=True, check=True)
    assert f"```text\n{done.stdout}```" in README


def test_python_block_with_output(capsys: pytest.CaptureFixture[str]) -> None:
    exec(PYTHON_BLOCKS[0], {})
    assert f"```python\n{PYTHON_BLOCKS[0]}```\n\n```text\n{capsys.readouterr().out}```" in README


def test_extras_that_are_installed_exist() -> None:
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    for command in PIP:
        assert command[:2] == ["pip", "install"]
        assert set(re.findall(r"\w+", command[2].partition("[")[2])) <= extras.keys()


@pytest.mark.slow
@pytest.mark.parametrize("command", CURL, ids=" ".join)
def test_requests(command: list[str], server_port: int) -> None:
    url = command[-1].replace(":8000", f":{server_port}")
    assert url != command[-1]
    if shutil.which("curl"):
        body = subprocess.run(
            [*command[:-1], "--silent", "--fail", url], capture_output=True, text=True, check=True
        ).stdout
    else:  # a machine with Python and make only
        with urllib.request.urlopen(url) as response:
            body = response.read().decode()
    assert json.loads(body)["source"] in ("cube", "solver")


def test_example_that_asks_a_server(
    server_port: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ROCKING_SERVER", f"http://127.0.0.1:{server_port}")
    runpy.run_path(str(ROOT / "examples/ask_a_server.py"))
    output = capsys.readouterr().out
    assert [text for text in PRINTED["ask_a_server"] if text not in output] == []
