"""Masonry arches: uplift by limit analysis, linearised equation by differences, impact by conservation of momentum."""

import cmath
import math

import numpy as np
import pytest
from scipy.optimize import linprog

from rocking._base.errors import InvalidArgumentError
from rocking._dimensional.block import Block
from rocking._model.linkage import FourBarLinkage, Link, VelocityField, restitution_of_impact
from rocking._model.masonry_arch import MasonryArch

OPPENHEIM = MasonryArch(radius=10.0, thickness=1.5, embrace=math.radians(157.5), voussoirs=7, gravity=9.81)


def static_multiplier(arch):
    """Largest horizontal acceleration [m/s2] for which forces in the joints, without tension, balance the weights.

    Unknowns are the force (x, y) and the moment about the middle of each joint, on the part to its left, and the
    acceleration (static theorem; no shared code with the kinematic one).
    """
    count = arch.voussoirs + 1
    middles = [cmath.rect(arch.radius, arch.angle(k)) for k in range(count)]
    outward = [middle / abs(middle) for middle in middles]
    equal, right = [], []
    for k, body in enumerate(arch.bodies):
        for component in range(3):  # x, y, moment about the origin
            row = np.zeros(3 * count + 1)
            for joint, sign in ((k, -1.0), (k + 1, 1.0)):
                x, y = middles[joint].real, middles[joint].imag
                columns = ([1, 0, 0], [0, 1, 0], [-y, x, 1])[component]
                row[3 * joint : 3 * joint + 3] = sign * np.array(columns, dtype=float)
            row[-1] = (body.mass, 0.0, -body.mass * body.centre.imag)[component]
            equal.append(row)
            right.append((0.0, body.mass * arch.gravity, body.mass * arch.gravity * body.centre.real)[component])
    bounds, limits = [], []
    for k in range(count):
        normal = np.zeros(3 * count + 1)
        clockwise = -1j * outward[k]  # the part on the right pushes the left one against this direction
        normal[3 * k : 3 * k + 2] = -clockwise.real, -clockwise.imag
        for sign in (-1.0, 1.0):
            row = -0.5 * arch.thickness * normal
            row[3 * k + 2] = sign
            bounds.append(row)
            limits.append(0.0)
    objective = np.zeros(3 * count + 1)
    objective[-1] = -1.0
    found = linprog(objective, bounds, limits, equal, right, bounds=(None, None))
    assert found.success
    return -found.fun


@pytest.mark.parametrize("thickness", [1.2, 1.5, 2.0])
@pytest.mark.parametrize("voussoirs", [7, 10])
def test_static_and_kinematic_theorem_agree(thickness, voussoirs):
    arch = MasonryArch(10.0, thickness, math.radians(157.5), voussoirs, 9.81)
    assert arch.mechanism().uplift_acceleration == pytest.approx(static_multiplier(arch), rel=1e-9)


def test_uplift_acceleration_of_the_arch_of_oppenheim():
    assert OPPENHEIM.mechanism().uplift_acceleration / 9.81 == pytest.approx(0.37, abs=0.005)  # Oppenheim (1992)


def centres_at(linkage, theta):
    """Centres and rotations of the links with the first one turned by `theta`, from the lengths of the links."""
    a, b, c, d = linkage.hinges
    turn = linkage.direction * theta
    moved = a + (b - a) * cmath.exp(1j * turn)
    along = (abs(c - b) ** 2 - abs(c - d) ** 2 + abs(d - moved) ** 2) / (2.0 * abs(d - moved))
    across = math.sqrt(abs(c - b) ** 2 - along**2)  # C is where two circles intersect
    direction = (d - moved) / abs(d - moved)
    nearest = min((moved + direction * complex(along, side * across) for side in (-1, 1)), key=lambda one: abs(one - c))
    rotations = np.array([turn, cmath.phase((nearest - moved) / (c - b)), cmath.phase((nearest - d) / (c - d))])
    arms = [link.centre - start for link, start in zip(linkage.links, (a, b, d), strict=True)]
    starts = np.array([a, moved, d])
    return starts + np.array(arms) * np.exp(1j * rotations), rotations


def test_linear_equation_against_differences_of_the_exact_positions():
    linkage, equation = OPPENHEIM.mechanism().linkage, OPPENHEIM.mechanism().equation
    masses = np.array([link.mass for link in linkage.links])
    inertias = np.array([link.inertia for link in linkage.links])
    step = 1e-4
    (plus, turned), (minus, back), (rest, _) = (centres_at(linkage, theta) for theta in (step, -step, 0.0))
    speed, spin = (plus - minus) / (2 * step), (turned - back) / (2 * step)
    curvature = (plus - 2 * rest + minus) / step**2
    assert equation.mass == pytest.approx(np.sum(masses * abs(speed) ** 2 + inertias * spin**2), rel=1e-4)
    assert equation.restoring == pytest.approx(9.81 * np.sum(masses * speed.imag), rel=1e-4)
    assert equation.load == pytest.approx(np.sum(masses * speed.real), rel=1e-4)
    assert equation.stiffness == pytest.approx(-9.81 * np.sum(masses * curvature.imag), rel=1e-4)


def test_restitution_of_a_block_on_the_ground():
    block = Block(0.8, 3.0)
    arm = complex(-0.4, 1.5)  # from the right corner to the centre; the block closes counterclockwise
    field = VelocityField(np.array([1.0]), np.array([1j * arm]))
    after = VelocityField(np.array([1.0]), np.array([1j * complex(0.4, 1.5)]))
    found = restitution_of_impact(field, after, np.array([1.0]), np.array([abs(arm) ** 2 / 3.0]))
    assert found == pytest.approx(block.momentum_restitution, rel=1e-14)  # (2.4)


def test_impact_of_an_arch_loses_energy_and_slender_joints_lose_less():
    ratios = [
        arch.restitution(arch.mechanism())
        for arch in (MasonryArch(10.0, t, math.radians(157.5), 7, 9.81) for t in (1.5, 1.35, 1.2))
    ]
    assert 0.0 < ratios[0] < ratios[1] < ratios[2] < 1.0


def test_an_arch_that_is_too_thin_is_refused():
    with pytest.raises(InvalidArgumentError, match="thickness"):
        MasonryArch(10.0, 0.6, math.pi, 20, 9.81).mechanism()


@pytest.mark.parametrize(
    ("name", "value"), [("radius", 0.0), ("thickness", 20.0), ("embrace", 3.2), ("voussoirs", 3), ("voussoirs", 7.5)]
)
def test_values_out_of_range_are_named(name, value):
    given = {"radius": 10.0, "thickness": 1.5, "embrace": 2.7, "voussoirs": 7, "gravity": 9.81, name: value}
    with pytest.raises(InvalidArgumentError, match=name):
        MasonryArch(**given)


def test_hinges_on_a_line_are_refused():
    link = Link(1.0, 0.5j, 1.0)
    with pytest.raises(InvalidArgumentError, match="hinges"):
        FourBarLinkage((-1 + 0j, 0j, 1 + 0j, 2 + 0j), (link, link, link)).rotations()
