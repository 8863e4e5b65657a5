"""Time histories: one block from the start of the pulse through free rocking, as a labelled data set."""

from __future__ import annotations

import numpy as np
import xarray as xr

from rocking.errors import in_range
from rocking.pulses import AbstractPulse
from rocking.response import Outcome
from rocking.rock import IMPACT_LIMIT
from rocking.sampling import rock_and_sample, rock_freely
from rocking.scratch import prepared
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
        Length [tau], > 0. By default the pulse and 8 units after it; where the block overturns, until
        |theta|/alpha = 4 or |theta| = pi/2.
    samples : int
        Uniform samples, 2 to 1,000,000; uplift, impacts and the end of the pulse are added to them.

    Returns
    -------
    xarray.Dataset
        tau(tau): time p t from the start of the pulse [-]; rotation(tau): theta/alpha [-]; angular_velocity(tau):
        theta'/(p alpha) [-], after the impact at an impact; ground_acceleration(tau): a f [-];
        impact_time(impact) [-]. Attributes: the question, outcome, overturned, peak_rotation, impacts.

    Raises
    ------
    InvalidArgumentError
        For an argument out of range.
    """
    in_range("samples", samples, 2, 1_000_000)
    if duration is not None:
        in_range("duration", duration, 0.0, np.inf, closed="neither")
    made = as_pulse(pulse)
    s, omega, eta, angle = (float(group) for group in checked_groups(slenderness, frequency_ratio, restitution, alpha))
    end = (made.end - made.start) / omega
    horizon = end + FREE_ROCKING if duration is None else float(duration)

    farthest = min(FALLEN, 0.5 * np.pi / angle) if angle > 0 else FALLEN  # it lies on the ground at pi/2

    # once for the events, then again with the events among the samples
    answer, nothing = prepared(made).copy(), np.empty(0)
    forced, free = np.empty(IMPACT_LIMIT), np.empty(FREE_IMPACTS)
    forced = forced[: rock_and_sample(s, omega, eta, angle, answer, farthest, nothing, nothing, nothing, forced)]
    free = free[: rock_freely(answer, eta, end, horizon, farthest, nothing, nothing, nothing, free)]
    landings = np.concatenate([forced, free])

    events = [0.0, end, float(np.nan_to_num(answer["uplift_time"]))]
    tau = np.concatenate([np.linspace(0.0, horizon, int(samples)), landings, events])
    tau = np.unique(tau[tau <= horizon])
    rotation, velocity = np.zeros(tau.size), np.zeros(tau.size)
    answer = prepared(made).copy()
    rock_and_sample(s, omega, eta, angle, answer, farthest, tau, rotation, velocity, nothing)
    # a step fills the samples before its end: the last one has to lie inside
    beyond = horizon * (1 + 1e-12)
    rock_freely(answer, eta, end, beyond, farthest, tau, rotation, velocity, np.empty(FREE_IMPACTS))
    outcome = Outcome(int(answer["outcome"]))
    if outcome >= Outcome.OVERTURNED_DIRECTLY:
        fallen = np.flatnonzero(np.abs(rotation) > farthest)
        last = int(fallen[0]) + 1 if fallen.size else int(np.flatnonzero(rotation).max(initial=0)) + 1
        tau, rotation, velocity = tau[:last], rotation[:last], velocity[:last]

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
                landings[landings <= horizon],
                {"long_name": "time of impact p t", "units": "1"},
            ),
        },
        coords={"tau": ("tau", tau, {"long_name": "time p t from the start of the pulse (3.6)", "units": "1"})},
        attrs={
            "pulse": made.name,
            "slenderness": s,
            "frequency_ratio": omega,
            "restitution": eta,
            "alpha": angle,
            "outcome": outcome.name,
            "overturned": int(outcome >= Outcome.OVERTURNED_DIRECTLY),
            "peak_rotation": float(answer["peak"]),
            "impacts": int(answer["impacts"]),
            "pulse_end": end,
        },
    )
