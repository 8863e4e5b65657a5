"""The quantities that people state, declared once: of the groups, bodies, motions, objects and sites.

Those of one kind of body or one family of pulses are in the file of that kind. Names in headers are those that people
write in English, German, Italian, French, Spanish, Portuguese, Dutch and Greek.
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
    closed="both", default="momentum", words=("momentum", "kalliontzis"),
    aliases="coefficient of restitution, restitution coefficient, eta, cor, stosszahl, restituzione, restitucion, "
    "\u03b7")
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
    example="0.4g",
    aliases="pga, a g, peak ground acceleration, acceleration, beschleunigung, accelerazione, aceleracion")

PERIOD = Quantity("period", "s", "period of the pulse; a half sine or rectangular pulse lasts half of it",
    symbol="T_p = 2 pi/omega_g", lower=0.0, example="0.5s", aliases="t p, tp, t, periode, periodo")

HIGHEST_SCALE = 1e6  # largest factor of a record [-]

SCALE = Quantity("scale", "-", "factor of the record, of its vertical component too", lower=0.0, upper=HIGHEST_SCALE,
    closed="right", default=1.0)

TIME_STEP = Quantity("time_step", "s", "time step of the samples", symbol="dt", lower=0.0, example="0.01s")

# Bodies

NAME = Quantity("name", "", "name of the object",
    aliases="object, object name, title, item, bezeichnung, objekt, titel, nome, oggetto, titolo, nom, objet, "
    "designation, titre, nombre, objeto, titulo, onoma, antikeimeno, "
    "\u03bf\u03bd\u03bf\u03bc\u03b1, \u03b1\u03bd\u03c4\u03b9\u03ba\u03b5\u03b9\u03bc\u03b5\u03bd\u03bf")

NUMBER = Quantity("number", "", "inventory number, the name of an object without another one",
    aliases="inventory number, inventory no, inv number, inv no, inv nr, inventarnummer, inventario, object number, "
    "object id, objectnumber, objectid, identifier, object identifier, idno, accession number, accession no, "
    "catalogue number, catalog number, numero di inventario, "
    "numero d inventaire, numero de inventario, id, no, nr, #", stands_for=("name",))
"""Read where a table has no names."""

WIDTH = Quantity("width", "m", "width of the base", symbol="2b", lower=0.0, example="0.4m",
    aliases="w, b, breadth, base width, width of base, width of the base, breite, larghezza, largeur, ancho, anchura, "
    "largura, breedte, platos, \u03c0\u03bb\u03b1\u03c4\u03bf\u03c2, \u5e45, 2b", absent_beside=("diameter",))

HEIGHT = Quantity("height", "m", "height of the object", symbol="2h", lower=0.0, example="160 cm",
    aliases="h, overall height, total height, hohe, hoehe, gesamthohe, altezza, hauteur, alto, altura, hoogte, ypsos, "
    "\u03c5\u03c8\u03bf\u03c2, \u9ad8\u3055, 2h")

HALF_WIDTH = Quantity("half_width", "m", "half of the width of the base", symbol="b", times=2.0, stands_for=("width",),
    aliases="half base, half base width, half breadth, halbe breite")

HALF_HEIGHT = Quantity("half_height", "m", "half of the height", symbol="h", times=2.0, stands_for=("height",),
    aliases="halbe hohe, halbe hoehe")

DEPTH = Quantity("depth", "m", "depth of the base", lower=0.0, example="30 cm",
    aliases="d, base depth, depth of base, depth of the base, tiefe, profondita, profondeur, p, profundidad, "
    "profundidade, diepte, vathos, \u03b2\u03b1\u03b8\u03bf\u03c2, \u5965\u884c, \u5965\u884c\u304d",
    absent_beside=("diameter",))

DIAMETER = Quantity("diameter", "m", "diameter of a round base", lower=0.0, example="30 cm",
    aliases="dia, diam, base diameter, diameter base, diameter of base, diameter of the base, durchmesser, diametro, "
    "diametre, diametre base, diametre de la base, \u76f4\u5f84, diametros, "
    "\u03b4\u03b9\u03b1\u03bc\u03b5\u03c4\u03c1\u03bf\u03c2", absent_beside=("width",))

LENGTH = Quantity("length", "m", "horizontal length: the depth beside a width, otherwise the width",
    aliases="l, base length, length of base, lange, laenge, longueur, lunghezza, largo, longitud, comprimento, lengte, "
    "mikos, \u03bc\u03b7\u03ba\u03bf\u03c2", stands_for=("width", "depth"))

THICKNESS = Quantity("thickness", "m", "thickness: the depth beside a width",
    aliases="thick, thk, t, dicke, starke, staerke, spessore, epaisseur, e, espesor, grosor, espessura, dikte, pachos, "
    "\u03c0\u03b1\u03c7\u03bf\u03c2", stands_for=("depth",))

OFFSET = Quantity("offset", "m", "distance of the centre of mass from the middle of the width, positive to the right",
    default=0.0, example="5 cm")

OFFSET_WIDTH = Quantity("offset_width", "m", "centre of mass from the middle of the width", default=0.0,
    aliases="offset, offset x, eccentricity x")

OFFSET_DEPTH = Quantity("offset_depth", "m", "centre of mass from the middle of the depth", default=0.0,
    aliases="offset y, eccentricity y")

MASS_HEIGHT = Quantity("mass_height", "m", "height of the centre of mass above the base; by default half of the height",
    symbol="h", lower=0.0, example="70 cm",
    aliases="height of the centre of mass, height of the center of mass, centre of mass height, center of mass height, "
    "cg height, com height, schwerpunkthohe, altezza del baricentro, hauteur du centre de masse, "
    "altura del centro de masa")

GYRATION = Quantity("gyration", "m",
    "radius of gyration about the centre of mass; by default that of the uniform rectangle", symbol="r", lower=0.0,
    example="45 cm",
    aliases="radius of gyration, tragheitsradius, raggio di inerzia, rayon de giration, radio de giro")

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
    example="45 kg", aliases="weight, masse, gewicht, massa, peso, maza, varos, poids, \u03bc\u03b1\u03b6\u03b1, "
    "\u03b2\u03b1\u03c1\u03bf\u03c2", absent_beside=("height",), assumed="kg")

FRICTION = Quantity("friction", "-", "coefficient of friction at the base", symbol="mu", lower=0.0, upper=10.0,
    closed="right",
    aliases="friction coefficient, coefficient of friction, static friction, coefficient of static friction, "
    "static friction coefficient, friction coeff, coeff of friction, cof, mu, mu s, reibung, reibungskoeffizient, "
    "reibungszahl, reibbeiwert, haftreibung, attrito, coefficiente di attrito, frottement, friccion, trivi, "
    "coefficient de frottement, coeficiente de friccion, coeficiente de atrito, \u03bc, \u03bc s, "
    "\u03c4\u03c1\u03b9\u03b2\u03b7, \u6469\u64e6\u4fc2\u6570")

TOLERANCE = Quantity("tolerance", "m", "uncertainty of the dimensions, up and down", lower=0.0, closed="left",
    default=0.0, aliases="dimension tolerance, toleranz, tolleranza")

PEDESTAL = Quantity("pedestal", "", "what the object stands on",
    aliases="sockel, piedistallo, socle, pedestal type, vathro")

NOTES = Quantity("notes", "", "anything else",
    aliases="note, remark, remarks, comment, comments, bemerkung, bemerkungen, anmerkungen, osservazioni, remarques, "
    "notas, observaciones, simeioseis, material, location, room", joined=True)

# Sites

PGA = Quantity("pga", "m/s2", "peak ground acceleration; records are scaled to it", symbol="PGA", lower=0.0,
    example="0.3g")

PGV = Quantity(
    "pgv", "m/s", "peak ground velocity: each pulse has this one", symbol="PGV", lower=0.0, example="0.3 m/s"
)
