"""What an assessment takes and gives, declared once: Python, tables, the command and the service derive from it."""

from __future__ import annotations

from rocking._dimensional.table_reader import HEIGHT, NAME, RESTITUTION, WIDTH, Column

INPUTS = (
    NAME,
    WIDTH,
    Column(
        "depth", "m", "depth of the base", ("d", "tiefe", "profondita", "profondeur", "fondo", "profundidad", "vathos")
    ),
    Column("diameter", "m", "diameter of a round base", ("dia", "durchmesser", "diametro", "diametre", "diametros")),
    HEIGHT,
    Column(
        "mass_height",
        "m",
        "height of the centre of mass above the base; by default half of the height",
        (
            *(
                "height of the centre of mass",
                "centre of mass height",
                "center of mass height",
                "cg height",
                "com height",
            ),
            *("schwerpunkthohe", "altezza del baricentro", "hauteur du centre de masse", "altura del centro de masa"),
        ),
    ),
    Column(
        "offset_width", "m", "centre of mass from the middle of the width", ("offset", "offset x", "eccentricity x")
    ),
    Column("offset_depth", "m", "centre of mass from the middle of the depth", ("offset y", "eccentricity y")),
    Column(
        "mass",
        "kg",
        "mass; not needed for the outcome",
        ("weight", "masse", "gewicht", "massa", "peso", "maza", "poids"),
    ),
    Column(
        "friction",
        "-",
        "coefficient of friction at the base",
        (
            "friction coefficient",
            "coefficient of friction",
            "mu",
            "reibung",
            "reibungskoeffizient",
            "attrito",
            "frottement",
            "friccion",
            "trivi",
        ),
    ),
    RESTITUTION,
    Column("tolerance", "m", "how far the dimensions are uncertain", ("dimension tolerance", "toleranz", "tolleranza")),
    Column("pedestal", "", "what the object stands on", ("sockel", "piedistallo", "socle", "pedestal type", "vathro")),
    Column(
        "notes",
        "",
        "anything else",
        (
            "note",
            "remarks",
            "comment",
            "comments",
            "bemerkung",
            "bemerkungen",
            "anmerkungen",
            "osservazioni",
            "remarques",
            "notas",
            "observaciones",
            "simeioseis",
            "material",
            "location",
            "room",
        ),
    ),
)

OUTPUTS = (
    Column("object", "", "name of the object"),
    Column(
        "direction",
        "",
        "along which it rocks: width, depth, any of a round base, the plane of an outline, or an angle from the x axis "
        "of a mesh",
    ),
    Column("verdict", "", "stays, rocks, overturns in some motions or overturns in most"),
    Column("uplifts", "bool", "whether a motion of the site makes it uplift"),
    Column("uplift_acceleration", "m/s2", "peak acceleration from which on it uplifts"),
    Column("factor", "-", "lowest factor tried on the motions of the site at which one of them overturns it"),
    Column("governing", "", "that motion"),
    Column("overturned_by", "", "motions that overturn it at the strength of the site or below"),
    Column(
        "share",
        "-",
        "share of the motions of the site, a pair of components being one, that overturn it at a factor up to 1",
    ),
    Column("share_lower", "-", "lower end of the 95 % interval of the share, of a suite of records"),
    Column("share_upper", "-", "upper end of it"),
    Column("rotation", "rad", "largest rotation under the motions that do not overturn it"),
    Column("displacement", "m", "largest movement of its top under them"),
    Column(
        "annual_rate", "1/year", "annual rate of overturning, where a hazard curve is given that reaches far enough"
    ),
    Column("annual_rate_lower", "1/year", "that rate at least"),
    Column("annual_rate_upper", "1/year", "that rate at most; not known where the hazard curve begins too high"),
    Column("friction_needed", "-", "coefficient of friction that uplift needs"),
    Column("slides_first", "bool", "whether it slides before it rocks, by the coefficient of friction that is given"),
    Column(
        "slides_under",
        "",
        "motions that need more friction than that, each from when on, or none; with `sensitivity` while it rocks, too",
    ),
    Column("slides_at", "s", "earliest of these times"),
    Column("sliding", "m", "displacement if it only slides, where it slides first; the other bound"),
    Column(
        "smallest_width",
        "m",
        "smallest base at this height from which on no base that was tried is overturned at a factor up to 1",
    ),
    Column("largest_height", "m", "largest height on this base up to which no height that was tried is overturned so"),
    Column("factor_less_restitution", "-", "the factor with a coefficient of restitution lower by 0.05"),
    Column("factor_more_restitution", "-", "the factor with one higher by 0.05"),
    Column("factor_slenderer", "-", "the factor of a base smaller, and a height larger, by the tolerance"),
    Column("factor_stockier", "-", "the factor of a base larger, and a height smaller, by the tolerance"),
    Column(
        "sampled_share",
        "-",
        "share of its variants within tolerance and restitution that a motion overturns at a factor up to 1",
    ),
    Column("warnings", "", "what is in doubt"),
)

VERDICTS = ("stays", "rocks", "overturns in some motions", "overturns in most")
"""From the best to the worst."""
