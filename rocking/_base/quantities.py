"""The quantities that people state, declared once: of the groups, bodies, motions, objects and sites.

Those of one kind of body or one family of pulses are in the file of that kind.
"""

from __future__ import annotations

import math

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.quantity import Quantity

# fmt: off
# The groups of a response

SLENDERNESS = Quantity("slenderness", "-", "slenderness (depends on the motion, unlike h/b)",
    symbol="g tan(alpha)/a_g = 1/a", lower=1e-12, closed="left")
"""From 1 on the block does not uplift. The lower end is an acceleration of 1e12 g tan(alpha)."""

FREQUENCY_RATIO = Quantity("frequency_ratio", "-", "frequency ratio", symbol="omega_g/p", lower=1e-9, upper=1e9,
    closed="both")

FREQUENCY_PARAMETER = Quantity("frequency_parameter", "rad/s", "frequency parameter", symbol="p", lower=1e-6, upper=1e6,
    closed="both")
"""Of a block under a recorded motion, whose time is in seconds."""

RESTITUTION = Quantity("restitution", "-", "coefficient of restitution", symbol="eta", lower=0.0, upper=1.0,
    closed="both", default="momentum", words=("momentum", "kalliontzis"))
"""`momentum`: from the conservation of angular momentum, (2.4) for a block, 0 where that is negative;
`kalliontzis(k=0.8)`: the same with the impact at that share of the half base."""

ALPHA = Quantity("alpha", "rad", "slenderness angle (slender limit without)", symbol="alpha", lower=0.0, upper=1.57,
    closed="both", example="20 deg")
"""Values between 0 and `SMALLEST_ALPHA` are not accepted. At pi/2 tan(alpha) is infinite."""

SMALLEST_ALPHA = 1e-12  # smallest slenderness angle of (2.2) [rad]

RELATIVE_TOLERANCE = Quantity("relative_tolerance", "-", "relative error of the peak that you accept for speed",
    lower=1e-13, upper=1e-3, closed="both")
"""Of `peak_response`. `absolute_tolerance` is of an interpolated response, see `rocking._lookup.cube`."""

GROUPS = (SLENDERNESS, FREQUENCY_RATIO, RESTITUTION, ALPHA)
"""The dimensionless groups of a response, in the order of the arguments."""

STIFFNESS = Quantity("stiffness", "-", "stiffness of a vertical tendon along the centre line",
    symbol="kappa = k b^2/(m g R)", lower=0.0, upper=1e4, closed="both", default=0.0)

PRESTRESS = Quantity("prestress", "-", "prestress of the tendon over the weight", symbol="sigma = P_0/(m g)", lower=0.0,
    upper=1e4, closed="both", default=0.0)

DAMPING = Quantity("damping", "-", "damping by a vertical damper at the edge that uplifts",
    symbol="zeta = (3/2) (b/R)^2 c/(m p)", lower=0.0, upper=10.0, closed="both", default=0.0)

RESTRAINTS = (STIFFNESS, PRESTRESS, DAMPING)
"""The dimensionless groups of a restraint, 0 of a free block; `rocking.restraint` has their formulas."""

# Motions

PEAK_ACCELERATION = Quantity("peak_acceleration", "m/s2", "peak acceleration of the pulse", symbol="a_g", lower=0.0,
    example="0.4g")

PERIOD = Quantity("period", "s", "period of the pulse; a half sine or rectangular pulse lasts half of it",
    symbol="T_p = 2 pi/omega_g", lower=0.0, example="0.5s")

HIGHEST_SCALE = 1e6  # largest factor of a record [-]

SCALE = Quantity("scale", "-", "factor of the record, of its vertical component too", lower=0.0, upper=HIGHEST_SCALE,
    closed="right", default=1.0)

TIME_STEP = Quantity("time_step", "s", "time step of the samples", symbol="dt", lower=0.0, example="0.01s")

# Bodies

NAME = Quantity("name", "", "name of the object")

WIDTH = Quantity("width", "m", "width of the base", symbol="2b", lower=0.0, example="0.4m")

HEIGHT = Quantity("height", "m", "height of the object", symbol="2h", lower=0.0, example="160 cm")

DEPTH = Quantity("depth", "m", "depth of the base", lower=0.0, example="30 cm")

DIAMETER = Quantity("diameter", "m", "diameter of a round base", lower=0.0, example="30 cm")

OFFSET = Quantity("offset", "m", "distance of the centre of mass from the middle of the width, positive to the right",
    default=0.0, example="5 cm")

OFFSET_WIDTH = Quantity("offset_width", "m", "centre of mass from the middle of the width", default=0.0)

OFFSET_DEPTH = Quantity("offset_depth", "m", "centre of mass from the middle of the depth", default=0.0)

MASS_HEIGHT = Quantity("mass_height", "m", "height of the centre of mass above the base; by default half of the height",
    symbol="h", lower=0.0, example="70 cm")

GYRATION = Quantity("gyration", "m",
    "radius of gyration about the centre of mass; by default that of the uniform rectangle", symbol="r", lower=0.0,
    example="45 cm")

LEFT = Quantity("left", "m", "distance of the centre of mass from the left edge along the base", lower=0.0,
    example="12 cm")

RIGHT = Quantity("right", "m", "distance of the centre of mass from the right edge along the base", lower=0.0,
    example="18 cm")

TOP_HEIGHT = Quantity("top_height", "m",
    "height above the base of the point whose displacement is given; by default twice that of the centre of mass",
    lower=0.0, example="80 cm")

INCLINATION = Quantity("inclination", "rad", "angle by which the base is inclined towards the right",
    lower=-math.pi / 2, upper=math.pi / 2, default=0.0, example="2 deg")

SIDES = Quantity("sides", "",
    "edges about which it rocks: both, or left or right where a wall stops it at the other side", example="right")

START = Quantity("start", "rad", "rotation from which the body is released at rest, in place of a pulse",
    symbol="theta_0", lower=-math.pi / 2, upper=math.pi / 2, example="3deg")

REBOUND = Quantity("rebound", "-", "velocity after a rebound from the wall over the one before, without its sign",
    symbol="e", lower=0.0, upper=1.0, closed="both")

GRAVITY = Quantity("gravity", "m/s2", "acceleration of gravity", symbol="g", lower=0.0, default=STANDARD_GRAVITY)

MASS = Quantity("mass", "kg", "mass, or the weight of it; not needed for the outcome", symbol="m", lower=0.0,
    example="45 kg")

FRICTION = Quantity("friction", "-", "coefficient of friction at the base", symbol="mu", lower=0.0, upper=10.0,
    closed="right")

TOLERANCE = Quantity("tolerance", "m", "uncertainty of the dimensions, up and down", lower=0.0, closed="left",
    default=0.0)

PEDESTAL = Quantity("pedestal", "", "what the object stands on")

NOTES = Quantity("notes", "", "anything else")

# Sites

PGA = Quantity("pga", "m/s2", "peak ground acceleration; records are scaled to it", symbol="PGA", lower=0.0,
    example="0.3g")

PGV = Quantity(
    "pgv", "m/s", "peak ground velocity: each pulse has this one", symbol="PGV", lower=0.0, example="0.3 m/s"
)
