"""CSV text: exact numbers, empty cells for missing values."""

import csv
import io
import math

import pytest

from rocking._datasets.csv_text import csv_rows, csv_text


def test_cells_are_exact_and_missing_values_empty():
    columns = {"peak": [0.1 + 0.2, math.nan, None], "overturned": [False, True, True], "impacts": [3, -1, 0]}
    text = csv_text(columns)
    assert text == "peak,overturned,impacts\n0.30000000000000004,false,3\n,true,-1\n,true,0\n"
    rows = list(csv.reader(io.StringIO(text)))
    assert float(rows[1][0]) == 0.1 + 0.2


def test_parts_make_the_same_text():
    columns = {"a": [1, 2, 3], "b": ["x", "y", "z"]}
    parts = [csv_rows({name: column[k : k + 1] for name, column in columns.items()}) for k in range(3)]
    assert "a,b\n" + "".join(parts) == csv_text(columns)


NAMES = ("vase, blue", 'say "no"', "two\nlines", "a\rb", "a\r\nb", " vase ", "", "vase; red", "6'", "Säule", '"')


def test_names_are_read_back_as_they_were_written():
    text = csv_text({"name": NAMES, "name, too": NAMES})
    rows = list(csv.reader(io.StringIO(text, newline=""), strict=True))
    assert rows[0] == ["name", "name, too"]
    assert [tuple(row) for row in rows[1:]] == [(name, name) for name in NAMES]


@pytest.mark.parametrize(
    "name",
    [
        "=1+1",
        "+1",
        "-2+3",
        "@SUM(A1)",
        "\r=1",
        "\n=1",
        "＝1+1",
        "＋1",
        "－1",
        "＠SUM(A1)",
        '=HYPERLINK("x", "y")',
        "-sine",
    ],
)
def test_text_that_starts_a_formula_has_an_apostrophe(name):
    rows = list(csv.reader(io.StringIO(csv_text({name: [name]}), newline=""), strict=True))
    assert rows == [[f"'{name}"], [f"'{name}"]]


def test_numbers_are_not_taken_for_formulas():
    assert csv_text({"a": [-1.5, -3, -0.0, 1e-300], "b": ["1", "x", "y", "z"]}) == (
        "a,b\n-1.5,1\n-3,x\n-0.0,y\n1e-300,z\n"
    )


@pytest.mark.parametrize(
    ("name", "cell"), [("x;=1+1;y", "x;'=1+1;y"), ("x\t=1+1", "x\t'=1+1"), ("\t=1", "'\t'=1"), ("a;-2;b", "a;-2;b")]
)
def test_a_formula_behind_a_delimiter_of_another_program_has_an_apostrophe(name, cell):
    rows = list(csv.reader(io.StringIO(csv_text({"name": [name]}), newline=""), strict=True))
    assert rows[1] == [cell]
