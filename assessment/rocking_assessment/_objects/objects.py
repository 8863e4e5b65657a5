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
        for name, side in (("width", self.width), ("depth", self.depth)):
            if self.diameter is not None and side is not None:
                raise InvalidArgumentError(name, side, "none beside a diameter; a base is a rectangle or round")
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
        self._check_values()

    def _check_texts(self) -> None:
        for name in ("name", "pedestal", "notes"):
            if not isinstance(getattr(self, name), str):
                raise InvalidArgumentError(name, getattr(self, name), "a text")
        details: Any = self.details
        is_mapping = isinstance(details, Mapping)
        if not is_mapping or not all(isinstance(text, str) for text in [*details, *details.values()]):
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
        self._check_values()

    def _check_values(self) -> None:
        """Check the values that are not dimensions."""
        checked: dict[str, float] = {}
        for quantity in (MASS, FRICTION):
            value = getattr(self, quantity.name)
            if value is not None:
                checked[quantity.name] = quantity.number(value)
        planes = self.planes.values()
        share = impact_share(self.restitution)
        if share is None:
            checked["restitution"] = RESTITUTION.number(self.restitution)
        elif share < 1.0 and any(plane.offset or plane.side for plane in planes):
            allowed = "momentum or a number for an object against a wall, or whose centre of mass is not in the middle"
            raise InvalidArgumentError("restitution", self.restitution, allowed)
        half = 0.5 * min(min(plane.base, plane.height) for plane in planes)
        checked["tolerance"] = number("tolerance", self.tolerance, 0.0, half, closed="left", unit="m")
        vars(self).update(checked)

    @staticmethod
    def from_mesh(
        path: str | Path,
        *,
        unit: str | None = None,
        up: str | None = None,
        name: str | None = None,
        **properties: Any,
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
        properties
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
        stem = Path(path).stem
        return MeshObject(stem if name is None else name, path=str(path), unit=unit, up=up, **properties)

    @staticmethod
    def from_outline(vertices: ArrayLike, *, name: str = "outline", **properties: Any) -> OutlineObject:
        """An object of uniform density from its outline, which rocks in the plane of this outline.

        Parameters
        ----------
        vertices : array_like (vertices, 2)
            Corners x, y [m], y upwards, as of `rocking.RigidBody.from_polygon`.
        name, properties
            As for `from_mesh`.

        Raises
        ------
        InvalidArgumentError
            If the outline crosses itself, encloses no area, or does not stand; as for an object.
        """
        corners = tuple((float(x), float(y)) for x, y in checked_vertices(vertices))
        return OutlineObject(name, vertices=corners, **properties)

    @staticmethod
    def from_body(
        body: RespondingBody | str | Mapping[str, Any], *, name: str = "body", **properties: Any
    ) -> DescribedObject:
        """An object from a rigid body or its description, as of `rocking.body`; it rocks in the plane of this body.

        Parameters
        ----------
        body : Block, RigidBody, str or mapping
            The body, or what describes it, such as "hollow(width=40cm, height=1.6m, wall=2cm)".
        name, properties
            As for `from_mesh`.
        """
        if not isinstance(body, RespondingBody):
            body = describe(body)
        return DescribedObject(name, described=body, **properties)

    @property
    def depth_is_missing(self) -> bool:
        """True if it has a width and no depth, so that only rocking along the width can be assessed."""
        return self.width is not None and self.depth is None

    @property
    def planes(self) -> dict[str, Plane]:
        """The planes in which it can rock, by name of the direction."""
        sizes: dict[str, Any] = vars(self)
        height = sizes["height"]
        centre = 0.5 * height if self.mass_height is None else sizes["mass_height"]
        if self.diameter is not None:
            offset = math.hypot(sizes["offset_width"], sizes["offset_depth"])
            return {"any": Plane(sizes["diameter"], offset, height, centre, CYLINDER, 1.0)}
        names = ("width",) if self.depth is None else ("width", "depth")
        return {name: Plane(sizes[name], sizes[f"offset_{name}"], height, centre, 1.0, 1.0) for name in names}

    @property
    def body(self) -> RigidBody:
        """The body in each plane, over the dimension `direction`."""
        import xarray as xr  # noqa: PLC0415  (takes longer to load than the package)

        rigid = Bodies.of([self]).scaled().rigid
        directions = {"direction": list(self.planes)}
        parameters: dict[str, Any] = dict(rigid.parameters)
        for name, values in parameters.items():
            if values.ndim:
                parameters[name] = xr.DataArray(values, directions, "direction")
        plane = next(iter(self.planes.values()))
        return plane.against_wall(rigid.changed(**parameters))

    @property
    def planes_around(self) -> dict[float, Plane]:
        """The planes across the sides of its base, by angle from the width towards the depth, below 180 [degrees]."""
        planes = self.planes
        if self.diameter is None:
            return dict(zip((0.0, 90.0), planes.values(), strict=False))
        sizes: dict[str, Any] = vars(self)
        degrees = np.arange(0.0, 180.0, STEP)
        angles = np.radians(degrees)
        offsets = sizes["offset_width"] * np.cos(angles) + sizes["offset_depth"] * np.sin(angles)
        around = zip(degrees.tolist(), offsets.tolist(), strict=True)
        return {angle: replace(planes["any"], offset=offset) for angle, offset in around}

    @property
    def footprint(self) -> Array:
        """Corners of the base, along the width and along the depth from the centre of mass [m]; array (points, 2)."""
        sizes: dict[str, Any] = vars(self)
        if self.diameter is not None:
            angle = np.radians(np.arange(0.0, 360.0, 5.0))
            corners = 0.5 * sizes["diameter"] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        else:
            signs = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
            corners = 0.5 * signs * (sizes["width"], sizes["depth"] or 0.0)
        return np.asarray(corners - (sizes["offset_width"], sizes["offset_depth"]))

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
    base_share: float  # share of base^2 in k^2, k the radius of gyration: 1 of a box, 3/4 of a cylinder [-]
    inertia: float  # 12 k^2 over (base_share base^2 + height^2) [-]
    side: float = 0.0  # 1, -1: it rocks about its right or left edge only, since a wall stops it at the other side
    rebound: float = math.nan  # from this wall; nan: from the angular momentum [-]

    @classmethod
    def of(cls, outline: PolygonProperties, side: float = 0.0, rebound: float = math.nan) -> Plane:
        """The plane of a body with these edges and this radius of gyration."""
        base = outline.left + outline.right
        number("base", base, *LENGTHS, unit="m")
        number("height", outline.top, *LENGTHS, unit="m")
        offset = 0.5 * (outline.left - outline.right)
        inertia = 12.0 * outline.gyration**2 / (base**2 + outline.top**2)
        return cls(base, offset, outline.top, outline.height, 1.0, inertia, side, rebound)

    @property
    def mirrored(self) -> Plane:
        """The plane seen from the other side."""
        return replace(self, offset=-self.offset, side=-self.side)

    def against_wall(self, body: RigidBody) -> RigidBody:
        """A body with the wall of this plane, if it has one."""
        if not self.side:
            return body
        rebound = None if math.isnan(self.rebound) else self.rebound
        return body.one_sided("right" if self.side > 0.0 else "left", rebound)


@dataclass(frozen=True)
class MeshObject(Object):
    """An object from a surface mesh, see `Object.from_mesh`."""

    path: str = ""  # the file
    unit: str | None = None  # of its lengths
    up: str | None = None  # its axis that points upwards
    contact_tolerance: float = 1e-4  # of vertices in contact with the ground, over the height of the mesh [-]
    allow_unusual: bool = False  # True: any size is accepted

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
        planes = {}
        for angle in directions_around(self.footprint, STEP):
            outline = mesh.properties(math.radians(angle), self.contact_tolerance)
            planes[f"{angle:g} deg"] = Plane.of(outline)
        return planes

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
    """An object from a rigid body, see `Object.from_body`."""

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
    """An object from its outline, see `Object.from_outline`."""

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
    """Plane of an object that is a rigid body."""
    if body.shape or not isinstance(body, RigidBody | RectangularBlock):
        raise InvalidArgumentError("body", body.description, "one rigid body, such as rocking.RigidBody")
    if float(body.tilt) or float(body.gravity) != STANDARD_GRAVITY:
        raise InvalidArgumentError("body", body.description, "on level ground under standard gravity")
    if isinstance(body, RectangularBlock):
        half, gyration = body.half_width, body.half_diagonal / math.sqrt(3.0)
        return Plane.of(PolygonProperties(half, half, body.half_height, gyration, body.height))
    parameters = body.parameters
    values = parameters["left"], parameters["right"], body.height, body.gyration, body.top_height
    side = {"both": 0.0, "right": 1.0, "left": -1.0}[body.sides]
    rebound = float(parameters.get("rebound", math.nan))
    return Plane.of(PolygonProperties(*map(float, values)), side, rebound)


@dataclass(frozen=True, eq=False)
class Bodies:
    """A body for each object and direction: arrays (bodies,) of the values of `Plane`, `restitution` of `BodyArray`."""

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
        planes: list[tuple[Plane, Scalar]] = []
        for obj in objects:
            planes += [(plane, obj.restitution) for plane in obj.planes.values()]
        return cls.of_planes(planes)

    @classmethod
    def of_planes(cls, planes: Iterable[tuple[Plane, Scalar]]) -> Bodies:
        """The bodies of some planes and their restitutions."""
        rows = [(*astuple(plane), signed_restitution(eta)) for plane, eta in planes]
        return cls(*np.array(rows, dtype=np.float64).reshape(-1, 9).T)

    def take(self, rows: Index) -> Bodies:
        """The bodies of some rows."""
        return Bodies(**{name: column[rows] for name, column in vars(self).items()})

    def scaled(self, base: Array | float = 1.0, height: Array | float = 1.0, change: Array | float = 0.0) -> BodyArray:
        """The bodies with base and height multiplied by factors (bodies,), and `change` added to the restitution."""
        b, h, centre = self.base * base, self.height * height, self.mass_height * height
        gyration = np.sqrt(self.inertia * (self.base_share * b * b + h * h) / 12.0)
        body = RigidBody.from_size(b, h, offset=self.offset * base, mass_height=centre, gyration=gyration)
        return BodyArray(body, self.restitution, np.broadcast_to(change, b.shape), self.side, self.rebound)


def signed_restitution(restitution: Scalar) -> Any:
    """Restitution as of `BodyArray.restitution`: a number [-], or -k for a way to compute it."""
    share = impact_share(restitution)
    return restitution if share is None else -share


@dataclass(frozen=True, eq=False)
class BodyArray(AbstractBody):
    """Rigid bodies with their coefficients of restitution."""

    rigid: RigidBody  # the bodies, arrays (bodies,) or (bodies, 1)
    # of each; -k: from the angular momentum of an impact at the share k of the half base, of each edge [-]
    restitution: Array
    change: Array  # added to the restitution, which stays in [0, 1] [-]
    side: Array  # as of `Plane`
    rebound: Array  # as of `Plane`

    @cached_property
    def right(self) -> Edge:
        return self._edge("right", "left", self.side < 0.0)

    @cached_property
    def left(self) -> Edge:
        return self._edge("left", "right", self.side > 0.0)

    def _edge(self, name: str, opposite: str, blocked: Flags) -> Edge:
        """An edge; where a wall blocks it, the values of the opposite one."""
        edge = self._with_restitution(name, opposite)
        if not blocked.any():
            return edge
        behind = vars(self._with_restitution(opposite, name))
        values = {key: np.where(blocked, behind[key], value) for key, value in vars(edge).items()}
        return Edge(**values | {"blocked": blocked})

    def _with_restitution(self, name: str, opposite: str) -> Edge:
        """An edge with its restitution; of a body against a wall that of its rebound."""
        edge: Edge = getattr(self.rigid, name)
        parameters = self.rigid.parameters
        b, other_b = parameters[name], parameters[opposite]
        share = np.square(np.minimum(self.restitution, 0.0))  # k^2
        square = parameters["gyration"] ** 2 + parameters["height"] ** 2
        momentum = (square - share * b * other_b) / (square + share * other_b**2)  # (2.4) for k = 1
        rebound = np.where(np.isnan(self.rebound), rebound_of(edge.alpha), self.rebound)
        computed = np.where(self.side == 0.0, np.maximum(momentum, 0.0), rebound)
        eta = np.where(self.restitution < 0.0, computed, self.restitution) + self.change
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
        return [self, replace(self, rigid=mirror_image(self.rigid), side=-self.side)]

    @property
    def is_lopsided(self) -> Flags:
        """True for a body with its centre of mass not in the middle, or a wall at one side."""
        parameters = self.rigid.parameters
        return np.asarray((parameters["left"] != parameters["right"]) | (self.side != 0.0))

    @property
    def column(self) -> BodyArray:
        """The bodies along the first of two axes."""
        parameters: dict[str, Any] = dict(self.rigid.parameters)
        for name, values in parameters.items():
            if values.ndim:
                parameters[name] = values[..., None]
        columns = [values[:, None] for values in (self.restitution, self.change, self.side, self.rebound)]
        return BodyArray(self.rigid.changed(**parameters), *columns)


def mirror_image(rigid: RigidBody) -> RigidBody:
    """Rigid bodies with left and right exchanged."""
    parameters = rigid.parameters
    return rigid.changed(**{**parameters, "left": parameters["right"], "right": parameters["left"]})
