"""The block from a measured free rocking: restitution, slenderness angle and frequency parameter, with intervals.

Between impacts the body obeys theta'' = -p^2 sin(alpha - theta), theta > 0 (2.2), so that phi = alpha - theta is a
pendulum near its upper equilibrium. With the peak at time t_c,

    sin(phi/2) = sin(phi_c/2)/dn(p (t - t_c) | cos^2(phi_c/2)),

dn the elliptic function of Jacobi. An impact multiplies the velocity by eta, so that the peaks obey
cos(alpha - theta_n) - cos(alpha) = eta^2 (cos(alpha - theta_(n-1)) - cos(alpha)) (Housner 1963), with the factor
(p/p')^2 where the edges differ. The whole trace therefore follows from the time of the first impact, the energy before
it, to which a push at the release may have added, and eta, alpha, p. These are fitted to all samples by least
squares, with an offset and a drift of the sensor. The start is from peaks and impacts, which are located by a parabola
in each flight.

The residual is tested. Where flights differ by more than errors explain, because the ground moves, restitution varies
or the body is not quite rigid, ln alpha of each flight and ln eta of each impact are fitted with a random change, and
the intervals count the unknown sizes of the changes (`rocking_assessment._evidence.variance_components`). Where errors
of successive samples are correlated, as after a filter, the samples count as fewer independent ones (N/tau, with tau
the sum of the correlations of the residual over the lags), and the rotation is fitted as averaged over an unknown
duration, the effect of any filter without delay in lowest order. Where too few independent samples are left, or flights
differ by too much, or the residual is too large, the trace is refused.

References
----------
Housner G. W. (1963), The behavior of inverted pendulum structures during earthquakes, Bulletin of the Seismological
Society of America 53(2), 403-417.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.optimize import OptimizeResult, least_squares
from scipy.special import ellipj, ellipkinc, fdtri, stdtrit

from rocking.extension import Array, Flags, InvalidArgumentError, Scalar, number, variable
from rocking_assessment._evidence.trace import (
    MAX_ROTATION,
    MIN_IMPACTS,
    checked_trace,
    flights_of,
    oscillation_text,
    peak_text,
    rest_of,
)
from rocking_assessment._evidence.variance_components import Mixture, mixture

if TYPE_CHECKING:
    from rocking.extension import StopFlag  # numba takes longer to load than the fit


LOWEST_FREQUENCY = 0.1
"""Smallest p [rad/s], of a block 1 km wide and high: where it is lower, the times are not in seconds."""


START_SHARES = 0.3, 0.5, 0.7, 0.85, 0.95
"""Ratios of the first peak to alpha from which fits start [-]: of 200 traces one start left three at wrong minima."""

FIRST_EDGE = 4  # unknowns before those of the edges [-]
HIGHEST_FLIGHT = 1.0 - 1e-8  # highest energy of a flight over that of alpha [-]: at alpha a flight has no end
HIGHEST_ENERGY = 25.0  # highest energy before the first impact over that of alpha, of a body released with a push [-]
SHORTEST_AVERAGE = 0.1  # shortest duration over which a trace is averaged, over the step between samples [-]
STEP = 1e-6  # of derivatives by changes of ln alpha and ln eta [-]

AVERAGE = 0.5 * np.polynomial.legendre.leggauss(5)[0], 0.5 * np.polynomial.legendre.leggauss(5)[1]
"""Nodes and weights of an average over a duration of 1."""

LARGEST_RESIDUAL = 0.1
"""Standard deviation of the residual over the first peak, above which the trace is no free rocking [-]."""

NEGLIGIBLE = 1e-3
"""Standard deviation of the residual over the first peak, below which a trace is not refused for its errors [-]."""

LARGEST_DEPARTURE = 0.02, 0.05
"""Largest changes of alpha and of eta from flight to flight [-]: larger ones are not independent of each other.

Of ground that moves at 5 % of uplift the changes of alpha are up to 5 %. Where they are above 2 %, intervals hold alpha
and p in about half of the traces (`python -m benchmarks.accuracy.free_rocking --kind ground`, without the limit).
"""

EXACT = 5e-5
"""Standard deviation of the residual over the first peak, below which a trace is computed, and not measured [-]."""

LEAST_FREEDOM = 10.0  # fewest independent samples less unknowns of a trace that is free rocking [-]
MAX_LOG = 700.0  # largest logarithm of the end of an interval [-]: e^710 is infinite
ROUNDS = 8  # most steps of a fit with changes, each with the sizes of changes that the one before it gave [-]
SETTLED = 0.05  # largest last step over the standard deviation of an unknown [-]
STEP_LENGTHS = 1.0, 0.5, 0.25, 0.1, 0.02  # lengths of a step that are tried, over its full length [-]
SIGNIFICANT = 4.0  # standard deviations beyond which a sum of correlations of the residual is no chance [-]
HELD_SHARE = 0.95  # share of the first peak below which the body is taken as released [-]: a hand holds it before


def identify_free_rocking(
    time: ArrayLike, rotation: ArrayLike, *, edges: int = 1, confidence: Scalar = 0.95, stop: StopFlag | None = None
) -> xr.Dataset:
    """Restitution, slenderness angle and frequency parameter from the trace of a body that rocks freely.

    Parameters
    ----------
    time : array_like (samples,)
        Times [s], ascending; steps may differ.
    rotation : array_like (samples,)
        Rotation [rad], of a sensor or a video, with noise and an offset; positive values turn on the right edge. It may
        begin while the body is held, and end after it has come to rest. What is fitted begins where the rotation has
        fallen to 95 % of its first peak, and ends with the last flight that stands out from the noise.
    edges : {1, 2}
        1 for a body with equal edges; 2 fits the three numbers of each edge.
    confidence : float
        Of the intervals [-], (0, 1). They count errors of the samples, errors that follow each other, as after a
        filter, and random changes of alpha and restitution from flight to flight.
    stop : StopFlag, optional
        Cancels the work: it raises `StoppedError` soon after another thread sets the flag.

    Returns
    -------
    xarray.Dataset
        Over `edge` ("both", or "right" and "left"): `restitution` [-] of the impacts after which the body turns on the
        edge, `alpha` [rad], `frequency_parameter` [rad/s], and the ends of their intervals, `_lower` and `_upper`. Over
        `time`: `rotation`, `fitted` and `residual` [rad], nan where nothing is fitted. Over `impact`: `impact_time` [s]
        of the fit. `offset` [rad]: the rotation at rest, at the first impact; `drift` [rad/s] of the sensor, with its
        interval. `noise` [rad]: standard deviation of the residual; `sample_noise` [rad]: of independent errors of the
        samples. The attribute `warnings`: why intervals are wider, and a drift that stands out; empty without.

    Raises
    ------
    InvalidArgumentError
        If an argument is not as described, the rotation seems to be in degrees, the trace has fewer than three
        impacts, for two edges fewer than six, or it is no free rocking: an oscillation, flights that differ by more
        than `LARGEST_DEPARTURE`, or errors that are correlated over so many samples that fewer than `LEAST_FREEDOM`
        more independent samples than unknowns are left.

    Notes
    -----
    Small rotations alone tell p^2 alpha but not p and alpha: then their intervals are wide. Release the body at half of
    alpha or more.
    """
    t, theta, sides = checked_trace(time, rotation, edges)
    level = number("confidence", confidence, 0.0, 1.0, closed="neither")
    offset, noise, _ = rest_of(theta)
    flights, impacts = flights_of(t, theta - offset, noise)
    needed = MIN_IMPACTS * sides
    if impacts.size < needed:
        allowed = f"a trace with at least {needed} impacts between flights that stand out from the noise"
        raise InvalidArgumentError("rotation", f"{impacts.size} impacts", allowed)
    peaks = np.array([(theta - offset)[run][np.abs(theta[run] - offset).argmax()] for run in flights])
    held = np.flatnonzero(np.abs(theta[flights[0]] - offset) > HELD_SHARE * abs(peaks[0]))
    first = t[flights[0][held[-1]]]
    sign = float(np.sign(peaks[0]))
    starts = _starts(offset, impacts, peaks, sides)
    _check_seconds(t, math.exp(max(start[FIRST_EDGE + sides] for start in starts)))
    count, fewer = needed + 1, False
    while True:  # a few flights first: a wrong period would shift the later ones by whole flights
        used = (t > first) & (t <= t[flights[count - 1][-1]])
        misfit = partial(_misfit, t[used], theta[used], sign, sides, count, stop)
        fits = [_fitted(misfit, start, sides, jac="2-point", tolerance=1e-8) for start in starts]
        fit = min(fits, key=lambda candidate: float(candidate.cost))
        starts = [fit.x]
        # the first offset is inaccurate, and errors that follow each other hardly differ from sample to sample
        residual = math.sqrt(2.0 * fit.cost / np.count_nonzero(used))
        flights = flights_of(t, theta - _level(t, fit.x), max(noise, residual))[0]
        if len(flights) <= needed or len(flights) == count or fewer:
            break
        fewer = len(flights) < count
        count = min(count + count // 2, len(flights))
    fit = _fitted(misfit, fit.x, sides, jac="3-point", tolerance=1e-12)
    largest = float(np.abs(peaks).max())
    if fit.x[FIRST_EDGE : FIRST_EDGE + sides].max() >= math.log(0.999 * MAX_ROTATION):
        allowed = f"free rocking in radians, not degrees, of a block with alpha below {MAX_ROTATION:g} rad; none fits"
        raise InvalidArgumentError("rotation", peak_text(theta), oscillation_text(impacts, peaks) or allowed)
    if residual > LARGEST_RESIDUAL * largest:
        allowed = "free rocking: no block of the model is within 10 % of the first peak of these samples"
        raise InvalidArgumentError("rotation", peak_text(theta), oscillation_text(impacts, peaks) or allowed)
    bodies = _Bodies(t[used], theta[used], sign, sides, count, stop)
    state = bodies.state(fit.x, np.zeros(2 * count - 1))
    is_exact = residual < EXACT * largest
    best = _estimated(state)._replace(departure=0.0) if is_exact else _with_changes(bodies, state)
    model, impacts = bodies.trace(best.state.x, best.state.w)
    step = float(np.ptp(t[used])) / np.count_nonzero(used)
    if best.freedom < LEAST_FREEDOM and residual > NEGLIGIBLE * largest:
        raise InvalidArgumentError(
            "rotation",
            f"samples {residual:.3g} rad from the best block, {residual / noise:.3g} times their noise, by errors that "
            f"last {best.correlated * step:.2g} s",
            "free rocking of a rigid body on ground at rest, by a sensor whose drift does not change",
        )
    changes = best.mixture.typical_sizes() if best.departure else np.zeros(2)
    if np.any(changes > LARGEST_DEPARTURE):
        alpha, eta = 100.0 * changes
        largest_alpha, largest_eta = LARGEST_DEPARTURE
        raise InvalidArgumentError(
            "rotation",
            f"flights that differ by {alpha:.2g} % in alpha and {eta:.2g} % in restitution",
            "free rocking of a rigid body on ground at rest, whose flights differ by at most "
            f"{largest_alpha:.0%} in alpha and {largest_eta:.0%} in restitution",
        )
    result = _described(_Fit(t, theta, used, model, impacts, best, sides, level, noise))
    _check_seconds(t, float(result["frequency_parameter_upper"].max()))
    return result


class _State(NamedTuple):
    """Unknowns, changes from flight to flight, errors of the trace, and its derivatives by both."""

    x: Array
    w: Array
    error: Array
    jacobian: Array
    changes: Array

    def cost(self, scale: float, sizes: Array) -> float:
        """Errors over their scale, and changes over their sizes, squared."""
        return float(np.sum((self.error / scale) ** 2) + np.sum((self.w / sizes) ** 2))


class _Bodies(NamedTuple):
    """Blocks for the samples that are fitted."""

    t: Array
    theta: Array
    sign: float
    sides: int
    flights: int
    stop: StopFlag | None

    def trace(self, x: Array, w: Array) -> tuple[Array, Array]:
        """Rotation at the samples, and times of the impacts."""
        if self.stop is not None:
            self.stop.check()
        return _trace(self.t, x, self.sign, self.sides, self.flights, w)

    def state(self, x: Array, w: Array) -> _State:
        """The state at unknowns and changes, with derivatives by differences."""
        theta = self.trace(x, w)[0]
        jacobian = np.empty((theta.size, x.size))
        for k, step in enumerate(_steps(x)):
            unit = np.zeros(x.size)
            unit[k] = step
            jacobian[:, k] = (self.trace(x + unit, w)[0] - theta) / step
        changes = np.empty((theta.size, w.size))
        for k in range(w.size):
            unit = np.zeros(w.size)
            unit[k] = STEP
            changes[:, k] = (self.trace(x, w + unit)[0] - theta) / STEP
        return _State(x, w, theta - self.theta, jacobian, changes)


def _steps(x: Array) -> Array:
    """Steps of differences by the unknowns; none goes beyond an end from inside."""
    steps = np.full(x.size, STEP)
    steps[FIRST_EDGE - 1] = -STEP * x[FIRST_EDGE - 1]
    edges = (x.size - FIRST_EDGE) // 3
    steps[FIRST_EDGE + 2 * edges : FIRST_EDGE + 3 * edges] = -STEP
    if x.size > FIRST_EDGE + 3 * edges:
        steps[-1] = 1e-3 * x[-1]
    return steps


class _Best(NamedTuple):
    """The fit, its intervals, and what widens them.

    `freedom`: of the errors [-]; `correlated`: samples over which they are correlated [-]; `departure`: relative change
    of alpha and eta from flight to flight [-], 0 where independent errors explain as much.
    """

    state: _State
    mixture: Mixture
    variance: float
    freedom: float
    correlated: float
    departure: float


def _with_changes(bodies: _Bodies, state: _State) -> _Best:
    """Fit alpha and eta with a change in each flight where flights differ, and an average where errors are correlated.

    A filter makes errors follow each other, and averages the rotation too: over a duration that is fitted.
    """
    best = _estimated(state)
    correlated = best.correlated > 1.0
    if correlated:
        shortest = float(np.median(np.diff(bodies.t))) ** 2
        state = bodies.state(np.append(state.x, shortest), state.w)
        best = _estimated(state)
    if not (correlated or best.departure):
        return best
    for _ in range(ROUNDS):
        before = best.state
        sizes = np.repeat(best.mixture.typical_sizes(), [bodies.flights, bodies.flights - 1])
        state = _improved(bodies, best.state, sizes, math.sqrt(best.variance))
        if state is best.state:
            break
        best = _estimated(state)
        if np.all(np.abs(state.x - before.x) < SETTLED * best.mixture.deviation.min(axis=0)):
            break
    return best


def _estimated(state: _State) -> _Best:
    """The linear model at a state, in the space of the derivatives."""
    y = state.changes @ state.w - state.error
    unknowns, flights = state.x.size, (state.w.size + 1) // 2
    basis, triangle = np.linalg.qr(np.hstack([state.jacobian, state.changes]))
    explained = basis.T @ y
    residual = y - basis @ explained  # what neither unknowns nor changes explain
    correlated = _correlated(residual)
    left = y.size - triangle.shape[1]
    freedom = max(left / correlated, 1.0)
    variance = correlated * float(residual @ residual) / max(left, 1)
    fixed, changes = triangle[:, :unknowns], triangle[:, unknowns:]
    groups = changes[:, :flights], changes[:, flights:]
    estimate = mixture(explained, fixed, groups, max(variance, 1e-30), freedom)
    departure = 0.0
    if _differs(explained, fixed, changes, variance, freedom):
        departure = float(estimate.typical_sizes().max())
    return _Best(state, estimate, variance, freedom, correlated, departure)


def _differs(y: Array, fixed: Array, changes: Array, variance: float, freedom: float) -> bool:
    """True if changes from flight to flight explain more than errors do in one of 100 traces."""
    fitted = np.linalg.qr(fixed / np.maximum(np.linalg.norm(fixed, axis=0), 1e-300))[0]
    beside = changes - fitted @ (fitted.T @ changes)
    basis, sizes, _ = np.linalg.svd(beside)
    basis = basis[:, : np.count_nonzero(sizes > 1e-6 * sizes[0])]
    explained = float(np.sum((basis.T @ (y - fitted @ (fitted.T @ y))) ** 2))
    rank = basis.shape[1]
    return bool(explained > rank * variance * float(fdtri(rank, freedom, 0.99)))


def _improved(bodies: _Bodies, state: _State, sizes: Array, scale: float) -> _State:
    """A step of Gauss and Newton to the least cost of errors of the scale and changes of the sizes.

    Halved until the cost falls; the state itself if none of the steps lowers it.
    """
    unknowns = state.x.size
    norms = np.maximum(np.linalg.norm(state.jacobian, axis=0), 1e-300)
    top = np.hstack([state.jacobian / norms, state.changes * sizes]) / scale
    bottom = np.hstack([np.zeros((sizes.size, unknowns)), np.eye(sizes.size)])
    residual = np.concatenate([state.error / scale, state.w / sizes])
    step = np.linalg.lstsq(np.vstack([top, bottom]), -residual)[0]
    smoothed = unknowns > FIRST_EDGE + 3 * bodies.sides
    low, high = _ends(bodies.sides, smoothed)
    if smoothed:
        low[-1] = (SHORTEST_AVERAGE * float(np.median(np.diff(bodies.t)))) ** 2
    cost = state.cost(scale, sizes)
    for length in STEP_LENGTHS:
        x = np.clip(state.x + length * step[:unknowns] / norms, low, high)
        w = state.w + length * step[unknowns:] * sizes
        error = bodies.trace(x, w)[0] - bodies.theta
        if state._replace(w=w, error=error).cost(scale, sizes) < cost:
            return bodies.state(x, w)
    return state


def _check_seconds(t: Array, p: float) -> None:
    """Refuse times that would make the block too large; `p`: its largest possible frequency parameter [rad/s]."""
    if p < LOWEST_FREQUENCY:
        allowed = f"times in seconds: a block with p of {p:.2g} rad/s is larger than 1 km; is this a counter, or ms?"
        raise InvalidArgumentError("time", f"steps of {np.median(np.diff(t)):.3g} s", allowed)


class _Fit(NamedTuple):
    """A fit with the trace and the choices that it was made from."""

    t: Array
    theta: Array
    used: Flags
    model: Array
    impacts: Array
    best: _Best
    sides: int
    level: float
    noise: float


def _level(t: Array, x: Array) -> Array:
    """Rotation at rest, with the drift of the sensor."""
    return np.asarray(x[0] + x[1] * (t - x[2]))


def _correlated(residual: Array) -> float:
    """Samples over which errors are correlated [-], 1 for independent ones: 1 + 2 times the sum of correlations.

    The sum is over 1, 2, 4, ... lags, the largest of those that stand out from what independent errors have.
    """
    size = residual.size
    power = np.abs(np.fft.rfft(residual - residual.mean(), 2 * size)) ** 2
    covariance = np.fft.irfft(power)[:size]
    lags = 2 ** np.arange(max(size // 4, 1).bit_length())
    sums = np.cumsum(covariance[1:] / covariance[0])[lags - 1] if covariance[0] > 0.0 else np.zeros(lags.size)
    return float(1.0 + 2.0 * np.max(sums, where=sums > SIGNIFICANT * np.sqrt(lags / size), initial=0.0))


def _starts(offset: float, impacts: Array, peaks: Array, sides: int) -> list[Array]:
    """First values of all unknowns, a set for each of `START_SHARES`.

    p is from peaks and times of flight, in the slender limit (2/p) arccosh(1/(1 - theta_n/alpha)); eta from the peaks,
    and with it the energy before the first impact from the peak after it: a push may have added to the first flight.
    """
    size, duration = np.abs(peaks), np.diff(impacts)
    starts = []
    for share in START_SHARES:
        alpha = size.max() / share
        rates = 2.0 * np.arccosh(1.0 / (1.0 - size[1:-1] / alpha)) / duration
        barrier = 1.0 - (1.0 - size / alpha) ** 2
        eta = float(np.clip(np.sqrt(np.median(barrier[2:] / barrier[1:-1])), 0.3, 0.99))
        edges = np.repeat([math.log(alpha), math.log(np.median(rates)), eta], sides)
        starts.append(np.concatenate([[offset, 0.0, impacts[0], barrier[1] / eta**2], edges]))
    return starts


def _misfit(
    t: Array,
    theta: Array,
    sign: float,
    sides: int,
    flights: int,
    stop: StopFlag | None,
    x: Array,
    w: Array | None = None,
) -> Array:
    if stop is not None:
        stop.check()
    return _trace(t, x, sign, sides, flights, w)[0] - theta


def _ends(sides: int, smoothed: bool) -> tuple[list[float], list[float]]:
    """Lowest and highest values of the unknowns."""
    low = [-1.0, -np.inf, -np.inf, 1e-6, *[-12.0] * sides, *[-5.0] * sides, *[0.0] * sides]
    high = [1.0, np.inf, np.inf, HIGHEST_ENERGY, *[math.log(MAX_ROTATION)] * sides, *[6.0] * sides, *[1.0] * sides]
    return low + [0.0] * smoothed, high + [np.inf] * smoothed


def _fitted(
    misfit: Callable[[Array], Array], x: Array, sides: int, *, jac: Literal["2-point", "3-point"], tolerance: float
) -> OptimizeResult:
    low, high = _ends(sides, smoothed=False)
    inside = np.clip(x, np.add(low, 1e-7), np.subtract(high, 1e-7))
    return least_squares(misfit, inside, jac, (low, high), x_scale="jac", xtol=tolerance, ftol=tolerance)


def _trace(
    t: Array, x: Array, sign: float, sides: int, flights: int, changes: Array | None = None
) -> tuple[Array, Array]:
    """Rotation at times t (samples,), ascending, and times of the impacts (flights - 1,), from all unknowns.

    x: offset at the first impact, drift, time of that impact, energy before it over that of alpha, and of each edge
    ln alpha, ln p, eta; where it has one more, the square of the duration over which the trace is averaged [s2].
    `changes` (2 flights - 1,): of ln alpha, flight by flight, and of ln eta, impact by impact.
    """
    shape = _shape(x, sign, sides, flights, np.zeros(2 * flights - 1) if changes is None else changes)
    impacts = shape.impacts[:-1]
    if x.size == FIRST_EDGE + 3 * sides:
        return _level(t, x) + _rotation(t, shape), impacts
    theta = _level(t, x)
    for node, weight in zip(*AVERAGE, strict=True):
        theta += weight * _rotation(t + node * math.sqrt(x[-1]), shape)
    return theta, impacts


class _Shape(NamedTuple):
    """Flights of a trace: the arrays (flights,) are of the closed form; `energy` is that before the first impact."""

    impacts: Array
    centre: Array
    p: Array
    angle: Array
    lowest: Array
    sign: Array
    energy: float


def _shape(x: Array, sign: float, sides: int, flights: int, changes: Array) -> _Shape:
    impact, energy = x[2:FIRST_EDGE].tolist()
    alpha, p, eta = x[FIRST_EDGE : FIRST_EDGE + 3 * sides].reshape(3, sides)
    alpha, p, eta = np.exp(alpha).tolist(), np.exp(p).tolist(), eta.tolist()
    tilts, kicks = np.exp(changes[:flights]).tolist(), np.exp(changes[flights:]).tolist()
    side = 0 if sign > 0.0 else sides - 1
    rows = []
    end = impact
    for k in range(flights):
        angle = alpha[side] * tilts[k]
        edge = math.sin(0.5 * angle)
        if k > 0:
            energy = min(energy, HIGHEST_FLIGHT)
        lowest = edge * math.sqrt(max(1.0 - energy, 1.0 - HIGHEST_FLIGHT))  # sin(phi_c/2)
        m = 1.0 - lowest * lowest
        dn = lowest / edge
        half = float(ellipkinc(math.asin(math.sqrt(max(1.0 - dn * dn, 0.0) / m)), m)) / p[side]
        centre = impact - half if k == 0 else end + half
        end = centre + half
        rows.append((end, centre, p[side], angle, lowest, sign))
        if k == flights - 1:
            break
        speed = p[side] ** 2 * energy * edge * edge
        side, sign = sides - 1 - side if sides == 2 else 0, -sign
        edge = math.sin(0.5 * alpha[side] * tilts[k + 1])
        energy = (eta[side] * kicks[k]) ** 2 * speed / (p[side] * edge) ** 2
    impacts, centres, rates, angles, lowest_sines, signs = np.array(rows).T
    return _Shape(impacts, centres, rates, angles, lowest_sines, signs, float(x[3]))


def _rotation(t: Array, shape: _Shape) -> Array:
    """Rotation of the block from its rest position (samples,)."""
    flight = np.searchsorted(shape.impacts[:-1], t)
    centre, p, angle, lowest, sign = (column[flight] for column in shape[1:6])
    dn = ellipj(np.clip(p * (t - centre), -1e3, 1e3), 1.0 - lowest * lowest)[2]
    theta = sign * (angle - 2.0 * np.arcsin(np.clip(lowest / dn, 0.0, 1.0)))
    if shape.energy <= HIGHEST_FLIGHT:
        return np.asarray(theta)
    # released with a velocity that would have taken it over alpha: phi/2 = pi/2 - am(u), without a peak
    first = flight == 0
    edge = math.sin(0.5 * shape.angle[0])
    above = (max(shape.energy, 2.0 - HIGHEST_FLIGHT) - 1.0) * edge * edge
    m = 1.0 / (1.0 + above)
    at_impact = float(ellipkinc(0.5 * (math.pi - shape.angle[0]), m))
    u = at_impact + shape.p[0] * math.sqrt(1.0 + above) * (shape.impacts[0] - t[first])
    theta[first] = shape.sign[0] * (shape.angle[0] - math.pi + 2.0 * ellipj(np.clip(u, -1e3, 1e3), m)[3])
    return np.asarray(theta)


def _described(fit: _Fit) -> xr.Dataset:
    """The result, with intervals, and texts for what widens them."""
    t, theta, used, model, impacts, best, sides, level, noise = fit
    x = best.state.x
    half_width = best.mixture.half_widths(level)
    freedom = model.size - x.size
    residual = math.sqrt(float(best.state.error @ best.state.error) / freedom)
    texts = []
    if best.departure:
        texts.append(
            f"the flights depart from those of one rigid body on ground at rest by {100 * best.departure:.2g} %"
        )
    if best.correlated > 1.0:
        texts.append(f"errors follow each other over {best.correlated:.2g} samples")
    alone = np.sqrt((np.linalg.pinv(best.state.jacobian) ** 2).sum(axis=1))
    if texts:
        plain = float(stdtrit(freedom, 0.5 * (1.0 + level))) * residual * alone  # 0 at a confidence of almost 0
        wider = float(np.max(np.divide(half_width, plain, out=np.ones_like(plain), where=plain > 0.0)))
        texts = [f"{' and '.join(texts)}: the intervals are up to {wider:.2g} times wider for it"]
    if abs(x[1]) > SIGNIFICANT * math.sqrt(best.variance) * alone[1]:
        texts.append(f"the sensor drifts by {x[1]:.3g} rad/s, which is taken off")
    fitted = np.full(t.shape, np.nan)
    fitted[used] = model
    drift_end = "drift of the sensor, end of the interval"
    result = xr.Dataset(
        {
            "rotation": variable("time", theta, "rad", "measured rotation"),
            "fitted": variable("time", fitted, "rad", "rotation of the fitted body"),
            "residual": variable("time", theta - fitted, "rad", "measured less fitted rotation"),
            "impact_time": variable("impact", impacts, "s", "times of the impacts"),
            "offset": variable((), x[0], "rad", "rotation of the body at rest, at the first impact"),
            "drift": variable((), x[1], "rad s-1", "drift of the sensor"),
            "drift_lower": variable((), x[1] - half_width[1], "rad s-1", drift_end),
            "drift_upper": variable((), x[1] + half_width[1], "rad s-1", drift_end),
            "noise": variable((), residual, "rad", "standard deviation of the residual"),
            "sample_noise": variable((), noise, "rad", "standard deviation of independent errors of the samples"),
        },
        {
            "time": variable("time", t, "s", "time"),
            "edge": variable("edge", ["both"] if sides == 1 else ["right", "left"], "", "edge of rotation"),
        },
        {"confidence": level, "samples": int(used.sum()), "warnings": "; ".join(texts)},
    )
    parameters = (
        ("alpha", "rad", "slenderness angle"),
        ("frequency_parameter", "rad s-1", "frequency parameter p"),
        ("restitution", "1", "coefficient of restitution eta of impacts after which it turns on the edge"),
    )
    for k, (name, unit, meaning) in enumerate(parameters):
        edges = slice(FIRST_EDGE + k * sides, FIRST_EDGE + (k + 1) * sides)
        estimate, width = x[edges], half_width[edges]
        values = np.stack([estimate, estimate - width, estimate + width])
        if name != "restitution":  # fitted as logarithms
            values = np.exp(np.minimum(values, MAX_LOG))
        end = f"{meaning}, end of the interval"
        result[name] = variable("edge", values[0], unit, meaning)
        result[f"{name}_lower"] = variable("edge", values[1], unit, end)
        result[f"{name}_upper"] = variable("edge", values[2], unit, end)
    return result
