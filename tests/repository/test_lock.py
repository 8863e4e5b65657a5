"""environment.lock holds names, versions and hashes only, and agrees with pyproject.toml."""

import ast
import re
import sys
import tomllib
from importlib import metadata
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version

ROOT = Path(__file__).parents[2]
LOCK = (ROOT / "environment.lock").read_text()
RELEASE = (ROOT / "deploy" / "release.lock").read_text()
SERVICE = (ROOT / "deploy" / "service.lock").read_text()
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
PIN = r"^([\w.-]+)==(\S+)"
PINS = {canonicalize_name(name): version for name, version in re.findall(PIN, LOCK, re.MULTILINE)}
EXTRAS = PROJECT["project"]["optional-dependencies"]
UNLOCKED = ("seismic", "slurm")
"""Extras that are not in the lock: packages that few users need."""

DIRECT = [
    *PROJECT["build-system"]["requires"],
    *PROJECT["project"]["dependencies"],
    *(
        line
        for extra, part in EXTRAS.items()
        if extra not in UNLOCKED
        for line in part
        if not line.startswith("rocking[")
    ),
]


def test_every_line_is_a_pin_or_a_hash() -> None:
    assert re.fullmatch(r"([\w.-]+==[\w.+!-]+( \\\n    --hash=sha256:[0-9a-f]{64})+\n)+", LOCK)


def test_tools_of_a_release_have_hashes_and_the_versions_of_the_lock() -> None:
    assert re.fullmatch(r"([\w.-]+==[\w.+!-]+( \\\n    --hash=sha256:[0-9a-f]{64})+\n)+", RELEASE)
    pins = {canonicalize_name(name): version for name, version in re.findall(PIN, RELEASE, re.MULTILINE)}
    tools = [Requirement(line) for line in PROJECT["dependency-groups"]["release"]]
    assert [tool for tool in tools if not tool.specifier.contains(pins[canonicalize_name(tool.name)])] == []
    common = pins.keys() & PINS.keys()
    assert {name: pins[name] for name in common} == {name: PINS[name] for name in common}


def blocks(lock: str) -> dict[str, str]:
    return {canonicalize_name(block.partition("==")[0]): block for block in re.split(r"\n(?=\S)", lock.rstrip())}


def required_by(lines: list[str]) -> set[str]:
    waiting, seen = [Requirement(line) for line in lines], set()
    while waiting:
        requirement = waiting.pop()
        if str(requirement) not in seen:
            seen.add(str(requirement))
            for inner in map(Requirement, metadata.requires(requirement.name) or ()):
                python = {"python_version": "3.11", "python_full_version": "3.11.0"}
                extras = {"", *requirement.extras}
                if inner.marker is None or any(inner.marker.evaluate(python | {"extra": extra}) for extra in extras):
                    waiting.append(inner)
    return {canonicalize_name(Requirement(line).name) for line in seen}


def test_lock_of_the_service_is_the_part_of_the_lock_that_it_requires() -> None:
    part = blocks(SERVICE)
    direct = [*PROJECT["project"]["dependencies"], *EXTRAS["service"], *EXTRAS["assessment"]]
    assert part.keys() == required_by(direct) - {"rocking"}
    assert part == {name: block for name, block in blocks(LOCK).items() if name in part}


@pytest.mark.parametrize("line", DIRECT)
def test_direct_requirement_is_pinned_within_its_bound(line: str) -> None:
    requirement = Requirement(line)
    pin = PINS[canonicalize_name(requirement.name)]
    assert requirement.specifier.contains(Version(pin)), f"{line}: pinned {pin}"


def test_no_requirement_has_two_bounds() -> None:
    lines = {line for line in DIRECT if not line.startswith("setuptools")}
    names = [canonicalize_name(Requirement(line).name) for line in lines]
    assert len(names) == len(set(names))


@pytest.mark.parametrize(
    ("folder", "extras"),
    [
        ("rocking", ("plot", "seismic", "workflow")),
        ("api", ("service",)),
        ("assessment", ("assessment", "plot", "service")),
    ],
)
def test_what_the_package_imports_is_required(folder: str, extras: tuple[str, ...]) -> None:
    distributions = metadata.packages_distributions()
    lines = [*PROJECT["project"]["dependencies"], *(line for extra in extras for line in EXTRAS[extra])]
    required = {canonicalize_name(Requirement(line).name) for line in lines}
    if "service" in extras:
        required |= {"starlette", "anyio", "pydantic-core"}  # named by the documentation of FastAPI and pydantic
    trees = [ast.parse(path.read_text()) for path in (ROOT / folder).rglob("*.py")]
    nodes = [node for tree in trees for node in ast.walk(tree)]
    names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    names |= {node.module for node in nodes if isinstance(node, ast.ImportFrom) and node.module}
    tops = (
        {name.split(".")[0] for name in names}
        - sys.stdlib_module_names
        - {"rocking", "rocking_api", "rocking_assessment"}
    )
    for top in tops:
        assert required & {canonicalize_name(name) for name in distributions.get(top, [top])}, f"{top} is not required"
