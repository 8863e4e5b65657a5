"""The public interface is the stored one: a removed, changed or new name is seen (see tests/public_names.py)."""

import dataclasses
from collections.abc import Callable
from typing import Any

import pytest

from tests.public_names import STORED, names_of, present


def test_public_names_are_the_stored_ones() -> None:
    """After an intended change `python -m tests.public_names` writes the list anew."""
    assert present().splitlines() == STORED.read_text(encoding="utf-8").splitlines()


def present_form(number: int, *, kind: str = "pulse") -> None: ...


def renamed(count: int, *, kind: str = "pulse") -> None: ...


def by_position(number: int, kind: str = "pulse") -> None: ...


def other_default(number: int, *, kind: str = "record") -> None: ...


@pytest.mark.parametrize("changed", [renamed, by_position, other_default])
def test_a_changed_signature_is_another_line(changed: Callable[..., None]) -> None:
    assert [*names_of("f", present_form)] == ["f(number, *, kind='pulse')"]
    assert [*names_of("f", changed)] != [*names_of("f", present_form)]


def test_members_are_fields_properties_and_methods_without_imports_and_private_names() -> None:
    @dataclasses.dataclass
    class Body:
        width: float
        _hidden: float = 0.0

        @property
        def height(self) -> float:
            return self.width

        def response(self, motion: Any, *, scale: float = 1.0) -> None: ...

    assert [*names_of("Body", Body)] == [
        "Body: height response width",
        "Body.__init__(self, width, _hidden=0.0)",
        "Body.response(self, motion, *, scale=1.0)",
    ]
