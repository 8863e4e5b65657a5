"""The parameters of a rocking problem, declared once: name, symbol, unit, range and meaning.

The checks of the library (`rocking._model.checks`), the help of the command line and the description of the HTTP
service derive from these declarations.
"""

import math

from rocking._base.parameter import Parameter

SLENDERNESS = Parameter(
    "slenderness",
    "g tan(alpha)/a_g = 1/a",
    "-",
    1e-12,
    math.inf,
    "left",
    "slenderness (depends on the motion, unlike h/b)",
)
"""From 1 on the block does not uplift. The lower end is an acceleration of 1e12 g tan(alpha)."""

FREQUENCY_RATIO = Parameter("frequency_ratio", "omega_g/p", "-", 1e-9, 1e9, "both", "frequency ratio")

FREQUENCY_PARAMETER = Parameter("frequency_parameter", "p", "rad/s", 1e-6, 1e6, "both", "frequency parameter")
"""Of a block under a recorded motion, whose time is in seconds."""

RESTITUTION = Parameter("restitution", "eta", "-", 0.0, 1.0, "both", "coefficient of restitution")

ALPHA = Parameter("alpha", "alpha", "rad", 0.0, 1.57, "both", "slenderness angle (slender limit without)")
"""Values between 0 and `SMALLEST_ALPHA` are not accepted. At pi/2 tan(alpha) is infinite."""

SMALLEST_ALPHA = 1e-12  # smallest slenderness angle of (2.2) [rad]

RELATIVE_TOLERANCE = Parameter(
    "relative_tolerance", "", "-", 1e-13, 1e-3, "both", "relative error of the peak allowed for speed"
)
"""Of `peak_response`. `absolute_tolerance` is of an interpolated response, see `rocking._lookup.cube`."""

GROUPS = (SLENDERNESS, FREQUENCY_RATIO, RESTITUTION, ALPHA)
"""The dimensionless groups of a response, in the order of the arguments."""
