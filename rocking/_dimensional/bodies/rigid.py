"""Rigid bodies: a rectangle, one with its centre of mass elsewhere, two edges, a cylinder, an outline, a mesh."""

import inspect
import math
from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Annotated, Any

import rocking._base.quantities as q
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.quantity import Quantity

if TYPE_CHECKING:
    from rocking._dimensional.block import Block
    from rocking._dimensional.restrained_block import RestrainedBlock
    from rocking._dimensional.rigid_body import RigidBody

VERTICES = Quantity(
    "vertices", "", "corners x, y of the outline in order, in metres; y is upwards", example="0 0; 0.3 0; 0.3 1.0"
)


def rectangle(
    width: Annotated[float, q.WIDTH],
    height: Annotated[float, q.HEIGHT],
    gravity: Annotated[float, q.GRAVITY] = STANDARD_GRAVITY,
) -> "Block":
    """A rectangular block of uniform density."""
    from rocking._dimensional.block import Block  # noqa: PLC0415

    return Block(width, height, gravity)


TENDON = Quantity("stiffness", "N/m", "stiffness of a vertical tendon along the centre line", symbol="k", lower=0.0,
    closed="left", default=0.0, example="50 kN/m")  # fmt: skip

TENSION = Quantity("prestress", "N", "prestress of the tendon", symbol="P_0", lower=0.0, closed="left", default=0.0,
    example="2 kN")  # fmt: skip

DAMPER = Quantity("damping", "N s/m", "vertical damper at the edge that uplifts", symbol="c", lower=0.0, closed="left",
    default=0.0, example="4 kN s/m")  # fmt: skip


def anchored(
    width: Annotated[float, q.WIDTH],
    height: Annotated[float, q.HEIGHT],
    mass: Annotated[float, q.MASS],
    stiffness: Annotated[float, TENDON] = 0.0,
    prestress: Annotated[float, TENSION] = 0.0,
    damping: Annotated[float, DAMPER] = 0.0,
    gravity: Annotated[float, q.GRAVITY] = STANDARD_GRAVITY,
) -> "RestrainedBlock":
    """A rectangular block with a vertical tendon along its centre line and a damper at the edge that uplifts."""
    block = rectangle(width, height, gravity)
    return block.with_restraint(stiffness=stiffness, prestress=prestress, damping=damping, mass=mass)


def offset_mass(
    width: Annotated[float, q.WIDTH],
    height: Annotated[float, q.HEIGHT],
    offset: Annotated[float, q.OFFSET] = 0.0,
    mass_height: Annotated[float | None, q.MASS_HEIGHT] = None,
    gyration: Annotated[float | None, q.GYRATION] = None,
    gravity: Annotated[float, q.GRAVITY] = STANDARD_GRAVITY,
) -> "Block | RigidBody":
    """A body from its outer dimensions, the place of its centre of mass and its radius of gyration."""
    from rocking._base.errors import number  # noqa: PLC0415
    from rocking._dimensional.rigid_body import RigidBody  # noqa: PLC0415

    if mass_height is not None:
        mass_height = number("mass_height", mass_height, 0.0, q.HEIGHT.number(height), closed="right", unit="m")
    elif gyration is None and not q.OFFSET.number(offset):
        return rectangle(width, height, gravity)
    return RigidBody.from_size(
        width, height, offset=offset, mass_height=mass_height, gyration=gyration, gravity=gravity
    )


def two_edges(
    left: Annotated[float, q.LEFT],
    right: Annotated[float, q.RIGHT],
    mass_height: Annotated[float, q.MASS_HEIGHT],
    gyration: Annotated[float | None, q.GYRATION] = None,
    top_height: Annotated[float | None, q.TOP_HEIGHT] = None,
    inclination: Annotated[float, q.INCLINATION] = 0.0,
    gravity: Annotated[float, q.GRAVITY] = STANDARD_GRAVITY,
) -> "RigidBody":
    """A body from the distances of its edges from the centre of mass, and the height of that."""
    from rocking._dimensional.rigid_body import RigidBody  # noqa: PLC0415

    return RigidBody(
        left, right, mass_height, gyration, inclination=inclination, gravity=gravity, top_height=top_height
    )


def cylinder(
    diameter: Annotated[float, q.DIAMETER],
    height: Annotated[float, q.HEIGHT],
    offset: Annotated[float, q.OFFSET] = 0.0,
    mass_height: Annotated[float | None, q.MASS_HEIGHT] = None,
    gravity: Annotated[float, q.GRAVITY] = STANDARD_GRAVITY,
) -> "Block | RigidBody":
    """A body on a round base, in the planar model, in which it does not wobble or roll."""
    gyration = (0.75 * diameter * diameter + height * height) ** 0.5 / math.sqrt(12.0)
    return offset_mass(diameter, height, offset, mass_height, gyration, gravity)


def outline(vertices: Annotated[Any, VERTICES], gravity: Annotated[float, q.GRAVITY] = STANDARD_GRAVITY) -> "RigidBody":
    """A body of uniform density from its outline, standing on its lowest edge."""
    from rocking._base.errors import InvalidArgumentError  # noqa: PLC0415
    from rocking._dimensional.rigid_body import RigidBody  # noqa: PLC0415

    points = vertices
    if isinstance(vertices, str):
        try:
            points = [[float(one) for one in part.split()] for part in vertices.split(";")]
        except ValueError:
            raise InvalidArgumentError(
                "vertices", vertices, f"pairs x y in metres, such as {VERTICES.example}"
            ) from None
    return RigidBody.from_polygon(points, gravity=gravity)


def with_wall(make: Callable[..., "Block | RigidBody"]) -> Callable[..., "Block | RigidBody"]:
    """The kind with two parameters more, `sides` and `rebound` of `rocking.RigidBody`."""

    def wall(sides: Annotated[str, q.SIDES] = "both", rebound: Annotated[float | None, q.REBOUND] = None) -> None:
        pass

    @wraps(make)
    def made(sides: str = "both", rebound: float | None = None, **others: Any) -> "Block | RigidBody":
        from rocking._dimensional.rigid_body import RigidBody  # noqa: PLC0415

        body = make(**others)
        if sides == "both" and rebound is None:
            return body
        if not isinstance(body, RigidBody):
            body = RigidBody.from_size(body.width, body.height, gravity=body.gravity)
        return body.one_sided(sides, rebound)

    parameters = [one for each in (make, wall) for one in inspect.signature(each).parameters.values()]
    vars(made)["__signature__"] = inspect.Signature(parameters)
    return made
