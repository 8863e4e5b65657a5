"""Forces between block and ground during rocking, and the friction that pure rocking requires (docs/contact.md).

The paper assumes that the corner neither slides nor leaves the ground. Newton's law for the centre of mass, with the
angular acceleration from (2.2), gives the reaction that this requires.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking.model.checks import check_number, check_one_alpha
from rocking.model.parameters import RESTITUTION

Floats = NDArray[np.float64]

INERTIA_RATIO = 0.75
"""R p^2/g = 3/4 for a rectangle that rotates about its corner, below (2.2)."""


@dataclass(frozen=True, eq=False)
class Reactions:
    """Reaction of the ground at the pivot, on the block; arrays of one shape.

    Attributes
    ----------
    horizontal : float array [-]
        H/(m g tan(alpha)), positive as the ground acceleration; at rest it is that acceleration, a f.
    normal : float array [-]
        N/(m g), positive upwards; at rest 1. Where it is not positive, rocking would require a tensile force.
    """

    horizontal: Floats
    normal: Floats

    @property
    def friction_demand(self) -> Floats:
        """|H|/(N tan(alpha)) [-]: the coefficient of friction that prevents sliding of the corner, over tan(alpha).

        Infinite where N <= 0.
        """
        pressed = self.normal > 0.0
        return np.where(pressed, np.abs(self.horizontal) / np.where(pressed, self.normal, 1.0), math.inf)


def reactions(
    rotation: Floats, angular_velocity: Floats, ground_acceleration: Floats, side: Floats, alpha: float
) -> Reactions:
    """Reaction at the pivot from the state of motion.

    Parameters
    ----------
    rotation, angular_velocity : float arrays
        theta/alpha and d(theta/alpha)/d tau [-].
    ground_acceleration : float array
        a f = u/(g tan(alpha)) [-].
    side : float array
        Corner in contact: +1 the right one (theta > 0), -1 the left one; 0 at rest on both.
    alpha : float
        Slenderness angle [rad], [0, pi/2). At 0 the limit: the horizontal reaction stays finite over tan(alpha), and
        N = m g.

    Returns
    -------
    Reactions
        Of the shape of the arguments.
    """
    u, lean = ground_acceleration, side - rotation
    if alpha > 0.0:
        slope, q = math.tan(alpha), alpha * angular_velocity
        e, c = np.sin(alpha * lean) / slope, np.cos(alpha * lean)
    else:
        slope, q, e, c = 0.0, np.zeros_like(angular_velocity), lean, np.ones_like(lean)
    turn = -e - u * c  # (2.2): theta''/(p^2 tan(alpha))
    horizontal = u + INERTIA_RATIO * (c * turn + e * q * q)
    normal = 1.0 + INERTIA_RATIO * (slope * slope * e * turn - c * q * q)
    moving = side != 0.0
    return Reactions(np.where(moving, horizontal, u), np.where(moving, normal, 1.0))


def impulse_ratio(restitution: float, alpha: float) -> float:
    """Horizontal over vertical impulse of the ground at an impact, (1 - eta)/((1 + eta) tan(alpha)) [-].

    Parameters
    ----------
    restitution : float
        eta [-], [0, 1].
    alpha : float
        Slenderness angle [rad], [0, pi/2).

    Returns
    -------
    float
        Coefficient of friction required at an impact for (2.3) to hold without sliding: infinite in the slender limit
        unless eta = 1. With the eta of (2.4) it is 3 sin(alpha) cos(alpha)/(4 - 3 sin^2(alpha)), less than tan(alpha).

    Raises
    ------
    InvalidArgumentError
        For an argument out of range.
    """
    eta = check_number(RESTITUTION, restitution)
    slope = math.tan(check_one_alpha(alpha))
    loss = (1.0 - eta) / (1.0 + eta)
    if loss == 0.0:
        return 0.0
    return loss / slope if slope > 0.0 else math.inf
