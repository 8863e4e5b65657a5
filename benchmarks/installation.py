"""An installation of the wheel, as a user has it; what it requires are the packages of this environment."""

from __future__ import annotations

import shutil
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

from rocking._base.source_tree import PROJECT

PACKAGES = {
    "rocking": "rocking",
    "rocking_api": "api/rocking_api",
    "rocking_assessment": "assessment/rocking_assessment",
}
"""Packages of the wheel and their folders."""

PIP = (sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet")


def copy_source(folder: Path) -> None:
    """Copy what the wheel is built from: the build writes files next to its sources."""
    folder.mkdir(parents=True)
    for name in ("pyproject.toml", "setup.py", "README.md", "LICENSE"):
        shutil.copy(PROJECT / name, folder)
    for place in PACKAGES.values():
        shutil.copytree(PROJECT / place, folder / place, ignore=shutil.ignore_patterns("__pycache__"))


def build_wheel(source: Path, folder: Path) -> Path:
    """Build the wheel, without network."""
    options = ("--no-deps", "--no-build-isolation", "--no-index", "--wheel-dir", str(folder))
    subprocess.run([*PIP, "wheel", *options, str(source)], check=True)
    (wheel,) = folder.glob("rocking-*.whl")
    return wheel


def install(wheel: Path, folder: Path) -> Path:
    """Install the wheel into a new virtual environment; returns its folder of packages.

    The packages of this environment are links in the same folder, where an installation has them: what reads the folder
    finds them there.
    """
    venv.create(folder, symlinks=True)
    python = folder / "bin" / "python"
    ask = "import sysconfig; print(sysconfig.get_path('purelib'))"
    packages = Path(subprocess.run([python, "-c", ask], capture_output=True, text=True, check=True).stdout.strip())
    for place in {sysconfig.get_path(name) for name in ("purelib", "platlib")}:
        for one in Path(place).iterdir():
            if "rocking" not in one.name and one.name != "__pycache__":
                (packages / one.name).symlink_to(one)
    command = [*PIP, "--python", str(python), "install", "--no-deps", "--no-index", str(wheel)]
    subprocess.run(command, check=True)
    return packages
