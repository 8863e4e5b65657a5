"""Bodies with two edges: the parameters of their equation of motion from mass and geometry.

About the edge s (right: theta > 0) a rigid body on a ground that accelerates by a to the right and w upwards obeys

    theta'' = -p_s^2 (sgn(theta) (1 + w/g) sin(alpha_s - |theta|) + (a/g) cos(alpha_s - |theta|)),

(2.2) for equal edges and w = 0, with R_s^2 = h^2 + b_s^2, tan(alpha_s) = b_s/h and p_s^2 = g R_s/(r^2 + R_s^2), where
b_s is the distance of the centre of mass from the edge, h its height and r the radius of gyration about it.

A body against a wall (one-sided) rotates about one edge only and rebounds at theta = 0 with -e times its velocity.
"""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, in_range
from rocking._model.labelled import Index


@dataclass(frozen=True, eq=False)
class Edge:
    """One edge of a body and the rotation about it; float64 arrays that broadcast."""

    alpha: Array  # rotation at which the body is balanced on the edge, (0, 1.57] [rad]
    frequency_parameter: Array  # p of small rotations about the equilibrium on the edge, > 0 [rad/s]
    # velocity ratio of an impact that leaves the edge, at most 1. Negative: the body does not rock on but stops [-]
    restitution: Array
    # R p^2/g, (0, 1): 3/4 for a rectangle. Nan: the contact forces do not follow from the motion [-]
    inertia_ratio: Array
    # whether a wall blocks it; its other values are then equal to the other edge's
    blocked: bool | NDArray[np.bool_] = False

    @property
    def resistance(self) -> Array:
        """Horizontal acceleration over g at which the body starts to rotate about the edge: tan(alpha_s), or inf."""
        return np.where(self.blocked, np.inf, np.tan(self.alpha))


def rigid_edge(distance: Array, other: Array, height: Array, gyration: Array, gravity: Array, tilt: Array) -> Edge:
    """An edge of a rigid body.

    `distance`, `other`: distances b_s, b_-s of the centre of mass from this edge and from the other, along the base
    [m]; `height`, `gyration`: height h of the centre of mass above the base, and radius of gyration r about it [m];
    `tilt`: angle by which the base is inclined towards this edge [rad].
    """
    b, c, h, r = distance, other, height, gyration
    with np.errstate(over="ignore", invalid="ignore"):  # beyond 1e150 m, which a body refuses
        square = r * r + h * h
        about_edge = square + b * b
        radius = np.hypot(h, b)
        return Edge(
            alpha=np.arctan2(b, h) - tilt,  # below (2.1)
            frequency_parameter=np.sqrt(gravity * radius / about_edge),  # below (2.2)
            # angular momentum about the new edge, (2.4) for a rectangle
            restitution=(square - b * c) / (square + c * c),
            inertia_ratio=radius * radius / about_edge,
        )


def rebound_of(alpha: Array) -> Array:
    """Velocity ratio e of a wall that falls back against transverse walls, from momentum at its base and back [-].

    e = -(1 - 3/2 sin^2 alpha)^2 (1 - 3/2 cos^2 alpha), 1/2 for a slender wall, 0 where that is negative; after
    Sorrentino et al. (2008), from a secondary source. Measured values differ: state them.
    """
    square = np.sin(alpha) ** 2
    return np.maximum((1.0 - 1.5 * square) ** 2 * (0.5 - 1.5 * square), 0.0)


class AbstractBody(ABC):
    """What rocks about two edges: everything that responses need to know of it. Attributes broadcast."""

    @property
    @abstractmethod
    def right(self) -> Edge:
        """The edge about which theta is positive."""

    @property
    @abstractmethod
    def left(self) -> Edge:
        """The other one."""

    @property
    @abstractmethod
    def gravity(self) -> Array | float:
        """g [m/s2]."""

    @property
    @abstractmethod
    def top_height(self) -> Array | float:
        """Height above the base of the point whose displacement is given [m]."""

    @property
    @abstractmethod
    def description(self) -> str:
        """One body, or several, in words."""

    @property
    def tilt(self) -> Array:
        """Angle by which the base is inclined towards the right [rad]; 0 unless a body says otherwise."""
        return np.zeros(())

    @property
    def is_linear(self) -> bool:
        """Whether the equation of motion is the linear one (3.1); False unless a body says otherwise."""
        return False

    @property
    def contact_is_known(self) -> bool:
        """Whether the contact forces follow from the motion."""
        return not math.isnan(float(self.right.inertia_ratio))

    def displacement(self, rotation: Array) -> Array:
        """Horizontal displacement of the top [m] at a rotation [rad]: `top_height` sin(theta), above the pivot."""
        return np.asarray(self.top_height * np.sin(rotation))

    @property
    def restraint(self) -> dict[str, Array]:
        """Groups of a tendon and a damper [-], by the names of cells of the solver; nothing unless a body says so."""
        return {}

    moves_as_block: ClassVar[bool] = False
    """Whether it moves as a rectangular block, whose width and height it then has."""

    labels: dict[str, Any] = {}  # noqa: RUF012  # not changed
    """The arguments that were given as labelled arrays (xarray), with their labels."""

    index: Index | None = None
    """Name and labels of the index of the series (pandas) from which an array of bodies is made."""

    @property
    def parameters(self) -> dict[str, Array]:
        """What the body was made from, for exports: arrays by name; nothing unless a body says so."""
        return {}

    @property
    def uplift_accelerations(self) -> tuple[Array, Array]:
        """Horizontal ground accelerations at which it starts to rotate about the right and the left edge [m/s2]."""
        return self.gravity * self.right.resistance, self.gravity * self.left.resistance

    @property
    def uplift_acceleration(self) -> Array:
        """Smallest horizontal ground acceleration that starts rocking, g tan(alpha) of the weaker edge [m/s2]."""
        return np.asarray(self.gravity * np.minimum(self.right.resistance, self.left.resistance))

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of an array of bodies, () for one."""
        edges = [getattr(edge, name) for edge in (self.right, self.left) for name in Edge.__dataclass_fields__]
        return np.broadcast_shapes(*(np.shape(value) for value in (*edges, self.gravity, self.top_height, self.tilt)))


@dataclass(frozen=True)
class PolygonProperties:
    """Of a polygon of uniform density that stands on its lowest edge."""

    # left, right: distances of the centre of mass from the ends of its base [m]
    left: float
    right: float
    height: float  # height of the centre of mass above the base [m]
    gyration: float  # radius of gyration about the centre of mass [m]
    top: float  # height of the highest vertex above the base [m]


def polygon_properties(vertices: ArrayLike) -> PolygonProperties:
    """Mass properties of an outline by Green's theorem, from its corners (vertices, 2): x, y [m] in order, y upwards.

    At least three, either way round; the outline is closed by the first one and does not cross itself. Raises
    `InvalidArgumentError` if the vertices are not so, enclose no area, or do not stand: the base is the part of the
    outline between the outermost vertices of the lowest height, which needs a length, and the centre of mass must lie
    above it.
    """
    points = checked_vertices(vertices)
    size = float(np.ptp(points, axis=0).max())
    origin = points.mean(axis=0)
    x, y = (points - origin).T
    x1, y1 = np.roll(x, -1), np.roll(y, -1)
    cross = x * y1 - x1 * y
    area = 0.5 * float(cross.sum())
    if not abs(area) > 1e-12 * size * size:
        raise InvalidArgumentError("vertices", points.tolist(), "an outline that encloses an area")
    if _crosses_itself(points):
        raise InvalidArgumentError("vertices", points.tolist(), "an outline that does not cross itself")
    centre_x = float(((x + x1) * cross).sum()) / (6.0 * area)
    centre_y = float(((y + y1) * cross).sum()) / (6.0 * area)
    polar = float(((x * x + x * x1 + x1 * x1 + y * y + y * y1 + y1 * y1) * cross).sum()) / 12.0
    lowest = float(y.min())
    base = x[y <= lowest + 1e-9 * size]
    left, right = centre_x - float(base.min()), float(base.max()) - centre_x
    if not (left > 0.0 and right > 0.0):
        raise InvalidArgumentError(
            "vertices", points.tolist(), "an outline that stands: a base of some length below its centre of mass"
        )
    squared = polar / area - centre_x * centre_x - centre_y * centre_y
    if not squared > 0.0:  # parts of opposite orientation: it crosses itself at a vertex
        raise InvalidArgumentError("vertices", points.tolist(), "an outline that does not cross itself")
    return PolygonProperties(left, right, centre_y - lowest, math.sqrt(squared), float(y.max()) - lowest)


def checked_vertices(vertices: ArrayLike) -> Array:
    """Vertices of an outline as an array (vertices, 2) [m], at least three."""
    points = in_range("vertices", vertices, -1e6, 1e6, unit="m")
    if points.ndim != 2 or points.shape[1] != 2 or len(points) < 3:
        raise InvalidArgumentError("vertices", f"shape {points.shape}", "at least three pairs x, y")
    return points


def _crosses_itself(points: Array) -> bool:
    """Whether two sides of a closed outline that are not neighbours meet."""
    start, end = points, np.roll(points, -1, axis=0)

    def turn(a: Array, b: Array, c: Array) -> Array:
        """Sign of the area of the triangles a, b, c."""
        (ux, uy), (vx, vy) = np.moveaxis(b - a, -1, 0), np.moveaxis(c - a, -1, 0)
        return np.asarray(np.sign(ux * vy - uy * vx))

    def crossed(a: Array, b: Array) -> bool:
        between = turn(a, b, start) * turn(a, b, end) < 0.0
        # each side has its ends on different sides of the other; sides that only touch have a turn of 0 and pass
        return bool((between & (turn(start, end, a) * turn(start, end, b) < 0.0)).any())

    return any(map(crossed, start, end))  # a side at a time: of many vertices all pairs would need much memory
