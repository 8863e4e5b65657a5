"""Structures that rock like a block (DeJong & Dimitrakopoulos 2014): frames, rigid bodies, linearised mechanisms.

A structure with one degree of freedom that is closed at theta = 0 and dissipates energy at impacts is described by the
frequency parameter p, the rotation alpha at which its restoring moment vanishes, its uplift acceleration and its
coefficient of restitution. Bodies and frames obey (2.2) exactly; for other mechanisms the equation is linearised about
theta = 0 and reads as (3.1), with p^2 = K/M, alpha = C/K and uplift acceleration C/B of

    M theta'' - K theta + C = -B a,  theta > 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self, final

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError, number, positive
from rocking._base.quantities import FREQUENCY_PARAMETER, RESTITUTION
from rocking._base.units import Scalar
from rocking._dimensional.body import RespondingBody
from rocking._model.block import AbstractBlock, RectangularBlock
from rocking._model.linkage import LinearEquation
from rocking._model.masonry_arch import MasonryArch


@final
@dataclass(frozen=True, init=False, eq=False, repr=False)
class EquivalentBlock(AbstractBlock, RespondingBody):
    """The block that rocks like a structure; every function that takes a `Block` takes it.

    `width` and `height` are those of the rectangular block of this alpha and p. Contact forces and friction
    demand are not known. The structure has to rock to both sides alike.

    Parameters
    ----------
    alpha : float
        Rotation at which the restoring moment vanishes [rad], (0, pi/2).
    frequency_parameter : float
        p [rad/s], [1e-6, 1e6].
    restitution : float
        eta [-], [0, 1].
    uplift_acceleration : float, optional
        Smallest ground acceleration that starts rocking [m/s2], > 0. If given, the equation of motion is linear as
        (3.1), else it is (2.2) with g tan(alpha).
    gravity : float
        g [m/s2], > 0.
    top_height : float, optional
        Height of the point whose displacement is given, above the pivot [m], > 0; by default that of the top of the
        rectangular block.
    """

    alpha: float = math.nan  # in place of the properties of the rectangle
    frequency_parameter: float = math.nan
    momentum_restitution: float = math.nan
    uplift_acceleration: float = math.nan  # type: ignore[assignment]  # as of AbstractBlock
    equation_alpha: float = math.nan
    top_height: float = math.nan

    def __init__(
        self,
        alpha: Scalar,
        frequency_parameter: Scalar,
        *,
        restitution: Scalar,
        uplift_acceleration: Scalar | None = None,
        gravity: Scalar = STANDARD_GRAVITY,
        top_height: Scalar | None = None,
    ) -> None:
        angle = number("alpha", alpha, 0.0, math.pi / 2, closed="neither", unit="rad")
        p = FREQUENCY_PARAMETER.number(frequency_parameter)
        g = positive("gravity", gravity, "m/s2")
        eta = RESTITUTION.number(restitution)
        size = 0.75 * g / p**2  # p = sqrt(3 g/(4 R)), below (2.2)
        super().__init__(2.0 * size * math.sin(angle), 2.0 * size * math.cos(angle), g)
        own = {
            "alpha": angle,
            "frequency_parameter": p,
            "momentum_restitution": eta,
            "uplift_acceleration": g * self.half_width / self.half_height,  # below (2.1)
            "equation_alpha": angle,
            "top_height": 2.0 * self.half_height if top_height is None else positive("top_height", top_height, "m"),
        }
        if uplift_acceleration is not None:
            uplift = positive("uplift_acceleration", uplift_acceleration, "m/s2")
            own |= {"uplift_acceleration": uplift, "equation_alpha": 0.0}
        vars(self).update(own)  # it is frozen

    @property
    def description(self) -> str:
        """The structure in words."""
        return f"structure of alpha {math.degrees(self.alpha):.4g} deg and p {self.frequency_parameter:.4g} rad/s"

    @property
    def contact_is_known(self) -> bool:
        """False: the forces at the pivots depend on more than the parameters of the motion."""
        return False

    def __repr__(self) -> str:
        own = f", uplift_acceleration={self.uplift_acceleration!r}" if self.is_linear else ""
        top = "" if self.top_height == 2.0 * self.half_height else f", top_height={self.top_height!r}"
        return (
            f"EquivalentBlock(alpha={self.alpha!r}, frequency_parameter={self.frequency_parameter!r}, "
            f"restitution={self.momentum_restitution!r}{own}, gravity={self.gravity!r}{top})"
        )

    @classmethod
    def rigid_body(
        cls,
        *,
        mass: Scalar,
        inertia: Scalar,
        base: Scalar,
        centre_height: Scalar,
        top_height: Scalar | None = None,
        gravity: Scalar = STANDARD_GRAVITY,
    ) -> Self:
        """A symmetric rigid body of any shape on two pivots; exact.

        Parameters
        ----------
        mass : float
            m [kg], > 0.
        inertia : float
            Mass moment of inertia about the centre of mass [kg m2], > 0.
        base : float
            Distance of the pivots [m], > 0; smaller than the width where the edges are rounded or crushed.
        centre_height : float
            Height of the centre of mass above the pivots [m], > 0.
        top_height, gravity
            As for `EquivalentBlock`; by default the displacement is that at twice the height of the centre.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range, or the body would bounce: a negative coefficient of restitution.
        """
        mass, inertia = positive("mass", mass, "kg"), positive("inertia", inertia, "kg m2")
        base, centre_height = positive("base", base, "m"), positive("centre_height", centre_height, "m")
        gravity = positive("gravity", gravity, "m/s2")
        radius = math.hypot(0.5 * base, centre_height)
        about_pivot = inertia + mass * radius * radius
        # angular momentum about the new pivot, as for (2.4)
        restitution = 1.0 - 0.5 * mass * base * base / about_pivot
        if restitution < 0.0:
            raise InvalidArgumentError("base", base, "a base so narrow that the body does not bounce at impacts")
        return cls(
            math.atan2(0.5 * base, centre_height),
            math.sqrt(mass * gravity * radius / about_pivot),
            restitution=restitution,
            gravity=gravity,
            top_height=2.0 * centre_height if top_height is None else top_height,
        )

    @classmethod
    def rocking_frame(cls, column: RectangularBlock, *, mass_ratio: Scalar) -> Self:
        """Equal columns that carry a rigid beam without mortar; exact (Makris & Vassiliou 2013).

        Parameters
        ----------
        column : Block
            One of the columns.
        mass_ratio : float
            Mass of the beam over that of all columns [-], >= 0.

        Raises
        ------
        InvalidArgumentError
            If `mass_ratio` is out of range, or the frame would bounce at impacts.
        """
        if getattr(column, "shape", None) != () or not isinstance(column, RectangularBlock):
            raise InvalidArgumentError("column", column, "a rocking.Block")
        mass_ratio = number("mass_ratio", mass_ratio, 0.0, math.inf, closed="left")
        alpha, inertia = column.alpha, 1.0 + 3.0 * mass_ratio
        # the beam moves as a point mass on the circle of radius 2 R of the tops of the columns
        restitution = (1.0 - 1.5 * math.sin(alpha) ** 2 + 3.0 * mass_ratio * math.cos(2.0 * alpha)) / inertia
        if restitution < 0.0:
            raise InvalidArgumentError("column", column, "columns so slender that the frame does not bounce at impacts")
        return cls(
            alpha,
            column.frequency_parameter * math.sqrt((1.0 + 2.0 * mass_ratio) / inertia),
            restitution=restitution,
            gravity=column.gravity,
            top_height=2.0 * column.half_height,
        )

    @classmethod
    def linear_mechanism(
        cls,
        *,
        mass: Scalar,
        stiffness: Scalar,
        restoring: Scalar,
        load: Scalar,
        restitution: Scalar,
        top_height: Scalar,
        gravity: Scalar = STANDARD_GRAVITY,
    ) -> Self:
        """Any mechanism by its linearised equation M theta'' - K theta + C = -B a.

        Parameters
        ----------
        mass, stiffness, restoring, load : float
            M [kg m2], K [N m], C [N m] and |B| [kg m], > 0.
        restitution, top_height, gravity
            As for `EquivalentBlock`; a top height is needed.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range, or C/K is not below pi/2.
        """
        mass, stiffness = positive("mass", mass, "kg m2"), positive("stiffness", stiffness, "N m")
        restoring, load = positive("restoring", restoring, "N m"), positive("load", load, "kg m")
        if not restoring < 0.5 * math.pi * stiffness:
            allowed = f"(0, {0.5 * math.pi * stiffness:.6g}) [N m], up to pi/2 times the stiffness"
            raise InvalidArgumentError("restoring", restoring, allowed)
        return cls(
            restoring / stiffness,
            math.sqrt(stiffness / mass),
            restitution=restitution,
            uplift_acceleration=restoring / load,
            gravity=gravity,
            top_height=top_height,
        )

    @classmethod
    def masonry_arch(
        cls,
        *,
        radius: Scalar,
        thickness: Scalar,
        embrace: Scalar,
        voussoirs: int,
        restitution: Scalar | None = None,
        gravity: Scalar = STANDARD_GRAVITY,
    ) -> Self:
        """A circular masonry arch, which opens as a four-bar linkage; linearised.

        The rotation is that of the part of the arch next to its first hinge, the displacement that of its other end.
        The hinges are those of the mechanism of least uplift acceleration.

        Parameters
        ----------
        radius, thickness : float
            Of the centre line, [1e-3, 1e6], and of the voussoirs, from 1e-6 to below 2 times the radius [m].
        embrace : float
            Angle between the springings [rad], (0, pi].
        voussoirs : int
            Their number, 4 to 24.
        restitution : float, optional
            eta [-], [0, 1]; by default that of an impact without bouncing between the mechanism and its mirror image.
        gravity
            As for `EquivalentBlock`.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range, or the arch does not stand under its weight.
        """
        arch = MasonryArch(radius, thickness, embrace, voussoirs, gravity)
        mechanism = arch.mechanism()
        equation: LinearEquation = mechanism.equation
        first, second, *_ = mechanism.linkage.hinges
        return cls.linear_mechanism(
            mass=equation.mass,
            stiffness=equation.stiffness,
            restoring=equation.restoring,
            load=abs(equation.load),
            restitution=arch.restitution(mechanism) if restitution is None else restitution,
            top_height=abs((second - first).imag),
            gravity=gravity,
        )
