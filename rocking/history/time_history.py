"""Time histories: one block from the start of the pulse through free rocking, as a labelled data set."""

from __future__ import annotations

import numpy as np
import xarray as xr

from rocking._numba.cancellation import StopFlag
from rocking.errors import in_range
from rocking.excitation.pulses import AbstractPulse
from rocking.history.contact import add_contact
from rocking.history.motion import build_motion, overturned
from rocking.model.response import Outcome


def time_history(
    pulse: str | AbstractPulse,
    *,
    slenderness: float,
    frequency_ratio: float,
    restitution: float,
    alpha: float | None = None,
    duration: float | None = None,
    samples: int = 400,
    contact: bool = False,
    stop: StopFlag | None = None,
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
    contact : bool
        Whether to add the reactions of the ground and the friction that they need (docs/contact.md).
    stop : StopFlag, optional
        Once another thread sets it, this ends soon with `StoppedError`.

    Returns
    -------
    xarray.Dataset
        tau(tau): time p t from the start of the pulse [-]; rotation(tau): theta/alpha [-]; angular_velocity(tau):
        theta'/(p alpha) [-], after the impact at an impact; ground_acceleration(tau): a f [-];
        impact_time(impact) [-]. Attributes: the question, outcome, overturned, peak_rotation, impacts. With
        `contact`, what `history_contact.add_contact` adds.

    Raises
    ------
    InvalidArgumentError
        For an argument out of range.
    StoppedError
        If `stop` was set.
    """
    in_range("samples", samples, 2, 1_000_000)
    groups = {"slenderness": slenderness, "frequency_ratio": frequency_ratio, "restitution": restitution}
    motion = build_motion(pulse, **groups, alpha=alpha, duration=duration, stop=stop)
    answer, landings = motion.events()  # they are among the samples
    events = [0.0, motion.pulse_end, float(np.nan_to_num(answer["uplift_time"]))]
    tau = np.concatenate([np.linspace(0.0, motion.horizon, int(samples)), landings, events])
    tau = np.unique(tau[tau <= motion.horizon])
    rotation, velocity = motion.sample(tau)
    last = motion.sample_count(tau, rotation, answer)
    tau, rotation, velocity = tau[:last], rotation[:last], velocity[:last]
    history = xr.Dataset(
        {
            "rotation": ("tau", rotation, {"long_name": "rotation theta/alpha (3.4)", "units": "1"}),
            "angular_velocity": ("tau", velocity, {"long_name": "velocity theta'/(p alpha) (3.4)", "units": "1"}),
            "ground_acceleration": (
                "tau",
                motion.ground_acceleration(tau),
                {"long_name": "ground acceleration a f = u/(g tan alpha) (3.2)", "units": "1"},
            ),
            "impact_time": ("impact", landings, {"long_name": "time of impact p t", "units": "1"}),
        },
        coords={"tau": ("tau", tau, {"long_name": "time p t from the start of the pulse (3.6)", "units": "1"})},
        attrs={
            "pulse": motion.pulse.name,
            "slenderness": motion.slenderness,
            "frequency_ratio": motion.frequency_ratio,
            "restitution": motion.restitution,
            "alpha": motion.alpha,
            "outcome": Outcome(int(answer["outcome"])).name,
            "overturned": int(overturned(answer)),
            "peak_rotation": float(answer["peak_rotation"]),
            "impacts": int(answer["impacts"]),
            "pulse_end": motion.pulse_end,
        },
    )
    return add_contact(history, motion, landings) if contact else history
