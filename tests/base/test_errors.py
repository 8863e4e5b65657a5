"""Messages about invalid arguments."""

import numpy as np
import pytest

from rocking._base.errors import InvalidArgumentError, in_range
from rocking._solver.peak_response import peak_response


@pytest.mark.parametrize(
    ("value", "shown"),
    [(10**400, np.inf), (-(10**400), -np.inf), ([1, 10**400], np.inf), ([[0.5], [-(10**5000)]], -np.inf)],
)
def test_integers_beyond_the_range_of_doubles_are_reported_as_infinite(value, shown):
    with pytest.raises(InvalidArgumentError) as caught:
        in_range("any", value, -1.0, np.inf)
    assert (caught.value.parameter, caught.value.value, caught.value.allowed) == ("any", shown, "[-1, inf) [-]")


@pytest.mark.parametrize("name", ["slenderness", "frequency_ratio", "restitution", "alpha"])
def test_the_solver_rejects_them_by_name(name):
    block = {"slenderness": 0.5, "frequency_ratio": 5.0, "restitution": 0.9, "alpha": 0.2}
    with pytest.raises(InvalidArgumentError) as caught:
        peak_response("sine", **block | {name: 10**400})
    assert caught.value.parameter == name
