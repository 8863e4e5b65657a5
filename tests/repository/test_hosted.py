"""The workflows of a hosted runner call targets of the Makefile, for every Python that the package promises."""

import re
import tomllib
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).parents[2]
JOBS: dict[str, Any] = {
    name: job
    for path in sorted((ROOT / ".github" / "workflows").glob("*.yml"))
    for name, job in yaml.safe_load(path.read_text())["jobs"].items()
}
COMMANDS = [step["run"] for job in JOBS.values() for step in job["steps"] if "run" in step]


def test_every_command_is_a_target_of_make() -> None:
    targets = re.findall(r"^([a-z-]+):.*##", (ROOT / "Makefile").read_text(), re.MULTILINE)
    called = {command.split()[1] for command in COMMANDS}
    assert all(command.startswith("make ") for command in COMMANDS)
    assert called == {"test", "test-all", "newest", "oldest", "wheel"}
    assert called <= set(targets)


def test_the_promised_pythons_are_tried_on_three_systems() -> None:
    classifiers = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["classifiers"]
    matrix = JOBS["newest"]["strategy"]["matrix"]
    assert [f"Programming Language :: Python :: {python}" for python in matrix["python"]] == [
        one for one in classifiers if re.search(r":: 3\.\d+$", one)
    ]
    assert len(matrix["system"]) == 3


def test_only_the_job_that_publishes_may_sign() -> None:
    assert [name for name, job in JOBS.items() if "id-token" in job.get("permissions", {})] == ["publish"]
    assert JOBS["publish"]["needs"] == "build"
