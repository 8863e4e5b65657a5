"""Responses under smooth pulses of one's own: against named ones, in multi-precision, and in every use."""

import math

import numpy as np
import pytest
from flint import arb, arb_series, ctx

import reference.multiprecision
import rocking
from reference.conditioning import integrate_with_conditioning
from reference.exact_pulses import ExactPulse, _newton
from reference.exact_response import working_precision
from rocking.paper import margin_without_impact
from tests.excitation.test_smooth_pulse import CHIRP, Given
from tests.sampling import number

SINE = Given("own_sine", 0.0, 2.0 * math.pi, np.sin)
RICKER = Given("own_ricker", *(s * 4.0 * math.pi for s in (-1, 1)), rocking.pulse("ricker").shape)
COUNT = number(1000, 3000)
GROUPS = {"slenderness": 0.45, "frequency_ratio": 3.0, "restitution": 0.85}


@pytest.mark.parametrize("rigid", [False, True])
@pytest.mark.parametrize(("own", "name"), [(SINE, "sine"), (RICKER, "ricker")])
def test_named_pulses_written_as_smooth_ones_give_the_same_responses(own, name, rigid):
    rng = np.random.default_rng(3)
    groups = {
        "slenderness": rng.uniform(0.05, 0.98, COUNT),
        "frequency_ratio": 10 ** rng.uniform(-0.5, 1.3, COUNT),
        "restitution": rng.uniform(0.4, 0.98, COUNT),
    }
    if rigid:
        groups["alpha"] = rng.uniform(0.02, 0.5, COUNT)
    named, found = rocking.peak_response(name, **groups), rocking.peak_response(own, **groups)
    for field in ("outcome", "impacts", "chatter", "peak_mode"):
        np.testing.assert_array_equal(getattr(found, field), getattr(named, field), err_msg=field)
    # the change of the peak by a relative change of 1e-9 of the amplitude amplifies roundings alike
    moved = rocking.peak_response(name, **groups | {"slenderness": groups["slenderness"] * (1.0 + 1e-9)})
    amplification = 1.0 + np.abs(moved.peak_rotation / named.peak_rotation - 1.0) / 1e-9
    error = np.abs(found.peak_rotation / named.peak_rotation - 1.0) / amplification
    assert np.nanmax(error) < 1e-13
    assert np.nanmedian(error) < 1e-15
    mirrored = rocking.peak_response(own.mirrored(), **groups)
    np.testing.assert_array_equal(mirrored.peak_rotation, found.peak_rotation)


def exact_chirp() -> ExactPulse:
    """The pulse `CHIRP` at the working precision, scaled to its largest value."""

    def series(phi: arb, rate: arb, n: int, scale: arb | None = None) -> list[arb]:
        ctx.cap = n
        at = arb_series([phi, rate][:n], n)
        found = (at * -arb(CHIRP.decay)).exp() * (at + at * at * arb(CHIRP.growth)).sin()
        if scale is not None:
            found = found / scale
        return (found.coeffs() + [arb(0)] * n)[:n]

    def slope(phi: arb) -> tuple[arb, arb]:
        _, first, half_second = series(phi, arb(1), 3)
        return first, 2 * half_second

    stationary = tuple(_newton(slope, arb(phi)) for phi in CHIRP.stationary)
    scale = series(stationary[0], arb(0), 1)[0]
    return ExactPulse(
        arb(CHIRP.start), arb(CHIRP.end), stationary, 3.6, lambda phi, rate, n: series(phi, rate, n, scale)
    )


@pytest.mark.parametrize("alpha", [None, 0.3])
def test_the_chirp_against_the_multi_precision_integrator(alpha, monkeypatch):
    monkeypatch.setattr(reference.multiprecision, "exact_pulse", lambda *_: exact_chirp())
    rng = np.random.default_rng(7)
    for _ in range(number(3, 6)):
        groups = {
            "slenderness": float(rng.uniform(0.1, 0.9)),
            "frequency_ratio": float(rng.uniform(1.0, 6.0)),
            "restitution": float(rng.uniform(0.5, 0.9)),
        }
        exact, conditioning = integrate_with_conditioning("chirp", **groups, alpha=alpha)
        found = rocking.peak_response(CHIRP, **groups, alpha=alpha)
        assert bool(found.overturned) == exact.overturned
        with working_precision(192):
            for name in ("peak_rotation", "uplift_time", "first_impact_time"):
                true = getattr(exact, name)
                if true is not None:
                    allowed = 1e-13 + 20.0 * getattr(conditioning, name)
                    assert float(getattr(found, name)) == pytest.approx(float(true), rel=allowed), (groups, name)


def test_margin_without_impact_is_that_of_the_named_pulse():
    for omega in (0.5, 3.0):
        own, named = margin_without_impact(SINE, 3.0, omega), margin_without_impact("sine", 3.0, omega)
        assert own == pytest.approx(named, rel=1e-13)
