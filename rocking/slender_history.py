"""Time history of the slender block: the flights that the solver recorded, sampled; then free rocking, impact by impact."""

from __future__ import annotations

import math

from rocking.compilation import Record, Vector, kernel
from rocking.slender_arcs import hyperbolic
from rocking.slender_flight import start_flight, state, turn

INVISIBLE = 1e-7
"""Velocity after an impact [-] below which free rocking is shown as rest: a rotation of 5e-15 alpha."""


@kernel
def sample_flights(
    tau: Vector, record: Vector, noted: int, first: float, end: float, flight: Record, rotation: Vector, velocity: Vector
) -> tuple[float, float, float]:
    """Fill rotation and velocity at the times `tau` up to the end of the pulse.

    Parameters
    ----------
    tau : float array (samples,)
        Times from the pulse's start [-], ascending.
    record, noted
        Flights as `slender.rock` wrote them, and how many.
    first, end : float
        Phases at which the pulse starts and ends [rad].
    flight
        The scratch that the solver left.
    rotation, velocity : float arrays (samples,)
        theta/alpha and theta'/(p alpha) [-]; zero where not reached.

    Returns
    -------
    z, w, sign : float
        The state at the end of the pulse, in the mirror image of the flight; sign 0 at rest.
    """
    entry = -1
    for i in range(len(tau) + 1):
        at_end = i == len(tau)
        phase = end if at_end else first + flight.omega * tau[i]
        if not at_end and phase > end:
            continue
        moved = False
        while entry + 1 < noted and record[entry + 1, 0] <= phase:
            entry += 1
            moved = True
        if entry < 0 or record[entry, 1] == 0.0:
            if at_end:
                return 0.0, 0.0, 0.0
            rotation[i], velocity[i] = 0.0, 0.0
            continue
        sign = record[entry, 1]
        if moved:
            turn(flight, record[entry, 0], flight.cosine0, flight.sine0)
            start_flight(flight, record[entry, 0], record[entry, 2], sign, False)
        turn(flight, phase, flight.cosine1, flight.sine1)
        z, w = state(flight, (phase - flight.phase) / flight.omega, flight.cosine1, flight.sine1)
        if at_end:
            return z, w, sign
        rotation[i], velocity[i] = sign * z, sign * w
    return 0.0, 0.0, 0.0


@kernel
def free_impacts(z: float, w: float, eta: float, horizon: float, times: Vector, speeds: Vector) -> int:
    """Impacts in free rocking from (z, w) until `horizon`: fills times and speeds before impact; returns their number.

    From rest position a flight with velocity w lasts 2 artanh(w) and returns with -w, (3.5).
    """
    if z + w >= 1.0:
        return 0
    squared = w * w + z * (2.0 - z) if z < 1.5 else 1.0 - (1.0 - z - w) * (1.0 - z + w)
    speed = math.sqrt(squared)
    time = math.log((1.0 + speed) / (1.0 - z - w))  # (3.13)
    count = 0
    while count < len(times) and time <= horizon:
        times[count], speeds[count] = time, speed
        count += 1
        speed *= eta
        if speed >= 1.0:
            break
        if speed <= INVISIBLE or count == len(times):
            speeds[count - 1] = 0.0  # the rest of the chatter is below anything that a history shows
            break
        time += 2.0 * math.atanh(speed)
    return count


@kernel
def sample_free(
    tau: Vector,
    end: float,
    z: float,
    w: float,
    sign: float,
    eta: float,
    times: Vector,
    speeds: Vector,
    impacts: int,
    rotation: Vector,
    velocity: Vector,
) -> None:
    """Fill rotation and velocity at the times `tau` after `end`, the pulse's end; `times` count from there, (3.5)."""
    passed = 0
    z0, w0, start, mirror = z, w, 0.0, sign
    for i in range(len(tau)):
        h = tau[i] - end
        if h <= 0.0:
            continue
        while passed < impacts and times[passed] <= h:
            z0, w0, start = 0.0, eta * speeds[passed], times[passed]
            mirror = -mirror
            passed += 1
        if z0 == 0.0 and w0 <= 0.0:
            rotation[i], velocity[i] = 0.0, 0.0
            continue
        cosh1, sinh = hyperbolic(h - start)
        rotation[i] = mirror * (z0 + (z0 - 1.0) * cosh1 + w0 * sinh)
        velocity[i] = mirror * (w0 + (z0 - 1.0) * sinh + w0 * cosh1)
