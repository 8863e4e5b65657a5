"""Four-bar linkages under gravity and ground acceleration: the mechanism of a masonry arch (Oppenheim 1992).

Three rigid links are joined by hinges at the points A, B, C, D, of which A and D move with the ground. With the
rotation theta of the first link from its closed position, the Lagrange equation linearised about theta = 0 is

    M theta'' - K theta + C = -B a,  theta > 0,

where a is the horizontal ground acceleration; terms in theta'^2 are of second order (DeJong & Dimitrakopoulos 2014).
Points are complex numbers x + i y.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from rocking._base.errors import InvalidArgumentError


@dataclass(frozen=True)
class Link:
    """A rigid body."""

    mass: float  # [kg], > 0
    centre: complex  # centre of mass [m]
    inertia: float  # mass moment of inertia about the centre [kg m2], > 0

    @classmethod
    def join(cls, parts: list[Link]) -> Self:
        """Several bodies that move as one."""
        mass = sum(part.mass for part in parts)
        centre = sum(part.mass * part.centre for part in parts) / mass
        inertia = sum(part.inertia + part.mass * abs(part.centre - centre) ** 2 for part in parts)
        return cls(mass, centre, inertia)


@dataclass(frozen=True)
class LinearEquation:
    """Coefficients of M theta'' - K theta + C = -B a for theta > 0."""

    mass: float  # M [kg m2], > 0
    stiffness: float  # K [N m], > 0: the restoring moment decreases with theta
    restoring: float  # C [N m], > 0: the restoring moment at theta = 0
    load: float  # B [kg m]; its sign is that of the acceleration which keeps the structure closed


@dataclass(frozen=True, eq=False)
class VelocityField:
    """A motion of several bodies for a unit rate of its coordinate."""

    rotations: NDArray[np.float64]  # (bodies,) counterclockwise [-]
    centres: NDArray[np.complex128]  # (bodies,) velocities of the centres of mass [m]


@dataclass(frozen=True)
class FourBarLinkage:
    """Three links and their hinges."""

    hinges: tuple[complex, complex, complex, complex]  # A, B, C, D [m]; A and D on the ground
    links: tuple[Link, Link, Link]  # between A and B, B and C, C and D
    # sense of the rotation theta of the first link that opens the mechanism, 1: counterclockwise, or -1
    direction: int = 1

    def rotations(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Counterclockwise rotations of the links: first and second derivatives with respect to theta [-].

        The links AB, BC and DC close a polygon: AB exp(i r1) + BC exp(i r2) - DC exp(i r3) is constant. Raises
        `InvalidArgumentError` if B, C and D lie on a line, where the first link cannot move.
        """
        a, b, c, d = self.hinges
        ab, bc, dc = b - a, c - b, c - d
        matrix = np.array([[bc.real, -dc.real], [bc.imag, -dc.imag]])
        if abs(np.linalg.det(matrix)) <= 1e-12 * abs(bc) * abs(dc):
            raise InvalidArgumentError("hinges", self.hinges, "B, C and D that do not lie on a line")

        def solve(value: complex) -> tuple[float, float]:
            second, third = np.linalg.solve(matrix, np.array([value.real, value.imag]))
            return float(second), float(third)

        phi, psi = solve(-ab * self.direction)
        # i times the second derivatives balances the centripetal terms
        phi2, psi2 = solve(-1j * (ab + bc * phi**2 - dc * psi**2))
        return np.array([float(self.direction), phi, psi]), np.array([0.0, phi2, psi2])

    def velocity_field(self) -> VelocityField:
        """The motion for theta' = 1."""
        rates, _ = self.rotations()
        a, b, _, d = self.hinges
        arms = np.array([link.centre for link in self.links]) - np.array([a, b, d])
        carried = np.array([0.0, 1j * rates[0] * (b - a), 0.0])  # the hinge B moves with the first link
        return VelocityField(rates, carried + 1j * rates * arms)

    def linear_equation(self, gravity: float) -> LinearEquation:
        """The linearised equation of motion; `gravity` in m/s2."""
        rates, accelerations = self.rotations()
        a, b, _, d = self.hinges
        masses = np.array([link.mass for link in self.links])
        inertias = np.array([link.inertia for link in self.links])
        arms = np.array([link.centre for link in self.links]) - np.array([a, b, d])
        first = self.velocity_field().centres
        # Centres move as r(theta) = r0 + first theta + second theta^2/2. Kinetic energy M theta'^2/2 gives M; potential
        # energy g sum(m y) gives C from `first` and -K from `second`; the force -m a of the moving ground does the
        # work -B a theta. A point at an arm from a hinge has the second derivative -rate^2 arm + i acceleration arm.
        carried = np.array([0.0, a - b, 0.0])  # of the hinge B, which the second link starts from; rates[0]**2 = 1
        second = carried - rates**2 * arms + 1j * accelerations * arms
        return LinearEquation(
            mass=float(np.sum(masses * np.abs(first) ** 2 + inertias * rates**2)),
            stiffness=float(-gravity * np.sum(masses * second.imag)),
            restoring=float(gravity * np.sum(masses * first.imag)),
            load=float(np.sum(masses * first.real)),
        )


def restitution_of_impact(
    before: VelocityField, after: VelocityField, masses: NDArray[np.float64], inertias: NDArray[np.float64]
) -> float:
    """Ratio of the rates after and before an impact without bouncing [-], from motions for unit rates.

    The impulses act at the contact points of the motion after the impact, on which they do no work: the change of the
    momentum is orthogonal to that motion. For a block on the ground this is (2.4). `masses` [kg] and `inertias` about
    the centres [kg m2], (bodies,).
    """

    def product(one: VelocityField, other: VelocityField) -> float:
        work = masses * (one.centres * other.centres.conj()).real + inertias * one.rotations * other.rotations
        return float(np.sum(work))

    return product(before, after) / product(after, after)
