"""Every reader of text takes time in proportion to the length of the text, whatever it holds."""

from itertools import islice

import pytest

from tests.repeated_fragments import MATCHED_UNITS, READERS, Fragments, Reader, excess, fragments
from tests.sampling import sample

ROWS = "\n0,1\n1,2\n2,1\n"
AT2 = "PEER\nTitle\nACCELERATION TIME HISTORY IN UNITS OF G\n{}\n1 2 3\n"

FOUND = [
    *(
        ("columns", f"@{ROWS}", *parts)
        for parts in (("", "a", ""), ("", "a ", ""), ("a:b", " ", "b,"), ("a", " ", "b"))
    ),
    *(("columns", f"time @,a_g{ROWS}", *parts) for parts in (("", " ", "("), ("", "s", ""))),
    *(("columns", f"time,acc@{ROWS}", *parts) for parts in (("", "(", ""), ("", " g", ""))),
    *(("AT2", AT2.format("NPTS= 3, DT= .01").replace("Title", "@"), "", fragment, "") for fragment in ("(", "[a")),
    ("AT2", AT2.format("@ NPTS DT"), "", "1", ""),
    ("AT2", AT2.format("@ NPTS DT"), "1", " ", ""),
    ("AT2", AT2.format("DT= .01 NPTS@;"), "", " ", ""),
    *(("cell of a header", "@", *parts) for parts in (("[", " ", "x"), ("width [", " ", "] x"))),
    ("query string", "@&a=1&a=2", "", "a№=1&", ""),
    ("points in JSON", "@", "", '"slenderness":[', ""),
]
"""Texts whose time grew with the square of their length."""


@pytest.mark.parametrize(("name", "given"), [(name, Fragments(*parts)) for name, *parts in FOUND])
def test_texts_that_took_long(name, given):
    assert excess(READERS[name], given) is None


def assert_in_proportion(name: str, reader: Reader) -> None:
    for given in sample([*islice(fragments(name, reader, seed=1), 100)], 4):
        assert excess(reader, given) is None


@pytest.mark.parametrize("name", READERS)
def test_readers(name):
    assert_in_proportion(name, READERS[name])


@pytest.mark.parametrize("name", MATCHED_UNITS)
def test_readers_of_units(name):
    assert_in_proportion(name, MATCHED_UNITS[name])
