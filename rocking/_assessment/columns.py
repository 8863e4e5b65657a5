"""What an assessment takes and gives, declared once: Python, tables, the command and the service derive from it."""

from __future__ import annotations

from rocking._base.column import Column
from rocking._dimensional.table_header import HEIGHT, NAME, NUMBER, RESTITUTION, WIDTH

INPUTS = (
    NAME,
    WIDTH,
    Column(
        "depth",
        "m",
        "depth of the base",
        (
            *("d", "base depth", "depth of base", "depth of the base", "tiefe", "profondita", "profondeur", "p"),
            *("profundidad", "profundidade", "diepte", "vathos", "\u03b2\u03b1\u03b8\u03bf\u03c2"),
        ),
        absent_beside=("diameter",),
    ),
    Column(
        "diameter",
        "m",
        "diameter of a round base",
        (
            *("dia", "diam", "base diameter", "diameter base", "diameter of base", "diameter of the base"),
            *(
                "durchmesser",
                "diametro",
                "diametre",
                "diametros",
                "\u03b4\u03b9\u03b1\u03bc\u03b5\u03c4\u03c1\u03bf\u03c2",
            ),
        ),
        absent_beside=("width",),
    ),
    HEIGHT,
    Column(
        "mass_height",
        "m",
        "height of the centre of mass above the base; by default half of the height",
        (
            *("height of the centre of mass", "height of the center of mass", "centre of mass height"),
            *("center of mass height", "cg height", "com height", "schwerpunkthohe", "altezza del baricentro"),
            *("hauteur du centre de masse", "altura del centro de masa"),
        ),
    ),
    Column(
        "offset_width", "m", "centre of mass from the middle of the width", ("offset", "offset x", "eccentricity x")
    ),
    Column("offset_depth", "m", "centre of mass from the middle of the depth", ("offset y", "eccentricity y")),
    Column(
        "mass",
        "kg",
        "mass, or the weight of it; not needed for the outcome",
        (
            *("weight", "masse", "gewicht", "massa", "peso", "maza", "varos", "poids"),
            *("\u03bc\u03b1\u03b6\u03b1", "\u03b2\u03b1\u03c1\u03bf\u03c2"),
        ),
        absent_beside=("height",),
        assumed="kg",
    ),
    Column(
        "friction",
        "-",
        "coefficient of friction at the base",
        (
            *("friction coefficient", "coefficient of friction", "mu", "reibung", "reibungskoeffizient"),
            *("reibungszahl", "haftreibung", "attrito", "coefficiente di attrito", "frottement", "friccion", "trivi"),
            *("coefficient de frottement", "coeficiente de friccion", "\u03bc", "\u03c4\u03c1\u03b9\u03b2\u03b7"),
        ),
        highest=10.0,
    ),
    RESTITUTION,
    Column("tolerance", "m", "how far the dimensions are uncertain", ("dimension tolerance", "toleranz", "tolleranza")),
    Column("pedestal", "", "what the object stands on", ("sockel", "piedistallo", "socle", "pedestal type", "vathro")),
    Column(
        "notes",
        "",
        "anything else",
        (
            *("note", "remark", "remarks", "comment", "comments", "bemerkung", "bemerkungen", "anmerkungen"),
            *("osservazioni", "remarques", "notas", "observaciones", "simeioseis", "material", "location", "room"),
        ),
        joined=True,
    ),
)
"""What an object has."""

STAND_INS = (
    NUMBER,
    Column(
        "length",
        "m",
        "horizontal length: the depth beside a width, otherwise the width",
        (
            *("l", "base length", "length of base", "lange", "laenge", "longueur", "lunghezza", "largo", "longitud"),
            *("comprimento", "lengte", "mikos", "\u03bc\u03b7\u03ba\u03bf\u03c2"),
        ),
        stands_for=("width", "depth"),
    ),
    Column(
        "thickness",
        "m",
        "thickness: the depth beside a width",
        (
            *("thick", "thk", "t", "dicke", "starke", "staerke", "spessore", "epaisseur", "e", "espesor", "grosor"),
            *("espessura", "dikte", "pachos", "\u03c0\u03b1\u03c7\u03bf\u03c2"),
        ),
        stands_for=("depth",),
    ),
)
"""Other columns of tables, which are read as one of these."""

REQUIRED = (("width", "diameter"), ("height",))
"""Columns that the header of a table has, one of each group."""

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
    Column(
        "sliding",
        "m",
        "largest displacement if it only slides, with the vertical components, where it slides first",
    ),
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

CLOSE = 0.2
"""Distance of a factor from 1 below which a warning is given [-]: a ground motion is not known better."""
