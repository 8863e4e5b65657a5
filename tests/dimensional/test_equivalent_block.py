"""Equivalent blocks: the same motion as the structure, by its own Lagrange equation, and accepted like a block."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking._model.linkage import VelocityField, restitution_of_impact

COLUMN = rocking.Block(width=0.6, height=4.0)
ARCH = {"radius": 10.0, "thickness": 1.5, "embrace": math.radians(157.5), "voussoirs": 7}


def frame_of(mass_ratio):
    return rocking.EquivalentBlock.rocking_frame(COLUMN, mass_ratio=mass_ratio)


def test_a_rectangular_body_is_the_block():
    b, h, mass = 0.3, 2.0, 700.0
    given = {"mass": mass, "inertia": mass * (b * b + h * h) / 3.0, "centre_height": h}
    body = rocking.EquivalentBlock.rigid_body(base=2 * b, **given)
    assert body.alpha == COLUMN.alpha
    for name in ("frequency_parameter", "momentum_restitution", "uplift_acceleration"):
        assert getattr(body, name) == pytest.approx(getattr(COLUMN, name), rel=1e-14)
    ground = {"peak_acceleration": 2.5, "period": 0.5}
    same, found = COLUMN.response("sine", **ground), body.response("sine", **ground)
    assert (found.outcome, found.impacts) == (same.outcome, same.impacts)
    assert (found.rotation, found.displacement) == pytest.approx((same.rotation, same.displacement), rel=1e-11)
    crushed = rocking.EquivalentBlock.rigid_body(base=1.8 * b, **given)
    assert crushed.uplift_acceleration == pytest.approx(0.9 * body.uplift_acceleration, rel=1e-12)


def frame_by_lagrange(mass_ratio, peak, period, times):
    """Rotation of a frame of three columns until its first impact, from positions of the bodies by differences.

    A half-period of a sine starts the motion; no equation of the library is used.
    """
    g, b, h, count = COLUMN.gravity, COLUMN.half_width, COLUMN.half_height, 3
    mass, step = 1.0, 1e-4
    inertia = mass * (b * b + h * h) / 3.0

    def positions(theta):  # of a column and the beam; the corner at the origin is the pivot
        turn = np.exp(-1j * theta)
        return complex(-b, h) * turn, complex(-2 * b, 2 * h) * turn

    masses = (count * mass, mass_ratio * count * mass)

    def acceleration(theta, ground):
        before, here, after = (positions(theta + k * step) for k in (-1, 0, 1))
        first = [(late - early) / (2 * step) for early, late in zip(before, after, strict=True)]
        generalised = sum(m * abs(v) ** 2 for m, v in zip(masses, first, strict=True)) + count * inertia
        force = -sum(m * (g * v.imag + ground * v.real) for m, v in zip(masses, first, strict=True))
        assert all(abs(abs(z) - abs(w)) < 1e-12 for z, w in zip(before, here, strict=True))  # circles: M is constant
        return force / generalised

    def motion(time, state):
        ground = -peak * math.sin(2 * math.pi * time / period) if time < period else 0.0
        push = acceleration(state[0], ground)
        return [state[1], push if state[0] > 0.0 or push > 0.0 else 0.0]

    uplift = math.asin(g * b / h / peak) / (2 * math.pi) * period
    found = solve_ivp(motion, (uplift, times[-1]), [0.0, 0.0], t_eval=times, rtol=1e-10, atol=1e-12, max_step=1e-2)
    return found.y[0]


@pytest.mark.parametrize("mass_ratio", [0.0, 1.5])
def test_a_frame_moves_as_its_own_lagrange_equation_says(mass_ratio):
    frame, peak, period = frame_of(mass_ratio), 2.6, 0.8
    found = frame.history("-sine", peak_acceleration=peak, period=period, duration=0.6)
    times = np.linspace(0.25, 0.55, 20)
    expected = frame_by_lagrange(mass_ratio, peak, period, times)
    assert expected.min() > 1e-4  # before the first impact
    rotation = np.interp(times, found["time"], np.abs(found["rotation"]))
    assert np.abs(rotation - expected).max() < 2e-4 * expected.max()  # of the interpolation
    assert frame.top_height == 2 * COLUMN.half_height


@pytest.mark.parametrize("mass_ratio", [0.0, 0.4, 3.0])
def test_restitution_of_a_frame_by_conservation_of_momentum(mass_ratio):
    b, h = COLUMN.half_width, COLUMN.half_height
    masses = np.array([1.0, 1.0, 2.0 * mass_ratio])
    inertias = np.array([1.0, 1.0, 0.0]) * (b * b + h * h) / 3.0
    before, after = (
        VelocityField(np.array([1.0, 1.0, 0.0]), 1j * np.array([complex(x, h), complex(x, h), complex(2 * x, 2 * h)]))
        for x in (-b, b)
    )
    assert frame_of(mass_ratio).momentum_restitution == pytest.approx(
        restitution_of_impact(before, after, masses, inertias), rel=1e-13
    )


def test_a_linear_mechanism_is_a_slender_block():
    wanted = rocking.peak_response("cosine", slenderness=0.4, frequency_ratio=9.0, restitution=0.9)
    mass, p, alpha, uplift = 5.0, 2.5, 0.2, 1.7
    block = rocking.EquivalentBlock.linear_mechanism(
        mass=mass, stiffness=mass * p**2, restoring=mass * p**2 * alpha, load=mass * p**2 * alpha / uplift,
        restitution=0.9, top_height=3.0,
    )  # fmt: skip
    found = block.response("cosine", peak_acceleration=uplift / 0.4, period=2 * math.pi / (9.0 * p))
    assert found.peak_rotation == pytest.approx(float(wanted.peak_rotation), rel=1e-12)
    assert found.rotation == pytest.approx(alpha * float(wanted.peak_rotation), rel=1e-12)
    assert found.displacement == pytest.approx(3.0 * math.sin(found.rotation), rel=1e-14)


def test_an_arch_opens_above_its_uplift_acceleration_only():
    arch = rocking.EquivalentBlock.masonry_arch(**ARCH)
    assert arch.uplift_acceleration / arch.gravity == pytest.approx(0.37, abs=0.005)  # Oppenheim (1992)
    below, above = (
        arch.response("half_sine", peak_acceleration=factor * arch.uplift_acceleration, period=0.3)
        for factor in (1 - 1e-9, 1.1)
    )
    assert below.outcome == rocking.Outcome.NO_UPLIFT
    assert above.outcome == rocking.Outcome.RECOVERS
    assert rocking.EquivalentBlock.masonry_arch(**ARCH, restitution=0.8).momentum_restitution == 0.8


def test_contact_is_said_to_be_unknown():
    found = frame_of(1.0).response("sine", peak_acceleration=4.0, period=0.5)
    assert found.rocking_model_applies
    assert any("contact forces" in text for text in found.warnings)
    assert found.largest_surviving_acceleration is not None
    assert found.largest_surviving_friction_demand is None
    assert "structure of alpha" in repr(found)


@pytest.mark.parametrize(
    ("make", "given", "said"),
    [
        ("rocking_frame", {"column": rocking.Block(width=4.0, height=2.0), "mass_ratio": 1.0}, "column"),
        ("rigid_body", {"mass": 1.0, "inertia": 0.1, "base": 4.0, "centre_height": 0.5}, "base"),
        ("rigid_body", {"mass": "0.3 t", "inertia": "20 kg m2", "base": 0.4, "centre_height": 0.8},
         r"`inertia` = '20 kg m2'.*a number in \[kg m2\]"),
        ("linear_mechanism", {"stiffness": -1.0, "restoring": 1.0}, "stiffness"),
        ("linear_mechanism", {"stiffness": 1.0, "restoring": 2.0}, r"`restoring` = 2\.0"),  # C/K is an angle
    ],
)  # fmt: skip
def test_structures_that_would_bounce_are_refused(make, given, said):
    if make == "linear_mechanism":
        given |= {"mass": 1.0, "load": 1.0, "restitution": 0.9, "top_height": 1.0}
    with pytest.raises(InvalidArgumentError, match=said):
        getattr(rocking.EquivalentBlock, make)(**given)
