"""Time histories of one block, from the start of the pulse through free rocking, as labelled data sets."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rocking._base.errors import integer
from rocking._base.units import Scalar
from rocking._excitation.pulses import AbstractPulse, as_pulse
from rocking._history.body_motion import overturned
from rocking._history.contact import add_contact
from rocking._history.motion import build_motion
from rocking._model.checks import check_number
from rocking._model.parameters import FREQUENCY_RATIO
from rocking._model.response import Outcome
from rocking._numba.cancellation import StopFlag

if TYPE_CHECKING:
    import xarray as xr


def time_history(
    pulse: str | AbstractPulse,
    *,
    slenderness: Scalar,
    frequency_ratio: Scalar,
    restitution: Scalar,
    alpha: Scalar | None = None,
    duration: Scalar | None = None,
    samples: int = 400,
    contact: bool = False,
    stop: StopFlag | None = None,
) -> xr.Dataset:
    """Rotation and angular velocity of one block against time, exact to rounding at every sample.

    Parameters
    ----------
    pulse, slenderness, frequency_ratio, restitution, alpha
        As for `peak_response`; scalars.
    duration : float, optional
        Duration [tau], > 0. By default the pulse and 8 units after it; if the block overturns, until
        |theta|/alpha = 4 or |theta| = pi/2.
    samples : int
        Number of uniform samples, 2 to 1,000,000; uplift, impacts and the end of the pulse are added.
    contact : bool
        Whether to add the reactions of the ground and the friction demand (docs/contact.md).
    stop : StopFlag, optional
        Cancels the work: it raises `StoppedError` soon after another thread sets the flag.

    Returns
    -------
    xarray.Dataset
        tau(tau): time p t from the start of the pulse [-]; rotation(tau): theta/alpha [-]; angular_velocity(tau):
        theta'/(p alpha) [-], after the impact at an impact; ground_acceleration(tau): a f [-];
        impact_time(impact) [-]. Attributes: the arguments, outcome, overturned, peak_rotation, impacts. With
        `contact`, the variables and attributes of `rocking._history.contact.add_contact`.

    Raises
    ------
    InvalidArgumentError
        For an argument out of range.
    StoppedError
        If `stop` was set.
    """
    import xarray as xr  # noqa: PLC0415  # takes longer to load than the solver

    samples = integer("samples", samples, 2, 1_000_000)
    groups = {"slenderness": slenderness, "frequency_ratio": frequency_ratio, "restitution": restitution}
    motion = build_motion(pulse, **groups, alpha=alpha, duration=duration, stop=stop)
    record, tau, rotation, velocity, impact_times = motion.history(np.linspace(0.0, motion.horizon, samples))
    history = xr.Dataset(
        {
            "rotation": ("tau", rotation, {"long_name": "rotation theta/alpha (3.4)", "units": "1"}),
            "angular_velocity": ("tau", velocity, {"long_name": "velocity theta'/(p alpha) (3.4)", "units": "1"}),
            "ground_acceleration": (
                "tau",
                motion.ground_acceleration(tau),
                {"long_name": "ground acceleration a f = u/(g tan alpha) (3.2)", "units": "1"},
            ),
            "impact_time": ("impact", impact_times, {"long_name": "time of impact p t", "units": "1"}),
        },
        coords={"tau": ("tau", tau, {"long_name": "time p t from pulse start", "units": "1"})},
        attrs={
            "pulse": as_pulse(pulse).name,
            "slenderness": float(motion.cell["slenderness"][0]),
            "frequency_ratio": check_number(FREQUENCY_RATIO, frequency_ratio),
            "restitution": motion.restitution,
            "alpha": motion.alpha,
            "outcome": Outcome(int(record["outcome"])).name,
            "overturned": int(overturned(record)),
            "peak_rotation": float(record["peak_rotation"]),
            "impacts": int(record["impacts"]),
            "pulse_end": motion.pulse_end,
        },
    )
    return add_contact(history, motion, impact_times) if contact else history
