"""The wheel, and an installation of it: made once for all processes of a test run."""

import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

from benchmarks.installation import build_wheel, copy_source, install
from rocking import precompile
from rocking._numba import kernel_cache


class Installation(NamedTuple):
    folder: Path
    packages: Path

    @property
    def python(self) -> str:
        return str(self.folder / "bin" / "python")

    def environment(self, **variables: str) -> dict[str, str]:
        """Variables of a process that sees the installation, not this checkout."""
        own = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "NUMBA_CACHE_DIR")}
        return own | variables


@pytest.fixture(scope="session")
def build(once: Callable[[str, Callable[[Path], None]], Path]) -> Path:
    """Folder with `source`, from which the wheel was built, the wheel in `dist`, and `installed`."""

    def make(folder: Path) -> None:
        copy_source(folder / "source")
        install(build_wheel(folder / "source", folder / "dist"), folder / "installed")

    return once("wheel", make)


@pytest.fixture(scope="session")
def source(build: Path) -> Path:
    return build / "source"


@pytest.fixture(scope="session")
def wheel(build: Path) -> Path:
    (wheel,) = (build / "dist").iterdir()
    return wheel


@pytest.fixture(scope="session")
def installed(build: Path) -> Installation:
    (package,) = (build / "installed").glob("**/rocking/__init__.py")
    return Installation(build / "installed", package.parents[1])


@pytest.fixture(scope="session")
def kernels(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the compiled kernels of this checkout, for NUMBA_CACHE_DIR; not marked as of a state of the package."""
    precompile.main()
    compiled = Path(str(kernel_cache.cache_folder()))
    folder = tmp_path_factory.mktemp("kernels")
    shutil.copytree(compiled, folder / compiled.name, ignore=shutil.ignore_patterns("sources-*"))
    return folder
