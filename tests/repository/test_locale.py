"""The package works in a folder whose name is not ASCII, in a locale that knows ASCII only."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.sampling import but_long

ROOT = Path(__file__).parents[2]
BLOCKS = "name,width [m],height [m],peak_acceleration [g],period [s]\nStèle é,0.2,1.0,0.3,0.5\n"
ASCII = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONSAFEPATH": "1"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("copy") / "pâté"
    shutil.copytree(ROOT / "rocking", folder / "rocking", ignore=shutil.ignore_patterns("__pycache__"))
    for package in ("api/rocking_api", "assessment/rocking_assessment"):
        target = folder / Path(package).name
        shutil.copytree(ROOT / package, target, ignore=shutil.ignore_patterns("__pycache__"))
    return folder


def run(folder, *arguments, **environment):
    variables = os.environ | ASCII | {"PYTHONPATH": str(folder)} | environment
    variables.pop("NUMBA_CACHE_DIR", None)
    command = [sys.executable, *arguments]
    done = subprocess.run(command, cwd=folder, env=variables, input=BLOCKS.encode(), capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode(errors="replace")
    return done.stdout.decode()


def test_the_locale_of_these_tests_knows_ascii_only(folder):
    printed = run(folder, "-c", "import sys, locale; print(sys.getfilesystemencoding(), locale.getpreferredencoding())")
    assert printed.split() == ["ascii", "ANSI_X3.4-1968"]


@pytest.mark.parametrize("locale", but_long([{}, {"PYTHONUTF8": "1"}], {}), ids=["ascii", "utf-8"])
def test_commands_and_the_service_are_imported(folder, locale):
    assert "response" in run(folder, "-m", "rocking._cli", "--help", **locale)
    run(folder, "-c", "import rocking_api.settings, rocking_api.command", **locale)


RESPONSE = ("-m", "rocking._cli", "response", "--pulse", "sine", "--format=csv")


@pytest.mark.parametrize("file", ["-", "blocs_é.csv"])
def test_names_pass_from_files_and_standard_input(folder, file):
    (folder / "blocs_é.csv").write_text(BLOCKS, encoding="utf-8")
    assert "\nStèle é,0.2,1.0," in run(folder, *RESPONSE, file, PYTHONPATH=str(ROOT))


@pytest.mark.long
def test_kernels_are_compiled_and_kept(folder):
    first = run(folder, *RESPONSE, "-")
    kept = {path: path.stat().st_mtime_ns for path in folder.rglob("*.nbc")}
    assert kept
    assert run(folder, *RESPONSE, "-") == first
    assert {path: path.stat().st_mtime_ns for path in folder.rglob("*.nbc")} == kept
