"""CSV text: exact numbers, empty cells for missing values."""

import csv
import io
import math

from rocking.datasets.csv_text import csv_rows, csv_text


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
