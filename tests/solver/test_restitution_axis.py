"""Cells that differ in restitution only share their first flight: their responses are those of the cells alone."""

import numpy as np
import pytest

from rocking import PULSE_NAMES
from rocking._model.fields import RESPONSE_FIELDS
from rocking._solver.peak_response import peak_response

ETAS = np.array([0.85, 0.0, 1.0, 0.45, 0.2, 0.95, 0.6, 0.75])
"""Not sorted: a response must not depend on the one before, whether that block came to rest or not."""


@pytest.mark.parametrize("alpha", [None, 0.3])
@pytest.mark.parametrize("pulse", [sign + name for name in PULSE_NAMES for sign in ("", "-")])
def test_an_axis_of_restitutions_has_the_bits_of_single_cells(pulse, alpha):
    random = np.random.default_rng(21)
    n = 400
    s, omega = random.uniform(0.01, 1.1, n), np.exp(random.uniform(-3.0, 3.0, n))  # some without uplift
    cells = np.broadcast_arrays(s[:, None], omega[:, None], ETAS)
    axis = peak_response(pulse, slenderness=cells[0], frequency_ratio=cells[1], restitution=ETAS, alpha=alpha)
    order = np.concatenate([ETAS.size * random.permutation(n) + k for k in range(ETAS.size)])
    s, omega, eta = (values.ravel()[order] for values in cells)
    assert (np.diff(s) != 0.0).all()  # no first flight is shared
    alone = peak_response(pulse, slenderness=s, frequency_ratio=omega, restitution=eta, alpha=alpha)
    for field in RESPONSE_FIELDS:
        expected = getattr(alone, field.name)
        np.testing.assert_array_equal(getattr(axis, field.name).ravel()[order], expected, err_msg=field.name)
    assert np.unique(axis.outcome).size > 2
