"""The declaration of a quantity: conversion, ranges, and what options, JSON and tables derive from it."""

import math
from functools import partial
from typing import Annotated

import numpy as np
import pytest
from pydantic import BaseModel, BeforeValidator, ValidationError, create_model
from rocking_api.models.quantity import described

import rocking._base.quantities as quantities
from rocking._base.cells import name_and_unit, read_cell
from rocking._base.errors import InvalidArgumentError
from rocking._base.quantities import (
    ALPHA,
    GROUPS,
    MASS_HEIGHT,
    PGA,
    RESTITUTION,
    SIDES,
    WIDTH,
)
from rocking._base.quantity import Quantity
from rocking._base.units import UNITS


@pytest.mark.parametrize("parameter", GROUPS, ids=[quantity.name for quantity in GROUPS])
def test_interval_states_which_values_are_accepted(parameter):
    assert parameter.convert(parameter.lower) == parameter.lower
    for wrong in (parameter.lower - 1.0, math.nan, math.inf):
        with pytest.raises(InvalidArgumentError) as caught:
            parameter.convert(wrong)
        assert caught.value.allowed == f"{parameter.interval} [{parameter.unit}]"


DECLARED = [quantity for quantity in vars(quantities).values() if isinstance(quantity, Quantity)]


@pytest.mark.parametrize("quantity", DECLARED, ids=[quantity.name for quantity in DECLARED])
def test_a_declaration_is_complete(quantity):
    assert quantity.unit in UNITS or quantity.unit in ("", "bool")
    assert quantity.meaning[0].islower() or quantity.meaning[0].isupper() != quantity.meaning[1].isupper()
    assert not quantity.meaning.endswith(".")
    if quantity.example and quantity is not SIDES:  # a word
        assert quantity.lower <= quantity.number(quantity.example) <= quantity.upper


def test_one_declaration_reads_python_options_json_and_tables():
    assert WIDTH.number("40 cm") == WIDTH.read("40 cm") == WIDTH.read(0.4) == WIDTH.read("0.4", si=True) == 0.4
    np.testing.assert_array_equal(WIDTH.convert(["40 cm", 0.5]), [0.4, 0.5])
    assert RESTITUTION.read("momentum") == "momentum"
    assert RESTITUTION.read("85 %") == RESTITUTION.read("0.85") == 0.85
    assert (WIDTH.option, MASS_HEIGHT.option, WIDTH.header) == ("--width", "--mass-height", "width [m]")
    assert (WIDTH.limits, ALPHA.limits) == ({"exclusiveMinimum": 0.0}, {"minimum": 0.0, "maximum": 1.57})
    assert name_and_unit("mass height (cm)") == ("mass height", "cm")
    assert read_cell(WIDTH, "40", "cm", ".") == 0.4
    assert PGA.sentence == "Peak ground acceleration, PGA; records are scaled to it, such as 0.3g."


@pytest.mark.parametrize(
    ("quantity", "value", "words"),
    [
        (WIDTH, "0.4", "missing unit: write 0.4m"),
        (WIDTH, -1.0, r"allowed: \(0, inf\) \[m\]"),
        (WIDTH, [1.0, -1.0], "at index 1|one number"),
        (RESTITUTION, "bouncy", "or a number"),
        (RESTITUTION, 1.5, r"or \[0, 1\] \[-\]"),
        (ALPHA, 30.0, "write '30 deg'"),
    ],
)
def test_what_is_refused_has_its_name_its_value_and_what_is_allowed(quantity, value, words):
    with pytest.raises(InvalidArgumentError, match=words) as caught:
        quantity.read(value)
    assert (caught.value.parameter, caught.value.value) == (quantity.name, value)


def test_a_field_of_pydantic_has_the_declaration():
    model: type[BaseModel] = create_model(
        "Model",
        width=(Annotated[float, BeforeValidator(partial(WIDTH.read, si=True)), described(WIDTH)], ...),
        restitution=(Annotated[float | str, BeforeValidator(RESTITUTION.read)], "momentum"),
    )
    assert model(width="40 cm").width == model.model_validate_strings({"width": "0.4"}).width == 0.4
    assert model.model_json_schema()["properties"]["width"]["exclusiveMinimum"] == 0.0
    assert model.model_json_schema()["properties"]["width"]["description"] == WIDTH.help
    with pytest.raises(ValidationError) as caught:
        model(width=-1.0)
    assert isinstance(caught.value.errors()[0]["ctx"]["error"], InvalidArgumentError)
