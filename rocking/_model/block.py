"""The rigid rectangular block: a body with equal edges, and its equation of motion (section 2 of the paper)."""

import math
from abc import abstractmethod
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, Self

import numpy as np

from rocking._base.arrays import Array
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.equality import equal_values
from rocking._base.errors import float_array, number, positive
from rocking._base.quantities import GRAVITY, HEIGHT, WIDTH
from rocking._base.units import Scalar, Values
from rocking._model.body import AbstractBody, Edge
from rocking._model.checks import check_quantities
from rocking._model.reactions import INERTIA_RATIO

Number = Any  # a float; of an array of blocks an array of them


@dataclass(frozen=True, init=False, eq=False)
class AbstractBlock(AbstractBody):
    """What rocks like a rectangular block; a subclass overrides properties in which it differs from the rectangle.

    `width`, `height`: 2b and 2h of the rectangular block of this alpha and p [m]. All arguments may be arrays, which
    broadcast: the properties of an array of blocks are arrays.
    """

    width: Number
    height: Number
    gravity: Number = STANDARD_GRAVITY

    def __init__(self, width: Values, height: Values, gravity: Values = STANDARD_GRAVITY) -> None:
        values, labels, index = check_quantities({WIDTH: width, HEIGHT: height, GRAVITY: gravity})
        one = not any(value.ndim for value in values.values())
        vars(self).update({name: float(value) if one else value for name, value in values.items()})  # it is frozen
        if labels or index:
            vars(self).update(labels=labels, index=index)

    def __eq__(self, other: object) -> bool:
        return equal_values(self._values, other._values) if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        return hash(tuple(np.asarray(value).tobytes() for value in self._values))

    @property
    def _values(self) -> tuple[Any, ...]:
        return tuple(getattr(self, one.name) for one in fields(self))

    @property
    @abstractmethod
    def contact_is_known(self) -> bool:
        """Whether the contact forces follow from the motion."""

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """Shape of an array of blocks, () for one."""
        return np.broadcast_shapes(*map(np.shape, self._values))

    moves_as_block = True

    @property
    def parameters(self) -> dict[str, Array]:
        """Sizes and gravity."""
        return {name: np.asarray(getattr(self, name)) for name in ("width", "height", "gravity")}

    @property
    def half_width(self) -> Number:
        """b [m] (figure 1)."""
        return 0.5 * self.width

    @property
    def half_height(self) -> Number:
        """h [m] (figure 1)."""
        return 0.5 * self.height

    @cached_property
    def half_diagonal(self) -> Number:
        """R = sqrt(b^2 + h^2) [m] (figure 1)."""
        return (np.hypot if self.shape else math.hypot)(self.half_width, self.half_height)

    @cached_property
    def alpha(self) -> Number:
        """Rotation at which the restoring moment vanishes [rad], (0, pi/2): tan(alpha) = b/h, below (2.1)."""
        return (np.arctan2 if self.shape else math.atan2)(self.half_width, self.half_height)

    @cached_property
    def equation_alpha(self) -> Number:
        """Alpha in the equation of motion (2.2) [rad]; 0 stands for the linear equation (3.1)."""
        return self.alpha

    @property
    def is_linear(self) -> bool:
        """Whether the equation of motion is the linear one (3.1)."""
        return not np.any(self.equation_alpha)

    @cached_property
    def frequency_parameter(self) -> Number:
        """p = sqrt(3 g/(4 R)) [rad/s], below (2.2)."""
        return (np.sqrt if self.shape else math.sqrt)(0.75 * self.gravity / self.half_diagonal)

    @cached_property
    def uplift_acceleration(self) -> Number:
        """Smallest ground acceleration that starts rocking, g tan(alpha) [m/s2], below (2.1)."""
        return self.gravity * self.half_width / self.half_height

    @property
    def uplift_accelerations(self) -> tuple[Array, Array]:
        """Those of both edges, which are alike."""
        uplift = np.asarray(self.uplift_acceleration)
        return uplift, uplift

    @cached_property
    def momentum_restitution(self) -> Number:
        """Coefficient of restitution eta = 1 - (3/2) sin^2(alpha) [-], (2.4) (Housner 1963).

        Negative for alpha above 54.7 degrees, where `inelastic_restitution` applies.
        """
        sin_alpha = self.half_width / self.half_diagonal
        return 1.0 - 1.5 * sin_alpha * sin_alpha  # (2.4)

    @cached_property
    def inelastic_restitution(self) -> Number:
        """Coefficient of restitution of an impact without bouncing [-], [0, 1): the larger of (2.4) and 0.

        (2.4) assumes that the whole impulse acts at the new pivot and that the old pivot rises. Above
        alpha = 54.7 degrees it is negative: the old pivot would move into the ground. The ground then exerts an impulse
        there too, and with impulses at both corners the block stops.
        """
        return (np.maximum if self.shape else max)(self.momentum_restitution, 0.0)  # departs from (2.4)

    @cached_property
    def right(self) -> Edge:
        """The right edge; the left one is alike."""
        inertia_ratio = INERTIA_RATIO if self.contact_is_known else math.nan
        alpha, p, eta, ratio = map(
            np.asarray, (self.alpha, self.frequency_parameter, self.momentum_restitution, inertia_ratio)
        )
        return Edge(alpha, p, eta, ratio)

    @property
    def left(self) -> Edge:
        """The left edge."""
        return self.right

    @property
    def top_height(self) -> Number:
        """Height of a top corner above the pivot below it [m], 2 h."""
        return 2.0 * self.half_height

    def displacement(self, rotation: Number) -> Number:
        """Horizontal displacement of the top [m] at a rotation [rad]: `top_height` sin(theta), above the pivot."""
        angle = float_array("rotation", rotation, unit="rad")
        if angle.ndim or self.shape:
            return super().displacement(angle)
        return self.top_height * math.sin(angle) if math.isfinite(angle) else math.nan


@dataclass(frozen=True, init=False, eq=False)
class RectangularBlock(AbstractBlock):
    """A free-standing rigid rectangular block of uniform density (figure 1): `rocking.Block` without its responses."""

    @classmethod
    def from_slenderness_angle(cls, alpha: Scalar, half_diagonal: Scalar, gravity: Scalar = STANDARD_GRAVITY) -> Self:
        """Build a block from alpha [rad], (0, pi/2), and R [m], > 0."""
        angle = number("alpha", alpha, 0.0, math.pi / 2, closed="neither", unit="rad")
        radius = positive("half_diagonal", half_diagonal, "m")
        g = positive("gravity", gravity, "m/s2")
        return cls(2.0 * radius * math.sin(angle), 2.0 * radius * math.cos(angle), g)

    @property
    def description(self) -> str:
        if self.shape:
            return f"{' x '.join(map(str, self.shape))} blocks"
        return f"block of {self.width:.4g} m x {self.height:.4g} m"

    @property
    def contact_is_known(self) -> bool:
        return True
