"""Contact forces during a whole motion: largest friction demand, smallest normal reaction, validity of pure rocking.

Between events the reactions are smooth; they are discontinuous at impacts, at the end of the pulse and where a pulse
starts with a jump. The motion is sampled finely where the block moves and on both sides of every event, and the
extremes are refined around the extreme samples. An impact is an impulse and is treated separately
(`rocking._model.reactions.impulse_ratio`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rocking._history.motion import BodyMotion, overturned
from rocking._model.labelled import variable
from rocking._model.reactions import Floats, Reactions, impulse_ratio, reactions
from rocking._model.response import Outcome
from rocking._numba.compilation import Record

if TYPE_CHECKING:
    import xarray as xr

MAX_STEP = 0.02
"""Largest step between samples of a moving block, in tau and, while the pulse acts, in its phase [-, rad]."""

MAX_STEPS = 250_000
"""Most steps during the ground motion, and after it [-]: longer motions have longer steps than `MAX_STEP`."""

LAST_FLIGHT = 100.0
"""Longest flight of free rocking [tau]: within a rounding of the unstable equilibrium it lasts 2 ln(2/1e-16) = 75."""

EVENT_OFFSET = 1e-12  # relative distance in time of the samples on either side of an event

PRACTICAL_FRICTION = 0.7
"""Coefficient of friction that a dry contact reliably provides [-]: rough concrete on concrete, EN 1992-1-1, 6.2.5."""

MAX_FRICTION = 1.0
"""Friction demand beyond which the rocking model is considered invalid [-]; common dry contacts provide less."""

COLUMNS = {
    "horizontal_reaction": "horizontal reaction H/(m g) of the ground at the pivot",
    "normal_reaction": "normal reaction N/(m g) of the ground at the pivot",
    "friction_demand": "friction demand |H|/N",
    "friction_demand_over_slope": "friction demand |H|/(N tan alpha)",
}
"""Variables that `add_contact` adds to a time history, with their meanings."""

ATTRIBUTES = (
    *("largest_friction_demand", "largest_friction_demand_over_slope"),
    *("smallest_normal_reaction", "impulse_ratio"),
)
"""Attributes of the whole motion that it adds, beside `lifts_off` and `warnings`."""

FORCES = (*ATTRIBUTES, "friction_time", "normal_time")  # fields of `ContactExtremes` that depend on the contact forces


@dataclass(frozen=True)
class ContactExtremes:
    """Extremes during a motion, impacts excluded; of a block that overturns, until it exceeds alpha permanently.

    The forces are nan where they are not known; sliding and lifting off are then not assessed.
    """

    largest_friction_demand: float  # largest |H|/N; infinite if the block lifts off, 0 in the slender limit [-]
    largest_friction_demand_over_slope: float  # the same over tan(alpha), at least 1 for every block that rocks [-]
    friction_time: float  # tau at which it occurs [-]
    smallest_normal_reaction: float  # smallest N/(m g) [-]
    normal_time: float  # tau at which it occurs [-]
    impulse_ratio: float  # horizontal over vertical impulse at the impacts; 0 if there are none [-]
    chatters: bool  # whether impacts accumulate to rest while the pulse acts
    outcome: Outcome  # final outcome of the motion

    def without_forces(self) -> ContactExtremes:
        """The same without the forces, where only the motion of a structure is known."""
        unknown = dict.fromkeys(FORCES, math.nan)
        return replace(self, **unknown)  # type: ignore[arg-type]

    def __repr__(self) -> str:
        """What the contact requires, and the outcome."""
        needs = f"friction {self.largest_friction_demand:.3g}, normal reaction {self.smallest_normal_reaction:.3g}"
        return f"<rocking.ContactExtremes: needs {needs} of the weight; {self.sentence}>"

    @property
    def lifts_off(self) -> bool:
        """Whether pure rocking would require a tensile reaction, so that the block leaves the ground."""
        return self.smallest_normal_reaction <= 0.0

    @property
    def rocking_applies(self) -> bool:
        """Whether the block rocks without sliding or lifting off, or does not uplift at all.

        False if the block lifts off, or if rocking requires a coefficient of friction beyond `MAX_FRICTION`.
        A block that does not uplift without sliding does not uplift with less friction either.
        """
        held = not self.lifts_off and not self.largest_friction_demand > MAX_FRICTION
        return held or self.outcome == Outcome.NO_UPLIFT

    @property
    def sentence(self) -> str:
        """The outcome in words, without a subject; first whether the rocking model does not apply."""
        outcome, demand = self.outcome.sentence, self.largest_friction_demand
        if self.outcome == Outcome.NO_UPLIFT and demand > MAX_FRICTION:
            return f"{outcome}, but slides unless the coefficient of friction is at least {demand:.3g}"
        if self.rocking_applies:
            return outcome
        if self.lifts_off:
            return (
                "would lift off the ground: the rocking model does not apply, it needs a normal reaction of "
                f"{self.smallest_normal_reaction:.3g} times the weight; held on the ground, it {outcome}"
            )
        return (
            "would slide: the rocking model does not apply, it needs a coefficient of friction of "
            f"{demand:.3g}; held against sliding, it {outcome}"
        )

    @property
    def warnings(self) -> list[str]:
        """Warnings where pure rocking is doubtful; friction is not assessed in the slender limit."""
        said = []
        kept = "rest" if self.outcome == Outcome.NO_UPLIFT else "pure rocking"
        if self.lifts_off:
            said.append(
                f"the block lifts off: pure rocking would need a normal reaction {self.smallest_normal_reaction:.3g} "
                f"of its weight at tau = {self.normal_time:.4g}, and has no meaning from where that reaches 0"
            )
        elif self.largest_friction_demand > PRACTICAL_FRICTION:
            said.append(
                f"the block may slide: {kept} needs a friction coefficient of {self.largest_friction_demand:.3g} "
                f"at tau = {self.friction_time:.4g}, more than {PRACTICAL_FRICTION} (rough concrete)"
            )
        if PRACTICAL_FRICTION < self.impulse_ratio < math.inf:
            said.append(
                f"the block may slide at an impact: its horizontal impulse is {self.impulse_ratio:.3g} of the vertical "
                f"one, more than a friction coefficient of {PRACTICAL_FRICTION} (rough concrete)"
            )
        if self.chatters:
            said.append(
                "impacts accumulate to rest while the ground moves: the motion depends on the restitution of ever "
                "smaller ones"
            )
        return said


def add_contact(history: xr.Dataset, motion: BodyMotion, impact_times: Floats) -> xr.Dataset:
    """Add the contact forces to a time history of this motion.

    Variables over tau, all [-], at an impact after it: horizontal_reaction, H/(m g), positive as the ground
    acceleration; normal_reaction, N/(m g); friction_demand, |H|/N, infinite where N <= 0; friction_demand_over_slope,
    |H|/(N tan(alpha)), finite in the slender limit, where the first and the third are 0. Attributes: those of
    `ContactExtremes` over the whole motion, also between its samples.
    """
    tau, rotation, velocity = (history[name].values for name in ("tau", "rotation", "angular_velocity"))
    found = reactions_of(motion, impact_times, tau, rotation, velocity)
    most = contact_extremes(motion)
    slope = math.tan(motion.alpha)
    demand = found.friction_demand
    columns = (slope * found.horizontal, found.normal, slope * demand if slope > 0.0 else np.zeros_like(demand), demand)
    return history.assign(
        {
            name: variable("tau", column, "1", meaning)
            for (name, meaning), column in zip(COLUMNS.items(), columns, strict=True)
        }
    ).assign_attrs(
        {name: getattr(most, name) for name in ATTRIBUTES}
        | {"lifts_off": int(most.lifts_off), "warnings": "; ".join(most.warnings)}
    )


def reactions_of(
    motion: BodyMotion, impact_times: Floats, tau: Floats, rotation: Floats, velocity: Floats
) -> Reactions:
    """The reactions at samples of the motion, all arrays (samples,); at an impact those after it.

    `impact_times` (impacts,): times of the impacts [tau], ascending; `tau`, `rotation`, `velocity`: ascending times and
    `BodyMotion.sample` there.
    """
    ground, vertical = motion.ground_acceleration(tau), 1.0 + motion.vertical_acceleration(tau)
    geometry = motion.contact_geometry
    # the edge in contact: one for each stretch between two impacts; by the velocity where a stretch has no rotation
    leaning = _sides_between(impact_times, tau, rotation)[np.searchsorted(impact_times, tau, side="right")]
    side = np.where(leaning != 0.0, leaning, np.sign(velocity))
    still = (rotation == 0.0) & (velocity == 0.0)
    # at rest both edges are in contact, unless the ground lifts one of them at this very time, as a jump does
    left = math.tan(geometry.ratio * motion.alpha) / math.tan(motion.alpha) if motion.alpha > 0.0 else geometry.ratio
    lifting = np.where(ground > left * vertical, -1.0, np.where(-ground > vertical, 1.0, 0.0))
    side = np.where(still, lifting, side)
    return reactions(rotation, velocity, ground, side, motion.alpha, vertical, geometry)


def _sides_between(impact_times: Floats, tau: Floats, rotation: Floats) -> Floats:
    """Sgn(theta) before the first impact, between the impacts, and after the last one; array (impacts + 1,).

    Between two impacts one edge is in contact; the sign of a sample next to an impact may be a rounding error.
    """
    stretch = np.searchsorted(impact_times, tau, side="right")
    return np.asarray(np.sign(np.bincount(stretch, weights=rotation, minlength=impact_times.size + 1)))


def contact_extremes(motion: BodyMotion) -> ContactExtremes:
    """Extremes of the contact forces during the motion, up to its horizon."""
    record, impact_times = motion.events()
    tau, rotation = _fine_samples(motion, record, impact_times)
    count = motion.sample_count(tau, rotation, record)
    tau, rotation = tau[:count], rotation[:count]
    left = _sides_between(impact_times, tau, rotation)[:-1]
    if overturned(record):
        tau = _until_last_crossing_of_alpha(motion, tau, rotation)

    def measured(at: Floats) -> Reactions:
        return reactions_of(motion, impact_times, at, *motion.sample(at))

    sampled = measured(tau)
    # the demand has a largest value only if the normal reaction stays positive
    normal_time, lowest = _refined_maximum(lambda at: -measured(at).normal, tau, -sampled.normal)
    time, demand = normal_time, math.inf
    if lowest < 0.0:
        time, demand = _refined_maximum(lambda at: measured(at).friction_demand, tau, sampled.friction_demand)
    slope = math.tan(motion.alpha)
    return ContactExtremes(
        largest_friction_demand=slope * demand if slope > 0.0 else 0.0,
        largest_friction_demand_over_slope=demand,
        friction_time=time,
        smallest_normal_reaction=-lowest,
        normal_time=normal_time,
        impulse_ratio=_largest_impulse_ratio(motion, left),
        chatters=bool(record["chatter"]),
        outcome=Outcome(int(record["outcome"])),
    )


def first_excess(motion: BodyMotion, friction: float) -> float:
    """tau from which a motion needs more than a coefficient of friction; nan if it does not.

    Up to where a body that overturns exceeds alpha permanently, as `contact_extremes`. The demand is taken to be linear
    between samples: `MAX_STEP` apart in tau and in the phase of the ground motion, and both sides of every event.
    """
    record, impact_times = motion.events()
    end, sides = motion.pulse_end, _event_sides(motion, record, impact_times)
    step = max(MAX_STEP / motion.ground_rate, end / MAX_STEPS)
    tau = np.concatenate([np.arange(0.0, end, step), np.arange(end, motion.horizon, MAX_STEP), sides])
    tau = np.unique(np.clip(tau, 0.0, motion.horizon))
    rotation, velocity = motion.sample(tau)
    count = motion.sample_count(tau, rotation, record)
    if overturned(record):
        count = min(count, int(np.flatnonzero(_within_alpha(motion, rotation[:count]))[-1]) + 1)
    tau = tau[:count]
    found = reactions_of(motion, impact_times, tau, rotation[:count], velocity[:count])
    excess = math.tan(motion.alpha) * found.friction_demand - friction
    over = np.flatnonzero(excess > 0.0)
    if not over.size:
        return math.nan
    k = int(over[0])
    if k == 0 or excess[k] == math.inf:
        return float(tau[k])
    return float(tau[k] - (tau[k] - tau[k - 1]) * (excess[k] / (excess[k] - excess[k - 1])))


def _event_sides(motion: BodyMotion, record: Record, impact_times: Floats) -> Floats:
    """Events, times just before and after each of them, and where the ground acceleration has kinks; not in order."""
    events = np.concatenate([impact_times, motion.jump_times(record), [motion.pulse_end]])
    return np.concatenate([events, events * (1 - EVENT_OFFSET), events * (1 + EVENT_OFFSET), motion.kink_times])


def _largest_impulse_ratio(motion: BodyMotion, left: Floats) -> float:
    """Of impacts that leave the edges with these sgn(theta); 0 if there are none."""
    alpha = motion.alpha + motion.tilt, motion.alpha * motion.contact_geometry.ratio - motion.tilt  # above the base
    found = [
        impulse_ratio(float(motion.cell["eta"][edge]), alpha[edge], alpha[1 - edge])
        for edge, sign in enumerate((1.0, -1.0))
        if (left == sign).any()
    ]
    return max(found, default=0.0)


def _fine_samples(motion: BodyMotion, record: Record, impact_times: Floats) -> tuple[Floats, Floats]:
    """Times and rotations: both sides of every event, and small steps where the block moves, until it overturns."""
    end = motion.pulse_end
    after = max(impact_times.max(initial=end) - end, 0.0) + LAST_FLIGHT
    steps = max(MAX_STEP / motion.ground_rate, end / MAX_STEPS), max(MAX_STEP, after / MAX_STEPS)
    tau = np.concatenate([np.linspace(0.0, motion.horizon, 400), _event_sides(motion, record, impact_times)])
    tau = np.unique(np.clip(tau, 0.0, motion.horizon))
    # divide the steps that are too wide until there are none: where the block rests they may be wide
    while True:
        rotation, velocity = motion.sample(tau)
        beyond = np.flatnonzero(np.abs(rotation) > motion.max_rotation)
        if beyond.size and overturned(record):
            last = int(beyond[0]) + 1
            tau, rotation, velocity = tau[:last], rotation[:last], velocity[:last]
        moves = (rotation != 0.0) | (velocity != 0.0)
        step = np.diff(tau)
        allowed = np.where(tau[:-1] < end, *steps)
        wide = (moves[1:] | moves[:-1]) & (step > np.maximum(allowed, 8 * EVENT_OFFSET * tau[1:]))
        if not wide.any():
            return tau, rotation
        between = tau[:-1][wide, None] + step[wide, None] * np.array([0.25, 0.5, 0.75])
        tau = np.sort(np.concatenate([tau, between.ravel()]))


def _within_alpha(motion: BodyMotion, rotation: Floats) -> NDArray[np.bool_]:
    """Whether |theta| is at most alpha of the edge of its sign; `rotation` is theta over alpha of the right edge."""
    return np.abs(rotation) <= np.where(rotation < 0.0, motion.contact_geometry.ratio, 1.0)


def _until_last_crossing_of_alpha(motion: BodyMotion, tau: Floats, rotation: Floats) -> Floats:
    """The times up to the last crossing of |theta| = alpha, after which the block overturns monotonically."""
    below = int(np.flatnonzero(_within_alpha(motion, rotation))[-1])
    if below == tau.size - 1:
        return tau
    left, right = tau[below], tau[below + 1]
    for _ in range(6):  # 32 parts each time, to 1e-9 of the step
        grid = np.linspace(left, right, 33)
        k = int(np.flatnonzero(_within_alpha(motion, motion.sample(grid)[0])).max(initial=0))
        left, right = grid[k], grid[min(k + 1, 32)]
    return np.append(tau[: below + 1], left) if left > tau[below] else tau[: below + 1]


def _refined_maximum(measure: Callable[[Floats], Floats], tau: Floats, values: Floats) -> tuple[float, float]:
    """Time and value of the maximum of a function, refined around the largest of its `values` at times `tau`."""
    k = int(values.argmax())
    for _ in range(3):
        tau = np.union1d(np.linspace(tau[max(k - 1, 0)], tau[min(k + 1, tau.size - 1)], 33), tau[k])
        values = measure(tau)
        k = int(values.argmax())
    return float(tau[k]), float(values[k])
