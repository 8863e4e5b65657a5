"""The indicator of progress: on a terminal after a second, on stderr only; nothing where stderr is piped."""

import sys
import time

import pytest

from rocking._cli import progress as module
from rocking._cli.progress import progress


@pytest.fixture
def terminal(monkeypatch):
    """A stderr that is taken for a terminal."""
    monkeypatch.setenv("TTY_COMPATIBLE", "1")
    monkeypatch.setenv("TTY_INTERACTIVE", "1")
    monkeypatch.setattr(module, "DELAY", 0.05)


@pytest.mark.usefixtures("terminal")
def test_shown_on_a_terminal_while_the_block_runs_long(monkeypatch, capsys):
    monkeypatch.setattr(module, "LONG", 0.3)
    with progress("solving"):
        time.sleep(0.6)
        sys.stdout.write("result\n")
    found = capsys.readouterr()
    assert found.out == "result\n"
    assert "solving (the first calls compile parts of the solver)" in found.err.replace("\n", " ")
    assert "0:00:00" in found.err


@pytest.mark.usefixtures("terminal")
def test_nothing_for_short_work_and_after_an_error(capsys):
    with pytest.raises(ValueError, match="refused"), progress("solving"):
        raise ValueError("refused")
    time.sleep(0.1)
    assert capsys.readouterr().err == ""


def test_silent_when_piped(monkeypatch, capsys):
    monkeypatch.setattr(module, "DELAY", 0.0)
    with progress("solving"):
        time.sleep(0.1)
    assert capsys.readouterr().err == ""
