"""What an assessment takes and gives, declared once: Python, tables, the command and the service derive from it."""

from __future__ import annotations

from rocking._base.quantities import (
    DEPTH,
    DIAMETER,
    FRICTION,
    HEIGHT,
    LENGTH,
    MASS,
    MASS_HEIGHT,
    NAME,
    NOTES,
    NUMBER,
    OFFSET_DEPTH,
    OFFSET_WIDTH,
    PEDESTAL,
    RESTITUTION,
    THICKNESS,
    TOLERANCE,
    WIDTH,
)
from rocking._base.quantity import Quantity
from rocking._dimensional.body_kinds import columns_beside

INPUTS = (
    NAME,
    WIDTH,
    DEPTH,
    DIAMETER,
    HEIGHT,
    MASS_HEIGHT,
    OFFSET_WIDTH,
    OFFSET_DEPTH,
    MASS,
    FRICTION,
    RESTITUTION,
    TOLERANCE,
    PEDESTAL,
    NOTES,
)
"""What an object has."""

STAND_INS = (NUMBER, LENGTH, THICKNESS)  # other columns of tables, which are read as one of these

SHAPES = columns_beside((*INPUTS, *STAND_INS), "inclination", "sides", "rebound")
"""Parameters of kinds of bodies, which an object may have in place of or beside its own dimensions."""

REQUIRED = (("width", "diameter", "left"), ("height", "mass_height"))
"""Columns that the header of a table has, one of each group."""

CLAUSES = {
    "static": "static check: PGA over g b/h",
    "ishiyama": "Ishiyama (1982): the smaller one of PGA and PGV over their lower bounds",
    "asce43": "ASCE 43-05 A.2, best estimate: spectral demand over capacity at alpha, at most PGA over g b/h",
    "circolare_linear": "Circolare 2009 C8A.4.2.3, linear kinematic check with q = 2: PGA/q over g b/h",
    "circolare_nonlinear": "Circolare 2009 C8A.4.2.3, nonlinear kinematic check: S_De(T_s) over 0.4 b",
}
"""Checks by standards and their demand over capacity; a body passes below 1. Spectra are of the motion, which on a
floor is that of the floor."""

OUTPUTS = (
    Quantity("object", "", "name of the object"),
    Quantity("direction", "",
        "along which it rocks: width, depth, any of a round base, the plane of an outline, or an angle from the x axis "
        "of a mesh"),
    Quantity("verdict", "", "stays, rocks, overturns in some motions or overturns in most"),
    Quantity("uplifts", "bool", "whether a motion of the site makes it uplift"),
    Quantity("uplift_acceleration", "m/s2", "peak acceleration from which on it uplifts"),
    Quantity("factor", "-", "lowest factor tried on the motions of the site at which one of them overturns it"),
    Quantity("governing", "", "that motion"),
    Quantity("overturned_by", "", "motions that overturn it at the strength of the site or below"),
    Quantity("share", "-",
        "share of the motions of the site, a pair of components being one, that overturn it at a factor up to 1"),
    Quantity("share_lower", "-", "lower end of the 95 % interval of the share, of a suite of records"),
    Quantity("share_upper", "-", "upper end of it"),
    Quantity("rotation", "rad", "largest rotation under the motions that do not overturn it"),
    Quantity("displacement", "m", "largest movement of its top under them"),
    Quantity("annual_rate", "1/year",
        "annual rate of overturning, where a hazard curve is given that reaches far enough"),
    Quantity("annual_rate_lower", "1/year", "that rate at least"),
    Quantity("annual_rate_upper", "1/year", "that rate at most; not known where the hazard curve begins too high"),
    Quantity("friction_needed", "-", "coefficient of friction that uplift needs"),
    Quantity("slides_first", "bool", "whether it slides before it rocks, by the coefficient of friction that is given"),
    Quantity("slides_under", "",
        "motions that need more friction than that, each from when on, or none; with `sensitivity` while it rocks, "
        "too"),
    Quantity("slides_at", "s", "earliest of these times"),
    Quantity("sliding", "m",
        "largest displacement if it only slides, with the vertical components, where it slides first"),
    Quantity("smallest_width", "m",
        "smallest base at this height from which on no base that was tried is overturned at a factor up to 1"),
    Quantity("largest_height", "m",
        "largest height on this base up to which no height that was tried is overturned so"),
    Quantity("factor_less_restitution", "-", "the factor with a coefficient of restitution lower by 0.05"),
    Quantity("factor_more_restitution", "-", "the factor with one higher by 0.05"),
    Quantity("factor_slenderer", "-", "the factor of a base smaller, and a height larger, by the tolerance"),
    Quantity("factor_stockier", "-", "the factor of a base larger, and a height smaller, by the tolerance"),
    Quantity("sampled_share", "-",
        "share of its variants within tolerance and restitution that a motion overturns at a factor up to 1"),
    *(Quantity(f"{name}_ratio", "-", f"{meaning}; the largest of the motions") for name, meaning in CLAUSES.items()),
    Quantity("warnings", "", "what is in doubt"),
)  # fmt: skip

VERDICTS = ("stays", "rocks", "overturns in some motions", "overturns in most")  # from the best to the worst
CLOSE = 0.2  # distance of a factor from 1 below which a warning is given [-]: a ground motion is not known better
