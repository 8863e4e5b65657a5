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
