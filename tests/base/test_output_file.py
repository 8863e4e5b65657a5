"""Output files are replaced as a whole, or stay as they are."""

import os
import stat
from pathlib import Path

import pytest

from rocking._base.errors import InvalidArgumentError
from rocking._base.output_file import output_errors, replacement_of, write_output
from tests.full_disk import ROOM, full_disk

LONG = "x" * (ROOM + 1)


@pytest.fixture
def old(tmp_path: Path) -> Path:
    path = tmp_path / "table.csv"
    path.write_text("the old table\n")
    return path


def test_file_is_written_as_it_is(tmp_path: Path) -> None:
    write_output(tmp_path / "a.csv", "å\r\n")
    assert (tmp_path / "a.csv").read_bytes() == b"\xc3\xa5\r\n"
    write_output(tmp_path / "a.csv", b"\x00")
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"\x00"]


def test_old_file_stays_on_a_full_disk(old: Path) -> None:
    with full_disk(), pytest.raises(InvalidArgumentError) as caught, output_errors("output", old):
        write_output(old, LONG)
    assert str(caught.value).startswith(
        f"`output` = {str(old)!r} is not allowed; allowed: a file that can be written ("
    )
    assert old.read_text() == "the old table\n"
    assert list(old.parent.iterdir()) == [old]


def test_old_file_stays_when_the_block_raises(old: Path) -> None:
    def write_half() -> None:
        with replacement_of(old) as temporary:
            temporary.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_half()
    assert old.read_text() == "the old table\n"
    assert list(old.parent.iterdir()) == [old]


def test_mode_and_symbolic_link_stay(old: Path) -> None:
    old.chmod(0o640)
    link = old.with_name("link.csv")
    link.symlink_to(old.name)
    write_output(link, "new")
    assert link.is_symlink()
    assert old.read_text() == "new"
    assert stat.S_IMODE(old.stat().st_mode) == 0o640


def test_new_file_has_the_mode_of_other_new_files(tmp_path: Path) -> None:
    (tmp_path / "usual").touch()
    write_output(tmp_path / "new", "")
    assert (tmp_path / "new").stat().st_mode == (tmp_path / "usual").stat().st_mode


@pytest.mark.skipif(os.name != "posix", reason="no pipes with a name")
def test_what_cannot_be_replaced_is_written(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    write_output(pipe, "text")
    assert os.read(reader, 10) == b"text"
    os.close(reader)


def test_missing_folder_is_named_by_its_argument(tmp_path: Path) -> None:
    with pytest.raises(InvalidArgumentError, match=r"`report` = .*\(No such file or directory\)"):  # noqa: SIM117
        with output_errors("report", tmp_path / "no" / "report.html"):
            write_output(tmp_path / "no" / "report.html", "")


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write everything")
def test_protected_file_is_not_replaced(old: Path) -> None:
    old.chmod(0o444)
    with pytest.raises(PermissionError):
        write_output(old, "new")
