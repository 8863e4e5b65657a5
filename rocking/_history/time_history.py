"""Time histories of one block, from the start of the ground motion through free rocking, as labelled data sets."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking._base.errors import InvalidArgumentError, integer, needed, number, reject_given
from rocking._base.quantities import FREQUENCY_RATIO
from rocking._base.units import Scalar
from rocking._excitation.pulses import AbstractPulse, as_pulse
from rocking._excitation.records.record import Record
from rocking._history.contact import add_contact
from rocking._history.motion import BodyMotion, Floats, build_motion, build_record_motion, overturned
from rocking._model.checks import check_restraint, known_restitution
from rocking._model.labelled import variable
from rocking._model.response import Outcome
from rocking._numba.cancellation import StopFlag

if TYPE_CHECKING:
    import xarray as xr

MAX_SAMPLES = 1_000_000  # largest number of uniform samples of a history
DEFAULT_SAMPLES = 400  # uniform samples of a history under a pulse

MIN_CONTINUED = 10_000
"""So many samples after the end of a motion keep its step [-], even if the motion has fewer."""


def time_history(
    motion: str | AbstractPulse | Record,
    *,
    slenderness: Scalar,
    frequency_ratio: Scalar | None = None,
    frequency_parameter: Scalar | None = None,
    restitution: Scalar,
    alpha: Scalar | None = None,
    stiffness: Scalar = 0.0,
    prestress: Scalar = 0.0,
    damping: Scalar = 0.0,
    vertical_scale: Scalar | None = None,
    duration: Scalar | None = None,
    samples: int | None = None,
    contact: bool = False,
    stop: StopFlag | None = None,
) -> xr.Dataset:
    """Rotation and angular velocity of one block against time, exact to rounding at every sample.

    Parameters
    ----------
    motion, frequency_ratio, frequency_parameter, restitution, alpha, stiffness, prestress, damping, vertical_scale
        As for `peak_response`; scalars.
    slenderness : float
        g tan(alpha)/a_g = 1/a [-], [1e-12, inf): depends on the motion, unlike h/b.
    duration : float, optional
        Duration, > 0: [tau] under a pulse, [s] under a record. By default the motion and 8/p after it; if the block
        overturns, until |theta|/alpha = 4 or |theta| = pi/2.
    samples : int, optional
        Number of uniform samples, 2 to 1,000,000; by default 400 under a pulse, and those of a record, continued after
        its end by at most as many or 10,000, at a larger step if they would be more. The uplift, impacts and the end of
        the motion are added.
    contact : bool
        Whether to add the reactions of the ground and the friction demand.
    stop : StopFlag, optional
        Cancels the work: it raises `StoppedError` soon after another thread sets the flag.

    Returns
    -------
    xarray.Dataset
        Over tau, time p t from the start of the pulse [-]; or over time [s] from the first sample of a record, with
        tau(time) [-]: rotation: theta/alpha [-]; angular_velocity: theta'/(p alpha) [-], after the impact at an impact;
        ground_acceleration: a f = u/(g tan alpha) [-]; vertical_acceleration over g and upwards [-], for a record that
        has it; impact_time(impact), [-] or [s]. Attributes: the arguments, outcome, overturned, peak_rotation, impacts.
        With `contact`, horizontal_reaction(time) and normal_reaction(time) over the weight [-], friction_demand(time)
        [-] and that over tan(alpha) [-]; attributes largest_friction_demand, smallest_normal_reaction, impulse_ratio,
        lifts_off and warnings.

    Examples
    --------
    >>> history = time_history("sine", slenderness=0.5, frequency_ratio=3.0, restitution=0.9)
    >>> history.attrs["outcome"], history.impact_time.values.round(4).tolist()
    ('OVERTURNED_AFTER_IMPACT', [1.8387])
    """
    if samples is not None:
        samples = integer("samples", samples, 2, MAX_SAMPLES)
    restitution = known_restitution(restitution, alpha)
    restraint = check_restraint(stiffness, prestress, damping)
    if contact and restraint:
        raise InvalidArgumentError("contact", contact, "False for a restrained block: its tendon loads the ground too")
    if isinstance(motion, Record):
        reject_given("a record", frequency_ratio=frequency_ratio)
        groups = {
            "frequency_parameter": needed("a record", frequency_parameter=frequency_parameter),
            "slenderness": slenderness,
            "restitution": restitution,
            "alpha": alpha,
            "vertical_scale": vertical_scale,
            "restraint": restraint,
        }
        return _under_record(motion, groups, duration, samples, contact, stop)
    made = as_pulse(motion)
    reject_given("a pulse", frequency_parameter=frequency_parameter, vertical_scale=vertical_scale)
    omega = FREQUENCY_RATIO.number(needed("a pulse", frequency_ratio=frequency_ratio))
    of_pulse = {"slenderness": slenderness, "frequency_ratio": omega, "restitution": restitution, "alpha": alpha}
    moving = build_motion(made, **of_pulse, restraint=restraint, duration=duration, stop=stop)  # type: ignore[arg-type]  # alpha: None
    grid = np.linspace(0.0, moving.horizon, DEFAULT_SAMPLES if samples is None else samples)
    history, tau, impact_times = _sampled(moving, grid, (" (3.4)", "a f = ", " (3.2)"))
    history["impact_time"] = variable("impact", impact_times, "1", "time of impact p t")
    history = history.assign_coords(tau=variable("tau", tau, "1", "time p t from pulse start"))
    history.attrs |= {"pulse": made.name, "frequency_ratio": omega, "pulse_end": moving.pulse_end}
    return add_contact(history, moving, impact_times) if contact else history


def _under_record(
    record: Record,
    groups: dict[str, Any],
    duration: Scalar | None,
    samples: int | None,
    contact: bool,
    stop: StopFlag | None,
) -> xr.Dataset:
    moving = build_record_motion(record, **groups, duration=duration, stop=stop)
    grid = default_times(moving) if samples is None else np.linspace(0.0, moving.horizon, samples)
    history, tau, impact_times = _sampled(moving, grid)
    p = number("frequency_parameter", groups["frequency_parameter"], *record.frequency_parameters, unit="rad/s")
    history["impact_time"] = variable("impact", impact_times / p, "s", "time of impact")
    history = history.assign_coords(
        tau=variable("tau", tau, "1", "p t from the first sample"),
        time=variable("tau", tau / p, "s", "time from the first sample"),
    )
    history.attrs |= {
        "record": record.name,
        "record_digest": record.digest,
        "frequency_parameter": p,
        "motion_end": record.duration,
    }
    if record.vertical is not None:
        upwards = {"long_name": "vertical ground acceleration over g, upwards", "units": "1"}
        history["vertical_acceleration"] = "tau", moving.vertical_acceleration(tau), upwards
        history.attrs["vertical_scale"] = float(moving.cell["vertical"])
    if contact:
        history = add_contact(history, moving, impact_times)
    return history.swap_dims(tau="time")


def default_times(block: BodyMotion) -> Floats:
    """Times of the samples of the motion [tau], continued to the horizon at their step or a larger one."""
    count, interval = block.kink_times.size, float(block.cell["rate"])
    most = max(count, MIN_CONTINUED)
    wanted = min(block.horizon / interval * (1.0 + 1e-12), count + most)
    if wanted < count + most:
        return interval * np.arange(int(wanted) + 1, dtype=np.float64)
    return np.concatenate([block.kink_times, np.linspace(block.pulse_end, block.horizon, most + 1)[1:]])


def _sampled(
    motion: BodyMotion, grid: Floats, equations: tuple[str, str, str] = ("", "", "")
) -> tuple[xr.Dataset, Floats, Floats]:
    """What all histories hold, with `equations` in the names; tau, and the times of the impacts [tau]."""
    import xarray as xr  # noqa: PLC0415  # takes longer to load than the solver

    record, tau, rotation, velocity, impact_times = motion.history(grid)
    moves, of_ground, forced = equations
    named = {
        "rotation": (rotation, f"rotation theta/alpha{moves}"),
        "angular_velocity": (velocity, f"velocity theta'/(p alpha){moves}"),
        "ground_acceleration": (
            motion.ground_acceleration(tau), f"ground acceleration {of_ground}u/(g tan alpha){forced}",
        ),
    }  # fmt: skip
    attributes: dict[str, Any] = {
        "slenderness": motion.slenderness,
        "restitution": motion.restitution,
        "alpha": motion.alpha,
        "outcome": Outcome(int(record["outcome"])).name,
        "overturned": int(overturned(record)),
        "peak_rotation": float(record["peak_rotation"]),
        "impacts": int(record["impacts"]),
    }
    variables = {name: variable("tau", values, "1", text) for name, (values, text) in named.items()}
    return xr.Dataset(variables, attrs=attributes), tau, impact_times
