"""Inputs and outputs of an assessment, declared once: Python, tables, the command and the service derive from it."""

from __future__ import annotations

from rocking.extension import (
    DEPTH,
    DIAMETER,
    FRICTION,
    HEIGHT,
    MASS,
    MASS_HEIGHT,
    NAME,
    NOTES,
    OFFSET_DEPTH,
    OFFSET_WIDTH,
    PEDESTAL,
    RESTITUTION,
    TOLERANCE,
    WIDTH,
    Quantity,
    columns_beside,
)

INPUTS = (
    *(NAME, WIDTH, DEPTH, DIAMETER, HEIGHT, MASS_HEIGHT, OFFSET_WIDTH, OFFSET_DEPTH),
    *(MASS, FRICTION, RESTITUTION, TOLERANCE, PEDESTAL, NOTES),
)
"""What an object has."""

SHAPES = columns_beside(INPUTS, "inclination", "offset")
"""Parameters of kinds of bodies that an object may have in place of or beside its own dimensions."""

CLAUSES = {
    "static": "static check: PGA over g b/h",
    "ishiyama": "Ishiyama (1982): PGA and PGV over their lower bounds, the smaller ratio",
    "asce43": "ASCE 43-05 A.2, best estimate: spectral demand over capacity at alpha, at most PGA over g b/h",
    "circolare_linear":
        "Circolare 2009 C8A.4.2.3 and 2019 C8.7.1.2.1.7, linear kinematic check with q = 2: PGA/q over g b/h",
    "circolare_nonlinear": "Circolare 2009 C8A.4.2.3, nonlinear kinematic check: S_De(T_s) over 0.4 b",
    "circolare2019_nonlinear":
        "Circolare 2019 C8.7.1.2.1.8, check of SLV in displacements: largest S_De up to T_SLV over 0.4 b, at most PGA "
        "over g b/h",
}  # fmt: skip
"""Checks by standards and their demand over capacity; a body passes below 1. Spectra are those of the motion of the
ground, or of the floor on which the body stands; by the Circolare a body on a floor passes under both."""

OUTPUTS = (
    Quantity("object", "", "name of the object"),
    Quantity("direction", "",
        "direction in which it rocks: width, depth, any (round base), the plane of an outline, or the angle from the x "
        "axis of a mesh"),
    Quantity("verdict", "",
        "stays, rocks, depth missing (along its width alone it does not overturn), overturns in some motions or "
        "overturns in most"),
    Quantity("uplifts", "bool", "whether a motion of the site makes it uplift"),
    Quantity("uplift_acceleration", "m/s2", "peak acceleration above which it uplifts"),
    Quantity("factor", "-", "lowest factor tried at which a motion of the site overturns it"),
    Quantity("governing", "", "motion that overturns it at that factor"),
    Quantity("overturned_by", "", "motions that overturn it, at full strength or only at a lower factor"),
    Quantity("overturned_at_full_strength", "", "those of them that overturn it at full strength, a factor of 1"),
    Quantity("share", "-",
        "share of the motions of the site that overturn it, at full strength or only at a lower factor; a pair of "
        "components counts once"),
    Quantity("share_at_full_strength", "-", "share of them that overturn it at full strength, a factor of 1"),
    Quantity("share_lower", "-", "lower end of the 95 % interval of the share, for records"),
    Quantity("share_upper", "-", "upper end of that interval"),
    Quantity("rotation", "rad", "largest rotation under the motions that do not overturn it"),
    Quantity("displacement", "m", "largest movement of its top under these motions"),
    Quantity("annual_rate", "1/year",
        "annual rate of overturning, if a hazard curve is given and reaches far enough"),
    Quantity("annual_rate_lower", "1/year", "lower bound of the annual rate"),
    Quantity("annual_rate_upper", "1/year",
        "upper bound of the annual rate; not known where the hazard curve begins too high"),
    Quantity("friction_needed", "-", "coefficient of friction that uplift needs"),
    Quantity("slides_first", "bool", "whether, with its coefficient of friction, it slides before it rocks"),
    Quantity("slides_under", "",
        "motions that need more friction than it has, each with the first time, or none; with `sensitivity` also those "
        "that do so only while it rocks"),
    Quantity("slides_at", "s", "earliest of these times"),
    Quantity("sliding", "m",
        "largest displacement where it slides first and then only slides; vertical components count"),
    Quantity("smallest_width", "m",
        "smallest base at this height that survives up to a factor of 1, of those down to an eighth of one without "
        "uplift; all wider ones that were tried survive too"),
    Quantity("largest_height", "m",
        "largest height on this base that survives up to a factor of 1, of those up to eight times one without uplift; "
        "all lower ones that were tried survive too"),
    Quantity("factor_less_restitution", "-", "factor with a restitution 0.05 lower"),
    Quantity("factor_more_restitution", "-", "factor with a restitution 0.05 higher"),
    Quantity("factor_slenderer", "-", "factor with the base smaller and the height larger by the tolerance"),
    Quantity("factor_stockier", "-", "factor with the base larger and the height smaller by the tolerance"),
    Quantity("sampled_share", "-",
        "share of its variants (tolerance, restitution 0.05 up and down) that a motion overturns at a factor up to 1"),
    *(Quantity(f"{name}_ratio", "-", f"{meaning}; the largest of the motions") for name, meaning in CLAUSES.items()),
    Quantity("contact_tolerance", "m",
        "of a mesh: height above its lowest point up to which vertices are in contact with the ground"),
    Quantity("warnings", "", "reasons to doubt the row"),
)  # fmt: skip

DEPTH_MISSING = "depth missing"
"""Verdict of an object that does not overturn along its width, the only direction that is known."""

VERDICTS = ("stays", "rocks", DEPTH_MISSING, "overturns in some motions", "overturns in most")
"""From the best to the worst."""

CLOSE = 0.2  # distance of a factor from 1 below which a warning is given [-]: a ground motion is not known better

RESTS_AT_FULL_STRENGTH = "comes to rest at full strength under a motion that overturns it at a lower factor"
"""Beginning of the warning of an object whose outcome at a factor of 1 differs from that at a lower factor."""


def digits_apart(value: float) -> int:
    """Significant digits of a factor or ratio, 3 or more, so that it is written as 1 only if it equals 1.

    Otherwise a body that a factor of 1.0035 overturns would be said to overturn "from 1" with the verdict "rocks".
    """
    digits = 3
    while digits < 17 and value != 1.0 and float(f"{value:.{digits}g}") == 1.0:
        digits += 1
    return digits
