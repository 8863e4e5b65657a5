"""Accuracy of the identification from free rocking: `python -m benchmarks.accuracy.free_rocking`.

Blocks of alpha from 0.15 to 0.4 rad, p from 1.5 to 4 rad/s and eta from 0.82 to 0.95 are held at 60 to 90 % of alpha,
released and filmed at 60 samples a second, with noise of 0.05 degrees and an offset. The traces are integrated with
Runge-Kutta steps, without the elliptic functions of the fit. With `--edges 2` alpha and p of the edges differ by up to
20 and 5 %, and each has its eta. `--kind` adds one departure from such a trace, of those in `KINDS`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rocking_assessment._evidence.free_rocking import identify_free_rocking
from scipy.signal import butter, lfilter, sosfilt, sosfiltfilt

from benchmarks.measure import arguments
from rocking._base.errors import InvalidArgumentError

Array = NDArray[np.float64]

NAMES = "restitution", "alpha", "frequency_parameter"
RATE = 60
"""Samples a second."""

STEPS = 80
"""Steps of integration for each sample."""

NOISE = np.radians(0.05)
"""Standard deviation of the errors of samples [rad]."""

KINDS = {
    "plain": "none",
    "jittered": "times of samples that are 1 ms off (standard deviation), unknown to the fit",
    "gappy": "a tenth of the samples is missing, in gaps of up to 0.1 s",
    "drifting": "a drift of up to 0.003 rad/s",
    "hand-held": "one to two seconds in a hand that moves by 2 % of the rotation",
    "moving-average": "a moving average of five samples",
    "low-pass": "a Butterworth filter of order 2 at 10 Hz, forwards and backwards",
    "causal-low-pass": "a Butterworth filter of order 2 at 10 Hz, forwards only",
    "correlated": "errors of 0.05 degrees that follow each other over 10 samples, in place of independent ones",
    "ground": "a sinusoidal ground motion of 0.5 to 5 Hz at 5 % of the acceleration of uplift",
    "restitution": "a restitution that varies from impact to impact by 2 % (standard deviation)",
    "push": "a release with a velocity towards the rest position of up to half of p alpha",
}
"""Departures from a plain trace."""


def free_rocking(
    theta: Array,
    alpha: Array,
    p: Array,
    eta: Array,
    duration: float,
    rate: int = RATE,
    *,
    velocity: Array | float = 0.0,
    ground: Callable[[float], Array | float] | None = None,
    kicks: Array | None = None,
) -> Array:
    """Rotation (bodies, samples) from theta [rad] and a velocity [rad/s].

    alpha, p, eta are (bodies,) or of right and left edge (2, bodies). `ground` is the ground acceleration over g at a
    time; `kicks` (impacts, bodies) are factors of eta.
    """
    alpha, p, eta = (np.broadcast_to(value, (2, *theta.shape)) for value in (alpha, p, eta))
    body = np.arange(theta.size)
    h = 1.0 / (rate * STEPS)
    omega = np.zeros_like(theta) + velocity
    impacts = np.zeros(theta.size, dtype=np.intp)
    samples = [theta]
    for step in range(1, round(duration * rate) * STEPS + 1):
        sign = np.where(theta > 0.0, 1.0, -1.0)
        edge = (sign < 0.0).astype(int)
        angle, squared = alpha[edge, body], p[edge, body] ** 2
        push = [ground(h * (step - 1.0 + part)) if ground else 0.0 for part in (0.0, 0.5, 1.0)]

        def slope(x: Array, push: Array | float, tilt: Array = angle * sign, squared: Array = squared) -> Array:
            return np.asarray(-squared * (np.sin(tilt - x) + push * np.cos(tilt - x)))

        k1 = slope(theta, push[0])
        k2 = slope(theta + 0.5 * h * omega, push[1])
        k3 = slope(theta + 0.5 * h * omega + 0.25 * h * h * k1, push[1])
        k4 = slope(theta + h * omega + 0.5 * h * h * k2, push[2])
        after = theta + h * omega + h * h / 6.0 * (k1 + k2 + k3)
        speed = omega + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        hit = after * sign <= 0.0
        share = np.where(hit, theta / np.where(hit, theta - after, 1.0), 0.0)
        other = 1 - edge
        factor = eta[other, body]
        if kicks is not None:
            factor = factor * kicks[np.minimum(impacts, len(kicks) - 1), body]
        speed_after = factor * (omega + share * (speed - omega))
        back = sign * p[other, body] ** 2 * np.sin(alpha[other, body])
        rest = (1.0 - share) * h
        theta = np.where(hit, speed_after * rest + 0.5 * back * rest**2, after)
        omega = np.where(hit, speed_after + back * rest, speed)
        impacts = impacts + hit
        if step % STEPS == 0:
            samples.append(theta)
    return np.array(samples).T


class Trace(NamedTuple):
    """A trace, and the block behind it: eta, alpha, p (edges, 3)."""

    time: Array
    rotation: Array
    block: Array


def traces(count: int, seed: int, edges: int = 1, kind: str = "plain") -> list[Trace]:
    """Return traces of a kind; with two edges without bodies that overturn, with a push too."""
    rng = np.random.default_rng(seed)
    alpha, p, eta = (rng.uniform(*ends, (edges, count)) for ends in ((0.15, 0.4), (1.5, 4.0), (0.82, 0.95)))
    if edges == 2:
        alpha[1], p[1] = alpha[0] * rng.uniform(0.8, 1.2, count), p[0] * rng.uniform(0.95, 1.05, count)
    start = alpha.min(axis=0) * rng.uniform(0.6, 0.9, count) * rng.choice([-1.0, 1.0], count)
    held = rng.integers(5, 40, count)
    other = np.random.default_rng([seed, 1])  # of the departures, so that the blocks of all kinds are the same
    velocity = -np.sign(start) * p[0] * np.abs(alpha[0]) * other.uniform(0.0, 0.5, count) if kind == "push" else 0.0
    kicks = 1.0 + 0.02 * other.normal(size=(200, count)) if kind == "restitution" else None
    hertz, phase = other.uniform(0.5, 5.0, count), other.uniform(0.0, 2.0 * np.pi, count)
    strength = 0.05 * np.tan(alpha.min(axis=0)) if kind == "ground" else 0.0

    def ground(time: float) -> Array:
        return strength * np.sin(2.0 * np.pi * hertz * time + phase)

    clean = free_rocking(start, alpha, p, eta, 8.0, velocity=velocity, ground=ground, kicks=kicks)
    found = []
    for k in np.flatnonzero(np.abs(clean).max(axis=1) < 0.5 * np.pi):
        if kind == "hand-held":
            held[k] = other.integers(60, 120)
        rotation = np.concatenate([np.full(held[k], start[k]), clean[k]])
        time = np.arange(rotation.size) / RATE
        noise = NOISE * rng.normal(size=rotation.size)
        measured = _departed(kind, time, rotation, noise, int(held[k]), other)
        block = np.stack([eta[:, k], alpha[:, k], p[:, k]], axis=1)
        found.append(Trace(*measured[:1], measured[1] + 0.003 * rng.normal(), block))
    return found


def _departed(
    kind: str, time: Array, clean: Array, noise: Array, held: int, rng: np.random.Generator
) -> tuple[Array, Array]:
    """Times and rotation of a trace with errors, after what a kind does to the samples."""
    rotation = clean + noise
    if kind == "jittered":
        return time, np.interp(time + 1e-3 * rng.normal(size=time.size), time, clean) + noise
    if kind == "gappy":
        left = np.ones(time.size, dtype=bool)
        while left.mean() > 0.9:
            first = rng.integers(time.size)
            left[first : first + rng.integers(1, 7)] = False
        return time[left], rotation[left]
    if kind == "drifting":
        return time, rotation + rng.uniform(-0.003, 0.003) * time
    if kind == "hand-held":
        moved = np.sin(2.0 * np.pi * rng.uniform(0.5, 3.0) * (time[:held] - time[held]))
        rotation[:held] += 0.02 * clean[0] * moved
        return time, rotation
    if kind == "moving-average":
        return time[2:-2], np.convolve(rotation, np.full(5, 0.2), mode="valid")
    if kind == "low-pass":
        return time, sosfiltfilt(butter(2, 10.0, fs=RATE, output="sos"), rotation)
    if kind == "causal-low-pass":
        state = clean[0]
        return time, state + sosfilt(butter(2, 10.0, fs=RATE, output="sos"), rotation - state)
    if kind == "correlated":
        persistence = 0.8  # 1 + 2 (0.8 + 0.8^2 + ...) = 9
        white = NOISE * np.sqrt(1.0 - persistence**2) * rng.normal(size=time.size + 100)
        return time, clean + lfilter([1.0], [1.0, -persistence], white)[100:]
    return time, rotation


class Errors(NamedTuple):
    """Errors (edges, 3) of eta, and of alpha and p over their values; whether each lies within its interval.

    And the half width of the intervals, over the values, and the number of traces that were refused.
    """

    error: Array
    within: NDArray[np.bool_]
    width: Array
    refused: int


def errors(count: int, seed: int, edges: int = 1, kind: str = "plain") -> Errors:
    """Errors of traces of a kind, without traces that are refused."""
    error, within, width, refused = [], [], [], 0
    for trace in traces(count, seed, edges, kind):
        try:
            fit = identify_free_rocking(trace.time, trace.rotation, edges=edges)
        except InvalidArgumentError:
            refused += 1
            continue
        best, low, high = (np.stack([fit[name + end] for name in NAMES], axis=1) for end in ("", "_lower", "_upper"))
        unit = np.where(np.arange(3) == 0, 1.0, trace.block)
        error.append((best - trace.block) / unit)
        within.append((low <= trace.block) & (trace.block <= high))
        width.append(0.5 * (high - low) / unit)
    if not error:
        return Errors(np.empty((0, 3)), np.empty((0, 3), dtype=bool), np.empty((0, 3)), refused)
    return Errors(np.concatenate(error), np.concatenate(within), np.concatenate(width), refused)


if __name__ == "__main__":
    given = arguments(__doc__, traces=200, seed=1, edges=1, kind="plain")
    result = errors(given.traces, given.seed, given.edges, given.kind)
    print(f"{given.kind}: {len(result.error)} {'edges' if given.edges == 2 else 'traces'}, {result.refused} refused")
    print(f"{'':22}{'median':>10}{'95 %':>10}{'largest':>10}{'interval':>10}{'within':>10}")
    for n, name in enumerate(NAMES):
        size = np.abs(result.error[:, n])
        row = np.median(size), np.percentile(size, 95), size.max(), np.median(result.width[:, n])
        print(f"{name:22}" + "".join(f"{value:10.5f}" for value in row) + f"{result.within[:, n].mean():10.1%}")
