"""Public names stay: what was public before is public now; new names are allowed (see tests/public_names.py)."""

from collections.abc import Callable
from pathlib import Path

import pytest

import rocking
from tests import public_names
from tests.public_names import Names


@pytest.mark.parametrize(
    ("kind", "collect"),
    [
        ("python", lambda _: public_names.python_names()),
        ("commands", lambda _: public_names.command_names()),
        ("http", public_names.http_names),
    ],
)
def test_no_public_name_is_removed(kind: str, collect: Callable[[Path], Names], tmp_path: Path) -> None:
    assert public_names.missing(kind, collect(tmp_path)) == []


def test_every_public_name_is_stored_and_can_be_imported() -> None:
    assert set(rocking.__all__) == set(public_names.stored()["python"]["rocking"])
    for name in rocking.__all__:
        assert getattr(rocking, name) is not None


@pytest.mark.slow
def test_no_variable_of_a_data_set_is_removed(smoke_results: Path) -> None:
    assert public_names.missing("files", public_names.file_names(smoke_results)) == []


def test_a_removed_name_is_reported() -> None:
    present = public_names.command_names()
    present["rocking response"].remove("--pulse")
    del present["rocking serve"]
    assert public_names.missing("commands", present)[0] == "rocking response: --pulse"
    assert "rocking serve" in public_names.missing("commands", present)
