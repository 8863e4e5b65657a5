"""The block: geometry and parameters, (2.1), (2.2), (2.4)."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking._base.constants import STANDARD_GRAVITY
from rocking._dimensional.block import Block

lengths = st.floats(1e-3, 1e3)


@given(b=lengths, h=lengths)
def test_geometry(b, h):
    block = Block(width=2 * b, height=2 * h)
    R = math.hypot(b, h)
    assert h * math.sin(block.alpha) == pytest.approx(
        b * math.cos(block.alpha), rel=1e-12, abs=1e-13 * R
    )  # below (2.1)
    assert block.half_diagonal * math.sin(block.alpha) == pytest.approx(b, rel=1e-12)
    assert block.half_diagonal * math.cos(block.alpha) == pytest.approx(h, rel=1e-12)
    assert block.uplift_acceleration == pytest.approx(STANDARD_GRAVITY * b / h, rel=1e-12)


@given(b=lengths, h=lengths)
def test_frequency_parameter_is_that_of_a_rectangle_about_its_corner(b, h):
    block = Block(width=2 * b, height=2 * h)
    inertia = 4 / 3 * block.half_diagonal**2  # I_0/m of a uniform rectangle about a corner
    assert block.frequency_parameter**2 == pytest.approx(block.gravity * block.half_diagonal / inertia, rel=1e-12)


@given(alpha=st.floats(0.01, 1.5), R=lengths)
def test_angle_and_diagonal_round_trip(alpha, R):
    block = Block.from_slenderness_angle(alpha, R)
    assert block.alpha == pytest.approx(alpha, rel=1e-12)
    assert block.half_diagonal == pytest.approx(R, rel=1e-12)


@given(b=lengths, h=lengths)
def test_housner_restitution_conserves_angular_momentum(b, h):
    block = Block(width=2 * b, height=2 * h)
    R = block.half_diagonal
    # before impact the centre moves perpendicular to one diagonal; its moment about the other corner plus the spin
    centre = R * R * math.cos(2 * block.alpha) + R * R / 3
    assert block.momentum_restitution == pytest.approx(centre / (4 / 3 * R * R), rel=1e-12, abs=1e-12)  # (2.4)


@given(alpha=st.floats(0.05, 1.5))
def test_inelastic_restitution_has_no_tensile_impulse(alpha):
    """(2.4) requires the old corner to rise; otherwise the ground exerts impulses at both corners."""
    block = Block.from_slenderness_angle(alpha, 1.0)
    b, h = block.half_width, block.half_height
    # turning with unit rate about the corner (b, 0) towards the corner (-b, 0), its centre (0, h) goes (-h, -b);
    # stopping it requires vertical impulses at both corners (over the mass) with the sum b and the moment:
    old, new = np.linalg.solve([[1, 1], [b, -b]], [b, -(h * h + 1 / 3)])
    assert new > 0
    if abs(block.momentum_restitution) > 1e-9:
        assert (old > 0) == (block.momentum_restitution < 0)
    assert block.inelastic_restitution == (0.0 if old > 0 else pytest.approx(block.momentum_restitution, abs=1e-9))
