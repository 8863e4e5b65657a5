"""The wheel: it holds the three packages and nothing else, requires no service or plotting package without an
extra. Its installation is the subject of `test_installation.py` and of `tests/api/test_api_kernels.py`.
"""

import re
import subprocess
import sys
import zipfile
from email.message import Message
from email.parser import Parser
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from benchmarks.installation import PACKAGES

ROOT = Path(__file__).parents[2]

REQUIRED = {
    "lazy-loader", "llvmlite", "netCDF4", "numba", "numpy", "pandas", "rich", "scipy", "typer", "xarray",
}  # fmt: skip
"""Distributions that an installation without extras requires."""

OPTIONAL = {
    "service": {"fastapi", "prometheus-client", "uvicorn"},
    "plot": {"matplotlib"},
    "assessment": {"trimesh"},
}
"""Distributions that only an extra brings."""


@pytest.fixture(scope="module")
def metadata(wheel: Path) -> Message:
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        return Parser().parsestr(archive.read(name).decode())


def test_wheel_holds_the_packages_and_no_tests(source: Path, wheel: Path) -> None:
    held = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    files = {
        f"{package}/{path.relative_to(source / folder).as_posix()}"
        for package, folder in PACKAGES.items()
        for path in (source / folder).rglob("*")
        if path.is_file()
    }
    assert held == files
    assert {name.split("/")[0] for name in held} == set(PACKAGES)
    assert not [name for name in held if re.search(r"(^|/)(tests?|conftest|test_[^/]*)(/|\.py$)", name)]


def test_requirements_without_extras_are_those_of_the_package(metadata: Message) -> None:
    requirements = [Requirement(line) for line in metadata.get_all("Requires-Dist", [])]
    assert {one.name for one in requirements if one.marker is None} == REQUIRED
    for extra, names in OPTIONAL.items():
        markers = {one.name: one.marker for one in requirements if one.name in names}
        assert markers.keys() == names
        for marker in markers.values():
            assert marker is not None
            assert marker.evaluate({"extra": extra})
            assert not marker.evaluate({"extra": ""})


def test_description_is_the_readme_without_links_that_an_index_cannot_follow(metadata: Message) -> None:
    assert metadata["Description-Content-Type"] == "text/markdown"
    description = str(metadata.get_payload())
    links = re.findall(r"\]\(([^)]*)\)", description)
    assert links
    assert [link for link in links if not link.startswith("https://")] == []
    readme = (ROOT / "README.md").read_text()
    assert re.findall(r"```.*?```", description, re.DOTALL) == re.findall(r"```.*?```", readme, re.DOTALL)
    assert re.findall(r"^#.*", description, re.MULTILINE) == re.findall(r"^#.*", readme, re.MULTILINE)


@pytest.mark.parametrize(
    ("command", "extra", "modules"),
    [("serve", "service", ("fastapi", "uvicorn", "zarr")), ("assess", "assessment", ("trimesh",))],
)
def test_command_without_its_packages_names_the_extra(
    wheel: Path, tmp_path: Path, command: str, extra: str, modules: tuple[str, ...]
) -> None:
    """The module search path of the process holds the wheel and what a plain installation requires."""
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path)
    program = (
        "import sys\n"
        f"sys.modules.update(dict.fromkeys({[*modules]}))\n"
        "from rocking._cli.app import app\n"
        f"app(['{command}'])"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path, env={"PYTHONPATH": str(tmp_path)}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 1
    assert f"rocking {command}: no module {modules[0]}" in done.stderr
    assert f"the extra `{extra}`, pip install 'rocking[{extra}]'" in done.stderr
    assert "Traceback" not in done.stderr
