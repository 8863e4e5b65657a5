"""Objects that are assessed, and their bodies in each plane of rocking."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import astuple, dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from rocking.extension import (
    FRICTION,
    MASS,
    RESTITUTION,
    STANDARD_GRAVITY,
    AbstractBody,
    Array,
    Edge,
    Flags,
    Index,
    InvalidArgumentError,
    PolygonProperties,
    RectangularBlock,
    RespondingBody,
    RigidBody,
    Scalar,
    checked_vertices,
    impact_share,
    number,
    rebound_of,
)
from rocking.extension import body as describe

if TYPE_CHECKING:
    from rocking_assessment._meshes.mesh import Mesh

LENGTHS = 1e-4, 1e3  # smallest and largest dimension of an object [m]
STEP = 15  # between the directions around an object [degrees]
CYLINDER = 0.75  # 12 k^2 = 3/4 diameter^2 + height^2 of a cylinder, in place of width^2 + height^2 [-]


@dataclass(frozen=True)
class Object:
    """A free-standing object on a rectangular or round base. Lengths in metres, or texts such as "40 cm".

    Parameters
    ----------
    name : str
        Name in the output.
    width, depth : float
        Sizes of the base [m], 0.1 mm to 1 km like all lengths. Without a depth it is assessed along the width only.
    height : float
        Height of the object [m].
    diameter : float
        Diameter of a round base [m], in place of width and depth. The plane model leaves out wobbling and rolling.
    mass_height : float, optional
        Height of the centre of mass [m]; half the height by default.
    offset_width, offset_depth : float
        Distance of the centre of mass from the middle of the base [m]; it lies above the base.
    mass : float, optional
        Mass [kg], > 0; the outcome does not depend on it.
    friction : float, optional
        Coefficient of friction at the base [-], (0, 10].
    restitution : float, "momentum" or "kalliontzis(k=...)"
        Coefficient of restitution eta of every impact [-], [0, 1]; "momentum": from conservation of angular momentum.
    tolerance : float
        Uncertainty of each dimension, up and down [m], >= 0 and less than half of the smallest dimension.
    pedestal, notes : str
        Texts for the report.
    details : mapping of str to str
        Other texts, such as an inventory number, by header; tables that are written repeat them.
    cells : mapping of str to str or float
        The unchanged row of a table, by header; empty for an object that was not read from one.

    Notes
    -----
    The radius of gyration is that of a homogeneous box, or cylinder, of these dimensions; of a mesh it is computed.
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
    details: Mapping[str, str] = field(default_factory=dict, hash=False)
    cells: Mapping[str, str | float] = field(default_factory=dict, compare=False, repr=False)

    def __post_init__(self) -> None:
        if self.width is None and self.diameter is None:
            raise InvalidArgumentError("width", None, "a width, with or without a depth; or a diameter")
        if self.height is None:
            raise InvalidArgumentError("height", None, "a height")
        for name, other in (("width", self.width), ("depth", self.depth)):
            if self.diameter is not None and other is not None:
                raise InvalidArgumentError(name, other, "none beside a diameter; a base is a rectangle or round")
        self._check_texts()
        checked: dict[str, float] = {}
        for name in ("width", "height", "depth", "diameter", "mass_height"):
            value = getattr(self, name)
            if value is not None:
                checked[name] = number(name, value, *LENGTHS, unit="m")
        for name, size in (("offset_width", "width"), ("offset_depth", "depth")):
            half = 0.5 * checked.get(size, checked.get("diameter", math.inf))
            checked[name] = number(name, getattr(self, name), -half, half, closed="neither", unit="m")
        if self.depth is self.diameter is None and checked["offset_depth"] != 0.0:
            raise InvalidArgumentError("offset_depth", self.offset_depth, "0 without a depth")
        offset = math.hypot(checked["offset_width"], checked["offset_depth"])
        if self.diameter is not None and not offset < 0.5 * checked["diameter"]:
            raise InvalidArgumentError("offset_width", self.offset_width, "with offset_depth inside the round base")
        if checked.get("mass_height", 0.0) > checked["height"]:
            raise InvalidArgumentError("mass_height", self.mass_height, f"(0, {checked['height']:g}] [m], the height")
        vars(self).update(checked)  # a frozen dataclass
        self._check_others()

    def _check_texts(self) -> None:
        for name in ("name", "pedestal", "notes"):
            if not isinstance(getattr(self, name), str):
                raise InvalidArgumentError(name, getattr(self, name), "a text")
        details: Any = self.details
        pairs = details.items() if isinstance(details, Mapping) else [(None, details)]
        if not all(isinstance(one, str) for pair in pairs for one in pair):
            raise InvalidArgumentError("details", details, "texts by name")

    def _check_described(self, description: str) -> None:
        """Check an object that has its dimensions from a description, such as "a mesh"."""
        for size in ("width", "depth", "diameter", "height", "mass_height"):
            if getattr(self, size) is not None:
                raise InvalidArgumentError(size, getattr(self, size), f"nothing beside {description}, which has it")
        for name in ("offset_width", "offset_depth"):
            if getattr(self, name) != 0.0:
                raise InvalidArgumentError(name, getattr(self, name), f"0 beside {description}, which has it")
        self._check_texts()
        self._check_others()

    def _check_others(self) -> None:
        """Check the values that are not dimensions."""
        checked: dict[str, float] = {}
        for one in (MASS, FRICTION):
            if getattr(self, one.name) is not None:
                checked[one.name] = one.number(getattr(self, one.name))
        share = impact_share(self.restitution)
        if share is not None and share < 1.0 and any(plane.offset or plane.side for plane in self.planes.values()):
            allowed = "momentum or a number for an object against a wall, or whose centre of mass is not in the middle"
            raise InvalidArgumentError("restitution", self.restitution, allowed)
        if share is None:
            checked["restitution"] = RESTITUTION.number(self.restitution)
        half = 0.5 * min(size for plane in self.planes.values() for size in (plane.base, plane.height))
        checked["tolerance"] = number("tolerance", self.tolerance, 0.0, half, closed="left", unit="m")
        vars(self).update(checked)

    @staticmethod
    def from_mesh(
        path: str | Path,
        *,
        unit: str | None = None,
        up: str | None = None,
        name: str | None = None,
        **others: Any,
    ) -> MeshObject:
        """An object of uniform density from a surface mesh, as of `rocking_assessment.body_from_mesh`.

        It is assessed in vertical planes every 15 degrees from the x axis towards the y axis, and across the long sides
        of its footprint where they are in other directions, from both sides.

        Parameters
        ----------
        path : str or Path
            A file that trimesh reads (STL, PLY, OBJ, GLB, ...).
        unit : str
            Unit of the lengths in the file, "m", "cm", "mm", "in" or "ft"; required, but for glTF, which has metres.
        up : str
            Axis of the file that points upwards, "x", "y" or "z"; by default "z", of glTF "y".
        name : str, optional
            For output; the name of the file by default.
        others
            mass, friction, restitution, tolerance, pedestal and notes, as above, and `contact_tolerance`: height above
            the lowest point up to which vertices are in contact with the ground, over the height of the mesh [-],
            [0, 0.1], by default 1e-4. The column `contact_tolerance` of an assessment names it in metres.
            `allow_unusual=True` accepts a size below 1 cm or above 50 m.

        Raises
        ------
        InvalidArgumentError
            If the unit is not stated, the file cannot be read, encloses no volume, or does not stand; as for an object.
        ImportError
            If trimesh is not installed.
        """
        return MeshObject(Path(path).stem if name is None else name, path=str(path), unit=unit, up=up, **others)

    @staticmethod
    def from_outline(vertices: ArrayLike, *, name: str = "outline", **others: Any) -> OutlineObject:
        """An object of uniform density from its outline, which rocks in the plane of this outline.

        Parameters
        ----------
        vertices : array_like (vertices, 2)
            Corners x, y [m], y upwards, as of `rocking.RigidBody.from_polygon`.
        name, others
            As for `from_mesh`.

        Raises
        ------
        InvalidArgumentError
            If the outline crosses itself, encloses no area, or does not stand; as for an object.
        """
        corners = tuple((float(x), float(y)) for x, y in checked_vertices(vertices))
        return OutlineObject(name, vertices=corners, **others)

    @staticmethod
    def from_body(
        body: RespondingBody | str | Mapping[str, Any], *, name: str = "body", **others: Any
    ) -> DescribedObject:
        """An object from a rigid body or its description, as of `rocking.body`; it rocks in the plane of this body.

        Parameters
        ----------
        body : Block, RigidBody, str or mapping
            The body, or what describes it, such as "hollow(width=40cm, height=1.6m, wall=2cm)".
        name, others
            As for `from_mesh`.
        """
        made = body if isinstance(body, RespondingBody) else describe(body)
        return DescribedObject(name, described=made, **others)

    @property
    def depth_is_missing(self) -> bool:
        """True if it has a width and no depth, so that only rocking along the width can be assessed."""
        return self.width is not None and self.depth is None

    @property
    def planes(self) -> dict[str, Plane]:
        """The planes in which it can rock, by name of the direction."""
        given: dict[str, Any] = vars(self)
        height = given["height"]
        centre = 0.5 * height if self.mass_height is None else given["mass_height"]
        if self.diameter is not None:
            offset = math.hypot(given["offset_width"], given["offset_depth"])
            return {"any": Plane(given["diameter"], offset, height, centre, CYLINDER, 1.0)}
        names = ("width",) if self.depth is None else ("width", "depth")
        return {name: Plane(given[name], given[f"offset_{name}"], height, centre, 1.0, 1.0) for name in names}

    @property
    def body(self) -> RigidBody:
        """The body in each plane, over the dimension `direction`."""
        import xarray as xr  # noqa: PLC0415  (takes longer to load than the package)

        rigid, names = Bodies.of([self]).scaled().rigid, {"direction": list(self.planes)}
        given = rigid.parameters
        made = rigid.changed(
            **{key: xr.DataArray(value, names, "direction") if value.ndim else value for key, value in given.items()}
        )
        return next(iter(self.planes.values())).against_wall(made)

    @property
    def planes_around(self) -> dict[float, Plane]:
        """The planes across the sides of its base, by angle from the width towards the depth, below 180 [degrees]."""
        planes = self.planes
        if self.diameter is None:
            return dict(zip((0.0, 90.0), planes.values(), strict=False))
        given: dict[str, Any] = vars(self)
        angles = np.radians(np.arange(0.0, 180.0, STEP))
        offsets = given["offset_width"] * np.cos(angles) + given["offset_depth"] * np.sin(angles)
        around = zip(range(0, 180, STEP), offsets.tolist(), strict=True)
        return {float(angle): replace(planes["any"], offset=offset) for angle, offset in around}

    @property
    def footprint(self) -> Array:
        """Corners of the base, along the width and along the depth from the centre of mass [m]; array (points, 2)."""
        given: dict[str, Any] = vars(self)
        if self.diameter is not None:
            angle = np.radians(np.arange(0.0, 360.0, 5.0))
            corners = 0.5 * given["diameter"] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        else:
            signs = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
            corners = 0.5 * signs * (given["width"], given["depth"] or 0.0)
        return np.asarray(corners - (given["offset_width"], given["offset_depth"]))

    def outline(self, direction: str) -> Array:
        """Outline from the side, x from the middle of the base and heights [m]; array (points, 2)."""
        plane = self.planes[direction]
        half = 0.5 * plane.base
        return np.array([(-half, 0.0), (half, 0.0), (half, plane.height), (-half, plane.height)])


@dataclass(frozen=True)
class Plane:
    """An object in one plane of rocking."""

    base: float  # size of the base [m]
    offset: float  # distance of the centre of mass from the middle of the base, towards the right edge [m]
    height: float  # of the object [m]
    mass_height: float  # of its centre of mass [m]
    base_share: float  # 12 k^2 = inertia (base_share base^2 + height^2), k the radius of gyration [-]
    inertia: float  # likewise [-]
    side: float = 0.0  # 1, -1: it rocks about its right or left edge only, since a wall stops it at the other side
    rebound: float = math.nan  # from this wall; nan: from the angular momentum [-]

    @classmethod
    def of(cls, found: PolygonProperties, side: float = 0.0, rebound: float = math.nan) -> Plane:
        """The plane of a body with these edges and this radius of gyration."""
        base = found.left + found.right
        for name, size in (("base", base), ("height", found.top)):
            number(name, size, *LENGTHS, unit="m")
        inertia = 12.0 * found.gyration**2 / (base**2 + found.top**2)
        return cls(base, 0.5 * (found.left - found.right), found.top, found.height, 1.0, inertia, side, rebound)

    @property
    def mirrored(self) -> Plane:
        """The same seen from the other side."""
        return replace(self, offset=-self.offset, side=-self.side)

    def against_wall(self, body: RigidBody) -> RigidBody:
        """A body with the wall of this plane, if it has one."""
        rebound = None if math.isnan(self.rebound) else self.rebound
        return body.one_sided("right" if self.side > 0.0 else "left", rebound) if self.side else body


@dataclass(frozen=True)
class MeshObject(Object):
    """What `Object.from_mesh` makes."""

    path: str = ""  # the file
    unit: str | None = None  # of its lengths
    up: str | None = None  # its axis that points upwards
    contact_tolerance: float = 1e-4  # of vertices in contact with the ground, over the height of the mesh [-]
    allow_unusual: bool = False  # whether any size is accepted

    def __post_init__(self) -> None:
        self._check_described("a mesh")

    @property
    def mesh(self) -> Mesh:
        """The surface."""
        from rocking_assessment._meshes.mesh import read_mesh  # noqa: PLC0415  (trimesh is an extra)

        return read_mesh(self.path, unit=self.unit, up=self.up, allow_unusual=self.allow_unusual)

    @property
    def contact_height(self) -> float:
        """Height above its lowest point up to which vertices are in contact with the ground [m]."""
        return self.contact_tolerance * next(iter(self.planes.values())).height

    @cached_property
    def planes(self) -> dict[str, Plane]:
        from rocking_assessment._meshes.mesh import directions_around  # noqa: PLC0415  (trimesh is an extra)

        mesh = self.mesh
        for remark in mesh.remarks:
            warnings.warn(f"{Path(self.path).name} {remark}", UserWarning, 2)
        angles = directions_around(self.footprint, STEP)
        return {
            f"{angle:g} deg": Plane.of(mesh.properties(math.radians(angle), self.contact_tolerance)) for angle in angles
        }

    @property
    def planes_around(self) -> dict[float, Plane]:
        return {float(name.removesuffix(" deg")): plane for name, plane in self.planes.items()}

    @cached_property
    def footprint(self) -> Array:
        return self.mesh.footprint(self.contact_tolerance)

    def outline(self, direction: str) -> Array:
        angle = math.radians(float(direction.removesuffix(" deg")))
        offset = np.array([self.planes[direction].offset, 0.0])  # of the centre of mass from the middle of the base
        return np.asarray(self.mesh.outline(angle) + offset)


@dataclass(frozen=True)
class DescribedObject(Object):
    """What `Object.from_body` makes."""

    described: Any = None  # the body in the plane in which it rocks

    def __post_init__(self) -> None:
        self._check_described("a body")

    @cached_property
    def planes(self) -> dict[str, Plane]:
        return {"width": plane_of(self.described)}

    @property
    def planes_around(self) -> dict[float, Plane]:
        return {0.0: next(iter(self.planes.values()))}

    @property
    def footprint(self) -> Array:
        (plane,) = self.planes.values()
        return np.array([(-0.5 * plane.base - plane.offset, 0.0), (0.5 * plane.base - plane.offset, 0.0)])


@dataclass(frozen=True)
class OutlineObject(DescribedObject):
    """What `Object.from_outline` makes."""

    vertices: tuple[tuple[float, float], ...] = ()  # corners x, y of the outline [m]

    def __post_init__(self) -> None:
        self._check_described("an outline")

    @cached_property
    def planes(self) -> dict[str, Plane]:
        return {"outline": plane_of(RigidBody.from_polygon(self.vertices))}

    def outline(self, direction: str) -> Array:
        plane = self.planes[direction]
        points = np.array(self.vertices)
        points[:, 1] -= points[:, 1].min()
        base = points[points[:, 1] <= 1e-9 * plane.height, 0]
        return np.asarray(points - (0.5 * (base.min() + base.max()), 0.0))


def plane_of(body: RespondingBody) -> Plane:
    """A rigid body as a plane of an object."""
    if body.shape or not isinstance(body, RigidBody | RectangularBlock):
        raise InvalidArgumentError("body", body.description, "one rigid body, such as rocking.RigidBody")
    if float(body.tilt) or float(body.gravity) != STANDARD_GRAVITY:
        raise InvalidArgumentError("body", body.description, "on level ground under standard gravity")
    if isinstance(body, RectangularBlock):
        return Plane.of(
            PolygonProperties(
                body.half_width, body.half_width, body.half_height, body.half_diagonal / math.sqrt(3.0), body.height
            )
        )
    given = body.parameters
    values = given["left"], given["right"], body.height, body.gyration, body.top_height
    side = {"both": 0.0, "right": 1.0, "left": -1.0}[body.sides]
    return Plane.of(PolygonProperties(*map(float, values)), side, float(given.get("rebound", math.nan)))


@dataclass(frozen=True, eq=False)
class Bodies:
    """One body for each object and direction: the values of `Plane`, and `own` of `BodyArray`, as arrays (bodies,)."""

    base: Array
    offset: Array
    height: Array
    mass_height: Array
    base_share: Array
    inertia: Array
    side: Array
    rebound: Array
    restitution: Array

    @classmethod
    def of(cls, objects: Iterable[Object]) -> Bodies:
        """The bodies of some objects, those of one object in a row."""
        return cls.of_planes((plane, one.restitution) for one in objects for plane in one.planes.values())

    @classmethod
    def of_planes(cls, planes: Iterable[tuple[Plane, Scalar]]) -> Bodies:
        """The bodies of some planes and their restitutions."""
        rows = [(*astuple(plane), eta if (share := impact_share(eta)) is None else -share) for plane, eta in planes]
        return cls(*np.array(rows, dtype=np.float64).reshape(-1, 9).T)

    def take(self, rows: Index) -> Bodies:
        """Some of them."""
        return Bodies(**{name: column[rows] for name, column in vars(self).items()})

    def scaled(self, base: Array | float = 1.0, height: Array | float = 1.0, change: Array | float = 0.0) -> BodyArray:
        """The bodies with base and height multiplied by factors (bodies,), and `change` added to the restitution."""
        b, h, centre = self.base * base, self.height * height, self.mass_height * height
        gyration = np.sqrt(self.inertia * (self.base_share * b * b + h * h) / 12.0)
        body = RigidBody.from_size(b, h, offset=self.offset * base, mass_height=centre, gyration=gyration)
        return BodyArray(body, self.restitution, np.broadcast_to(change, b.shape), self.side, self.rebound)


@dataclass(frozen=True, eq=False)
class BodyArray(AbstractBody):
    """Rigid bodies, some with their own coefficient of restitution."""

    rigid: RigidBody  # the bodies, arrays (bodies,) or (bodies, 1)
    # restitution of each; -k: from the angular momentum of an impact at the share k of the half base, of each edge [-]
    own: Array
    change: Array  # added to the restitution, which stays in [0, 1] [-]
    side: Array  # as of `Plane`
    rebound: Array  # as of `Plane`

    @cached_property
    def right(self) -> Edge:
        return self._edge("right", "left", self.side < 0.0)

    @cached_property
    def left(self) -> Edge:
        return self._edge("left", "right", self.side > 0.0)

    def _edge(self, own: str, other: str, blocked: Flags) -> Edge:
        edge = self._changed(own, other)
        if not blocked.any():
            return edge
        behind = self._changed(other, own)
        values = {name: (getattr(behind, name), getattr(edge, name)) for name in vars(edge) if name != "blocked"}
        return Edge(**{name: np.where(blocked, *pair) for name, pair in values.items()}, blocked=blocked)

    def _changed(self, own: str, other: str) -> Edge:
        """An edge with its restitution; of a body against a wall that of its rebound."""
        edge: Edge = getattr(self.rigid, own)
        given, share = self.rigid.parameters, np.square(np.minimum(self.own, 0.0))  # k^2
        square = given["gyration"] ** 2 + given["height"] ** 2
        spread = (square - share * given[own] * given[other]) / (square + share * given[other] ** 2)  # (2.4) for k = 1
        rebound = np.where(np.isnan(self.rebound), rebound_of(edge.alpha), self.rebound)
        stated = np.where(self.side == 0.0, np.maximum(spread, 0.0), rebound)
        eta = np.where(self.own < 0.0, stated, self.own) + self.change
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
        """The bodies, and their mirror images unless all are like these."""
        if not self.is_lopsided.any():
            return [self]
        given = self.rigid.parameters
        mirrored = self.rigid.changed(**{**given, "left": given["right"], "right": given["left"]})
        return [self, replace(self, rigid=mirrored, side=-self.side)]

    @property
    def is_lopsided(self) -> Flags:
        """Whether each has its centre of mass not in the middle, or a wall at one side."""
        given = self.rigid.parameters
        return np.asarray((given["left"] != given["right"]) | (self.side != 0.0))

    @property
    def column(self) -> BodyArray:
        """The bodies along the first of two axes."""
        given = {name: value[..., None] if value.ndim else value for name, value in self.rigid.parameters.items()}
        others = {name: value[:, None] for name, value in vars(self).items() if name in _OF_EACH}
        return BodyArray(self.rigid.changed(**given), **others)


_OF_EACH = "own", "change", "side", "rebound"
