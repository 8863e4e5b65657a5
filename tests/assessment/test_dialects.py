"""Random tables of known objects: no silent error, by file, by workbook and over HTTP. `make test-all` tries more."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from rocking._assessment.tables import objects_of_csv, objects_of_text, read_objects
from rocking._base.errors import InvalidArgumentError
from rocking._dimensional.table_reader import csv_of_sheet
from tests.assessment.dialects import Writer, errors_of
from tests.sampling import SEED, number
from tests.sheets import xlsx_bytes

CASES = number(60, 11_000)


def test_what_is_read_is_true_or_refused() -> None:
    read, wrong, refused = 0, [], 0
    for seed in random.Random(SEED).sample(range(10**9), CASES):
        dialect = Writer(seed).table()
        try:
            table = objects_of_text(dialect.raw, json=False)
        except InvalidArgumentError:
            refused += 1
            continue
        wrong += [f"seed {seed}: {error}" for error in errors_of(table, dialect)]
        read += len(table.objects) == len(dialect.objects)
    assert wrong == []
    assert read > 0.5 * CASES
    assert refused < 0.15 * CASES


def test_a_workbook_is_read_alike_by_command_and_by_page(tmp_path: Path) -> None:
    pytest.importorskip("python_calamine")
    path = tmp_path / "table.xlsx"
    for seed in random.Random(SEED).sample(range(10**9), max(10, CASES // 10)):
        dialect = Writer(seed, typed=True).table()
        raw = xlsx_bytes(dialect.rows)
        path.write_bytes(raw)
        answers = []
        for page in (False, True):
            try:
                table = objects_of_csv(csv_of_sheet(raw, "table")) if page else read_objects(path)
            except InvalidArgumentError as error:
                answers.append(str(error))
                continue
            assert errors_of(table, dialect) == [], seed
            rows = [vars(one) | {"cells": one.cells} for one in table.objects]
            answers.append((rows, [vars(one) for one in table.bad_rows]))
        assert answers[0] == answers[1], seed
