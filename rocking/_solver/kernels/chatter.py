"""Chatter under a pulse: the window on which `rocking._solver.rules.impacts_accumulate` bounds the impacts."""

from rocking._numba.compilation import Record, kernel
from rocking._solver.excitation import shape_at
from rocking._solver.rules import impacts_accumulate, pulls_of


@kernel
def chatter_ends_in_rest(flight: Record, w: float, phase: float, end: float) -> bool:
    """Whether chatter from velocity w just after an impact at `phase` certainly ends in rest before the phase `end`.

    f is monotone up to `end` and both edges are held down there, so that q takes its extremes at the ends of the
    window.
    """
    stiffest = max(1.0, flight.stiffness[1])
    loss = 1.0 - max(flight.eta[0], flight.eta[1])
    if not phase + flight.omega * (8.0 * w / (stiffest * loss)) <= end:  # the window is longer: most impacts end here
        return False
    f0 = shape_at(phase, flight)
    pulls = pulls_of(flight)
    first = min(pulls[0] * (1.0 + flight.a[0] * f0), pulls[1] * (1.0 - flight.a[1] * f0))
    window = 8.0 * w / (first * loss)
    if not phase + flight.omega * window <= end:
        return False
    f1 = shape_at(phase + flight.omega * window, flight)
    least, most = min(f0, f1), max(f0, f1)
    right = 1.0 + flight.a[0] * least, 1.0 + flight.a[0] * most
    left = 1.0 - flight.a[1] * most, 1.0 - flight.a[1] * least
    return bool(impacts_accumulate(flight, w, pulls, window, right, left, 1.0))
