"""Bodies of several parts that move as one: a hollow box, an object on its pedestal."""

import math
from typing import TYPE_CHECKING, Annotated

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.quantities import DEPTH, GRAVITY, HEIGHT, WIDTH
from rocking._base.quantity import Quantity

if TYPE_CHECKING:
    from rocking._dimensional.rigid_body import RigidBody

WALL = Quantity("wall", "m", "thickness of the walls of a hollow box", lower=0.0, example="2 cm")
PEDESTAL_WIDTH = Quantity("pedestal_width", "m", "width of the pedestal", lower=0.0, example="60 cm")
PEDESTAL_HEIGHT = Quantity("pedestal_height", "m", "height of the pedestal", lower=0.0, example="90 cm")
PEDESTAL_MASS = Quantity(
    "pedestal_mass", "-", "mass of the pedestal over that of the object on it", lower=0.0, example="2.5"
)


def hollow(
    width: Annotated[float, WIDTH],
    height: Annotated[float, HEIGHT],
    wall: Annotated[float, WALL],
    depth: Annotated[float | None, DEPTH] = None,
    gravity: Annotated[float, GRAVITY] = STANDARD_GRAVITY,
) -> "RigidBody":
    """A closed box of uniform walls; without a depth that of a long tube, whose ends do not count."""
    import numpy as np  # noqa: PLC0415

    from rocking._base.errors import InvalidArgumentError  # noqa: PLC0415
    from rocking._dimensional.rigid_body import RigidBody  # noqa: PLC0415

    inner = [one - 2.0 * wall for one in (width, height, *([] if depth is None else [depth]))]
    if any(np.any(np.asarray(one) <= 0.0) for one in inner):
        raise InvalidArgumentError("wall", wall, "less than half of each dimension")
    outer_mass = width * height * (1.0 if depth is None else depth)
    inner_mass = math.prod(inner)
    square = outer_mass * (width**2 + height**2) - inner_mass * (inner[0] ** 2 + inner[1] ** 2)
    gyration = (square / (12.0 * (outer_mass - inner_mass))) ** 0.5
    return RigidBody.from_size(width, height, gyration=gyration, gravity=gravity)


def on_pedestal(
    width: Annotated[float, WIDTH],
    height: Annotated[float, HEIGHT],
    pedestal_width: Annotated[float, PEDESTAL_WIDTH],
    pedestal_height: Annotated[float, PEDESTAL_HEIGHT],
    pedestal_mass: Annotated[float, PEDESTAL_MASS],
    gravity: Annotated[float, GRAVITY] = STANDARD_GRAVITY,
) -> "RigidBody":
    """A rectangular object fixed on a rectangular pedestal, both of uniform density, that rock together."""
    from rocking._dimensional.rigid_body import RigidBody  # noqa: PLC0415

    share = pedestal_mass / (1.0 + pedestal_mass)
    low, high = 0.5 * pedestal_height, pedestal_height + 0.5 * height
    centre = share * low + (1.0 - share) * high
    own = share * (pedestal_width**2 + pedestal_height**2) + (1.0 - share) * (width**2 + height**2)
    apart = share * (centre - low) ** 2 + (1.0 - share) * (high - centre) ** 2
    return RigidBody.from_size(
        pedestal_width,
        pedestal_height + height,
        mass_height=centre,
        gyration=(own / 12.0 + apart) ** 0.5,
        gravity=gravity,
    )
