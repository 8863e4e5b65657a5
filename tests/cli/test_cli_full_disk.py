"""Commands on a full disk: the old file stays, the error is one line."""

from pathlib import Path

import pytest

from tests.cli.test_cli import refused
from tests.full_disk import full_disk

OBJECTS = "name,width [cm],depth [cm],height [cm]\nbust,40,30,160\n"
ASSESS = ("--pga", "0.3g", "--pgv", "0.3 m/s", "--shapes", "sine", "--no-sensitivity")


@pytest.mark.parametrize(("option", "ending"), [("output", "xlsx"), ("report", "html")])
def test_old_file_stays(tmp_path: Path, option: str, ending: str) -> None:
    (tmp_path / "objects.csv").write_text(OBJECTS)
    old = tmp_path / f"old.{ending}"
    old.write_text("old")
    command = ("assess", str(tmp_path / "objects.csv"), *ASSESS, f"--{option}")
    names = sorted(tmp_path.iterdir())
    with full_disk():
        message = refused(*command, str(old))
    assert "a file that can be written (File too large)" in message
    assert "Traceback" not in message
    assert old.read_text() == "old"
    assert sorted(tmp_path.iterdir()) == names
