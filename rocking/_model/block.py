"""The rigid rectangular block: a body with equal edges, and its equation of motion (section 2 of the paper)."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import Self

import numpy as np

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError, number, positive
from rocking._base.units import Scalar
from rocking._model.body import AbstractBody, Edge
from rocking._model.reactions import INERTIA_RATIO


@dataclass(frozen=True, init=False)
class AbstractBlock(AbstractBody):
    """What rocks like a rectangular block; its properties are those of the rectangle unless a subclass has others.

    Parameters
    ----------
    width : float
        2b of the rectangular block of this alpha and p [m], > 0.
    height : float
        2h of the same [m], > 0.
    gravity : float
        g [m/s2], > 0.

    Raises
    ------
    InvalidArgumentError
        If a length or gravity is not finite and positive.
    """

    width: float
    height: float
    gravity: float = STANDARD_GRAVITY

    def __init__(self, width: Scalar, height: Scalar, gravity: Scalar = STANDARD_GRAVITY) -> None:
        for name, value in (("width", width), ("height", height)):
            if getattr(value, "shape", ()) or isinstance(value, list | tuple):
                raise InvalidArgumentError(name, value, "one number in (0, inf) [m]; RigidBody.from_size takes arrays")
        object.__setattr__(self, "width", positive("width", width, "m"))  # a frozen dataclass
        object.__setattr__(self, "height", positive("height", height, "m"))
        object.__setattr__(self, "gravity", positive("gravity", gravity, "m/s2"))

    @property
    @abstractmethod
    def contact_is_known(self) -> bool:
        """Whether the contact forces follow from the motion."""

    @property
    def half_width(self) -> float:
        """b [m] (figure 1)."""
        return 0.5 * self.width

    @property
    def half_height(self) -> float:
        """h [m] (figure 1)."""
        return 0.5 * self.height

    @property
    def half_diagonal(self) -> float:
        """R = sqrt(b^2 + h^2) [m] (figure 1)."""
        return math.hypot(self.half_width, self.half_height)

    @property
    def alpha(self) -> float:
        """Rotation at which the restoring moment vanishes [rad], (0, pi/2): tan(alpha) = b/h, below (2.1)."""
        return math.atan2(self.half_width, self.half_height)

    @property
    def equation_alpha(self) -> float:
        """Alpha in the equation of motion (2.2) [rad]; 0 stands for the linear equation (3.1)."""
        return self.alpha

    @property
    def is_linear(self) -> bool:
        """Whether the equation of motion is the linear one (3.1)."""
        return self.equation_alpha == 0.0

    @property
    def frequency_parameter(self) -> float:
        """p = sqrt(3 g/(4 R)) [rad/s], below (2.2)."""
        return math.sqrt(0.75 * self.gravity / self.half_diagonal)

    @property
    def uplift_acceleration(self) -> float:  # type: ignore[override]  # a float is an array of shape ()
        """Smallest ground acceleration that starts rocking, g tan(alpha) [m/s2], below (2.1)."""
        return self.gravity * self.half_width / self.half_height

    @property
    def momentum_restitution(self) -> float:
        """Coefficient of restitution eta = 1 - (3/2) sin^2(alpha) [-], (2.4) (Housner 1963).

        Negative for alpha above 54.7 degrees, where `inelastic_restitution` applies.
        """
        sin_alpha = self.half_width / self.half_diagonal
        return 1.0 - 1.5 * sin_alpha * sin_alpha  # (2.4)

    @property
    def inelastic_restitution(self) -> float:
        """Coefficient of restitution of an impact without bouncing [-], [0, 1): the larger of (2.4) and 0.

        (2.4) assumes that the whole impulse acts at the new pivot and that the old pivot rises. Above
        alpha = 54.7 degrees it is negative: the old pivot would move into the ground. The ground then exerts an impulse
        there too, and with impulses at both corners the block stops.
        """
        return max(self.momentum_restitution, 0.0)  # departs from (2.4) where that is negative

    @property
    def right(self) -> Edge:
        """The right edge; the left one is alike."""
        inertia_ratio = INERTIA_RATIO if self.contact_is_known else math.nan
        values = self.alpha, self.frequency_parameter, self.momentum_restitution, inertia_ratio
        return Edge(*map(np.asarray, values))

    left = right

    @property
    def top_height(self) -> float:
        """Height of a top corner above the pivot below it [m], 2 h."""
        return 2.0 * self.half_height

    def top_displacement(self, rotation: float) -> float:
        """Horizontal displacement of the top [m] at a rotation [rad]: `top_height` sin(theta), above the pivot."""
        return self.top_height * math.sin(rotation) if math.isfinite(rotation) else math.nan


@dataclass(frozen=True, init=False)
class RectangularBlock(AbstractBlock):
    """A free-standing rigid rectangular block of uniform density (figure 1): `rocking.Block` without its responses."""

    @classmethod
    def from_slenderness_angle(cls, alpha: Scalar, half_diagonal: Scalar, gravity: Scalar = STANDARD_GRAVITY) -> Self:
        """Build a block from alpha [rad], (0, pi/2), and R [m], > 0."""
        angle = number("alpha", alpha, 0.0, math.pi / 2, closed="neither", unit="rad")
        radius = positive("half_diagonal", half_diagonal, "m")
        return cls(2.0 * radius * math.sin(angle), 2.0 * radius * math.cos(angle), gravity)

    @property
    def description(self) -> str:
        return f"block of {self.width:.4g} m x {self.height:.4g} m"

    @property
    def contact_is_known(self) -> bool:
        return True
