"""Energy of a block at the end of the pulse, and its margin over that with which the block overturns."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from rocking._base.arrays import Array
from rocking._base.quantities import RESTRAINTS


def residual_energy(
    fields: Mapping[str, Any], groups: Mapping[str, Any], _motion: Any = None, _body: Any = None
) -> Array:
    """Kinetic and potential energy at the end of the pulse over the potential energy at alpha, both from rest [-].

    Free rocking conserves w^2 - X^2 between impacts, with z = |theta|/alpha, w = dz/dtau and X(z) = (2/alpha) sin(alpha
    (1 - z)/2), so that the ratio is (w^2 + X(0)^2 - X(z)^2)/X(0)^2, (3.11). From |theta| below alpha the block can
    overturn only if it is at least 1; each impact multiplies it by eta^2, (3.16).

    From the fields `end_rotation` and `end_velocity`, z and w, and the group `alpha` of a block with equal edges [rad],
    0: slender. The fields do not tell about which edge a body rotates: where the edges differ there is no `alpha`, and
    the result is nan, as with a tendon or a damper.
    """
    z, w = fields["end_rotation"], fields["end_velocity"]
    if "alpha" not in groups or any(group.name in groups for group in RESTRAINTS):
        return np.full(z.shape, np.nan)
    half = 0.5 * groups["alpha"]
    barrier = np.sinc(half / np.pi)  # sin(half)/half
    x = (1.0 - z) * np.sinc(half * (1.0 - z) / np.pi)
    with np.errstate(over="ignore", invalid="ignore"):  # each form is used where it neither cancels nor overflows
        climbed = z * (2.0 - z) * np.sinc(half * z / np.pi) * np.sinc(half * (2.0 - z) / np.pi)  # X(0)^2 - X(z)^2
        energy = np.where(z < 1.0, w * w + climbed, (w - x) * (w + x) + barrier * barrier)
    return np.asarray(energy / (barrier * barrier))


def outcome_margin(z: Array, w: Array, eta: Array, alpha: Array) -> Array:
    """Energy at the end of the pulse, or after the next impact, less the energy of the barrier, over the latter [-].

    `z`, `w`: |theta|/alpha and its rate with respect to tau at the end of the pulse [-]; `alpha`: slenderness angle
    [rad], 0: slender. Positive where the block overturns: the larger of (w - X)/X(0), see
    `rocking._solver.free_rocking`, and of the energy after the next impact, relative to that of the barrier, minus 1,
    (3.16). It is continuous and zero at the transition.
    """
    half = np.where(alpha > 0.0, 0.5 * alpha, 1.0)
    barrier = np.where(alpha > 0.0, np.sin(half) / half, 1.0)
    x = np.where(alpha > 0.0, np.sin(half * (1.0 - z)) / half, 1.0 - z)
    escape = (w - x) / barrier  # (3.8)
    # Decided without following the motion: w >= x escapes about the present edge; otherwise the block comes back, and
    # the energy after the impact decides about the other edge. Both are 0 or less where w = x: no jump.
    rebound = eta * eta * (1.0 - (x - w) * (x + w) / (barrier * barrier))
    return np.asarray(np.where(w < x, np.maximum(escape, rebound - 1.0), escape))
