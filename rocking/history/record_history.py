"""Time histories of one block under a recorded ground motion, as labelled data sets."""

from __future__ import annotations

import numpy as np
import xarray as xr

from rocking._numba.cancellation import StopFlag
from rocking.errors import in_range
from rocking.excitation.records.record import Record
from rocking.history.body_motion import overturned
from rocking.history.contact import add_contact
from rocking.history.record_motion import build_record_motion
from rocking.model.response import Outcome

MAX_SAMPLES = 1_000_000
"""Largest number of uniform samples of a history."""


def record_history(
    motion: Record,
    *,
    frequency_parameter: float,
    slenderness: float,
    restitution: float,
    alpha: float | None = None,
    duration: float | None = None,
    samples: int | None = None,
    contact: bool = False,
    stop: StopFlag | None = None,
) -> xr.Dataset:
    """Rotation and angular velocity of one block under a recorded motion against time, exact to rounding.

    Parameters
    ----------
    motion, frequency_parameter, slenderness, restitution, alpha
        As for `record_response`; numbers.
    duration : float, optional
        Duration [s], > 0. By default the motion and 8/p after it; if the block overturns, until |theta|/alpha = 4 or
        |theta| = pi/2.
    samples : int, optional
        Number of uniform samples, 2 to 1,000,000; by default the samples of the motion, continued after its end. The
        uplift, impacts and the end of the motion are added.
    contact : bool
        Whether to add the reactions of the ground and the friction demand (docs/contact.md).
    stop : StopFlag, optional
        Cancels the work: it raises `StoppedError` soon after another thread sets the flag.

    Returns
    -------
    xarray.Dataset
        time(time) [s] from the first sample, and tau(time) = p t [-]; rotation(time): theta/alpha [-];
        angular_velocity(time): theta'/(p alpha) [-], after the impact at an impact; ground_acceleration(time): u [-],
        over g tan(alpha); impact_time(impact) [s]. Attributes: the arguments, outcome, overturned, peak_rotation,
        impacts. With `contact`, the variables and attributes of `rocking.history.contact.add_contact`.

    Raises
    ------
    InvalidArgumentError
        For an argument out of range.
    StoppedError
        If `stop` was set.
    """
    if samples is not None:
        in_range("samples", samples, 2, MAX_SAMPLES)
    groups = {
        "frequency_parameter": frequency_parameter,
        "slenderness": slenderness,
        "restitution": restitution,
        "alpha": alpha,
    }
    block = build_record_motion(motion, **groups, duration=duration, stop=stop)  # type: ignore[arg-type]  # alpha: None
    record, impact_times = block.events()
    if samples is None:
        interval = frequency_parameter * motion.time_step
        count = min(int(block.horizon / interval * (1.0 + 1e-12)) + 1, MAX_SAMPLES)
        grid = interval * np.arange(count)
    else:
        grid = np.linspace(0.0, block.horizon, int(samples))
    events = [0.0, block.pulse_end, float(np.nan_to_num(record["uplift_time"]))]
    tau = np.concatenate([grid, impact_times, events])
    tau = np.unique(tau[tau <= block.horizon])
    rotation, velocity = block.sample(tau)
    last = block.sample_count(tau, rotation, record)
    tau, rotation, velocity = tau[:last], rotation[:last], velocity[:last]
    impact_times = impact_times[impact_times <= tau[-1]]
    p = float(frequency_parameter)
    history = xr.Dataset(
        {
            "rotation": ("tau", rotation, {"long_name": "rotation theta/alpha", "units": "1"}),
            "angular_velocity": ("tau", velocity, {"long_name": "velocity theta'/(p alpha)", "units": "1"}),
            "ground_acceleration": (
                "tau",
                block.ground_acceleration(tau),
                {"long_name": "ground acceleration u/(g tan alpha)", "units": "1"},
            ),
            "impact_time": ("impact", impact_times / p, {"long_name": "time of impact", "units": "s"}),
        },
        coords={
            "tau": ("tau", tau, {"long_name": "p t from the first sample", "units": "1"}),
            "time": ("tau", tau / p, {"long_name": "time from the first sample", "units": "s"}),
        },
        attrs={
            "record": motion.name,
            "record_digest": motion.digest,
            "frequency_parameter": p,
            "slenderness": float(slenderness),
            "restitution": block.restitution,
            "alpha": block.alpha,
            "outcome": Outcome(int(record["outcome"])).name,
            "overturned": int(overturned(record)),
            "peak_rotation": float(record["peak_rotation"]),
            "impacts": int(record["impacts"]),
            "motion_end": motion.duration,
        },
    )
    if contact:
        history = add_contact(history, block, impact_times)
    return history.swap_dims(tau="time")
