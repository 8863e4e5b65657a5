"""`pip install .` yields a usable package: the wheel holds all of `rocking` and `api` and nothing else."""

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = ("rocking", "api")


@pytest.mark.slow
def test_wheel_holds_the_packages(tmp_path: Path) -> None:
    source = tmp_path / "source"  # built from a copy: the build leaves files beside its sources
    source.mkdir()
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    for name in PACKAGES:
        shutil.copytree(ROOT / name, source / name, ignore=shutil.ignore_patterns("__pycache__"))
    build = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "--no-index", "--quiet"]
    subprocess.run([*build, "--wheel-dir", str(tmp_path), str(source)], check=True)

    (wheel,) = tmp_path.glob("rocking-*.whl")
    held = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    files = {path.relative_to(source).as_posix() for name in PACKAGES for path in (source / name).rglob("*")}
    assert held == {name for name in files if (source / name).is_file()}
