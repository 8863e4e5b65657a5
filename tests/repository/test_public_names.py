"""The public interface is the stored one: a removed, changed or new name is seen (see tests/public_names.py)."""

from tests.public_names import STORED, present


def test_public_names_are_the_stored_ones() -> None:
    """After an intended change `python -m tests.public_names` writes the list anew."""
    assert present().splitlines() == STORED.read_text(encoding="utf-8").splitlines()
