"""`rocking.RigidBody`: a rigid body on two edges, from dimensions, an outline or a mesh."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self, final

import numpy as np
from numpy.typing import ArrayLike

import rocking._base.quantities as q
from rocking._base.arrays import Array
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError, in_range, positive
from rocking._base.units import Scalar, Values
from rocking._dimensional.body import RespondingBody
from rocking._model.body import Edge, polygon_properties, rebound_of, rigid_edge
from rocking._model.checks import check_quantities
from rocking._model.labelled import in_unit, index_of, is_labelled

SIDES = "both", "left", "right"  # edges about which a body rocks
_NO_LENGTHS = {one.name for one in (q.GRAVITY, q.INCLINATION, q.REBOUND)}


@final
@dataclass(frozen=True, init=False, eq=False, repr=False)
class RigidBody(RespondingBody):
    """A rigid body that stands on two edges, its centre of mass anywhere between them.

    All arguments may be arrays, which broadcast: an array of bodies; labelled ones (xarray) by the names of their
    dimensions. Here and wherever a quantity is expected, a number is in the SI unit; quantities of pint and texts such
    as "20 cm" are converted.

    Parameters
    ----------
    left, right : float
        Distances of the centre of mass from the left and the right edge along the base [m], > 0.
    height : float
        Height of the centre of mass above the base [m], > 0.
    gyration : float, optional
        Radius of gyration about the centre of mass [m], > 0; that of the uniform rectangle of width `left` + `right`
        and twice this height without it.
    inclination : float
        Angle by which the base is inclined towards the right [rad], (-pi/2, pi/2); see `tilted`.
    gravity : float
        g [m/s2], > 0.
    top_height : float, optional
        Height above the base of the point whose displacement is given [m], > 0; by default twice `height`.
    sides : {"both", "left", "right"}
        The edges about which it rocks. One: a wall at its other side stops it, such as a facade between transverse
        walls; at theta = 0 it rebounds.
    rebound : float, optional
        Velocity after that over the one before, without its sign [-], [0, 1], of a one-sided body; by default
        -(1 - 3/2 sin^2 alpha)^2 (1 - 3/2 cos^2 alpha), 0 where that is negative (after Sorrentino et al. 2008, from a
        secondary source). A stated `restitution` of a response takes its place.

    Raises
    ------
    InvalidArgumentError
        If a length or gravity is not finite and positive, the body does not stand at its inclination, or `rebound` is
        given for a body that rocks about both edges.

    Examples
    --------
    >>> vase = RigidBody(left="12 cm", right="18 cm", height="40 cm")
    >>> bool(vase.response("sine", peak_acceleration="0.4 g", period="0.5 s").overturned)
    False
    """

    _given: dict[str, Array]
    sides: str

    def __init__(
        self,
        left: Values,
        right: Values,
        height: Values,
        gyration: Values | None = None,
        *,
        inclination: Values = 0.0,
        gravity: Values = STANDARD_GRAVITY,
        top_height: Values | None = None,
        sides: str = "both",
        rebound: Values | None = None,
    ) -> None:
        if sides not in SIDES:
            raise InvalidArgumentError("sides", sides, f"one of {', '.join(SIDES)}")
        if rebound is not None and sides == "both":
            raise InvalidArgumentError("rebound", rebound, 'nothing beside sides="both": impacts have a restitution')
        checked, labels, index = check_quantities(
            {
                q.LEFT: left,
                q.RIGHT: right,
                q.HEIGHT: height,
                q.GYRATION: gyration,
                q.TOP_HEIGHT: top_height,
                q.GRAVITY: gravity,
                q.INCLINATION: inclination,
                q.REBOUND: rebound,
            }
        )
        vars(self).update(_given=checked, labels=labels, index=index, sides=sides)  # it is frozen
        for edge, sign in ((self.right, 1.0), (self.left, -1.0)):
            if not np.all(edge.frequency_parameter > 0.0):  # squares of lengths are no numbers, or their p is 0
                name = max(checked, key=lambda one: float(np.max(checked[one])))
                raise InvalidArgumentError(name, float(np.max(checked[name])), "at most 1e150 m")
            if not np.all(edge.alpha > 0.0):
                limit = math.degrees(float(np.min(edge.alpha + sign * self.tilt)))
                bound = f"less than {limit:.4g}" if sign > 0.0 else f"more than {-limit:.4g}"
                raise InvalidArgumentError(
                    "inclination", inclination, f"{bound} degrees: the body falls over by itself"
                )

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, RigidBody):
            return NotImplemented
        return (self.sides, self._given.keys()) == (other.sides, other._given.keys()) and all(
            np.array_equal(value, other._given[name]) for name, value in self._given.items()
        )

    def __hash__(self) -> int:
        return hash(self.sides) ^ hash(
            tuple((name, value.tobytes(), value.shape) for name, value in self._given.items())
        )

    def __repr__(self) -> str:
        """The body in words."""
        return f"<rocking.RigidBody: {self.description}>"

    @property
    def width(self) -> Array:
        """Distance of the edges [m]."""
        return np.asarray(self._given["left"] + self._given["right"])

    @property
    def height(self) -> Array:
        """Height of the centre of mass above the base [m]."""
        return self._given["height"]

    @property
    def gyration(self) -> Array:
        """Radius of gyration about the centre of mass [m]."""
        if "gyration" in self._given:
            return self._given["gyration"]
        return np.asarray(np.hypot(self.width, 2.0 * self.height) / math.sqrt(12.0))

    @property
    def tilt(self) -> Array:
        """Angle by which the base is inclined towards the right [rad]."""
        return self._given["inclination"]

    @property
    def gravity(self) -> Array:
        """g [m/s2]."""
        return self._given["gravity"]

    @property
    def top_height(self) -> Array:
        """Height above the base of the point whose displacement is given [m]."""
        return self._given.get("top_height", 2.0 * self.height)

    @cached_property
    def right(self) -> Edge:
        """The right edge, about which theta is positive."""
        return self._edge("right", "left", 1.0)

    @cached_property
    def left(self) -> Edge:
        """The left edge."""
        return self._edge("left", "right", -1.0)

    @property
    def contact_is_known(self) -> bool:
        """Whether the contact forces follow from the motion; they do not for a body against a wall."""
        return self.sides == "both"

    @property
    def parameters(self) -> dict[str, Array]:
        """The arguments that were given, as arrays."""
        return self._given

    @property
    def description(self) -> str:
        if self.shape:
            return f"{' x '.join(map(str, self.shape))} bodies"
        left, right, height = (float(self._given[name]) for name in ("left", "right", "height"))
        leaning = f", inclined by {math.degrees(float(self.tilt)):.4g} deg" if self.tilt else ""
        wall = "" if self.sides == "both" else f", which rocks about its {self.sides} edge only"
        return f"body on edges {left:.4g} m left and {right:.4g} m right of its mass at {height:.4g} m{leaning}{wall}"

    def _edge(self, name: str, other: str, direction: float) -> Edge:
        given, blocked = self._given, self.sides == other
        if blocked:  # its values are not used but for the scale of rotations
            name, other, direction = other, name, -direction
        edge = rigid_edge(given[name], given[other], self.height, self.gyration, self.gravity, direction * self.tilt)
        if self.sides == "both":
            return edge
        return replace(edge, restitution=given.get("rebound", rebound_of(edge.alpha)), blocked=blocked)

    def changed(self, **arguments: Any) -> RigidBody:
        """The body with these `parameters`, and the same wall."""
        return RigidBody(**arguments, sides=self.sides)

    def tilted(self, angle: Values) -> RigidBody:
        """The body on a base that is inclined further towards the right.

        The rotation is counted from there; alpha of the right edge becomes smaller by the angle, that of the left one
        larger. Reactions are along the inclined base and normal to it.

        Parameters
        ----------
        angle : array_like
            Angle [rad], or a text such as "2 deg"; negative towards the left.
        """
        added = in_unit("angle", angle, "rad")
        checked = in_range("angle", added, -math.pi / 2, math.pi / 2, closed="neither", unit="rad")
        given = self._given | self.labels
        leaning = given["inclination"] + (added if is_labelled(added) else checked)
        return self.changed(**given | {"inclination": leaning})

    def one_sided(self, side: str, rebound: Values | None = None) -> RigidBody:
        """The body against a wall, which lets it rock about one edge only.

        Parameters
        ----------
        side : {"left", "right"}
            The edge about which it rocks.
        rebound : float, optional
            As of `RigidBody`.

        Examples
        --------
        >>> facade = RigidBody.from_size("60 cm", "9 m").one_sided("right", rebound=0.4)
        >>> bool(facade.response("sine", peak_acceleration="0.2 g", period="1 s").overturned)
        False
        """
        return RigidBody(**self._given | self.labels | {"rebound": rebound}, sides=side)

    def scaled(self, size: Values) -> RigidBody:
        factor = in_unit("size", size, "-")
        checked = in_range("size", factor, 0.0, math.inf, closed="neither")
        given, factor = self._given | self.labels, factor if is_labelled(factor) else checked
        return self.changed(**{name: value if name in _NO_LENGTHS else value * factor for name, value in given.items()})

    @classmethod
    def from_size(
        cls,
        width: Values,
        height: Values,
        *,
        offset: Values = 0.0,
        mass_height: Values | None = None,
        gyration: Values | None = None,
        gravity: Values = STANDARD_GRAVITY,
    ) -> Self:
        """A body from its outer dimensions and the place of its centre of mass; arrays broadcast.

        Parameters
        ----------
        width, height : array_like
            Of the body [m], > 0; its top is at this height.
        offset : array_like
            Distance of the centre of mass from the middle of the width [m], less than half of it; positive to the
            right, so that it is closer to the right edge.
        mass_height : array_like, optional
            Height of the centre of mass above the base [m], > 0; half the height without it.
        gyration, gravity
            As of `RigidBody`; without a gyration that of the uniform rectangle of this width and height.

        Examples
        --------
        >>> RigidBody.from_size("40 cm", "160 cm", offset="5 cm")
        <rocking.RigidBody: body on edges 0.25 m left and 0.15 m right of its mass at 0.8 m>
        """
        lengths = {q.WIDTH: width, q.HEIGHT: height, q.OFFSET: offset, q.MASS_HEIGHT: mass_height}
        checked, labels, _ = check_quantities(lengths)
        given: dict[str, Any] = checked | labels
        w, h, e = given["width"], given["height"], given["offset"]
        half = 0.5 * w
        if not np.all(np.abs(e) < half):
            allowed = f"less than half the width to either side, {float(np.min(half)):.6g} m"
            raise InvalidArgumentError("offset", offset, allowed)
        made = cls(
            left=half + e,
            right=half - e,
            height=given.get("mass_height", 0.5 * h),
            gyration=np.hypot(w, h) / math.sqrt(12.0) if gyration is None else gyration,
            gravity=gravity,
            top_height=h,
        )
        vars(made)["index"] = index_of(*lengths.values(), gyration, gravity)
        return made

    @classmethod
    def from_polygon(cls, vertices: ArrayLike, *, gravity: Scalar = STANDARD_GRAVITY) -> Self:
        """A body of uniform density from its outline, standing on its lowest edge; its top is its highest vertex.

        Parameters
        ----------
        vertices : array_like (vertices, 2)
            Corners x, y [m] in order, either way round; y is upwards.
        gravity
            As of `RigidBody`.

        Raises
        ------
        InvalidArgumentError
            If the outline crosses itself, encloses no area, or does not stand.

        Examples
        --------
        >>> RigidBody.from_polygon([(0, 0), (0.3, 0), (0.3, 1.0), (0.1, 1.2), (0, 1.0)])
        <rocking.RigidBody: body on edges 0.1485 m left and 0.1515 m right of its mass at 0.5515 m>
        """
        g = positive("gravity", gravity, "m/s2")
        found = polygon_properties(vertices)
        return cls(found.left, found.right, found.height, found.gyration, gravity=g, top_height=found.top)
