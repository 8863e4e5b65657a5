"""The reference problems: as their schema states, and answered by this package with the digits that they ask for."""

import json
import math
from collections import Counter

import jsonschema
import pytest

from benchmarks.accuracy.reference_problems import by_rocking, by_scipy, digits_reached, problems
from reference.make_problems import FOLDER

PROBLEMS = list(problems())
BY_OTHERS = "06", "24", "39"  # quick by SciPy


def test_forty_different_problems_of_each_kind() -> None:
    schema = json.loads((FOLDER / "schema.json").read_text())
    for one in PROBLEMS:
        jsonschema.validate(one, schema)
    assert len({one["id"] for one in PROBLEMS}) == len(PROBLEMS) == 40
    assert Counter(one["motion"]["kind"] for one in PROBLEMS) == {"pulse": 23, "samples": 15, "release": 2}
    assert {one["answer"]["outcome"] for one in PROBLEMS} == set(
        schema["properties"]["answer"]["properties"]["outcome"]["enum"]
    )
    assert sum(one["body"]["edges"]["left"] is None for one in PROBLEMS) == 3
    assert min(one["digits"] for one in PROBLEMS) == 3


@pytest.mark.parametrize(
    "problem", [one for one in PROBLEMS if one["motion"]["kind"] != "release"], ids=lambda one: one["id"]
)
def test_package_reaches_the_digits(problem: dict) -> None:
    found = by_rocking(problem)
    assert found is not None
    if not math.isnan(found["peak_rotation"]):
        assert "peak_rotation" in problem["answer"] or problem["answer"]["outcome"] == "no uplift"
    assert float(digits_reached(problem, found)) >= problem["digits"]


@pytest.mark.parametrize("problem", [one for one in PROBLEMS if one["id"][:2] in BY_OTHERS], ids=lambda one: one["id"])
def test_a_second_way_finds_most_digits(problem: dict) -> None:
    assert float(digits_reached(problem, by_scipy(problem))) > 9.0


def test_a_wrong_answer_has_no_digits() -> None:
    one = PROBLEMS[0]
    found = by_rocking(one)
    assert found is not None
    assert digits_reached(one, found | {"outcome": "overturns after impact"}) == "-"
    assert float(digits_reached(one, found | {"peak_rotation": found["peak_rotation"] * 1.001})) == pytest.approx(
        3.0, abs=0.1
    )
