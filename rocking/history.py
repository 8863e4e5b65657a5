"""Time histories: one block from the start of the pulse through free rocking, as a labelled data set."""

from __future__ import annotations

import numpy as np
import xarray as xr

from rocking.errors import in_range
from rocking.pulses import AbstractPulse
from rocking.response import Outcome
from rocking.scratch import prepared
from rocking.slender import IMPACT_LIMIT, rock
from rocking.slender_history import free_impacts, sample_flights, sample_free
from rocking.solve import as_pulse, checked_groups

FREE_ROCKING = 8.0
"""Free rocking shown by default after the pulse [tau]."""

FREE_IMPACTS = 10_000
"""Most impacts of free rocking that are followed."""

FALLEN = 4.0
"""|theta|/alpha at which the default history of an overturning block ends [-]."""


def time_history(
    pulse: str | AbstractPulse,
    *,
    slenderness: float,
    frequency_ratio: float,
    restitution: float,
    alpha: float | None = None,
    duration: float | None = None,
    samples: int = 400,
) -> xr.Dataset:
    """Rotation and angular velocity of one block against time, exact at every sample.

    Parameters
    ----------
    pulse, slenderness, frequency_ratio, restitution, alpha
        As for `peak_response`; scalars.
    duration : float, optional
        Length [tau], > 0. By default the pulse and 8 units after it, or until |theta|/alpha = 4 where it overturns.
    samples : int
        Uniform samples, 2 to 1,000,000; uplift, impacts and the end of the pulse are added to them.

    Returns
    -------
    xarray.Dataset
        tau(tau): time p t from the start of the pulse [-]; rotation(tau): theta/alpha [-]; angular_velocity(tau):
        theta'/(p alpha) [-], after the impact at an impact; ground_acceleration(tau): a f [-];
        impact_time(impact) [-], impact_velocity(impact) before the impact [-]. Attributes: the question,
        outcome, overturned, peak_rotation, impacts.

    Raises
    ------
    InvalidArgumentError
        For an argument out of range.
    """
    in_range("samples", samples, 2, 1_000_000)
    if duration is not None:
        in_range("duration", duration, 0.0, np.inf, closed="neither")
    made = as_pulse(pulse)
    groups = checked_groups(slenderness, frequency_ratio, restitution)
    s, omega, eta = (float(group) for group in groups)
    scratch = prepared(made).copy()
    record = np.empty((2 * IMPACT_LIMIT, 3))
    outcome, peak, impacts, *_, noted = rock(s, omega, eta, scratch, record)
    record = record[:noted]
    end = (made.end - made.start) / omega
    horizon = end + FREE_ROCKING if duration is None else float(duration)

    starts = (record[:, 0] - made.start) / omega
    nothing = np.empty(0)
    z, w, sign = sample_flights(nothing, record, noted, made.start, made.end, scratch, nothing, nothing)
    times, speeds = np.empty(FREE_IMPACTS), np.empty(FREE_IMPACTS)
    count = free_impacts(z, w, eta, horizon - end, times, speeds) if sign else 0

    tau = np.concatenate([np.linspace(0.0, horizon, int(samples)), starts, [end], end + times[:count]])
    tau = np.unique(tau[tau <= horizon])
    rotation, velocity = np.zeros(tau.size), np.zeros(tau.size)
    sample_flights(tau, record, noted, made.start, made.end, scratch, rotation, velocity)
    sample_free(tau, end, z, w, sign, eta, times, speeds, count, rotation, velocity)
    if duration is None and outcome >= Outcome.OVERTURNED_DIRECTLY:
        fallen = np.flatnonzero(np.abs(rotation) > FALLEN)
        keep = slice(0, int(fallen[0]) + 1 if fallen.size else tau.size)
        tau, rotation, velocity = tau[keep], rotation[keep], velocity[keep]

    landed = np.flatnonzero((record[1:, 1] != record[:-1, 1]) & (record[:-1, 1] != 0.0)) + 1
    return xr.Dataset(
        {
            "rotation": ("tau", rotation, {"long_name": "rotation theta/alpha (3.4)", "units": "1"}),
            "angular_velocity": ("tau", velocity, {"long_name": "velocity theta'/(p alpha) (3.4)", "units": "1"}),
            "ground_acceleration": (
                "tau",
                made.acceleration(made.start + omega * tau) / s,
                {"long_name": "ground acceleration a f = u/(g tan alpha) (3.2)", "units": "1"},
            ),
            "impact_time": (
                "impact",
                np.concatenate([starts[landed], end + times[:count]]),
                {"long_name": "time of impact p t", "units": "1"},
            ),
        },
        coords={"tau": ("tau", tau, {"long_name": "time p t from the start of the pulse (3.6)", "units": "1"})},
        attrs={
            "pulse": made.name,
            "slenderness": s,
            "frequency_ratio": omega,
            "restitution": eta,
            "alpha": 0.0,
            "outcome": Outcome(outcome).name,
            "overturned": int(outcome >= Outcome.OVERTURNED_DIRECTLY),
            "peak_rotation": float(peak),
            "impacts": int(impacts),
            "pulse_end": end,
        },
    )
