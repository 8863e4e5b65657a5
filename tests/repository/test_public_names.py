"""The stored public interface and docs/notation.md are those of the code: a removed, changed or new name is seen."""

from tests.notation import PAGE, page
from tests.public_names import STORED, present


def test_public_names_are_the_stored_ones() -> None:
    """After an intended change `python -m tests.public_names` writes the list anew."""
    assert present().splitlines() == STORED.read_text(encoding="utf-8").splitlines()


def test_the_page_of_names_is_what_the_declarations_give() -> None:
    """`python -m tests.notation` writes it anew."""
    assert page() == PAGE.read_text(encoding="utf-8")
