"""Motion that is not integrated: after the pulse, in chatter, beyond return, and a first flight that is already known.

The block is integrated with the flights of the package, one after another, and on request beyond the point where the
solver stops.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.ablations.ablation import Ablation, measure_both
from rocking._excitation.pulses import as_pulse
from rocking._history.motion import MAX_FREE_IMPACTS, MAX_ROTATION
from rocking._history.sampling import REST_VELOCITY, sample_free_rocking
from rocking._numba.cancellation import NEVER_STOPPED
from rocking._numba.compilation import FloatArray, Record, entry, kernel
from rocking._solver.kernels.event_loop import end_flight, init_state, start_flight
from rocking._solver.peak_response import peak_response
from rocking._solver.records.state import BLOCK_STATE
from rocking._solver.rules import RECOVERS, set_block
from rocking._solver.state import pulse_state, step_state
from rocking._solver.taylor.flight import flight_by_steps
from rocking._solver.taylor.step import take_step

PULSE, RESTITUTION = "sine", 0.85
ALPHA = {"slender": 0.0, "rigid, 20 degrees": math.radians(20.0)}
RESTITUTIONS = (0.80, 0.82, 0.84, 0.85, 0.86, 0.88, 0.90, 0.92, 0.94, 0.96, 1.00)
"""Those of the reproduction."""

CHATTER, BEYOND, FREE = 1, 2, 4
"""Flags: what is integrated in addition; they can be added."""

FLIGHTS, FARTHER, IMPACTS, WRONG_OUTCOMES = 0, 1, 2, 3
"""Indices of the counts: flights during the pulse; Taylor steps beyond return; impacts after the pulse;
outcomes of the motion integrated after the pulse that differ from the outcome by energy."""

LONG_DURATION = 1e6
"""Time after the pulse that no block exceeds [tau]."""


@kernel
def advance(flight: Record, steps: Record) -> bool:
    """Follow the next flight of any block to its end; False if it is the last or there is none."""
    if not start_flight(flight):
        return False
    ended, w, z = flight_by_steps(flight, steps)
    flight.length, top = flight.elapsed, flight.largest_z
    return end_flight(flight, ended, w, z, top)


@kernel
def continue_beyond_return(flight: Record, steps: Record, phase: float) -> int:
    """Continue from an overturning at `phase` to the end of the pulse; return the number of steps."""
    found = 0
    steps.z0[0], steps.w0[0], steps.starts_at_uplift[0], steps.phase[0] = (
        flight.end_rotation,
        flight.end_velocity,
        0.0,
        phase,
    )
    left = (flight.end_phase[flight.pieces] - phase) / flight.omega
    while left > 0.0:
        steps.limit[0] = left
        take_step(steps)
        left -= steps.h[0]
        steps.z0[0], steps.w0[0] = steps.z1[0], steps.w1[0]
        steps.phase[0] += flight.omega * steps.h[0]
        found += 1
    return found


@kernel
def follow_block(
    slenderness: float,
    omega: float,
    eta: float,
    alpha: float,
    flight: Record,
    body: Record,
    steps: Record,
    followed: int,
    history: FloatArray,
    impact_times: FloatArray,
    stop: FloatArray,
    counts: FloatArray,
) -> None:
    """Solve one block as the solver does, and integrate farther where `followed` says so."""
    set_block(flight, slenderness, eta, alpha)
    init_state(flight, omega)
    going, phase = flight.interval_count > 0, math.inf
    while going:
        flight.length = math.nan
        going = advance(flight, steps)
        if math.isnan(flight.length):
            break
        counts[FLIGHTS] += 1
        phase = flight.phase + omega * flight.length
        if followed & CHATTER and flight.at_rest == 1 and flight.next_w > REST_VELOCITY:
            flight.at_rest = flight.chatter = 0
    if flight.end_sign == 0.0:
        return
    before_end = phase < flight.end_phase[flight.pieces] * (1.0 - 1e-12)
    if before_end and followed & BEYOND:
        counts[FARTHER] += continue_beyond_return(flight, steps, phase)
    if not before_end and followed & FREE:
        set_block(body, slenderness, eta, alpha)
        farthest = min(MAX_ROTATION, 0.5 * math.pi / alpha) if alpha > 0.0 else MAX_ROTATION
        counts[IMPACTS] += sample_free_rocking(
            flight.end_rotation,
            flight.end_velocity,
            flight.end_sign,
            body,
            steps,
            0.0,
            LONG_DURATION,
            farthest,
            history,
            impact_times,
            stop,
        )
        counts[WRONG_OUTCOMES] += (steps.z0[0] >= farthest) != (flight.outcome > RECOVERS)


@entry
def follow_blocks(
    slenderness: FloatArray,
    omega: FloatArray,
    eta: float,
    alpha: float,
    flight: Record,
    body: Record,
    steps: Record,
    followed: int,
    history: FloatArray,
    impact_times: FloatArray,
    stop: FloatArray,
    counts: FloatArray,
    peaks: FloatArray,
) -> None:
    """Solve blocks one after another; fills `peaks` (cells,)."""
    for i in range(len(slenderness)):
        follow_block(
            slenderness[i], omega[i], eta, alpha, flight, body, steps, followed, history, impact_times, stop, counts
        )
        peaks[i] = flight.peak_rotation


def control_plane(side: int, *, lowest: float = 0.02, highest: float = 0.98) -> tuple[NDArray[np.float64], ...]:
    """Return 1/a and omega of side x side blocks, ravelled."""
    axes = np.meshgrid(np.linspace(lowest, highest, side), np.geomspace(0.5, 12.0, side), indexing="ij")
    return axes[0].ravel(), axes[1].ravel()


def followed(alpha: float, side: int, what: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return counts and peaks of the blocks with the additional motion `what`."""
    flight = pulse_state(as_pulse(PULSE)).copy()
    cells, counts = control_plane(side), np.zeros(4)
    peaks = np.empty(side * side)
    follow_blocks(
        *cells,
        RESTITUTION,
        alpha,
        flight,
        np.zeros(1, BLOCK_STATE)[0],
        step_state(flight),
        what,
        np.empty((3, 0)),
        np.empty(MAX_FREE_IMPACTS),
        NEVER_STOPPED,
        counts,
        peaks,
    )
    return counts, peaks


def motions(side: int, rounds: int) -> Iterator[Ablation]:
    """Yield free rocking, chatter and motion beyond return, integrated and not."""
    kinds = {
        FREE: ("free rocking after the pulse", "impacts after the pulse", IMPACTS),
        CHATTER: ("chatter", "flights", FLIGHTS),
        BEYOND: ("motion beyond return", "Taylor steps", FARTHER),
    }
    for what, (name, unit, key) in kinds.items():
        for kind, alpha in ALPHA.items():
            (done, peaks), (more, peaks_without) = followed(alpha, side, 0), followed(alpha, side, what)
            other = np.sum(~((peaks == peaks_without) | np.isnan(peaks) & np.isnan(peaks_without)))
            changed = int(other + more[WRONG_OUTCOMES])
            times = measure_both(
                f"{name}, {kind}",
                lambda alpha=alpha: followed(alpha, side, 0),
                lambda alpha=alpha, what=what: followed(alpha, side, what),
                rounds,
            )
            yield Ablation(
                f"{name}: {kind}", unit, int(done[key]), int(more[key]), *times, changed, f"{side**2:,d} blocks"
            )


def no_uplift(side: int, rounds: int) -> Ablation:
    """Compare blocks that the ground cannot uplift with blocks that it uplifts."""
    quiet, lifted = control_plane(side, lowest=1.0, highest=2.0), control_plane(side)

    def ask(cells: tuple[NDArray[np.float64], ...]) -> Any:
        return peak_response(PULSE, slenderness=cells[0], frequency_ratio=cells[1], restitution=RESTITUTION, threads=1)

    count = [int(np.sum(np.isfinite(ask(cells).uplift_time))) for cells in (quiet, lifted)]
    times = measure_both("no uplift", lambda: ask(quiet), lambda: ask(lifted), rounds)
    note = "blocks with 1/a in [1, 2], compared with as many with 1/a in [0.02, 0.98]"
    return Ablation("blocks that never uplift: slender", "flights, at least", *count, *times, note=note)


def first_flights(side: int, rounds: int) -> Iterator[Ablation]:
    """Yield restitutions solved along the last axis, which share first flights, and along the first axis."""
    slenderness, omega = control_plane(side)
    eta = np.array(RESTITUTIONS)

    def ask(alpha: float, *, last: bool) -> Any:
        groups = (slenderness[:, None], omega[:, None], eta) if last else (slenderness, omega, eta[:, None])
        names = ("slenderness", "frequency_ratio", "restitution")
        return peak_response(PULSE, **dict(zip(names, groups, strict=True)), alpha=alpha or None, threads=1)

    for kind, alpha in ALPHA.items():
        first, last = ask(alpha, last=False).peak_rotation.T, ask(alpha, last=True).peak_rotation
        changed = int(np.sum(~((first == last) | np.isnan(first) & np.isnan(last))))
        times = measure_both(
            f"first flights, {kind}",
            lambda alpha=alpha: ask(alpha, last=True),
            lambda alpha=alpha: ask(alpha, last=False),
            rounds,
        )
        note = f"{eta.size} restitutions along the last axis or the first"
        yield Ablation(
            f"first flights: {kind}", "first flights", omega.size, omega.size * eta.size, *times, changed, note
        )
