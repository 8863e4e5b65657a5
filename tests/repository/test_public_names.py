"""The public interface is the stored one: a removed, changed or new name is seen (see tests/public_names.py)."""

import dataclasses

import numpy as np
import pytest

from tests.public_names import STORED, names_of, present


def test_public_names_are_the_stored_ones() -> None:
    """After an intended change `python -m tests.public_names` writes the list anew."""
    assert present().splitlines() == STORED.read_text(encoding="utf-8").splitlines()


def before(number, *, kind="pulse", at_rest=None): ...
def removed(number, *, kind="pulse"): ...
def reordered(at_rest=None, *, kind="pulse", number): ...
def other_default(number, *, kind="record", at_rest=None): ...


@pytest.mark.parametrize("after", [removed, reordered, other_default])
def test_a_changed_signature_is_another_line(after) -> None:
    assert [*names_of("f", before)] != [*names_of("f", after)]


def test_members_are_fields_properties_and_methods_without_imports_and_private_names() -> None:
    @dataclasses.dataclass
    class Body:
        width: float
        _hidden: float = 0.0

        @property
        def height(self) -> float:
            return self.width

        def response(self, motion: np.ndarray, *, scale: float = 1.0) -> float: ...

    assert [*names_of("Body", Body)] == [
        "Body: height response width",
        "Body.__init__(self, width, _hidden=0.0)",
        "Body.response(self, motion, *, scale=1.0)",
    ]
