"""Forces between a body and the ground during rocking, and the friction that pure rocking requires (docs/contact.md).

The paper assumes that the corner neither slides nor leaves the ground. Newton's law for the centre of mass, with the
angular acceleration from the equation of motion (`rocking._model.body`; (2.2) for a block), gives the reaction that
this requires.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking._base.quantities import RESTITUTION
from rocking._model.checks import check_one_alpha

Floats = NDArray[np.float64]

INERTIA_RATIO = 0.75  # R p^2/g = 3/4 for a rectangle that rotates about its corner, below (2.2)


@dataclass(frozen=True)
class ContactGeometry:
    """What reactions need beside alpha of the right edge; the defaults hold for a rectangular block."""

    ratio: float = 1.0  # alpha of the left edge over alpha of the right one [-]
    speed: float = 1.0  # p of the left edge over p of the right one [-]
    inertia_ratio: tuple[float, float] = (INERTIA_RATIO, INERTIA_RATIO)  # R p^2/g of the right and the left edge [-]
    tilt: float = 0.0  # angle by which the base is inclined towards the right [rad]


BLOCK = ContactGeometry()


@dataclass(frozen=True, eq=False)
class Reactions:
    """Reaction of the ground at the pivot, on the body; arrays of one shape."""

    # H/(m g tan(alpha)) along the base, positive as the ground acceleration; at rest on a level base it is that
    # acceleration, a f. alpha is that of the right edge [-]
    horizontal: Floats
    # N/(m g) normal to the base, positive upwards; at rest 1. Where it is not positive, rocking would require a tensile
    # force [-]
    normal: Floats

    @property
    def friction_demand(self) -> Floats:
        """|H|/(N tan(alpha)) [-]: the coefficient of friction that prevents sliding of the corner, over tan(alpha).

        Infinite where N <= 0.
        """
        pressed = self.normal > 0.0
        return np.where(pressed, np.abs(self.horizontal) / np.where(pressed, self.normal, 1.0), math.inf)


def reactions(
    rotation: Floats,
    angular_velocity: Floats,
    ground_acceleration: Floats,
    side: Floats,
    alpha: float,
    vertical: Floats | float = 1.0,
    geometry: ContactGeometry = BLOCK,
) -> Reactions:
    """Reaction at the pivot from the state of motion, arrays of one shape.

    `rotation`, `angular_velocity`: theta/alpha and d(theta/alpha)/d tau [-]; `ground_acceleration`: a f = u/(g
    tan(alpha)) [-]; `side`: corner in contact, +1 the right one (theta > 0), -1 the left one, 0 at rest on both;
    `vertical`: V = 1 + (vertical acceleration of the ground)/g [-]. `alpha` is that of the right edge [rad], [0, pi/2).
    At 0 the limit: the horizontal reaction stays finite over tan(alpha), and N = m g.
    """
    right = side >= 0.0
    u, lean = ground_acceleration, side * np.where(right, 1.0, geometry.ratio) - rotation
    inertia = np.where(right, *geometry.inertia_ratio)
    if alpha > 0.0:
        slope, q = math.tan(alpha), alpha * angular_velocity / np.where(right, 1.0, geometry.speed)  # theta'/p_s
        e, c = np.sin(alpha * lean) / slope, np.cos(alpha * lean)
    else:
        slope, q, e, c = 0.0, np.zeros_like(angular_velocity), lean, np.ones_like(lean)
    turn = -vertical * e - u * c  # (2.2): theta''/(p_s^2 tan(alpha))
    # Newton: H = m (a + x''), N = m (g + w + y''). The centre of mass moves on a circle about the pivot: R theta''
    # along it, R theta'^2 to the pivot; `inertia` = R p^2/g makes them accelerations over g tan(alpha) and over g.
    moving = side != 0.0
    horizontal = np.where(moving, u + inertia * (c * turn + e * q * q), u)
    normal = np.where(moving, vertical + inertia * (slope * slope * e * turn - c * q * q), vertical)
    if geometry.tilt != 0.0:
        cosine, sine = math.cos(geometry.tilt), math.sin(geometry.tilt)
        horizontal, normal = horizontal * cosine - normal * (sine / slope), horizontal * slope * sine + normal * cosine
    return Reactions(horizontal, normal)


def impulse_ratio(restitution: float, alpha: float, other_alpha: float | None = None) -> float:
    """Horizontal over vertical impulse of the ground at an impact, (1 - eta)/((1 + eta) tan(alpha)) [-].

    With edges that differ (1 - eta)/(tan(alpha) + eta tan(alpha')), alpha of the edge that is left, alpha' of the new
    one [rad], [0, pi/2). It is the coefficient of friction required at an impact for (2.3) to hold without sliding:
    infinite in the slender limit unless eta = 1. With the eta of (2.4) it is 3 sin(alpha) cos(alpha)/(4 - 3
    sin^2(alpha)), less than tan(alpha).
    """
    eta = RESTITUTION.number(restitution)
    slope = math.tan(check_one_alpha(alpha))
    other = slope if other_alpha is None else math.tan(check_one_alpha(other_alpha))
    pressed = slope + eta * other
    if eta == 1.0:
        return 0.0
    return (1.0 - eta) / pressed if pressed > 0.0 else math.inf
