"""Chatter under a pulse: the window on which `rocking._solver.rules.impacts_accumulate` bounds the impacts."""

from rocking._numba.compilation import Record, kernel
from rocking._solver.excitation import shape_at
from rocking._solver.rules import impacts_accumulate, pulls_of


@kernel
def chatter_ends_in_rest(flight: Record, w: float, phase: float, end: float) -> bool:
    """Whether chatter from velocity w just after an impact at `phase` certainly ends in rest before the phase `end`.

    Given: an impact in an interval of level 0 that lasts to `end`. Decided: whether the impacts that follow accumulate
    to rest in it. The window is four times as long as the series of flights would be under the present q. f is monotone
    up to `end`, so that q on both edges takes its extremes at the two ends of the window: no value between is missed.
    """
    stiffest = flight.level * max(1.0, flight.stiffness[1])
    loss = 1.0 - max(flight.eta[0], flight.eta[1])
    # q <= 1 on one of the edges, and sin(alpha_s) <= alpha_s: the window is at least this long, whatever f is
    if not phase + flight.omega * (8.0 * w / (stiffest * loss)) <= end:
        return False
    f0 = shape_at(phase, flight)
    pulls = pulls_of(flight)
    first = min(pulls[0] * (1.0 + flight.a[0] * f0), pulls[1] * (1.0 - flight.a[1] * f0))
    window = 8.0 * w / (first * loss)
    if not phase + flight.omega * window <= end:
        return False
    # the pulse at the end of the window; the extremes of q on the right edge and on the left one
    f1 = shape_at(phase + flight.omega * window, flight)
    least, most = min(f0, f1), max(f0, f1)
    right = 1.0 + flight.a[0] * least, 1.0 + flight.a[0] * most
    left = 1.0 - flight.a[1] * most, 1.0 - flight.a[1] * least
    return bool(impacts_accumulate(flight, w, pulls, window, right, left, 1.0))
