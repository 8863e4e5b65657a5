"""Declarations of the parameters: ranges in words, smaller ranges, windows."""

import math

import pytest

from rocking._base.errors import InvalidArgumentError
from rocking._base.quantities import ALPHA, FREQUENCY_RATIO, GROUPS, SLENDERNESS
from rocking._model.checks import check_window


@pytest.mark.parametrize("parameter", GROUPS, ids=[one.name for one in GROUPS])
def test_interval_states_which_values_are_accepted(parameter):
    assert parameter.convert(parameter.lower) == parameter.lower
    for wrong in (parameter.lower - 1.0, math.nan, math.inf):
        with pytest.raises(InvalidArgumentError) as caught:
            parameter.convert(wrong)
        assert caught.value.allowed == f"{parameter.interval} [{parameter.unit}]"


def test_smaller_range():
    served = SLENDERNESS.restricted(1e-9, math.inf)
    assert (served.interval, served.name) == ("[1e-09, inf)", "slenderness")
    assert FREQUENCY_RATIO.restricted(1.0, 2.0).interval == "[1, 2]"
    for wrong in ((1e-13, 1.0), (2.0, 1.0)):
        with pytest.raises(ValueError, match="not a part of"):
            SLENDERNESS.restricted(*wrong)


def test_angle_in_degrees():
    degrees = ALPHA.in_degrees()
    assert (degrees.name, degrees.unit, degrees.lower) == ("alpha_deg", "deg", 0.0)
    assert math.radians(degrees.upper) == pytest.approx(ALPHA.upper)


def test_window():
    assert check_window(FREQUENCY_RATIO, 1, 2) == (1.0, 2.0)
    for low, high, name in ((0.0, 1.0, "frequency_ratio_min"), (2.0, 2.0, "frequency_ratio_max")):
        with pytest.raises(InvalidArgumentError, match=f"^`{name}` = "):
            check_window(FREQUENCY_RATIO, low, high)
    with pytest.raises(InvalidArgumentError, match=r"^`last` = "):
        check_window(SLENDERNESS, 0.5, 0.4, ("first", "last"))
