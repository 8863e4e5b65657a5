"""Responses in SI units: fields, outcome in words, margins, contact with the ground, conditioning, warnings.

A field is declared once, in `FIELDS`: attributes, exports, the columns of the command line and the models of the
service derive from it. Margins, contact and warnings are found when they are first asked for.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from html import escape
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from rocking._base.arrays import Array
from rocking._base.equality import EqualByValue
from rocking._base.errors import InvalidArgumentError
from rocking._base.quantities import FREQUENCY_RATIO
from rocking._dimensional.doubts import LARGEST_AMPLIFICATION, notes_of, resampled_response, warnings_of
from rocking._dimensional.fields import FIELDS, JUDGED, SHOWN, ResponseFields
from rocking._dimensional.margins import Margins, margins_of
from rocking._dimensional.problem import Problem
from rocking._dimensional.thresholds import WORDS, BodyThresholds, block_thresholds, thresholds_of
from rocking._excitation.pulses import AbstractPulse
from rocking._excitation.records.record import Record
from rocking._history.contact import ContactExtremes, contact_extremes
from rocking._model.block import AbstractBlock
from rocking._model.body import AbstractBody
from rocking._model.fields import DERIVED_FIELDS, OUTCOME, OVERTURNED, ResponseField
from rocking._model.labelled import with_index
from rocking._model.outcome import Outcome
from rocking._model.response import Response, along_own_axes, axis_names
from rocking._numba.cancellation import StopFlag, run_with_timeout
from rocking._solver.bounded_response import BoundedResponse
from rocking._solver.records.amplification import record_amplification

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

T = TypeVar("T")

SEARCH_SECONDS = 12.0  # time limit of the search along one line for one block [s]
RELATIVE_OFFSET = 1e-9  # relative distance below the lowest change of outcome at which the contact is judged [-]


def _value(found: Any, about: ResponseField) -> Any:
    """The values of a field; a number of one body, the code of an outcome as an `Outcome`."""
    problem, known = found.problem, found._known
    if not problem.kinds <= about.kinds:
        raise AttributeError(about.name)
    if about in DERIVED_FIELDS:
        value = getattr(found.dimensionless, about.name)
    elif about.derive is None:
        value = known[about.name]
    else:
        value = about.derive(known, found._given, problem.motion, problem.body)
    if problem.shape:
        return np.array(np.broadcast_to(value, problem.shape), about.dtype)
    one = np.asarray(value, about.dtype).reshape(()).item()
    return Outcome(one) if about is OUTCOME else one


for _field in FIELDS:
    _cached = cached_property(partial(_value, about=_field))
    _cached.__doc__ = _field.description("nan")
    _cached.__set_name__(ResponseFields, _field.name)
    setattr(ResponseFields, _field.name, _cached)


@dataclass(frozen=True, eq=False, repr=False)
class BodyResponse(ResponseFields, EqualByValue):
    """The response of bodies to a pulse or a record, in SI units.

    Its fields, those of `fields`, are attributes: numbers for one body under one motion, arrays of the broadcast shape
    otherwise; `outcome` is a `rocking.Outcome`, or its codes. What concerns one body is found when it is first asked
    for, in some hundredths of a second under a pulse, some tenths under a record, and refused for several: `sentence`,
    `margin`, `margins`, `contact`, `warnings`, `notes`.

    Attributes
    ----------
    dimensionless : Response or BoundedResponse
        The response in groups; of one block under a pulse with a bound of its error.
    problem : Problem
        Bodies and ground motion.
    edges : float array (size, 4) or None
        What differs from edge to edge, see `rocking._solver.state.EDGE_COLUMNS`; None for one block.
    searches_thresholds : bool
        Whether the strengths at which the outcome changes are searched for sentences, warnings and margins.
    seconds : float
        Time limit of each search for one block [s].
    served : (float, float)
        Frequency ratios beyond which periods are not searched [-].
    stop : StopFlag or None
        Cancels also what is found later.
    """

    dimensionless: Response | BoundedResponse
    problem: Problem
    edges: Array | None = None
    searches_thresholds: bool = True
    seconds: float = field(default=SEARCH_SECONDS, compare=False)
    served: tuple[float, float] = field(default=(FREQUENCY_RATIO.lower, FREQUENCY_RATIO.upper), compare=False)
    stop: StopFlag | None = field(default=None, compare=False)

    @property
    def fields(self) -> tuple[ResponseField, ...]:
        """The fields of this kind of response, in order."""
        kinds = self.problem.kinds
        return tuple(one for one in FIELDS if kinds <= one.kinds)

    @property
    def shape(self) -> tuple[int, ...]:
        """The broadcast shape of bodies and arguments; () for one body under one motion."""
        return self.problem.shape

    @property
    def body(self) -> AbstractBody:
        """The body, or the array of them."""
        return self.problem.body

    @property
    def block(self) -> AbstractBlock:
        """The body, where it is a block."""
        return self.problem.block

    @property
    def record(self) -> Record:
        """The record without its factor, where the motion is one."""
        if not isinstance(self.problem.motion, Record):
            raise InvalidArgumentError("motion", self.problem.motion, "a record")
        return self.problem.motion

    @property
    def motion(self) -> Mapping[str, str]:
        """Kind of the ground motion and its name, {"pulse": NAME} or {"record": NAME}."""
        motion = self.problem.motion
        return {"record" if isinstance(motion, Record) else "pulse": motion.name}

    @cached_property
    def _known(self) -> dict[str, Any]:
        """What was solved, by name: arrays."""
        found = self.dimensionless
        known = {one: value for one, value in vars(found).items() if isinstance(value, np.ndarray)}
        known[OVERTURNED.name] = found.overturned
        if self.edges is not None:
            known |= dict(zip(("over_right", "over_left", "side", "last_edge"), self._sides, strict=True))
        return known

    @property
    def _sides(self) -> Any:
        return np.moveaxis(np.asarray(self.edges).reshape(*self.problem.shape, -1), -1, 0)

    @cached_property
    def _given(self) -> dict[str, Any]:
        """Strength of the motion and groups of one block, by name."""
        problem = self.problem
        given = {name: getattr(problem, name) for name in ("peak_acceleration", "period", "scale")}
        return (problem.groups if problem.is_block else {}) | given

    @cached_property
    def thresholds(self) -> BodyThresholds | None:
        """Peak accelerations [m/s2], or factors of the record, at which the outcome changes, for each body.

        Of one block None if they are not searched, or not found in time.
        """
        problem = self.problem
        if not problem.is_block:
            return thresholds_of(problem, stop=self.stop)
        return self._searched(lambda part: block_thresholds(problem, stop=part)) if self.searches_thresholds else None

    @property
    def changes(self) -> list[dict[str, Any]] | None:
        """The thresholds of one body, of a record with the peak accelerations too, and whether it overturns above.

        None if they are not searched, or not found in time.
        """
        found = self.thresholds if self.searches_thresholds else None
        return None if found is None else changes_of(found, self.problem.motion)

    def _searched(self, search: Callable[[StopFlag], T]) -> T | None:
        return run_with_timeout(search, self.seconds, StopFlag() if self.stop is None else self.stop)

    @cached_property
    def contact(self) -> ContactExtremes:
        """Extremes of the contact forces during the motion of one body."""
        return self._contact("contact")

    @cached_property
    def contact_below(self) -> ContactExtremes | None:
        """`contact` just below the lowest of `thresholds`, for a block under a pulse; None if there is none."""
        if not self._has_margins or not self.thresholds:
            return None
        lowest = self.block.uplift_acceleration / self.thresholds[0].value
        return self._contact("contact_below", slenderness=lowest * (1.0 + RELATIVE_OFFSET))

    def _contact(self, name: str, **changed: float) -> ContactExtremes:
        self._need_one(name)
        found = contact_extremes(self.problem.body_motion(None, self.stop, 0, **changed))
        return found if self.problem.body.contact_is_known else found.without_forces()

    @property
    def _of_record(self) -> bool:
        return isinstance(self.problem.motion, Record)

    @property
    def _has_margins(self) -> bool:
        return self.problem.is_block and not self._of_record

    @property
    def sentence(self) -> str:
        """The outcome for one body in words, after a warning if the rocking model does not apply."""
        return self.contact.sentence

    @property
    def rocking_model_applies(self) -> bool:
        """Whether pure rocking needs a coefficient of friction of at most 1, and the body does not lift off."""
        return self.contact.rocking_applies

    @property
    def margin(self) -> str | None:
        """From which strength one body overturns, in words; None if that was not searched.

        Of a block under a pulse below which acceleration it does not, as `largest_surviving_acceleration`.
        """
        self._need_one("margin")
        found = self.thresholds if self.searches_thresholds else None
        if found is None:
            name = WORDS["scale" if self._of_record else "peak_acceleration"][0]
            return f"from which {name} it overturns was not found in time" if self.searches_thresholds else None
        if not self._has_margins:
            return found.sentence
        if not found:
            return "no peak acceleration was found that overturns it at this period"
        if not self._survives_below:
            return "below which peak acceleration it survives is not known: the rocking model does not apply"
        return f"it does not overturn below {found[0].text()} m/s2 at this period"

    @property
    def _survives_below(self) -> bool:
        return self.contact_below is not None and self.contact_below.rocking_applies

    @cached_property
    def margins(self) -> Margins | None:
        """Distances of a block to another outcome under a pulse; None otherwise, if not searched or found in time."""
        self._need_one("margins")
        if not (self._has_margins and self.searches_thresholds):
            return None
        found = self.thresholds or ()
        return self._searched(lambda part: margins_of(self.problem, found, part, self.served))

    @property
    def largest_surviving_acceleration(self) -> float | None:
        """Peak acceleration [m/s2] below which a block does not overturn under this pulse at this period.

        None if no change of outcome was found, or if the rocking model does not apply just below the lowest.
        """
        self._need_one("largest_surviving_acceleration")
        return self.thresholds[0].value if self._survives_below and self.thresholds else None

    @property
    def largest_surviving_friction_demand(self) -> float | None:
        """Friction that it needs just below `largest_surviving_acceleration` [-]; None likewise, or if not known."""
        below = self.contact_below
        if below is None or not self._survives_below or not self.problem.body.contact_is_known:
            return None
        return below.largest_friction_demand

    @property
    def overturning_scale(self) -> float | None:
        """Lowest factor of a record found at which one body overturns [-]; None if none was found or searched."""
        self._need_one("overturning_scale")
        found = self.thresholds if self._of_record and self.searches_thresholds else None
        return found[0].value if found else None

    @cached_property
    def resampled(self) -> Response | BoundedResponse | None:
        """The response of a block to the record interpolated band-limited at an eighth of its step.

        None for a pulse, and for a record that would be too long, or its step too small, or its vertical acceleration
        reach -g.
        """
        self._need_one("resampled")
        return resampled_response(self.problem, self.stop) if self._of_record and self.problem.is_block else None

    @cached_property
    def amplification(self) -> float:
        """Relative change of the peak rotation of a block per relative change of the amplitude of a record [-].

        Infinite if the outcome changes within 1e-9 of the amplitude, nan if the block overturns or does not uplift.
        """
        self._need_one("amplification")
        motion = self.problem.motion
        if not isinstance(motion, Record) or not self.problem.is_block:
            return math.nan
        return float(record_amplification(motion, **self.problem.groups, stop=self.stop))

    @property
    def peak_is_determined(self) -> bool:
        """False if the amplification exceeds `LARGEST_AMPLIFICATION`."""
        return not self.amplification > LARGEST_AMPLIFICATION

    @property
    def warnings(self) -> list[str]:
        """Reasons to doubt the answer for one body, in words."""
        self._need_one("warnings")
        return warnings_of(self)

    @property
    def notes(self) -> list[str]:
        """Notes on the answer for one body, in words."""
        return notes_of(self)

    def to_dict(self) -> dict[str, Any]:
        """The fields by name: numbers and the name of the outcome for one body, arrays for several."""
        values = {one.name: getattr(self, one.name) for one in self.fields}
        return values if self.problem.shape else values | {OUTCOME.name: self.outcome.name}

    def summary(self) -> dict[str, Any]:
        """The fields of one body and what is judged of it, `SHOWN`, as the command line and the service show them.

        Numbers, flags, texts and lists by name: angles in degrees, None in place of nan and infinity.
        """
        self._need_one("summary")
        kinds = self.problem.kinds
        fields = [one for one in SHOWN if kinds <= one.kinds]
        return shown(fields, [JUDGED[one](self) if one in JUDGED else getattr(self, one.name) for one in fields])

    def to_xarray(self) -> xr.Dataset:
        """The fields as a labelled data set, with units and meanings; arguments of several bodies are coordinates."""
        import xarray as xr  # noqa: PLC0415  # takes longer to load than the solver

        arguments = self.problem.arguments
        names = axis_names(len(self.problem.shape), arguments, ())
        variables: dict[str, Any] = {
            one.name: one.variable(names, np.asarray(getattr(self, one.name)))
            for one in self.fields
            if one.name not in arguments
        }
        coordinates: dict[str, Any] = {
            name: (*along_own_axes(value, names), {"units": _UNITS.get(name, "1")}) for name, value in arguments.items()
        }
        found = xr.Dataset(variables, coordinates, {"motion": self.problem.motion.name, **self.motion})
        return with_index(found, names[-1], self.problem.index) if names else found

    def to_pandas(self) -> pd.Series | pd.DataFrame:
        """The fields of one body as a series; of several as columns, one row each, with the axes of `to_xarray`."""
        import pandas as pd  # noqa: PLC0415  # takes longer to load than the solver

        return self.to_xarray().to_dataframe() if self.problem.shape else pd.Series({**self.motion, **self.to_dict()})

    def __repr__(self) -> str:
        """The response in words and SI units; for a block under a record also its margin."""
        return f"<rocking.BodyResponse{' ' if self.problem.shape else ': '}{self._words()}>"

    def _repr_html_(self) -> str:
        if self.problem.shape:
            return f"<p>{escape(repr(self))}</p>{self.to_xarray()._repr_html_()}"
        rows = "".join(
            f"<tr><td>{escape(one.meaning)}</td><td>{escape(_text(value))}</td>"
            f"<td>{'' if one.unit == '1' else escape(one.unit)}</td></tr>"
            for one, value in zip(self.fields, self.to_dict().values(), strict=True)
        )
        return f"<p>{escape(self._words())}</p><table>{rows}</table>"

    def _words(self) -> str:
        problem, motion, doubt, margin = self.problem, self.problem.motion, "", ""
        under = motion.name or "a record"
        if self.problem.shape:
            counts = np.bincount(self.outcome.ravel(), minlength=len(Outcome))
            parts = [f"{count} {one.plural}" for one, count in zip(Outcome, counts.tolist(), strict=True) if count]
            return f"under {under} of {' x '.join(map(str, self.problem.shape))} bodies: {', '.join(parts)}"
        outcome = self.outcome
        happened, impacts = outcome.sentence, f"{self.impacts} impact{'' if self.impacts == 1 else 's'}"
        strength = f"{self.peak_acceleration:.4g} m/s2"
        if not problem.is_block:
            under += f" of {strength}"
            if outcome >= Outcome.OVERTURNED_DIRECTLY:
                happened += f" about the {EDGE_NAMES[self.edge]} edge"
        elif self._of_record:
            happened, margin = self.sentence, f"; {self.margin}" if self.margin else ""
            if not self.peak_is_determined:
                doubt = f" (not determined: amplification {self.amplification:.1e})"
            under += f" scaled to {strength}"
        else:
            impacts += " during the pulse"
            under += f" of {strength} and {self.period:.4g} s"
        if outcome == Outcome.RECOVERS:
            peak = f"peak rotation {math.degrees(self.rotation):.4g} deg{doubt}"
            happened += f": {peak}, top displacement {self.displacement:.4g} m, {impacts}"
        return f"{happened}{margin}; {self.problem.body.description} under {under}"

    def _need_one(self, name: str) -> None:
        if self.problem.shape:
            raise InvalidArgumentError(name, f"shape {self.problem.shape}", "a response of one body under one motion")


EDGE_NAMES = {1: "right", -1: "left", 0: None}  # edges in words

_UNITS = {
    "peak_acceleration": "m s-2",
    "period": "s",
    **dict.fromkeys(("left", "right", "width", "height", "gyration", "top_height"), "m"),
    "gravity": "m s-2",
    "inclination": "rad",
}
"""Units of the arguments; others are dimensionless."""


def respond(
    problem: Problem, threads: int | None = None, stop: StopFlag | None = None, *, thresholds: bool = True,
    seconds: float = SEARCH_SECONDS,
) -> BodyResponse:  # fmt: skip
    """The responses of bodies by the solver; `thresholds`, `seconds`: see `BodyResponse`."""
    found, edges = problem.solve(threads, stop)
    return BodyResponse(found, problem, edges, thresholds, seconds, stop=stop)


def changes_of(found: BodyThresholds, motion: AbstractPulse | Record) -> list[dict[str, Any]]:
    """The thresholds of one body, of a record with the peak accelerations too, and whether it overturns above."""
    peak = motion.peak_acceleration if isinstance(motion, Record) else 1.0
    return [
        {found.strength: one.value, "peak_acceleration": one.value * peak, "overturns_above": one.overturns_above}
        for one in found
    ]


def shown(fields: Iterable[ResponseField], values: Iterable[Any]) -> dict[str, Any]:
    """Values by their labels as the command line and the service show them."""
    found = {}
    for one, value in zip(fields, values, strict=True):
        text = value
        if one is OUTCOME:
            text = value.name
        elif one.name == "edge":
            text = EDGE_NAMES[value]
        elif isinstance(value, float):
            number = math.degrees(value) if one.unit == "rad" else value
            text = number if math.isfinite(number) else None
        found[one.label] = text
    return found


def _text(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
