"""Bodies with a tendon and a damper: constants of the motion, and rocking after the ground motion has ended.

A vertical tendon along the centre line of a body with two equal edges, of stiffness k and prestress P0, is fixed to the
ground under the middle of the base: its elongation is the chord 2 b sin(|theta|/2), its lever b cos(|theta|/2). A
vertical damper c acts at the edge that uplifts; its moment 4 b^2 c theta' is that of small rotations. With

    kappa = k b^2/(m g R),  sigma = P0/(m g),  zeta = (3/2) (b/R)^2 c/(m p)

and z, w, S, C, F of `rocking._solver.rules`, D = cos(alpha z/2), the equation of a flight is

    z'' = -(sin(alpha)/alpha) (V S + sigma D + F C) - kappa sin(alpha z)/alpha - 2 zeta w

in the slender limit z'' = -(1 + sigma) - F + (1 - kappa) z - 2 zeta w. The body uplifts at |a f| = 1 + sigma. The state
of the solver has slenderness and F over 1 + sigma, so that the levels of uplift are those of a free body.

With damping the energy does not decide what follows the motion. In the slender limit with kappa < 1

    W = w + ((1 - kappa)/lambda) z - (1 + sigma)/lambda,  lambda = sqrt(zeta^2 + 1 - kappa) - zeta,  W' = lambda W - F

so that the sign of W at the end of the motion decides about the flight: it escapes if W >= 0. A rigid body escapes
where it passes the unstable equilibrium, or |theta| = pi/2 if there is none below; with kappa >= 1 a slender one never
does.
"""

import math

from rocking._base.errors import SearchError
from rocking._numba.compilation import Record, kernel
from rocking._solver.state import FREE_ORDER, FULL_PRECISION
from rocking._solver.taylor.events import evaluate_series, refine_root

LOG_PRECISION, TINY = math.log(FULL_PRECISION), 1e-300

MAX_FREE_STEPS = 100_000
"""Most Taylor steps of a flight without ground motion: a hundred times what the range of kappa and zeta needs."""


@kernel
def set_restraint(state: Record, cell: Record) -> None:
    """Set tendon and damper of a `BODY_CELL`, and the constants that depend on them; alpha is set."""
    state.spring, state.level, state.damping = cell.spring, 1.0 + cell.prestress, cell.damping
    state.restrained = int(cell.spring > 0.0 or cell.prestress > 0.0 or cell.damping > 0.0)
    state.growth, state.equilibrium = 0.0, 0.0  # equilibrium 0: not known yet
    state.may_turn = int(steepest_pull(state) > 0.0)
    if state.restrained == 1 and state.alpha == 0.0:
        left, zeta = 1.0 - cell.spring, cell.damping
        state.equilibrium = math.inf
        if left > 0.0:
            state.growth = left / (math.sqrt(zeta * zeta + left) + zeta)
            state.equilibrium = state.level / left


@kernel
def steepest_pull(state: Record) -> float:
    """k >= 0 with z'' + 2 zeta w + k z >= 0 while the body is destabilised [-]; 0 of a free one.

    With t = alpha z, F = -(1 + sigma) and S - C = -sin(t)/(sin(alpha) cos(alpha)) the moments are

        z'' + 2 zeta w = (1/cos(alpha) - kappa) sin(t)/alpha + sigma (sin(alpha)/alpha) (C - D)

    and C < D beyond t = 2 alpha only. There sin(t) >= 2 sin(alpha) cos(alpha) up to pi/2, so that both together are
    >= 0 if sigma <= 2 (1 - kappa cos(alpha)): k = 0. Likewise z'' + 2 zeta w <= 0 below z = 0 while it is restored.
    Otherwise sin(t) <= t and D - C <= z/2 bound them.
    """
    if state.alpha == 0.0:
        return float(max(state.spring - 1.0, 0.0))
    sigma, left = state.level - 1.0, 1.0 - state.spring * math.cos(state.alpha)
    if left >= 0.0 and sigma <= 2.0 * left:
        return 0.0
    return float(state.spring + 0.5 * sigma)


@kernel
def moment_at_rest(state: Record, t: float) -> tuple[float, float]:
    """-z'' alpha without ground motion and velocity at |theta| = t, and its derivative by t."""
    alpha, tension = state.alpha, (state.level - 1.0) * math.sin(state.alpha)
    moment = math.sin(alpha - t) + state.spring * math.sin(t) + tension * math.cos(0.5 * t)
    slope = state.spring * math.cos(t) - math.cos(alpha - t) - 0.5 * tension * math.sin(0.5 * t)
    return moment, slope


@kernel
def equilibrium_of(state: Record) -> float:
    """z of the unstable equilibrium, at most |theta| = pi/2; computed once for a body.

    The moment sin(alpha) cos(t) - (cos(alpha) - kappa) sin(t) + sigma sin(alpha) cos(t/2) falls with t if kappa <=
    cos(alpha), and is positive up to pi/2 otherwise: it has one zero below pi/2, if it is negative there.
    """
    if state.equilibrium > 0.0:
        return float(state.equilibrium)
    low, high = 0.0, 0.5 * math.pi
    if moment_at_rest(state, high)[0] < 0.0:
        t = min(state.alpha, 0.7)
        for _ in range(200):
            moment, slope = moment_at_rest(state, t)
            low, high = (t, high) if moment > 0.0 else (low, t)
            following = t - moment / slope
            if not low <= following <= high:
                following = 0.5 * (low + high)
            moved = abs(following - t)
            t = following
            if moved <= 2e-16 * t:
                break
        high = t
    state.equilibrium = high / state.alpha
    return float(state.equilibrium)


@kernel
def potential(state: Record, z: float) -> float:
    """Potential energy of a rigid body [-], 0 at z = 0; its derivative is -z'' at rest."""
    alpha, t = state.alpha, state.alpha * z
    climbed = 2.0 * math.sin(0.5 * t) * math.sin(alpha - 0.5 * t)  # cos(alpha - t) - cos(alpha)
    stretched = 2.0 * state.spring * math.sin(0.5 * t) ** 2
    lifted = 2.0 * (state.level - 1.0) * math.sin(alpha) * math.sin(0.5 * t)
    return float((climbed + stretched + lifted) / (alpha * alpha))


@kernel
def growing_part(state: Record, z: float, w: float) -> float:
    """W lambda/(1 + sigma) of a slender body with kappa < 1 [-]; z + w - 1 of a free one."""
    return float((state.growth * w + (1.0 - state.spring) * z) / state.level - 1.0)


@kernel
def expand_free(state: Record, z0: float, w0: float) -> float:
    """Fill `free_z` and `free_rate` about z0, w0 without ground motion; returns the step size."""
    z, rate = state.free_z, state.free_rate
    s, c, d = state.free_s, state.free_c, state.free_d
    alpha, sigma = state.alpha, state.level - 1.0
    z[0, 0], z[1, 0], rate[0, 0] = z0, w0, w0
    sine, cosine, scale = 0.0, 1.0, 1.0
    s[0], c[0], d[0] = 1.0 - z0, 1.0, 1.0
    if alpha > 0.0:
        sine, cosine, scale = math.sin(alpha), math.cos(alpha), math.sin(alpha) / alpha
        s[0], c[0] = math.sin(alpha * (1.0 - z0)) / sine, math.cos(alpha * (1.0 - z0)) / cosine
        d[0] = math.cos(0.5 * alpha * z0)
    for n in range(FREE_ORDER - 1):
        force = scale * (s[n] + sigma * d[n]) + state.spring * scale * cosine * (c[n] - s[n])
        rate[n + 1, 0] = -(force + 2.0 * state.damping * rate[n, 0]) / (n + 1.0)
        z[n + 2, 0] = rate[n + 1, 0] / (n + 2.0)
        if alpha == 0.0:
            s[n + 1], c[n + 1], d[n + 1] = -z[n + 1, 0], 0.0, 0.0
            continue
        falling, rising = 0.0, 0.0
        for j in range(n + 1):
            falling += rate[j, 0] * c[n - j]
            rising += rate[j, 0] * s[n - j]
        s[n + 1] = -alpha * cosine / sine * falling / (n + 1.0)
        c[n + 1] = alpha * sine / cosine * rising / (n + 1.0)
        d[n + 1] = 0.0
        if sigma == 0.0:
            continue
        left = 0.5 * (sine * sine * s[n + 1] + cosine * cosine * c[n + 1])  # 2 D^2 = 1 + cos(alpha z)
        for j in range(1, n + 1):
            left -= d[j] * d[n + 1 - j]
        d[n + 1] = 0.5 * left / d[0]
    longest = 1.4  # log of the step size
    for k in range(FREE_ORDER - 1, FREE_ORDER + 1):
        last, allowed = math.log(abs(z[k, 0]) + TINY), -700.0
        for j in range(4):
            allowed = max(allowed, (LOG_PRECISION + math.log(abs(z[j, 0]) + TINY) - last) / (k - j))
        longest = min(longest, allowed)
    pull = steepest_pull(state)
    if pull > 0.0:  # as the cap of `rocking._solver.taylor.step.set_restraint_lane`
        return float(min(math.exp(longest), 1.5 / math.sqrt(pull)))
    return math.exp(longest)


@kernel
def free_flight(state: Record, z: float, w: float, to_impact: bool) -> tuple[bool, float, float, float]:
    """What follows from z >= 0 and w without ground motion, up to the escape, or to the peak or the impact.

    Given: z and w on an edge. Decided: whether the body escapes in this flight; if not, its largest z and, if
    `to_impact`, the velocity at the impact. No event is missed: below the equilibrium z'' + 2 zeta w < 0, so that w has
    at most one zero, at which it falls, and z = 0 is crossed downwards once. Beyond it the sign is the other one: a
    body that rises there escapes. The sign of w and z at the end of a step shows each event.

    Returns whether it escapes, the largest z, the speed at z = 0, and a margin that is positive where it escapes, zero
    at the transition: W lambda/(1 + sigma) of a slender body; else the kinetic energy at the equilibrium, or the
    potential energy at the peak less that at the equilibrium, both over the latter.

    Worked example: slender, zeta = 0.1, at z = 0.4 with w = 0.1. lambda = 0.905, W = 0.1 + 1.105 (0.4 - 1) < 0: it does
    not escape; it rises to 0.4075 and returns with a smaller speed than without the damper.
    """
    margin = -1.0
    if state.alpha == 0.0:
        top_z = state.equilibrium
        if state.growth > 0.0:
            margin = growing_part(state, z, w)
            if margin >= 0.0:
                return True, math.inf, math.inf, margin
    else:
        top_z = equilibrium_of(state)
    top, order = z, FREE_ORDER
    for _ in range(MAX_FREE_STEPS):
        if z >= top_z and w >= 0.0:
            if state.alpha > 0.0:
                margin = 0.5 * w * w / potential(state, top_z)
            return True, math.inf, math.inf, margin
        if z <= 0.0 and w <= 0.0:
            break
        h = expand_free(state, z, w)
        z1, w1 = evaluate_series(state.free_z, 0, order, h), evaluate_series(state.free_rate, 0, order - 1, h)
        if w > 0.0 and w1 <= 0.0 and z < top_z:
            at, _ = refine_root(state.free_rate, 0, order - 1, 0.0, h, True, False, h * w / (w - w1))
            z, w = evaluate_series(state.free_z, 0, order, at), 0.0
            top = max(top, z)
            if not to_impact:
                break
        elif w <= 0.0 and z1 <= 0.0:
            at, _ = refine_root(state.free_z, 0, order, 0.0, h, True, False, h * z / (z - z1))
            z, w = 0.0, min(evaluate_series(state.free_rate, 0, order - 1, at), 0.0)
        else:
            if w <= 0.0 and w1 > 0.0 and z < top_z:  # rounding at the peak
                w1 = 0.0
            z, w = z1, w1
    else:
        raise SearchError("a flight without ground motion does not end")
    if state.alpha > 0.0:
        margin = potential(state, min(top, top_z)) / potential(state, top_z) - 1.0
    return False, top, -w, margin
