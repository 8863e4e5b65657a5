"""A response depends neither on the other blocks of the array, their order and the threads, nor on earlier calls."""

import numpy as np
import pytest

import rocking
from rocking._model.fields import RESPONSE_FIELDS
from rocking._solver.peak_response import MAX_CHUNK
from tests.solver.records.tables import samples

FIELDS = [field.name for field in RESPONSE_FIELDS]
RECORD = rocking.Record(samples("synthetic_31"), 0.01, "g")
LIFTED = rocking.Record(RECORD.acceleration, 0.01, "m/s2", vertical=0.5 * RECORD.acceleration[::-1])
SAMPLED = rocking.SampledPulse(np.random.default_rng(9).uniform(-1, 1, 9), name="random")
MOTIONS = {"sine": "sine", "ricker": "ricker", "samples": SAMPLED, "record": RECORD, "vertical": LIFTED}
SINGLE = 40
"""Blocks that are solved alone as well."""


def blocks(motion: str, count: int) -> dict[str, np.ndarray]:
    """Random blocks; low frequency ratios divide the intervals of samples, each its own number of times."""
    rng = np.random.default_rng(9)
    found = {"slenderness": rng.uniform(0.01, 1.1, count), "restitution": rng.uniform(0.0, 1.0, count)}
    if motion in ("record", "vertical"):
        found |= {"frequency_parameter": np.exp(rng.uniform(-0.7, 3.0, count)), "restitution": np.full(count, 0.6)}
    else:
        found["frequency_ratio"] = np.exp(rng.uniform(-3.0 if motion != "samples" else -9.0, 3.0, count))
    return found | ({"vertical_scale": np.where(np.arange(count) % 2, 0.4, 0.0)} if motion == "vertical" else {})


def assert_same(one: rocking.Response, other: rocking.Response, chosen: object = ...) -> None:
    for name in FIELDS:
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name)[chosen], err_msg=name)


@pytest.mark.parametrize("alpha", [None, 0.3])
@pytest.mark.parametrize("name", MOTIONS)
def test_company_order_and_threads_change_no_bit(name: str, alpha: float | None) -> None:
    motion = MOTIONS[name]
    many = 2 * MAX_CHUNK + 17 if alpha is None else MAX_CHUNK + 17
    given = blocks(name, many if name == "sine" else 97)
    together = rocking.peak_response(motion, **given, alpha=alpha, threads=1)
    for threads in (2, None):
        assert_same(rocking.peak_response(motion, **given, alpha=alpha, threads=threads), together)
    order = np.random.default_rng(2).permutation(together.peak_rotation.size)
    shuffled = {key: value[order] for key, value in given.items()}
    assert_same(rocking.peak_response(motion, **shuffled, alpha=alpha), together, order)
    for k in order[:SINGLE]:
        alone = rocking.peak_response(motion, **{key: value[k] for key, value in given.items()}, alpha=alpha)
        assert_same(alone, together, k)
    assert np.unique(together.outcome).size > 2


ETAS = np.array([0.85, 0.0, 1.0, 0.45, 0.2, 0.95, 0.6, 0.75])
"""Not sorted: a response must not depend on the one before, whether that block came to rest or not."""


@pytest.mark.parametrize("alpha", [None, 0.3])
@pytest.mark.parametrize("pulse", [sign + name for name in rocking.PULSE_NAMES for sign in ("", "-")])
def test_an_axis_of_restitutions_has_the_bits_of_single_cells(pulse: str, alpha: float | None) -> None:
    """Cells that differ in restitution only share their first flight."""
    random = np.random.default_rng(21)
    n = 400
    s, omega = random.uniform(0.01, 1.1, n), np.exp(random.uniform(-3.0, 3.0, n))  # some without uplift
    cells = np.broadcast_arrays(s[:, None], omega[:, None], ETAS)
    axis = rocking.peak_response(pulse, slenderness=cells[0], frequency_ratio=cells[1], restitution=ETAS, alpha=alpha)
    order = np.concatenate([ETAS.size * random.permutation(n) + k for k in range(ETAS.size)])
    s, omega, eta = (values.ravel()[order] for values in cells)
    assert (np.diff(s) != 0.0).all()  # no first flight is shared
    alone = rocking.peak_response(pulse, slenderness=s, frequency_ratio=omega, restitution=eta, alpha=alpha)
    assert_same(alone, axis, np.unravel_index(order, axis.shape))
    assert np.unique(axis.outcome).size > 2
