"""Objects that are assessed, and the bodies that stand for them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking._base.errors import InvalidArgumentError, number, positive
from rocking._base.units import Scalar
from rocking._dimensional.rigid_body import RigidBody
from rocking._model.body import AbstractBody, Edge
from rocking._model.checks import check_number
from rocking._model.parameters import RESTITUTION

Array = NDArray[np.float64]

LENGTHS = 1e-4, 1e3
"""Smallest and largest dimension of an object [m]."""


@dataclass(frozen=True)
class Object:
    """A free-standing object on a rectangular or round base. Lengths in metres, or texts such as "40 cm".

    Parameters
    ----------
    name : str
        For output.
    width, depth : float
        Of the base [m], 0.1 mm to 1 km, as all lengths; without a depth only the direction of the width is assessed.
    height : float
        Of the object [m].
    diameter : float
        Of a round base, in place of the width [m]: the planar model, in which it does not wobble or roll.
    mass_height : float, optional
        Height of the centre of mass [m]; half the height by default.
    offset_width, offset_depth : float
        Distance of the centre of mass from the middle of the base [m], inside it.
    mass : float, optional
        Mass [kg], > 0; the outcome does not depend on it.
    friction : float, optional
        Coefficient of friction at the base [-], > 0.
    restitution : float or "momentum"
        eta of every impact [-], [0, 1], or from conservation of angular momentum.
    tolerance : float
        How far each dimension is uncertain [m], >= 0 and less than half of the smallest.
    pedestal, notes : str
        Repeated in reports.

    Raises
    ------
    InvalidArgumentError
        If a value is not as described.

    Notes
    -----
    The radius of gyration is that of a homogeneous box, or cylinder, of these dimensions.
    """

    name: str
    width: Scalar | None = None
    height: Scalar | None = None
    depth: Scalar | None = None
    diameter: Scalar | None = None
    mass_height: Scalar | None = None
    offset_width: Scalar = 0.0
    offset_depth: Scalar = 0.0
    mass: float | None = None
    friction: Scalar | None = None
    restitution: Scalar = "momentum"
    tolerance: Scalar = 0.0
    pedestal: str = ""
    notes: str = ""

    def __post_init__(self) -> None:
        if (self.width is None) == (self.diameter is None) or (self.diameter is not None and self.depth is not None):
            raise InvalidArgumentError("width", self.width, "a width, with or without a depth; or a diameter")
        for name in ("name", "pedestal", "notes"):
            if not isinstance(getattr(self, name), str):
                raise InvalidArgumentError(name, getattr(self, name), "a text")
        checked: dict[str, float] = {}
        for name in ("width", "height", "depth", "diameter", "mass_height"):
            value = getattr(self, name)
            if value is not None or name == "height":
                checked[name] = number(name, value, *LENGTHS, unit="m")
        for name, unit in (("mass", "kg"), ("friction", "-")):
            if getattr(self, name) is not None:
                checked[name] = positive(name, getattr(self, name), unit)
        if not (isinstance(self.restitution, str) and self.restitution == "momentum"):
            checked["restitution"] = check_number(RESTITUTION, self.restitution)
        sizes = [checked[name] for name in ("width", "height", "depth", "diameter") if name in checked]
        checked["tolerance"] = number("tolerance", self.tolerance, 0.0, 0.5 * min(sizes), closed="left", unit="m")
        for name, size in (("offset_width", "width"), ("offset_depth", "depth")):
            half = 0.5 * checked.get(size, checked.get("diameter", math.inf))
            checked[name] = number(name, getattr(self, name), -half, half, closed="neither", unit="m")
        for name, value in checked.items():
            object.__setattr__(self, name, value)  # a frozen dataclass

    @property
    def directions(self) -> dict[str, tuple[float, float]]:
        """Size of the base and offset of the centre of mass [m] of each direction in which it can rock."""
        given: dict[str, Any] = vars(self)
        if self.diameter is not None:
            return {"any": (given["diameter"], math.hypot(given["offset_width"], given["offset_depth"]))}
        names = ("width",) if self.depth is None else ("width", "depth")
        return {name: (given[name], given[f"offset_{name}"]) for name in names}


@dataclass(frozen=True, eq=False)
class Bodies:
    """One body for each object and direction; arrays (bodies,), SI units.

    Attributes
    ----------
    base, offset, height, mass_height : float array [m]
        Dimensions along the direction.
    round : bool array
        Whether the base is round.
    restitution : float array [-]
        Nan: from the angular momentum.
    """

    base: Array
    offset: Array
    height: Array
    mass_height: Array
    round: NDArray[np.bool_]
    restitution: Array

    @classmethod
    def of(cls, objects: Iterable[Object]) -> Bodies:
        """The bodies of some objects, those of one object in a row."""
        rows = [
            (
                *(base, offset, one.height, 0.5 * one.height if one.mass_height is None else one.mass_height),  # type: ignore[operator]
                *(one.diameter is not None, np.nan if one.restitution == "momentum" else one.restitution),
            )
            for one in objects
            for base, offset in one.directions.values()
        ]
        columns = np.array(rows, dtype=np.float64).reshape(-1, 6).T
        return cls(columns[0], columns[1], columns[2], columns[3], columns[4] > 0.0, columns[5])

    def take(self, rows: NDArray[np.intp]) -> Bodies:
        """Some of them."""
        return Bodies(**{name: column[rows] for name, column in vars(self).items()})

    def scaled(self, base: Array | float = 1.0, height: Array | float = 1.0, change: float = 0.0) -> BodyArray:
        """The bodies with base and height multiplied by factors (bodies,), and `change` added to the restitution."""
        b, h, centre = self.base * base, self.height * height, self.mass_height * height
        square = np.where(self.round, 0.75 * b * b, b * b) + h * h
        middle, offset = 0.5 * b, self.offset * base
        gyration = np.sqrt(square / 12.0)
        body = RigidBody(left=middle + offset, right=middle - offset, height=centre, gyration=gyration, top_height=h)
        return BodyArray(body, self.restitution, change)


@dataclass(frozen=True, eq=False)
class BodyArray(AbstractBody):
    """Rigid bodies of which some have a coefficient of restitution of their own.

    Attributes
    ----------
    rigid : RigidBody
        The bodies, arrays (bodies,) or (bodies, 1).
    own : float array [-]
        Restitution of each; nan: from the angular momentum, of each edge.
    change : float
        Added to the restitution, which stays in [0, 1].
    """

    rigid: RigidBody
    own: Array
    change: float

    @cached_property
    def right(self) -> Edge:
        return self._changed(self.rigid.right)

    @cached_property
    def left(self) -> Edge:
        return self._changed(self.rigid.left)

    def _changed(self, edge: Edge) -> Edge:
        eta = np.where(np.isnan(self.own), np.maximum(edge.restitution, 0.0), self.own) + self.change
        return replace(edge, restitution=np.clip(eta, 0.0, 1.0))

    @property
    def gravity(self) -> Array:
        return self.rigid.gravity

    @property
    def top_height(self) -> Array:
        return self.rigid.top_height

    @property
    def description(self) -> str:
        return self.rigid.description

    @property
    def sides(self) -> list[BodyArray]:
        """The bodies, and their mirror images if the centre of mass of one is not in the middle."""
        given = self.rigid.parameters
        if np.array_equal(given["left"], given["right"]):
            return [self]
        mirrored = RigidBody(**{**given, "left": given["right"], "right": given["left"]})
        return [self, BodyArray(mirrored, self.own, self.change)]

    @property
    def column(self) -> BodyArray:
        """The bodies along the first of two axes."""
        given = {name: value[..., None] if value.ndim else value for name, value in self.rigid.parameters.items()}
        return BodyArray(RigidBody(**given), self.own[:, None], self.change)
