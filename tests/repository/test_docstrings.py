"""The examples of docstrings print what they say."""

import doctest
import importlib
from pathlib import Path

import pytest

import rocking

PACKAGE = Path(rocking.__file__).parent
MODULES = [
    "rocking." + ".".join(path.relative_to(PACKAGE).with_suffix("").parts)
    for path in sorted(PACKAGE.rglob("*.py"))
    if "\n    >>> " in path.read_text(encoding="utf-8")
]


@pytest.mark.parametrize("name", MODULES)
def test_examples_print_what_they_say(name):
    found = doctest.testmod(importlib.import_module(name), extraglobs={"rocking": rocking})
    assert found.attempted > 0
    assert found.failed == 0
