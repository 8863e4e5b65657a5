"""Accuracy of the identification from free rocking: `python -m benchmarks.accuracy.free_rocking`.

Blocks of alpha from 0.15 to 0.4 rad, p from 1.5 to 4 rad/s and eta from 0.82 to 0.95 are held at 60 to 90 % of alpha,
released and filmed at 60 samples a second, with noise of 0.05 degrees and an offset. The traces are integrated with
Runge-Kutta steps, without the elliptic functions of the fit. With `--edges 2` alpha and p of the edges differ by up to
20 and 5 %, and each has its eta.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from rocking_assessment._evidence.free_rocking import identify_free_rocking

from benchmarks.measure import arguments
from rocking._base.errors import InvalidArgumentError

Array = NDArray[np.float64]

NAMES = "restitution", "alpha", "frequency_parameter"
RATE = 60
"""Samples a second."""

STEPS = 80
"""Steps of integration for each sample."""


def free_rocking(theta: Array, alpha: Array, p: Array, eta: Array, duration: float, rate: int = RATE) -> Array:
    """Rotation (bodies, samples) from rest at theta; alpha, p, eta (bodies,) or of right and left edge (2, bodies)."""
    alpha, p, eta = (np.broadcast_to(one, (2, *theta.shape)) for one in (alpha, p, eta))
    of = np.arange(theta.size)
    h = 1.0 / (rate * STEPS)
    omega = np.zeros_like(theta)
    found = [theta]
    for step in range(1, round(duration * rate) * STEPS + 1):
        sign = np.where(theta > 0.0, 1.0, -1.0)
        edge = (sign < 0.0).astype(int)
        angle, squared = alpha[edge, of], p[edge, of] ** 2

        def slope(x: Array, sign: Array = sign, angle: Array = angle, squared: Array = squared) -> Array:
            return np.asarray(-squared * np.sin(angle * sign - x))

        k1 = slope(theta)
        k2 = slope(theta + 0.5 * h * omega)
        k3 = slope(theta + 0.5 * h * omega + 0.25 * h * h * k1)
        k4 = slope(theta + h * omega + 0.5 * h * h * k2)
        after = theta + h * omega + h * h / 6.0 * (k1 + k2 + k3)
        speed = omega + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        hit = after * sign <= 0.0
        share = np.where(hit, theta / np.where(hit, theta - after, 1.0), 0.0)
        other = 1 - edge
        speed_after = eta[other, of] * (omega + share * (speed - omega))
        back = sign * p[other, of] ** 2 * np.sin(alpha[other, of])
        rest = (1.0 - share) * h
        theta = np.where(hit, speed_after * rest + 0.5 * back * rest**2, after)
        omega = np.where(hit, speed_after + back * rest, speed)
        if step % STEPS == 0:
            found.append(theta)
    return np.array(found).T


def errors(traces: int, seed: int, edges: int = 1) -> tuple[Array, NDArray[np.bool_]]:
    """Errors (traces, 3) of eta, and of alpha and p over their values; and whether each lies within its interval.

    With two edges (traces times 2, 3), without bodies that overturn and traces that have too few impacts.
    """
    rng = np.random.default_rng(seed)
    alpha, p, eta = (rng.uniform(*ends, (edges, traces)) for ends in ((0.15, 0.4), (1.5, 4.0), (0.82, 0.95)))
    if edges == 2:
        alpha[1], p[1] = alpha[0] * rng.uniform(0.8, 1.2, traces), p[0] * rng.uniform(0.95, 1.05, traces)
    start = alpha.min(axis=0) * rng.uniform(0.6, 0.9, traces) * rng.choice([-1.0, 1.0], traces)
    clean = free_rocking(start, alpha, p, eta, 8.0)
    held = rng.integers(5, 40, traces)
    found, within = [], []
    for k in np.flatnonzero(np.abs(clean).max(axis=1) < 0.5 * np.pi):
        rotation = np.concatenate([np.full(held[k], start[k]), clean[k]])
        rotation += np.radians(0.05) * rng.normal(size=rotation.size) + 0.003 * rng.normal()
        try:
            fit = identify_free_rocking(np.arange(rotation.size) / RATE, rotation, edges=edges)
        except InvalidArgumentError as error:
            if edges == 1 or "impacts" not in str(error.value):
                raise
            continue
        true = np.stack([eta[:, k], alpha[:, k], p[:, k]], axis=1)
        best, low, high = (np.stack([fit[name + end] for name in NAMES], axis=1) for end in ("", "_lower", "_upper"))
        found.append((best - true) / np.where(np.arange(3) == 0, 1.0, true))
        within.append((low <= true) & (true <= high))
    return np.concatenate(found), np.concatenate(within)


if __name__ == "__main__":
    given = arguments(__doc__, traces=200, seed=1, edges=1)
    found, within = errors(given.traces, given.seed, given.edges)
    print(f"{len(found)} edges" if given.edges == 2 else f"{len(found)} traces")
    print(f"{'':22}{'median':>10}{'95 %':>10}{'largest':>10}{'within':>10}")
    for n, name in enumerate(NAMES):
        size = np.abs(found[:, n])
        row = np.median(size), np.percentile(size, 95), size.max()
        print(f"{name:22}" + "".join(f"{value:10.5f}" for value in row) + f"{within[:, n].mean():10.1%}")
