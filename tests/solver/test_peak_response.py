"""`peak_response`: shapes, order, threads, invalid arguments, and properties of every valid response."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rocking
from rocking import PULSE_NAMES, Outcome
from rocking._model.fields import RESPONSE_FIELDS
from rocking._solver.peak_response import peak_response
from tests.sampling import number

FIELDS = tuple(field.name for field in RESPONSE_FIELDS)
SIGNED = tuple(sign + name for name in PULSE_NAMES for sign in ("", "-"))


def assert_identical(first: rocking.Response, second: rocking.Response) -> None:
    for name in FIELDS:
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name), err_msg=name)


def cells(n: int, seed: int = 0):
    rng = np.random.default_rng(seed)
    return {
        "slenderness": rng.uniform(0.01, 1.1, n),
        "frequency_ratio": np.exp(rng.uniform(-3, 3, n)),
        "restitution": rng.uniform(0, 1, n),
    }


def test_scalars_give_arrays_without_axes():
    found = peak_response("sine", slenderness=0.4, frequency_ratio=5.0, restitution=0.85)
    assert found.shape == ()
    for name in FIELDS:
        assert getattr(found, name).shape == ()
    assert not found.overturned
    assert found.outcome == Outcome.RECOVERS


def test_empty_arguments_give_an_empty_response():
    found = peak_response("sine", slenderness=np.empty((0, 3)), frequency_ratio=2.0, restitution=0.9)
    assert found.shape == (0, 3)
    assert found.overturned.shape == (0, 3)


def test_broadcasting():
    slenderness, omega, eta = np.linspace(0.1, 0.9, 5), np.linspace(0.5, 6, 4)[:, None], np.array([[[0.8]], [[0.95]]])
    found = peak_response("cosine", slenderness=slenderness, frequency_ratio=omega, restitution=eta)
    assert found.shape == (2, 4, 5)
    for i, j, k in np.ndindex(2, 4, 5):
        index = i, j, k
        one = peak_response("cosine", slenderness=slenderness[k], frequency_ratio=omega[j, 0], restitution=eta[i, 0, 0])
        for name in FIELDS:
            np.testing.assert_array_equal(getattr(found, name)[index], getattr(one, name))


def test_any_memory_layout_and_number_type():
    grid = np.linspace(0.1, 0.9, 12).reshape(3, 4)
    plain = peak_response("sine", slenderness=grid, frequency_ratio=3.0, restitution=0.9)
    for other in (np.asfortranarray(grid), np.repeat(grid, 2, axis=0)[::2], grid.tolist()):
        assert_identical(peak_response("sine", slenderness=other, frequency_ratio=3, restitution=0.9), plain)
    backwards = peak_response("sine", slenderness=grid[::-1], frequency_ratio=3.0, restitution=0.9)
    np.testing.assert_array_equal(backwards.peak_rotation[::-1], plain.peak_rotation)
    single = peak_response("sine", slenderness=np.float32(0.5), frequency_ratio=3, restitution=1)
    assert_identical(single, peak_response("sine", slenderness=0.5, frequency_ratio=3.0, restitution=1.0))


def test_alpha_may_mix_slender_and_rigid():
    alpha = np.array([0.0, 0.1, 0.0, 0.4])
    mixed = peak_response("sine", slenderness=0.7, frequency_ratio=4.0, restitution=0.9, alpha=alpha)
    for i, angle in enumerate(alpha):
        one = peak_response("sine", slenderness=0.7, frequency_ratio=4.0, restitution=0.9, alpha=angle)
        for name in FIELDS:
            np.testing.assert_array_equal(getattr(mixed, name)[i], getattr(one, name))
    none = peak_response("sine", slenderness=0.7, frequency_ratio=4.0, restitution=0.9)
    assert mixed.peak_rotation[0] == none.peak_rotation


@pytest.mark.parametrize("pulse", SIGNED)
@pytest.mark.parametrize("alpha", [None, 0.2])
def test_a_block_without_uplift_has_no_peak(pulse, alpha):
    found = peak_response(
        pulse, slenderness=[1.0, 1.0 + 1e-15, 2.0, 1e6, 1e300], frequency_ratio=2.0, restitution=0.9, alpha=alpha
    )
    assert (found.outcome == Outcome.NO_UPLIFT).all()
    assert (found.peak_rotation == 0).all()
    assert (found.impacts == 0).all()
    assert (found.peak_mode == -1).all()
    assert not found.exceeded_alpha.any()
    assert np.isnan(found.uplift_time).all()
    assert np.isnan(found.first_impact_time).all()


def test_shapes_that_do_not_broadcast_are_named():
    with pytest.raises(rocking.InvalidArgumentError, match=r"\(2,\), \(3,\)"):
        peak_response("sine", slenderness=[0.4, 0.5], frequency_ratio=[1.0, 2.0, 3.0], restitution=0.9)


@given(
    pulse=st.sampled_from(SIGNED),
    log_omega=st.floats(-3, 3),
    log_slenderness=st.one_of(st.floats(-3, -1e-12), st.floats(-12, -1).map(lambda x: math.log10(1 - 10**x))),
    eta=st.one_of(st.floats(0, 0.999), st.sampled_from([0.0, 1e-3, 0.99])),
    alpha=st.one_of(st.none(), st.floats(-8, 0.17).map(lambda x: 10**x)),
)
@settings(max_examples=number(100, 400))
def test_every_valid_cell_has_a_consistent_response(pulse, log_omega, log_slenderness, eta, alpha):
    found = peak_response(
        pulse, slenderness=10**log_slenderness, frequency_ratio=10**log_omega, restitution=eta, alpha=alpha
    )
    peak, outcome, impacts = float(found.peak_rotation), Outcome(int(found.outcome)), int(found.impacts)
    assert outcome != Outcome.NO_UPLIFT
    assert found.overturned == math.isnan(peak)
    assert math.isnan(peak) or 0 <= peak < math.inf
    assert found.exceeded_alpha == (math.isnan(peak) or peak > 1)
    assert (outcome == Outcome.OVERTURNED_DIRECTLY) <= (impacts == 0)
    assert (outcome == Outcome.OVERTURNED_AFTER_IMPACT) <= (impacts > 0)
    assert impacts >= 0
    assert (found.peak_mode == -1) == (math.isnan(peak) or peak == 0)
    duration = (rocking.pulse(pulse).end - rocking.pulse(pulse).start) / 10**log_omega
    assert 0 <= found.uplift_time <= duration
    if math.isfinite(found.first_impact_time):
        assert impacts >= 1
        assert 0 < found.first_impact_time <= (duration - found.uplift_time) * (1 + 1e-12) + 1e-300
        assert found.first_impact_velocity != 0
    elif impacts > 0:  # the only impact is that of free rocking which is followed by overturning
        assert (outcome, impacts) == (Outcome.OVERTURNED_AFTER_IMPACT, 1)
    assert not (found.chatter and impacts == 0)
