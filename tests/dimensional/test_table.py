"""Tables of blocks: names as they were written, and the line and the reason where a file is not CSV."""

import csv
import io

import pytest

from rocking._base.errors import InvalidArgumentError
from rocking._datasets.csv_text import csv_text
from rocking._dimensional.table import read_table

HEADER = "name,width [m],height [m],peak_acceleration [g],period [s]\n"
NAMES = ["vase, blue", 'say "no"', "two\nlines", "a\rb", "a\r\nb", " vase ", "", "vase; red", "6'", "=1+1", "'-1"]


@pytest.mark.parametrize("delimiter", [",", ";"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_names_are_kept(delimiter, end):
    text = io.StringIO(newline="")
    text.write(HEADER.strip().replace(",", delimiter) + end)
    writer = csv.writer(text, delimiter=delimiter, quoting=csv.QUOTE_ALL, lineterminator=end)
    writer.writerows([name, 0.2, 0.8, 0.4, 0.5] for name in NAMES)
    table = read_table(text.getvalue(), "sine")
    assert table.names == NAMES
    assert {problem.block.half_width for problem in table.problems} == {0.1}


def test_names_that_were_written_are_read_back():
    rest = [[0.2] * len(NAMES), [0.8] * len(NAMES), [0.4] * len(NAMES), [0.5] * len(NAMES)]
    text = csv_text(dict(zip(HEADER.strip().split(","), [NAMES, *rest], strict=True)))
    assert [name.removeprefix("'") for name in read_table(text, "sine").names] == [
        name.removeprefix("'") for name in NAMES
    ]


GOOD = "vase,0.2,0.8,0.4,0.5\n"


@pytest.mark.parametrize(
    ("rows", "line", "reason"),
    [
        (GOOD + '"vase,0.2,0.8,0.4,0.5\n' + GOOD, 3, "unexpected end of data"),
        (GOOD + '"va"se,0.2,0.8,0.4,0.5\n', 3, "',' expected after '\"'"),
        (GOOD + f"{'v' * 131_073},0.2,0.8,0.4,0.5\n", 3, "field larger than field limit"),
        (GOOD + '"two\nlines",0.2,0.8,0.4,0.5\n"vase', 5, "unexpected end of data"),
        ("va\rse,0.2,0.8,0.4,0.5\n", 2, "1 values"),
        ("vase,0.2,0.8,0.4\n", 2, "4 values"),
    ],
)
def test_what_is_not_csv_is_refused_with_line_and_reason(rows, line, reason):
    with pytest.raises(InvalidArgumentError, match=f"blocks, line {line}`") as refusal:
        read_table(HEADER + rows, "sine")
    assert reason in str(refusal.value.value)


@pytest.mark.parametrize("header", ['"name', "n" * 131_073 + ",width [m]\n", '"na"me,width [m]\n'])
def test_a_header_that_is_not_csv_is_refused_with_its_line(header):
    with pytest.raises(InvalidArgumentError, match="blocks, line 1`"):
        read_table(header, "sine")
