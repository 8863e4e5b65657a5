"""Commands on a full disk: the old file stays, the error is one line."""

import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.test_cli import GROUPS, refused
from tests.full_disk import full_disk

OBJECTS = "name,width [cm],depth [cm],height [cm]\nbust,40,30,160\n"
ASSESS = ("--pga", "0.3g", "--pgv", "0.3 m/s", "--shapes", "sine", "--no-sensitivity")


@pytest.mark.parametrize(("option", "ending"), [("output", "xlsx"), ("report", "html"), ("picture", "svg")])
def test_old_file_stays(tmp_path: Path, option: str, ending: str) -> None:
    (tmp_path / "objects.csv").write_text(OBJECTS)
    old = tmp_path / f"old.{ending}"
    old.write_text("old")
    command = ("assess", str(tmp_path / "objects.csv"), *ASSESS, f"--{option}")
    if option == "picture":
        command = ("plot", "response", *GROUPS, "--output")
    names = sorted(tmp_path.iterdir())
    with full_disk():
        message = refused(*command, str(old))
    assert "a file that can be written (File too large)" in message
    assert "Traceback" not in message
    assert old.read_text() == "old"
    assert sorted(tmp_path.iterdir()) == names


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
@pytest.mark.parametrize("arguments", [["pulses", "--format", "csv"], ["--help"]])
def test_standard_output_on_a_full_disk_is_one_line(arguments: list[str]) -> None:
    with Path("/dev/full").open("w") as full:
        command = [sys.executable, "-m", "rocking._cli", *arguments]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert done.stderr == "rocking: standard output: No space left on device\n"
    assert done.returncode == 1
