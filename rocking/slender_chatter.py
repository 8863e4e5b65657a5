"""Chatter: impacts that accumulate at a finite time. Their sum is bounded, not followed."""

from __future__ import annotations

import math

from rocking.compilation import Record, kernel


@kernel
def ground_acceleration(flight: Record, phase: float) -> float:
    """a f(phi) [-]."""
    u = 0.0
    for k in range(len(flight.force)):
        u += flight.a * flight.amplitude[k] * math.cos(flight.multiple[k] * phase + flight.shift[k])
    return u


@kernel
def settles(flight: Record, w: float, eta: float, phase: float, end: float, peak: float) -> bool:
    """Whether chatter from velocity w just after an impact at `phase` surely ends in rest before the phase `end`.

    f is monotone up to `end` and |a f| < 1 there. On a window with pulls in [q1, q2] (for each sign of rotation) a
    flight from w rises to z_m <= w^2/(2 (q1 - z_m)), lasts at most 2 w/(q1 - z_m) and lands with at most
    w sqrt(q2/(q1 - z_m)); with the restitution this bounds a geometric series. True only if its sum fits into the
    window and no flight can pass the peak so far.
    """
    u0 = ground_acceleration(flight, phase)
    window = 8.0 * w / ((1.0 - abs(u0)) * (1.0 - eta))
    if not phase + flight.omega * window <= end:
        return False
    u1 = ground_acceleration(flight, phase + flight.omega * window)
    least, most = min(u0, u1), max(u0, u1)
    weakest = 1.0 - max(abs(u0), abs(u1))
    if weakest <= 0.0:
        return False
    height = w * w / weakest  # above z_m while it stays below weakest/2
    if height > 0.5 * weakest or height > peak:
        return False
    spread = max((1.0 + most) / (1.0 + least - height), (1.0 - least) / (1.0 - most - height))
    ratio = eta * math.sqrt(spread)
    return ratio < 1.0 and 2.0 * w <= window * (weakest - height) * (1.0 - ratio)
