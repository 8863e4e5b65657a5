"""Arguments of the closed forms: ranges, and labelled arrays that numpy would combine by position."""

import inspect

import numpy as np
import pytest
import xarray as xr

from rocking import paper
from rocking._base.errors import InvalidArgumentError
from rocking.paper.arguments import checked

VALUES = {
    "amplitude": [2.0, 3.0],
    "frequency_ratio": [4.0, 5.0],
    "restitution": [0.8, 0.9],
    "time": [0.1, 0.2],
    "velocity": [0.3, 0.4],
    "impact_time": [0.5, 0.6],
    "falling": [-0.2, -0.1],
    "growing": [0.1, 0.2],
    "constant": [-1.0, -2.0],
}


def functions_of_arrays():
    for name, function in inspect.getmembers(paper, inspect.isfunction):
        arguments = [str(one) for one in inspect.signature(function).parameters]
        if len(arguments) > 1 and set(arguments) <= VALUES.keys():
            yield pytest.param(function, arguments, id=name)


FUNCTIONS = list(functions_of_arrays())


def test_most_closed_forms_are_covered():
    assert len(FUNCTIONS) >= 30


@pytest.mark.parametrize(("function", "arguments"), FUNCTIONS)
def test_labelled_arrays_of_different_dimensions_are_refused(function, arguments):
    labelled = {name: xr.DataArray(VALUES[name], dims=name) for name in arguments}
    with pytest.raises(InvalidArgumentError, match="equal dimensions and indexes"):
        function(**labelled)
    last = arguments[-1]  # one array against the others, which agree
    mixed = {name: xr.DataArray(VALUES[name], dims="y" if name == last else "x") for name in arguments}
    with pytest.raises(InvalidArgumentError, match="equal dimensions and indexes"):
        function(**mixed)


@pytest.mark.parametrize(("function", "arguments"), FUNCTIONS)
def test_labelled_arrays_of_equal_dimensions_give_the_numbers_of_plain_ones(function, arguments):
    plain = function(**{name: np.array(VALUES[name]) for name in arguments})
    labelled = function(**{name: xr.DataArray(VALUES[name], dims="x") for name in arguments})
    np.testing.assert_array_equal(np.asarray(labelled), np.asarray(plain))


@pytest.mark.parametrize("value", [0.99, np.nan])
def test_amplitudes_below_uplift_are_refused(value):
    with pytest.raises(InvalidArgumentError, match=r"^`amplitude` = "):
        checked(amplitude=value)
