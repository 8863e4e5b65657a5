"""`pip install .` yields a usable package: the wheel holds all of `rocking` and `api` and nothing else,
and the service answers from it.
"""

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import httpx2
import pytest

from tests.api.servers import serving

ROOT = Path(__file__).parents[2]
PACKAGES = {"rocking": "rocking", "rocking_api": "api/rocking_api"}


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy to build from: the build leaves files beside its sources."""
    source = tmp_path_factory.mktemp("source")
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    for folder in PACKAGES.values():
        shutil.copytree(ROOT / folder, source / folder, ignore=shutil.ignore_patterns("__pycache__"))
    return source


@pytest.fixture(scope="module")
def wheel(source: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "--no-index", "--quiet"]
    subprocess.run([*build, "--wheel-dir", str(folder), str(source)], check=True)
    (wheel,) = folder.glob("rocking-*.whl")
    return wheel


@pytest.mark.slow
def test_wheel_holds_the_packages(source: Path, wheel: Path) -> None:
    held = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    files = {
        f"{package}/{path.relative_to(source / folder).as_posix()}"
        for package, folder in PACKAGES.items()
        for path in (source / folder).rglob("*")
        if path.is_file()
    }
    assert held == files


@pytest.mark.slow
def test_the_service_answers_from_the_wheel(wheel: Path, tmp_path: Path) -> None:
    """Outside of the checkout; the environment lends it what it requires."""
    installed = tmp_path / "installed"
    install = [sys.executable, "-m", "pip", "install", "--no-deps", "--no-index", "--quiet", "--target"]
    subprocess.run([*install, str(installed), str(wheel)], check=True)
    program = "import rocking, sys; print(rocking.__file__); from rocking.cli.app import app; app()"
    path = {"PYTHONPATH": str(installed), "ROCKING_MAX_SECONDS": "600"}
    with serving(tmp_path, tmp_path / "log", (sys.executable, "-c", program), cwd=tmp_path, **path) as server:
        assert str(installed) in server.log.read_text()
        for page in ("/", "/docs", "/openapi.json", "/health", "/metrics", "/static/docs.js"):
            assert httpx2.get(server.address + page).status_code == 200, page
        question = "/v1/response?pulse=sine&slenderness=0.4&frequency_ratio=5&restitution=0.85"
        answer = httpx2.get(server.address + question, timeout=600).json()  # compiled anew, in a folder of its own
        assert answer["outcome"] == "SAFE"
        assert server.stop() in (0, -15)
