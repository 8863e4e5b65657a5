"""The rigid rectangular block: parameters of the equation of motion from its geometry (section 2 of the paper)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from rocking.constants import STANDARD_GRAVITY
from rocking.errors import in_range


@dataclass(frozen=True)
class Block:
    """A free-standing rigid rectangular block of uniform density (figure 1).

    Parameters
    ----------
    half_width : float
        b [m], > 0; the base is 2b wide.
    half_height : float
        h [m], > 0; the block is 2h high.
    gravity : float
        g [m/s2], > 0.

    Raises
    ------
    InvalidArgumentError
        If a length or gravity is not finite and positive.
    """

    half_width: float
    half_height: float
    gravity: float = STANDARD_GRAVITY

    def __post_init__(self) -> None:
        in_range("half_width", self.half_width, 0.0, math.inf, closed="neither", unit="m")
        in_range("half_height", self.half_height, 0.0, math.inf, closed="neither", unit="m")
        in_range("gravity", self.gravity, 0.0, math.inf, closed="neither", unit="m/s2")

    @classmethod
    def from_slenderness_angle(cls, alpha: float, half_diagonal: float, gravity: float = STANDARD_GRAVITY) -> Block:
        """Build a block from alpha [rad], (0, pi/2), and R [m], > 0."""
        in_range("alpha", alpha, 0.0, math.pi / 2, closed="neither", unit="rad")
        in_range("half_diagonal", half_diagonal, 0.0, math.inf, closed="neither", unit="m")
        return cls(half_diagonal * math.sin(alpha), half_diagonal * math.cos(alpha), gravity)

    @property
    def half_diagonal(self) -> float:
        """R = sqrt(b^2 + h^2) [m] (figure 1)."""
        return math.hypot(self.half_width, self.half_height)

    @property
    def alpha(self) -> float:
        """Slenderness angle alpha [rad], (0, pi/2): tan(alpha) = b/h, below (2.1)."""
        return math.atan2(self.half_width, self.half_height)

    @property
    def equation_alpha(self) -> float:
        """Alpha in the equation of motion [rad]: that of the block; (2.2) tends to (3.1) as it goes to 0."""
        return self.alpha

    @property
    def description(self) -> str:
        """The block in words."""
        return f"block of {2 * self.half_width:.4g} m x {2 * self.half_height:.4g} m"

    @property
    def contact_is_known(self) -> bool:
        """Whether the contact forces follow from the motion."""
        return True

    @property
    def frequency_parameter(self) -> float:
        """p = sqrt(3 g/(4 R)) [rad/s], below (2.2)."""
        return math.sqrt(0.75 * self.gravity / self.half_diagonal)

    @property
    def uplift_acceleration(self) -> float:
        """Smallest ground acceleration that starts rocking, g tan(alpha) [m/s2], below (2.1)."""
        return self.gravity * self.half_width / self.half_height

    @property
    def housner_restitution(self) -> float:
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
        return max(self.housner_restitution, 0.0)  # departs from (2.4) where that is negative

    @property
    def top_height(self) -> float:
        """Height of a top corner above the pivot below it [m], 2 h."""
        return 2.0 * self.half_height

    def top_displacement(self, rotation: float) -> float:
        """Horizontal displacement of a top corner [m] at a rotation [rad]: 2 h sin(theta), above the pivot."""
        return self.top_height * math.sin(rotation) if math.isfinite(rotation) else math.nan
