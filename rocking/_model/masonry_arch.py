"""Circular masonry arches of rigid voussoirs: the mechanism of least uplift acceleration, and its impact.

The arch opens at four joints, alternately at its inner and outer face, and becomes a four-bar linkage (Oppenheim 1992).
Of all such mechanisms the one with the least uplift acceleration forms (kinematic theorem). When it has closed, its
mirror image opens.
"""

import cmath
import itertools
import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from rocking._base.errors import InvalidArgumentError, integer, number, positive
from rocking._base.units import Scalar
from rocking._model.linkage import FourBarLinkage, LinearEquation, Link, VelocityField, restitution_of_impact

MOST_VOUSSOIRS = 24  # largest number of voussoirs: the number of mechanisms grows with its fourth power
RADII = 1e-3, 1e6  # smallest and largest radius [m]
THINNEST = 1e-6  # smallest thickness over the radius [-]; such an arch does not stand


class Mechanism(NamedTuple):
    """A mechanism of an arch."""

    joints: tuple[int, int, int, int]  # joints that open, from 0 at the left springing
    linkage: FourBarLinkage  # the linkage
    equation: LinearEquation  # its equation of motion

    @property
    def uplift_acceleration(self) -> float:
        """Smallest horizontal ground acceleration that opens it [m/s2]."""
        return self.equation.restoring / abs(self.equation.load)


@dataclass(frozen=True, init=False)
class MasonryArch:
    """A circular arch of equal voussoirs without tension or sliding in the joints.

    `radius` of the centre line and `thickness` [m], `embrace`: angle between the springings [rad], (0, pi]; in `RADII`
    and from `THINNEST` to below 2 radii, 4 to `MOST_VOUSSOIRS` voussoirs.
    """

    radius: float
    thickness: float
    embrace: float
    voussoirs: int
    gravity: float

    def __init__(self, radius: Scalar, thickness: Scalar, embrace: Scalar, voussoirs: int, gravity: Scalar) -> None:
        of_centre_line = number("radius", radius, *RADII, unit="m")
        thinnest, thickest = THINNEST * of_centre_line, 2.0 * of_centre_line
        checked = {
            "radius": of_centre_line,
            "thickness": number("thickness", thickness, thinnest, thickest, closed="left", unit="m"),
            "embrace": number("embrace", embrace, 0.0, math.pi, closed="right", unit="rad"),
            "voussoirs": integer("voussoirs", voussoirs, 4, MOST_VOUSSOIRS),
            "gravity": positive("gravity", gravity, "m/s2"),
        }
        for name, value in checked.items():
            vars(self)[name] = value  # a frozen dataclass

    def angle(self, joint: float) -> float:
        """Direction from the centre of the circle to a joint, or between two [rad]."""
        return 0.5 * (math.pi + self.embrace) - joint * self.embrace / self.voussoirs

    @cached_property
    def bodies(self) -> list[Link]:
        """The voussoirs from left to right, sectors of a ring of unit density and width."""
        inner, outer = self.radius - 0.5 * self.thickness, self.radius + 0.5 * self.thickness
        opening = self.embrace / self.voussoirs
        mass = 0.5 * (outer**2 - inner**2) * opening
        distance = 2.0 / 3.0 * (outer**3 - inner**3) / (outer**2 - inner**2) * math.sin(0.5 * opening) / (0.5 * opening)
        inertia = 0.25 * (outer**4 - inner**4) * opening - mass * distance**2
        return [Link(mass, cmath.rect(distance, self.angle(n + 0.5)), inertia) for n in range(self.voussoirs)]

    def mechanism(self) -> Mechanism:
        """The mechanism that opens at the smallest ground acceleration in one direction; an error if none opens."""
        # No mechanism is missed: four hinges at alternating faces, in any four joints, starting at either face, are all
        # ways to move with one degree of freedom. If one of them opens under the weight alone, the arch does not stand.
        quadruples = itertools.combinations(range(self.voussoirs + 1), 4)
        found = [one for joints in quadruples for face in (-1, 1) if (one := self._opening(joints, face))]
        if not found:
            raise InvalidArgumentError("embrace", self.embrace, "an angle with which the arch opens at four joints")
        if any(one.equation.restoring <= 0.0 for one in found):
            raise InvalidArgumentError("thickness", self.thickness, "a thickness with which the arch stands by itself")
        return min(found, key=lambda one: one.uplift_acceleration)

    def restitution(self, mechanism: Mechanism) -> float:
        """Ratio of the rates after and before the impact between a mechanism and its mirror image [-]."""
        bodies = self.bodies
        opening = self._velocity_field(mechanism)
        closing = VelocityField(-opening.rotations, -opening.centres)
        # the image in a vertical line of the symmetric arch: order, rotations and horizontal velocities reversed
        mirrored = VelocityField(-opening.rotations[::-1], -opening.centres[::-1].conj())
        masses, inertias = np.array([[one.mass, one.inertia] for one in bodies]).T
        return restitution_of_impact(closing, mirrored, masses, inertias)

    @cached_property
    def _links(self) -> dict[tuple[int, int], Link]:
        """The voussoirs between two joints, as one body."""
        joints = range(self.voussoirs + 1)
        return {(i, j): Link.join(self.bodies[i:j]) for i, j in itertools.combinations(joints, 2)}

    def _opening(self, joints: tuple[int, int, int, int], face: int) -> Mechanism | None:
        """The mechanism that opens at these joints, with the first hinge at the inner (-1) or outer (1) face.

        None if bodies would overlap in some joint.
        """
        faces = np.array([face, -face, face, -face])
        hinges = tuple(
            cmath.rect(self.radius + 0.5 * side * self.thickness, self.angle(joint))
            for side, joint in zip(faces.tolist(), joints, strict=True)
        )
        links = tuple(self._links[pair] for pair in itertools.pairwise(joints))
        # the part to the right of a hinge at the inner face turns clockwise against the part to the left
        linkage = FourBarLinkage(hinges, links, face)  # type: ignore[arg-type]
        rotations, _ = linkage.rotations()
        # each joint has to open away from its hinge: the next part turns against the one before, with the sign of the
        # face; the ground beside the first and the last joint does not turn
        if not np.all(np.diff(rotations, prepend=0.0, append=0.0) * faces > 0.0):
            return None
        return Mechanism(joints, linkage, linkage.linear_equation(self.gravity))

    def _velocity_field(self, mechanism: Mechanism) -> VelocityField:
        """The motion of the voussoirs as the mechanism opens."""
        rotations, centres = np.zeros(self.voussoirs), np.zeros(self.voussoirs, dtype=np.complex128)
        field, links = mechanism.linkage.velocity_field(), mechanism.linkage.links
        own = np.array([one.centre for one in self.bodies])
        for k, (i, j) in enumerate(itertools.pairwise(mechanism.joints)):
            rotations[i:j] = field.rotations[k]
            centres[i:j] = field.centres[k] + 1j * field.rotations[k] * (own[i:j] - links[k].centre)
        return VelocityField(rotations, centres)
