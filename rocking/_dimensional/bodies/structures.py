"""Structures that rock like a block, `rocking.EquivalentBlock`: frames, arches, bodies on pivots, mechanisms."""

import math
from typing import TYPE_CHECKING, Annotated

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.quantities import ALPHA, FREQUENCY_PARAMETER, GRAVITY, HEIGHT, MASS, RESTITUTION, TOP_HEIGHT, WIDTH
from rocking._base.quantity import Quantity

if TYPE_CHECKING:
    from rocking._dimensional.equivalent_block import EquivalentBlock

MASS_RATIO = Quantity("mass_ratio", "-", "mass of the beam over that of all columns", lower=0.0, closed="left")
RADIUS = Quantity("radius", "m", "radius of the centre line of the arch", lower=0.0, example="5 m")
THICKNESS = Quantity("thickness", "m", "thickness of the voussoirs", lower=0.0, example="60 cm")
EMBRACE = Quantity(
    "embrace", "rad", "angle between the springings", lower=0.0, upper=math.pi, closed="right", example="157 deg"
)
VOUSSOIRS = Quantity("voussoirs", "-", "number of voussoirs", lower=4.0, upper=24.0, closed="both", example="7")
INERTIA = Quantity("inertia", "kg m2", "moment of inertia about the centre of mass", symbol="I", lower=0.0)
BASE = Quantity("base", "m", "distance of the pivots", symbol="2b", lower=0.0)
CENTRE_HEIGHT = Quantity("centre_height", "m", "height of the centre of mass above the pivots", symbol="z", lower=0.0)
UPLIFT_ACCELERATION = Quantity(
    "uplift_acceleration",
    "m/s2",
    "smallest ground acceleration that starts rocking; the equation of motion is then the linear one",
    symbol="g tan(alpha)",
    lower=0.0,
)


def frame(
    width: Annotated[float, WIDTH],
    height: Annotated[float, HEIGHT],
    mass_ratio: Annotated[float, MASS_RATIO],
    gravity: Annotated[float, GRAVITY] = STANDARD_GRAVITY,
) -> "EquivalentBlock":
    """Equal columns of this width and height that carry a rigid beam."""
    from rocking._dimensional.block import Block  # noqa: PLC0415
    from rocking._dimensional.equivalent_block import EquivalentBlock  # noqa: PLC0415

    return EquivalentBlock.rocking_frame(Block(width, height, gravity), mass_ratio=mass_ratio)


def arch(
    radius: Annotated[float, RADIUS],
    thickness: Annotated[float, THICKNESS],
    embrace: Annotated[float, EMBRACE],
    voussoirs: Annotated[int, VOUSSOIRS],
    restitution: Annotated[float | None, RESTITUTION] = None,
    gravity: Annotated[float, GRAVITY] = STANDARD_GRAVITY,
) -> "EquivalentBlock":
    """A circular masonry arch, which opens as a four-bar linkage."""
    from rocking._dimensional.equivalent_block import EquivalentBlock  # noqa: PLC0415

    return EquivalentBlock.masonry_arch(
        radius=radius,
        thickness=thickness,
        embrace=embrace,
        voussoirs=voussoirs,
        restitution=restitution,
        gravity=gravity,
    )


def on_pivots(
    mass: Annotated[float, MASS],
    inertia: Annotated[float, INERTIA],
    base: Annotated[float, BASE],
    centre_height: Annotated[float, CENTRE_HEIGHT],
    top_height: Annotated[float | None, TOP_HEIGHT] = None,
    gravity: Annotated[float, GRAVITY] = STANDARD_GRAVITY,
) -> "EquivalentBlock":
    """A symmetric rigid body of any shape on two pivots."""
    from rocking._dimensional.equivalent_block import EquivalentBlock  # noqa: PLC0415

    return EquivalentBlock.rigid_body(
        mass=mass, inertia=inertia, base=base, centre_height=centre_height, top_height=top_height, gravity=gravity
    )


def structure(
    alpha: Annotated[float, ALPHA],
    frequency_parameter: Annotated[float, FREQUENCY_PARAMETER],
    restitution: Annotated[float, RESTITUTION],
    uplift_acceleration: Annotated[float | None, UPLIFT_ACCELERATION] = None,
    top_height: Annotated[float | None, TOP_HEIGHT] = None,
    gravity: Annotated[float, GRAVITY] = STANDARD_GRAVITY,
) -> "EquivalentBlock":
    """Any structure that rocks like a block of this slenderness angle and frequency parameter."""
    from rocking._dimensional.equivalent_block import EquivalentBlock  # noqa: PLC0415

    return EquivalentBlock(
        alpha,
        frequency_parameter,
        restitution=restitution,
        uplift_acceleration=uplift_acceleration,
        gravity=gravity,
        top_height=top_height,
    )
