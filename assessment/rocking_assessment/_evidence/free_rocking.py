"""The block from a measured free rocking: restitution, slenderness angle and frequency parameter, with intervals.

Between impacts the body obeys theta'' = -p^2 sin(alpha - theta), theta > 0 (2.2), so that phi = alpha - theta is a
pendulum near its upper equilibrium. With the peak at time t_c,

    sin(phi/2) = sin(phi_c/2)/dn(p (t - t_c) | cos^2(phi_c/2)),

dn the elliptic function of Jacobi. An impact multiplies the velocity by eta, so that the peaks obey
cos(alpha - theta_n) - cos(alpha) = eta^2 (cos(alpha - theta_(n-1)) - cos(alpha)) (Housner 1963), with the factor
(p/p')^2 where the edges differ. The whole trace therefore follows from the time of the first impact, the peak before
it, and eta, alpha, p; these are fitted to all samples by least squares, with an offset and a drift of the sensor. The
start is from peaks and impacts, which are located by a parabola in each flight.

The residual is tested: errors of one sample do not tell those of the next. Where they do, the samples count as fewer
independent ones, which widens the intervals (for N/tau independent samples, with tau the sum of the correlations of the
residual over the lags), and where that leaves too few, or the residual is too large, the trace is refused.

References
----------
Housner G. W. (1963), The behavior of inverted pendulum structures during earthquakes, Bulletin of the Seismological
Society of America 53(2), 403-417.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.optimize import OptimizeResult, least_squares
from scipy.special import ellipj, ellipkinc, fdtri, stdtrit

from rocking.extension import Array, Flags, Index, InvalidArgumentError, Scalar, in_range, integer, number, variable

if TYPE_CHECKING:
    from rocking.extension import StopFlag  # numba takes longer to load than the fit

MAX_ROTATION = 0.8  # largest rotation and alpha [rad]: beyond it a body hardly rocks, and the numbers are degrees

DURATION = 1e-3, 1e5
"""Shortest and longest trace [s]: bodies of 0.1 mm rock for hundredths of a second, those of 1 km for minutes."""

LOWEST_FREQUENCY = 0.1
"""Smallest p [rad/s], of a block 1 km wide and high: where it is lower, the times are not in seconds."""

SHORTEST_STEP = 1e-7  # shortest step between samples [s]
MIN_IMPACTS = 3  # fewest impacts from which eta, alpha and p are told apart [-]
MAX_FLIGHTS = 200  # most flights that are fitted [-]

LEVEL = 10.0
"""Peak of the smallest flight that is used, over the noise [-]; at 6, one trace in 100 had a flight too few."""

MIN_SAMPLES = 5  # fewest samples of a flight that is used [-]

START_SHARES = 0.3, 0.5, 0.7, 0.85, 0.95
"""Shares of alpha that the first peak is tried at [-]: of 200 traces one start in alpha left three at wrong minima."""

FIRST_EDGE = 4  # unknowns before those of the edges [-]
HIGHEST_SHARE = 0.9999  # highest peak over alpha [-]: at alpha a flight has no end

LARGEST_RESIDUAL = 0.1
"""Standard deviation of the residual over the first peak, above which the trace is no free rocking [-]."""

NEGLIGIBLE = 1e-3
"""Standard deviation of the residual over the first peak, below which a trace is not refused for its errors [-]."""

LEAST_FREEDOM = 10.0  # fewest independent samples less unknowns of a trace that is free rocking [-]
MAX_LOG = 700.0  # largest logarithm of the end of an interval [-]: e^710 is infinite
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
        Of the intervals [-], (0, 1): those of least squares with independent errors of equal variance, which are
        widened where the residual shows that errors follow each other, or that flights differ.
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
        impacts, for two edges fewer than six, or it is no free rocking: an oscillation, or errors from the best block
        that last so long that fewer than `LEAST_FREEDOM` more independent samples than unknowns are left.

    Notes
    -----
    Small rotations alone tell p^2 alpha but not p and alpha: then their intervals are wide. Release the body at half of
    alpha or more.
    """
    t, theta, sides = _checked(time, rotation, edges)
    level = number("confidence", confidence, 0.0, 1.0, closed="neither")
    offset, noise, _ = _rest(theta)
    flights, impacts = _flights(t, theta - offset, noise)
    needed = MIN_IMPACTS * sides
    if impacts.size < needed:
        allowed = f"a trace with at least {needed} impacts between flights that stand out from the noise"
        raise InvalidArgumentError("rotation", f"{impacts.size} impacts", allowed)
    peaks = np.array([(theta - offset)[run][np.abs(theta[run] - offset).argmax()] for run in flights])
    held = np.flatnonzero(np.abs(theta[flights[0]] - offset) > HELD_SHARE * abs(peaks[0]))
    first = t[flights[0][held[-1]]]
    sign = float(np.sign(peaks[0]))
    starts = _starts(offset, impacts, peaks, sides)
    _check_seconds(t, math.exp(max(one[FIRST_EDGE + sides] for one in starts)))
    count, fewer = needed + 1, False
    while True:  # a few flights first: a wrong period would shift the later ones by whole flights
        used = (t > first) & (t <= t[flights[count - 1][-1]])
        misfit = partial(_misfit, t[used], theta[used], sign, sides, count, stop)
        fit = min((_fitted(misfit, start) for start in starts), key=lambda one: float(one.cost))
        starts = [fit.x]
        # the first offset is inaccurate, and errors that follow each other hardly differ from sample to sample
        residual = math.sqrt(2.0 * fit.cost / np.count_nonzero(used))
        flights = _flights(t, theta - _level(t, fit.x), max(noise, residual))[0]
        if len(flights) <= needed or len(flights) == count or fewer:
            break
        fewer = len(flights) < count
        count = min(count + count // 2, len(flights))
    largest = float(np.abs(peaks).max())
    if fit.x[FIRST_EDGE : FIRST_EDGE + sides].max() >= math.log(0.999 * MAX_ROTATION):
        allowed = f"free rocking in radians, not degrees, of a block with alpha below {MAX_ROTATION:g} rad; none fits"
        raise InvalidArgumentError("rotation", _peak_text(theta), _oscillation(impacts, peaks) or allowed)
    if residual > LARGEST_RESIDUAL * largest:
        allowed = "free rocking: no block of the model is within 10 % of the first peak of these samples"
        raise InvalidArgumentError("rotation", _peak_text(theta), _oscillation(impacts, peaks) or allowed)
    trace = partial(_trace, t[used], fit.x, sign, sides, count)
    model, impacts = trace()
    error, step = model - theta[used], float(np.ptp(t[used])) / np.count_nonzero(used)
    correlated = _correlated(error)
    freedom = error.size / correlated - fit.x.size
    if freedom < LEAST_FREEDOM and residual > NEGLIGIBLE * largest:
        raise InvalidArgumentError(
            "rotation",
            f"samples {residual:.3g} rad from the best block, {residual / noise:.3g} times their noise, by errors that "
            f"last {correlated * step:.2g} s",
            "free rocking of a rigid body on ground at rest, by a sensor whose drift does not change",
        )
    departure, changes = _departure(error, fit.jac, lambda one: trace(one)[0], count)
    found = _Found(t, theta, used, model, impacts, fit, sides, level)
    result = _described(found, max(freedom, LEAST_FREEDOM), correlated, departure, changes, noise)
    _check_seconds(t, float(result["frequency_parameter_upper"].max()))
    return result


def _check_seconds(t: Array, p: float) -> None:
    """Refuse times that would make the block too large; `p`: its largest possible frequency parameter [rad/s]."""
    if p < LOWEST_FREQUENCY:
        allowed = f"times in seconds: a block with p of {p:.2g} rad/s is larger than 1 km; is this a counter, or ms?"
        raise InvalidArgumentError("time", f"steps of {np.median(np.diff(t)):.3g} s", allowed)


class _Found(NamedTuple):
    """A fit and what it was made from."""

    t: Array
    theta: Array
    used: Flags
    model: Array
    impacts: Array
    fit: OptimizeResult
    sides: int
    level: float


def _level(t: Array, x: Array) -> Array:
    """Rotation at rest, with the drift of the sensor."""
    return np.asarray(x[0] + x[1] * (t - x[2]))


def _correlated(residual: Array) -> float:
    """Samples over which errors follow each other [-], 1 for independent ones: 1 + 2 times the sum of correlations.

    The sum is over 1, 2, 4, ... lags, the largest of those that stand out from what independent errors have.
    """
    size = residual.size
    power = np.abs(np.fft.rfft(residual - residual.mean(), 2 * size)) ** 2
    covariance = np.fft.irfft(power)[:size]
    lags = 2 ** np.arange(max(size // 4, 1).bit_length())
    sums = np.cumsum(covariance[1:] / covariance[0])[lags - 1] if covariance[0] > 0.0 else np.zeros(lags.size)
    return float(1.0 + 2.0 * np.max(sums, where=sums > SIGNIFICANT * np.sqrt(lags / size), initial=0.0))


def _departure(residual: Array, jacobian: Array, trace: Callable[[Array], Array], flights: int) -> tuple[float, Array]:
    """By how much alpha and eta would have to change from flight to flight for the residual, as a share of them [-].

    0 where independent errors tell as much in one of 100 traces. The ground, or a body that is not rigid, changes the
    flights so: a ground acceleration of a share of that of uplift changes alpha by this share. Also the derivatives
    (samples, changes) of the trace.
    """
    step = 1e-6
    units = step * np.delete(np.eye(2 * flights), flights, axis=0).reshape(-1, 2, flights)  # no impact at the start
    at_none = trace(np.zeros((2, flights)))
    changes = np.array([trace(one) - at_none for one in units]).T / step
    seen = changes - jacobian @ np.linalg.lstsq(jacobian, changes)[0]
    basis, sizes, _ = np.linalg.svd(seen, full_matrices=False)
    basis = basis[:, sizes > 1e-6 * sizes[0]]
    told = float(np.sum((basis.T @ residual) ** 2))
    rank, freedom = basis.shape[1], residual.size - jacobian.shape[1] - basis.shape[1]
    noise = (float(residual @ residual) - told) / max(freedom, 1)
    if freedom < 1 or told <= rank * noise * float(fdtri(rank, freedom, 0.99)):
        return 0.0, changes
    return math.sqrt((told - rank * noise) / float(np.sum(seen**2))), changes


def _oscillation(impacts: Array, peaks: Array) -> str | None:
    """A text if the flights last as long whatever their peak: those of a block last as its power 1/2 and more."""
    duration = np.diff(impacts)
    peak = np.abs(peaks[1 : duration.size + 1])
    if np.ptp(np.log(peak)) == 0.0 or np.polyfit(np.log(peak), np.log(duration), 1)[0] > 0.25:
        return None
    return (
        "free rocking, whose flights shorten with their peaks: these last "
        f"{duration.min():.3g} to {duration.max():.3g} s for peaks of {peak.min():.3g} to {peak.max():.3g} rad, as of "
        f"an oscillation of {0.5 / np.median(duration):.3g} Hz"
    )


def _peak_text(theta: Array) -> str:
    return f"values up to {np.abs(theta).max():.4g}"


def _checked(time: ArrayLike, rotation: ArrayLike, edges: int) -> tuple[Array, Array, int]:
    t = in_range("time", time, -1e9, 1e9, unit="s")
    theta = in_range("rotation", rotation, -1e9, 1e9, unit="rad")
    if t.ndim != 1 or t.shape != theta.shape or t.size < MIN_SAMPLES * MIN_IMPACTS:
        raise InvalidArgumentError("rotation", theta.shape, f"as many samples as of time, {t.shape}, at least 15")
    if not np.all(np.diff(t) > 0.0):
        raise InvalidArgumentError("time", f"a step of {np.diff(t).min():g} s", "ascending times")
    shortest, duration = float(np.diff(t).min()), float(t[-1] - t[0])
    if not (shortest >= SHORTEST_STEP and DURATION[0] <= duration <= DURATION[1]):
        allowed = f"a trace of {DURATION[0]:g} to {DURATION[1]:g} s in steps of {SHORTEST_STEP:g} s or more"
        raise InvalidArgumentError("time", f"{duration:g} s, the shortest step {shortest:g} s", allowed)
    if np.abs(theta).max() > MAX_ROTATION:
        allowed = f"radians, with alpha below {MAX_ROTATION:g} rad: are these degrees?"
        raise InvalidArgumentError("rotation", _peak_text(theta), allowed)
    return t, theta, integer("edges", edges, 1, 2)


def _rest(theta: Array) -> tuple[float, float, bool]:
    """Rotation at rest, the median at the end or the middle if the body rocks on; noise; whether it comes to rest."""
    noise = float(np.median(np.abs(np.diff(theta, 3))) / (0.6745 * math.sqrt(20.0)))  # of normal errors
    end, half = theta[-max(theta.size // 10, 3) :], theta[theta.size // 2 :]
    rests = bool(np.std(end) <= LEVEL * noise)
    return float(np.median(end) if rests else 0.5 * (half.max() + half.min())), noise, rests


def _flights(t: Array, theta: Array, noise: float) -> tuple[list[Index], Array]:
    """Samples of each flight that stands out, in order, and the times of the impacts between them.

    An impact lies between the roots of the parabolas of two flights. The first flight, which may begin in a hand, is no
    parabola.
    """
    threshold = LEVEL * max(noise, 1e-9 * float(np.abs(theta).max()))
    above = np.flatnonzero(np.abs(theta) > 0.5 * threshold)
    runs = np.split(above, np.flatnonzero(np.diff(np.sign(theta[above]))) + 1)
    stands_out = [run.size >= MIN_SAMPLES and bool(np.abs(theta[run]).max() > threshold) for run in runs]
    first = stands_out.index(True) if any(stands_out) else len(runs)
    count = next((k for k, one in enumerate(stands_out[first:]) if not one), len(runs) - first)
    flights = runs[first : first + min(count, MAX_FLIGHTS)]
    if len(flights) < 2:
        return flights, np.empty(0)
    roots = [np.sort(np.roots(np.polyfit(t[run] - t[run[0]], theta[run], 2)).real) + t[run[0]] for run in flights]
    before = [t[flights[0][-1]], *(ends[-1] for ends in roots[1:-1])]
    between = [0.5 * (end + ends[0]) for end, ends in zip(before, roots[1:], strict=True)]
    low, high = ([t[run[place]] for run in part] for place, part in ((-1, flights[:-1]), (0, flights[1:])))
    return flights, np.clip(between, low, high)


def _starts(offset: float, impacts: Array, peaks: Array, sides: int) -> list[Array]:
    """First values of all unknowns, one set for each share of alpha that the first peak may be.

    p is from peaks and times of flight, in the slender limit (2/p) arccosh(1/(1 - theta_n/alpha)); eta from the peaks.
    """
    size, duration = np.abs(peaks), np.diff(impacts)
    found = []
    for share in START_SHARES:
        alpha = size.max() / share
        rates = 2.0 * np.arccosh(1.0 / (1.0 - size[1:-1] / alpha)) / duration
        barrier = 1.0 - (1.0 - size / alpha) ** 2
        eta = float(np.clip(np.sqrt(np.median(barrier[1:] / barrier[:-1])), 0.3, 0.99))
        edges = np.repeat([math.log(alpha), math.log(np.median(rates)), eta], sides)
        found.append(np.concatenate([[offset, 0.0, impacts[0], size[0] / alpha], edges]))
    return found


def _misfit(t: Array, theta: Array, sign: float, sides: int, flights: int, stop: StopFlag | None, x: Array) -> Array:
    if stop is not None:
        stop.check()
    return _trace(t, x, sign, sides, flights)[0] - theta


def _fitted(misfit: Callable[[Array], Array], x: Array) -> OptimizeResult:
    sides = (x.size - FIRST_EDGE) // 3
    low = [-1.0, -np.inf, -np.inf, 1e-6, *[-12.0] * sides, *[-5.0] * sides, *[0.0] * sides]
    high = [1.0, np.inf, np.inf, HIGHEST_SHARE, *[math.log(MAX_ROTATION)] * sides, *[6.0] * sides, *[1.0] * sides]
    inside = np.clip(x, np.add(low, 1e-7), np.subtract(high, 1e-7))
    return least_squares(misfit, inside, bounds=(low, high), x_scale="jac", xtol=1e-12, ftol=1e-12)


def _trace(
    t: Array, x: Array, sign: float, sides: int, flights: int, changes: Array | None = None
) -> tuple[Array, Array]:
    """Rotation at times t (samples,), and times of the impacts (flights - 1,), from all unknowns.

    x: offset at the first impact, drift, time of that impact, peak before it over alpha, and of each edge ln alpha,
    ln p, eta. `changes` (2, flights): of ln alpha and ln eta, flight by flight.
    """
    impact, share = x[2:FIRST_EDGE]
    alpha, p, eta = x[FIRST_EDGE:].reshape(3, sides)
    alpha, p = np.exp(alpha), np.exp(p)
    side = 0 if sign > 0.0 else sides - 1
    tilts, kicks = np.exp(np.zeros((2, flights)) if changes is None else changes).tolist()
    angle = float(alpha[side]) * tilts[0]
    phi = angle - float(alpha[side]) * share
    theta = _level(t, x)
    impacts = np.empty(flights)
    begin = -math.inf
    for k in range(flights):
        m = math.cos(0.5 * phi) ** 2
        lowest = math.sin(0.5 * phi)
        edge = math.sin(0.5 * angle)
        dn = min(lowest / edge, 1.0)
        half = float(ellipkinc(math.asin(math.sqrt(max(1.0 - dn * dn, 0.0) / m)), m)) / p[side]
        centre = impact - half if k == 0 else begin + half
        end = centre + half
        inside = (t > begin) & ((t <= end) if k < flights - 1 else True)
        shape = ellipj(np.clip(p[side] * (t[inside] - centre), -1e3, 1e3), m)[2]
        theta[inside] += sign * (angle - 2.0 * np.arcsin(np.clip(lowest / shape, 0.0, 1.0)))
        impacts[k] = begin = end
        if k == flights - 1:
            break
        energy = p[side] ** 2 * (math.cos(phi) - math.cos(angle))
        side, sign = sides - 1 - side if sides == 2 else 0, -sign
        angle = float(alpha[side]) * tilts[k + 1]
        cosine = math.cos(angle) + (eta[side] * kicks[k + 1]) ** 2 * max(energy, 0.0) / p[side] ** 2
        phi = max(math.acos(min(cosine, 1.0)), (1.0 - HIGHEST_SHARE) * angle)
    return theta, impacts[:-1]


def _described(
    found: _Found, freedom: float, correlated: float, departure: float, changes: Array, noise: float
) -> xr.Dataset:
    """The result, with intervals from the Jacobian."""
    t, theta, used, model, impacts, fit, sides, level = found
    variance = 2.0 * fit.cost / freedom
    inverse = np.linalg.pinv(fit.jac)
    deviation = np.sqrt(variance * (inverse**2).sum(axis=1))
    tail, texts = 0.5 * (1.0 + level), []
    reach = float(stdtrit(freedom, tail)) * deviation
    plain = float(stdtrit(model.size - fit.x.size, tail)) * np.sqrt(2.0 * fit.cost / (model.size - fit.x.size))
    if departure:
        by_changes = departure * np.sqrt(((inverse @ changes) ** 2).sum(axis=1))
        reach = np.maximum(reach, float(stdtrit(impacts.size, tail)) * np.hypot(by_changes, deviation))
        texts.append(f"the flights depart from those of one rigid body on ground at rest by {100 * departure:.2g} %")
    if correlated > 1.0:
        texts.append(f"errors follow each other over {correlated:.2g} samples")
    if texts:
        alone = plain * np.sqrt((inverse**2).sum(axis=1))  # 0 at a confidence of almost 0
        wider = float(np.max(np.divide(reach, alone, out=np.ones_like(reach), where=alone > 0.0)))
        texts = [f"{' and '.join(texts)}: the intervals are up to {wider:.2g} times wider for it"]
    if abs(fit.x[1]) > SIGNIFICANT * deviation[1]:
        texts.append(f"the sensor drifts by {fit.x[1]:.3g} rad/s, which is taken off")
    fitted = np.full(t.shape, np.nan)
    fitted[used] = model
    about = "drift of the sensor"
    result = xr.Dataset(
        {
            "rotation": variable("time", theta, "rad", "measured rotation"),
            "fitted": variable("time", fitted, "rad", "rotation of the fitted body"),
            "residual": variable("time", theta - fitted, "rad", "measured less fitted rotation"),
            "impact_time": variable("impact", impacts, "s", "times of the impacts"),
            "offset": variable((), fit.x[0], "rad", "rotation of the body at rest, at the first impact"),
            "drift": variable((), fit.x[1], "rad s-1", about),
            "drift_lower": variable((), fit.x[1] - reach[1], "rad s-1", f"{about}, end of the interval"),
            "drift_upper": variable((), fit.x[1] + reach[1], "rad s-1", f"{about}, end of the interval"),
            "noise": variable(
                (), math.sqrt(2.0 * fit.cost / (model.size - fit.x.size)), "rad", "standard deviation of the residual"
            ),
            "sample_noise": variable((), noise, "rad", "standard deviation of independent errors of the samples"),
        },
        {
            "time": variable("time", t, "s", "time"),
            "edge": variable("edge", ["both"] if sides == 1 else ["right", "left"], "", "edge of rotation"),
        },
        {"confidence": level, "samples": int(used.sum()), "warnings": "; ".join(texts)},
    )
    for k, (name, unit, meaning) in enumerate(
        [("alpha", "rad", "slenderness angle"), ("frequency_parameter", "rad s-1", "frequency parameter p"),
         ("restitution", "1", "coefficient of restitution eta of impacts after which it turns on the edge")]
    ):  # fmt: skip
        own = slice(FIRST_EDGE + k * sides, FIRST_EDGE + (k + 1) * sides)
        for suffix, shift in (("", 0.0), ("_lower", -reach[own]), ("_upper", reach[own])):
            values = fit.x[own] + shift
            attributes = {"units": unit, "long_name": meaning + (", end of the interval" if suffix else "")}
            result[name + suffix] = (
                "edge",
                values if name == "restitution" else np.exp(np.minimum(values, MAX_LOG)),
                attributes,
            )
    return result
