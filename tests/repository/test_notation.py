"""docs/notation.md is what `python -m tests.notation` writes from the declarations and the interfaces."""

from tests.notation import PAGE, page


def test_the_page_is_what_the_declarations_give() -> None:
    assert page() == PAGE.read_text(encoding="utf-8")
