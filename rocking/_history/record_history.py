"""Time histories of one block under a recorded ground motion, as labelled data sets."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rocking._base.errors import integer, number
from rocking._base.units import Scalar
from rocking._excitation.records.record import Record
from rocking._history.body_motion import Floats, overturned
from rocking._history.contact import add_contact
from rocking._history.record_motion import SamplesMotion, build_record_motion
from rocking._model.response import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.records.record_response import frequency_parameter_range

if TYPE_CHECKING:
    import xarray as xr

MAX_SAMPLES = 1_000_000
"""Largest number of uniform samples of a history."""

MIN_CONTINUED = 10_000
"""Samples after the end of a motion up to which they have its step [-], whatever its own number of samples."""


def record_history(
    motion: Record,
    *,
    frequency_parameter: Scalar,
    slenderness: Scalar,
    restitution: Scalar,
    alpha: Scalar | None = None,
    vertical_scale: Scalar | None = 1.0,
    duration: Scalar | None = None,
    samples: int | None = None,
    contact: bool = False,
    stop: StopFlag | None = None,
) -> xr.Dataset:
    """Rotation and angular velocity of one block under a recorded motion against time, exact to rounding.

    Parameters
    ----------
    motion, frequency_parameter, slenderness, restitution, alpha, vertical_scale
        As for `record_response`; numbers.
    duration : float, optional
        Duration [s], > 0. By default the motion and 8/p after it; if the block overturns, until |theta|/alpha = 4 or
        |theta| = pi/2.
    samples : int, optional
        Number of uniform samples, 2 to 1,000,000; by default the samples of the motion, continued after its end by at
        most as many or 10,000, at a larger step if they would be more. The uplift, impacts and the end of the motion
        are added.
    contact : bool
        Whether to add the reactions of the ground and the friction demand (docs/contact.md).
    stop : StopFlag, optional
        Cancels the work: it raises `StoppedError` soon after another thread sets the flag.

    Returns
    -------
    xarray.Dataset
        time(time) [s] from the first sample, and tau(time) = p t [-]; rotation(time): theta/alpha [-];
        angular_velocity(time): theta'/(p alpha) [-], after the impact at an impact; ground_acceleration(time): u [-],
        over g tan(alpha); vertical_acceleration(time) [-], over g and upwards, for a record that has it;
        impact_time(impact) [s]. Attributes: the arguments, outcome, overturned, peak_rotation,
        impacts. With `contact`, the variables and attributes of `rocking._history.contact.add_contact`.

    Raises
    ------
    InvalidArgumentError
        For an argument out of range.
    StoppedError
        If `stop` was set.
    """
    import xarray as xr  # noqa: PLC0415  # takes longer to load than the solver

    if samples is not None:
        samples = integer("samples", samples, 2, MAX_SAMPLES)
    groups = {
        "frequency_parameter": frequency_parameter,
        "slenderness": slenderness,
        "restitution": restitution,
        "alpha": alpha,
        "vertical_scale": vertical_scale,
    }
    block = build_record_motion(motion, **groups, duration=duration, stop=stop)  # type: ignore[arg-type]  # alpha: None
    grid = default_times(block) if samples is None else np.linspace(0.0, block.horizon, samples)
    record, tau, rotation, velocity, impact_times = block.history(grid)
    p = number("frequency_parameter", frequency_parameter, *frequency_parameter_range(motion), unit="rad/s")
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
            "slenderness": float(block.cell["slenderness"][0]),
            "restitution": block.restitution,
            "alpha": block.alpha,
            "outcome": Outcome(int(record["outcome"])).name,
            "overturned": int(overturned(record)),
            "peak_rotation": float(record["peak_rotation"]),
            "impacts": int(record["impacts"]),
            "motion_end": motion.duration,
        },
    )
    if motion.vertical is not None:
        upwards = {"long_name": "vertical ground acceleration over g, upwards", "units": "1"}
        history["vertical_acceleration"] = "tau", block.vertical_acceleration(tau), upwards
        history.attrs["vertical_scale"] = float(block.cell["vertical"])
    if contact:
        history = add_contact(history, block, impact_times)
    return history.swap_dims(tau="time")


def default_times(block: SamplesMotion) -> Floats:
    """Times of the samples of the motion [tau], continued to the horizon at their step or a larger one."""
    count, interval = block.times.size, float(block.cell["rate"])
    most = max(count, MIN_CONTINUED)
    wanted = min(block.horizon / interval * (1.0 + 1e-12), count + most)
    if wanted < count + most:
        return interval * np.arange(int(wanted) + 1, dtype=np.float64)
    return np.concatenate([block.times, np.linspace(block.pulse_end, block.horizon, most + 1)[1:]])
