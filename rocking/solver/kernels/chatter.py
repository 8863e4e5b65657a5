"""Chatter: impacts that accumulate at a finite time. Their geometric series is bounded instead of followed."""

from __future__ import annotations

import math

from rocking._numba.compilation import Record, kernel
from rocking.solver.excitation import shape_at


@kernel
def ground_acceleration(flight: Record, phase: float) -> float:
    """a f(phi) [-]."""
    return flight.a * shape_at(phase, flight)


@kernel
def chatter_ends_in_rest(flight: Record, w: float, eta: float, phase: float, end: float, peak: float) -> bool:
    """Whether chatter from velocity w just after an impact at `phase` certainly ends in rest before the phase `end`.

    f is monotone up to `end` and |a f| < 1 there. Near the ground -z'' lies within q +- k z with the restoring
    acceleration q = (sin(alpha)/alpha)(1 +- a f), one for each sign of rotation, and k = 1 + tan(alpha). On a window
    with q in [q1, q2] a flight from w rises to z_m <= w^2/(2 (q1 - k z_m)), lasts at most 2 w/(q1 - k z_m), and its
    impact velocity is at most w sqrt((q2 + k z_m)/(q1 - k z_m)). With the restitution this bounds a geometric series.
    True only if its sum fits into the window and no flight can exceed the peak so far.
    """
    if not phase + flight.omega * (8.0 * w / (1.0 - eta)) <= end:  # the window is longer: most impacts end here
        return False
    scale = math.sin(flight.alpha) / flight.alpha if flight.alpha > 0.0 else 1.0
    u0 = ground_acceleration(flight, phase)
    window = 8.0 * w / (scale * (1.0 - abs(u0)) * (1.0 - eta))
    if not phase + flight.omega * window <= end:
        return False
    u1 = ground_acceleration(flight, phase + flight.omega * window)
    least, most = min(u0, u1), max(u0, u1)
    weakest = scale * (1.0 - max(abs(u0), abs(u1)))
    if weakest <= 0.0:
        return False
    height = w * w / weakest  # above z_m while k z_m stays below weakest/2
    softening = (1.0 + math.tan(flight.alpha)) * height
    if softening > 0.5 * weakest or height > peak:
        return False
    spread = max(
        (scale * (1.0 + most) + softening) / (scale * (1.0 + least) - softening),
        (scale * (1.0 - least) + softening) / (scale * (1.0 - most) - softening),
    )
    ratio = eta * math.sqrt(spread)
    return ratio < 1.0 and 2.0 * w <= window * (weakest - softening) * (1.0 - ratio)
