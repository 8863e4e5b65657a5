"""The fields of a response in SI units, declared once: name, unit, equation, meaning, kinds of bodies and motions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from operator import attrgetter
from typing import Any

from rocking._dimensional.problem import STRENGTHS
from rocking._model import fields

ALL, BLOCK = fields.KINDS, fields.KINDS - {"edges"}

PULSES, RECORDS = ALL - {"record"}, ALL - {"pulse"}

ROTATION = fields.ResponseField(
    "rotation", "f8", "rad", "3.2", "peak rotation max |theta|", "the block overturns", shown="peak_rotation_deg"
)

DISPLACEMENT = fields.ResponseField(
    "displacement", "f8", "m", "3.2", "largest top displacement", "the block overturns",
    detail="horizontal",
)  # fmt: skip

ERROR_BOUND = fields.ERROR_BOUND

CONTACT_FORCES = {
    "horizontal_force": ("horizontal_reaction", "horizontal reaction H of the ground at the pivot"),
    "normal_force": ("normal_reaction", "normal reaction N of the ground at the pivot"),
}
"""Variables of a motion of a body of known mass [N]: the reaction over the weight of each, and its meaning."""


def _about(name: str, unit: str, equation: str, meaning: str, kinds: frozenset[str] = ALL) -> fields.ResponseField:
    """A number that is an argument, a group or a property of the body."""
    return fields.ResponseField(name, "f8", unit, equation, meaning, kinds=kinds)


_IN_CUBE = "the block overturns, or it is interpolated in a data set"

FIELDS = (
    ROTATION,
    replace(ROTATION, name="rotation_left", meaning="peak rotation about the left edge", missing=_IN_CUBE, shown=""),
    replace(ROTATION, name="rotation_right", meaning="peak rotation about the right edge", missing=_IN_CUBE, shown=""),
    DISPLACEMENT,
    fields.OVERTURNED,
    fields.OUTCOME,
    fields.ResponseField("edge", "i1", "1", "2.2",
                  "edge of the largest rotation over alpha, or of overturning: 1 right, -1 left, 0 without uplift",
                  detail="0 also where it is interpolated in a data set"),
    fields.IMPACTS,
    fields.EXCEEDED_ALPHA,
    fields.PEAK_ROTATION,
    replace(fields.UPLIFT_TIME, unit="s", meaning="time of the first uplift",
            missing="there is no uplift, or it is interpolated in a data set"),
    ERROR_BOUND,
    fields.RESIDUAL_ENERGY,
    _about("width", "m", "2.1", "width 2b of the block", BLOCK),
    _about("height", "m", "2.1", "height 2h of the block", BLOCK),
    _about("half_diagonal", "m", "2.2", "half-diagonal R of the block", BLOCK),
    _about("alpha", "rad", "2.1", "slenderness angle", BLOCK),
    _about("alpha_left", "rad", "2.1", "slenderness angle of the left edge"),
    _about("alpha_right", "rad", "2.1", "slenderness angle of the right edge"),
    _about("frequency_parameter", "rad s-1", "2.2", "frequency parameter p", BLOCK),
    _about("uplift_acceleration", "m s-2", "2.1", "smallest ground acceleration that starts rocking"),
    _about("scale", "1", "2.2", "factor of the record", RECORDS),
    _about("peak_acceleration", "m s-2", "3.2", "peak ground acceleration a_g"),
    _about("period", "s", "3.2", "period T_p of the pulse", PULSES),
    _about("slenderness", "1", "5.3", "dimensionless slenderness g tan(alpha)/a_g", BLOCK),
    _about("frequency_ratio", "1", "5.3", "frequency ratio omega_g/p", BLOCK & PULSES),
    _about("restitution", "1", "2.4", "coefficient of restitution eta", BLOCK),
)  # fmt: skip
"""Fields of a response in SI units, in order; each is an attribute of `BodyResponse`."""


def _judged(
    name: str, meaning: str, missing: str = "", *, dtype: str = "f8", unit: str = "1", kinds: frozenset[str] = ALL,
    source: Callable[[Any], Any] | None = None,
) -> tuple[fields.ResponseField, Callable[[Any], Any]]:  # fmt: skip
    """A value computed on request: an attribute of the response, or a function of it."""
    return fields.ResponseField(name, dtype, unit, "", meaning, missing, kinds=kinds), source or attrgetter(name)


_UNKNOWN = "it lifts off, or the forces are not known"

JUDGED = dict((
    _judged("meaning", "the outcome in words; where the rocking model does not apply, first the reason",
            dtype="U", source=lambda found: found.sentence),
    _judged("margin", "in words: the strength of the motion from which it overturns, or below which it does not",
            "that was not asked for", dtype="U"),
    _judged("rocking_model_applies", "false: pure rocking needs a coefficient of friction beyond 1, or the body lifts "
            "off; what is said of its rocking and overturning then does not hold for a body that is free to do so",
            dtype="?"),
    _judged("friction_demand", "coefficient of friction that pure rocking needs, impacts excluded; if it overturns, "
            "until it passes alpha for good", _UNKNOWN, source=lambda found: found.contact.largest_friction_demand),
    _judged("friction_at_impact", "ratio of the horizontal to the vertical impulse at its impacts, 0 without impacts",
            "it is not known", source=lambda found: found.contact.impulse_ratio),
    _judged("smallest_normal_reaction", "normal reaction over the weight; 0 and below: it lifts off",
            "it is not known", source=lambda found: found.contact.smallest_normal_reaction),
    _judged("lifts_off", "whether pure rocking would need a tensile reaction of the ground", dtype="?",
            source=lambda found: found.contact.lifts_off),
    _judged("friction_at_uplift", "coefficient of friction below which it slides instead of rocking", kinds=BLOCK,
            source=lambda found: found.block.half_width / found.block.half_height),
    _judged("pulse_duration", "duration of the pulse", unit="s", kinds=PULSES,
            source=lambda found: float(found.problem.duration)),
    _judged("largest_surviving_acceleration", "peak acceleration below which this block, of this size, does not "
            "overturn under this pulse at this period; a smaller block of the same shape may",
            "no change of outcome was found, or the rocking model does not apply just below the lowest of "
            "`thresholds`, see `warnings`",
            unit="m s-2", kinds=BLOCK & PULSES),
    _judged("largest_surviving_friction_demand",
            "coefficient of friction that it needs just below `largest_surviving_acceleration`",
            "that is null, or it is not known", kinds=BLOCK & PULSES),
    _judged("nearest_acceleration", "nearest peak acceleration, by ratio, at which the outcome changes",
            "none was found", unit="m s-2", kinds=BLOCK & PULSES,
            source=lambda found: found.margins and found.margins.nearest_acceleration),
    _judged("nearest_period", "nearest period, by ratio, at which the outcome changes", "none was found",
            unit="s", kinds=BLOCK & PULSES, source=lambda found: found.margins and found.margins.nearest_period),
    _judged("overturning_scale", "lowest factor of the record found at which it overturns", "none was found, or it was "
            "not asked for; narrower ranges than 0.2 % can be missed", kinds=RECORDS),
    _judged("amplification", "relative change of the peak rotation over that of the amplitude of the record",
            "it overturns or does not uplift, or the outcome changes within 1e-9 of the amplitude", kinds=RECORDS),
    _judged("peak_is_determined", "false: the amplification exceeds 1e4, the record does not determine the peak, see "
            "`warnings`", dtype="?", kinds=RECORDS),
    _judged("overturned_resampled", "the outcome under the record interpolated band-limited at an eighth of its step",
            "it is too long, or its step too small", dtype="?", kinds=RECORDS,
            source=lambda found: found.resampled and bool(found.resampled.overturned)),
    _judged("peak_rotation_resampled", "peak of |theta|/alpha likewise", "it overturns, or that was not computed",
            kinds=RECORDS, source=lambda found: found.resampled and float(found.resampled.peak_rotation)),
    _judged("warnings", "where the answer is in doubt", dtype="O"),
    _judged("notes", "what else is worth knowing", dtype="O"),
))  # fmt: skip
"""Values of one body that are computed on request, in order."""

SHOWN = (*(one for one in FIELDS if one.name not in STRENGTHS), *JUDGED)
"""Values of one body that the command line and the service show, in order, without the strength of the motion."""
