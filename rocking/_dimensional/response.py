"""Responses in SI units: fields, outcome in words, margins, contact with the ground, conditioning, warnings.

A field is declared in `FIELDS` and computed by the property of its name; exports, the columns of the command line and
the models of the service derive from the declaration. Margins, contact and warnings are found when first asked for.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from rocking._base.arrays import Array
from rocking._base.equality import EqualByValue
from rocking._base.errors import InvalidArgumentError
from rocking._base.quantities import FREQUENCY_RATIO, SCALE
from rocking._dimensional.doubts import LARGEST_AMPLIFICATION, notes_of, resampled_problem, warnings_of
from rocking._dimensional.fields import ERROR_BOUND, FIELDS, JUDGED
from rocking._dimensional.margins import Margins, margins_of
from rocking._dimensional.problem import STRENGTHS, Problem
from rocking._dimensional.thresholds import WORDS, BodyThresholds, thresholds_of
from rocking._excitation.motion import AbstractMotion
from rocking._history.contact import ContactExtremes, contact_extremes
from rocking._model.block import AbstractBlock
from rocking._model.body import AbstractBody
from rocking._model.fields import EXCEEDED_ALPHA, IMPACTS, OUTCOME, PEAK_ROTATION, SOLVED_FIELDS, ResponseField
from rocking._model.labelled import with_index
from rocking._model.outcome import Outcome
from rocking._model.response import along_own_axes, axis_names
from rocking._numba.cancellation import StopFlag, run_with_timeout
from rocking._solver.bodies import amplification_of, residual_energy_of, solve_with_bound
from rocking._solver.state import EDGE_COLUMNS, RESPONSE_RECORD

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

T = TypeVar("T")

SEARCH_SECONDS = 12.0  # time limit of the search along one line for one block [s]
RELATIVE_OFFSET = 1e-9  # relative distance below the lowest change of outcome at which the contact is judged [-]


@dataclass(frozen=True, eq=False, repr=False)
class BodyResponse(EqualByValue):
    """The response of bodies to a pulse or a record, in SI units.

    Its fields, those of `fields`, are numpy scalars for one body under one motion and arrays of the broadcast shape
    otherwise; `outcome` of one body is a `rocking.Outcome`. What concerns one body is found when it is first asked for,
    in some hundredths of a second under a pulse, some tenths under a record, and refused for several: `sentence`,
    `margin`, `margins`, `contact`, `warnings`, `notes`.

    Attributes
    ----------
    problem : Problem
        Bodies and ground motion.
    records : array of `RESPONSE_RECORD` (size,)
        The responses of the solver; times are p t, rotations over alpha of the right edge.
    edges : float array (size, 4)
        What differs from edge to edge, see `rocking._solver.state.EDGE_COLUMNS`.
    bound : float array (size,) or None
        Bound of the error of the peak rotation [-]; None unless it was asked for.
    searches_thresholds : bool
        Whether the strengths at which the outcome changes are searched for sentences, warnings and margins.
    seconds : float
        Time limit of each search for one block [s].
    served : (float, float)
        Frequency ratios beyond which periods are not searched [-].
    stop : StopFlag or None
        Cancels also what is found later.
    """

    problem: Problem
    records: NDArray[np.void]
    edges: Array
    bound: Array | None = None
    searches_thresholds: bool = True
    seconds: float = field(default=SEARCH_SECONDS, compare=False)
    served: tuple[float, float] = field(default=(FREQUENCY_RATIO.lower, FREQUENCY_RATIO.upper), compare=False)
    stop: StopFlag | None = field(default=None, compare=False)

    @property
    def rotation(self) -> Any:
        """Peak rotation max |theta| [rad], (3.2); nan where the body overturns."""
        largest = np.maximum(self.rotation_right, self.rotation_left)
        # a data set, of blocks, does not say about which edge
        return np.where(np.isnan(largest), self.peak_rotation * self.problem.body.right.alpha, largest)[()]

    @property
    def rotation_left(self) -> Any:
        """Peak rotation about the left edge [rad]; nan where the body overturns."""
        return self._shaped(self.edges[:, 1]) * self.problem.body.right.alpha  # z has the scale of the right edge

    @property
    def rotation_right(self) -> Any:
        """Peak rotation about the right edge [rad]; nan where the body overturns."""
        return self._shaped(self.edges[:, 0]) * self.problem.body.right.alpha

    @property
    def displacement(self) -> Any:
        """Largest horizontal displacement of the top [m], `top_height` sin(theta); nan where the body overturns."""
        return self.problem.body.top_height * np.sin(self.rotation)

    @property
    def overturned(self) -> Any:
        """True where the body overturns in the end."""
        return self._shaped(self.records["outcome"]) >= Outcome.OVERTURNED_DIRECTLY

    @property
    def outcome(self) -> Any:
        """Final outcome, (3.8): a `rocking.Outcome`, of several bodies its codes."""
        codes = self._shaped(self.records["outcome"])
        return codes if self.shape else Outcome(int(codes))

    @property
    def edge(self) -> Any:
        """Edge of the largest rotation over alpha, or of overturning: 1 right, -1 left, 0 without uplift."""
        body = self.problem.body
        right, left = self.rotation_right / body.right.alpha, self.rotation_left / body.left.alpha
        larger = np.where(right >= left, 1, np.where(left > right, -1, 0))
        larger = np.where(self._shaped(self.records["outcome"]) == Outcome.NO_UPLIFT, 0, larger)
        last = self._shaped(self.edges[:, 3])
        return np.where(self.overturned, last, larger).astype(np.int8)[()]

    @property
    def impacts(self) -> Any:
        """Number of impacts before the motion ends, and the one after it that is followed by overturning, (2.3)."""
        return self._shaped(self.records["impacts"])

    @property
    def exceeded_alpha(self) -> Any:
        """True where |theta| passed alpha at some time."""
        return self._shaped(self.records["exceeded_alpha"])

    @property
    def peak_rotation(self) -> Any:
        """Peak of |theta|/alpha [-], (3.2); nan where the body overturns."""
        return self._shaped(self.records["peak_rotation"])

    @property
    def uplift_time(self) -> Any:
        """Time of the first uplift [s]; nan where there is none."""
        return self._shaped(self.records["uplift_time"]) / self.problem.body.right.frequency_parameter

    @property
    def error_bound(self) -> Any:
        """Bound of the absolute error of `peak_rotation` [-], see `rocking._solver.bodies.error_bound`.

        Raises `InvalidArgumentError` unless it was asked for.
        """
        if self.bound is None:
            raise InvalidArgumentError("error_bound", False, "True, for a response with a bound of its error")
        return self._shaped(self.bound)

    @property
    def residual_energy(self) -> Any:
        """Energy at the end of the motion over that of the unstable equilibrium at alpha [-], (3.11)."""
        return self._shaped(residual_energy_of(self.records, self.edges, self.problem.cells))

    @property
    def width(self) -> Any:
        """Width 2b of the block [m]."""
        return self._spread(self.block.width)

    @property
    def height(self) -> Any:
        """Height 2h of the block [m]."""
        return self._spread(self.block.height)

    @property
    def half_diagonal(self) -> Any:
        """Half-diagonal R of the block [m], (2.2)."""
        return self._spread(self.block.half_diagonal)

    @property
    def alpha(self) -> Any:
        """Slenderness angle of the block [rad], (2.1)."""
        return self._spread(self.block.alpha)

    @property
    def alpha_left(self) -> Any:
        """Slenderness angle of the left edge [rad]."""
        return self._spread(self.problem.body.left.alpha)

    @property
    def alpha_right(self) -> Any:
        """Slenderness angle of the right edge [rad]."""
        return self._spread(self.problem.body.right.alpha)

    @property
    def frequency_parameter(self) -> Any:
        """Frequency parameter p of the block [rad/s], (2.2)."""
        return self._spread(self.block.frequency_parameter)

    @property
    def uplift_acceleration(self) -> Any:
        """Smallest ground acceleration that starts rocking [m/s2]."""
        return self._spread(self.problem.body.uplift_acceleration)

    @property
    def scale(self) -> Any:
        """Factor of the record [-]."""
        return self._spread(self.problem.strength)

    @property
    def peak_acceleration(self) -> Any:
        """Peak ground acceleration a_g [m/s2]."""
        return self._spread(self.problem.peak_acceleration)

    @property
    def period(self) -> Any:
        """Period T_p of the pulse [s]."""
        return self._spread(self.problem.period)

    @property
    def slenderness(self) -> Any:
        """Dimensionless slenderness g tan(alpha)/a_g of the block [-], (5.3)."""
        return self.uplift_acceleration / self.peak_acceleration

    @property
    def frequency_ratio(self) -> Any:
        """Frequency ratio omega_g/p of the block [-], (5.3)."""
        return 2.0 * math.pi / self.period / self.frequency_parameter

    @property
    def restitution(self) -> Any:
        """Coefficient of restitution eta of the block [-]."""
        return self._spread(self.problem.restitutions[0])

    def _shaped(self, values: Array) -> Any:
        """Values (size,) in the shape of the responses, of one body a numpy scalar."""
        return values.reshape(self.problem.shape)[()]

    def _spread(self, values: Any) -> Any:
        """Values that broadcast in the shape of the responses."""
        return np.array(np.broadcast_to(values, self.problem.shape))[()]

    @property
    def fields(self) -> tuple[ResponseField, ...]:
        """The fields of this response, in order."""
        kinds = self.problem.kinds
        return tuple(one for one in FIELDS if kinds <= one.kinds and (self.bound is not None or one is not ERROR_BOUND))

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
    def motion(self) -> Mapping[str, str]:
        """Kind of the ground motion and its name, {"pulse": NAME} or {"record": NAME}."""
        motion = self.problem.motion
        return {motion.kind: motion.name}

    @cached_property
    def thresholds(self) -> BodyThresholds | None:
        """Peak accelerations [m/s2], or factors of the record, at which the outcome changes, for each body.

        Of one body None if they are not searched, or not found in time.
        """
        problem = self.problem
        if problem.shape:
            return thresholds_of(problem, stop=self.stop)
        return self._searched(lambda part: thresholds_of(problem, stop=part)) if self.searches_thresholds else None

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
        self._need_one("contact")
        return self._contact(self.problem)

    @cached_property
    def contact_below(self) -> ContactExtremes | None:
        """`contact` just below the lowest of `thresholds`, for a block under a pulse; None if there is none."""
        if not self.has_margins or not self.thresholds:
            return None
        below = np.asarray(self.thresholds[0].value / (1.0 + RELATIVE_OFFSET))
        return self._contact(replace(self.problem, strength=below))

    def _contact(self, problem: Problem) -> ContactExtremes:
        found = contact_extremes(problem.body_motion(None, self.stop))
        return found if problem.body.contact_is_known else found.without_forces()

    @property
    def has_margins(self) -> bool:
        """True for a block under a pulse."""
        return self.problem.kinds == {"pulse", "block"}

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
            name = WORDS[self.problem.motion.strength.name][0]
            return f"from which {name} it overturns was not found in time" if self.searches_thresholds else None
        if not self.has_margins:
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
        if not (self.has_margins and self.searches_thresholds):
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
        found = self.thresholds if self.searches_thresholds else None
        return found[0].value if found and found.strength == SCALE.name else None

    @cached_property
    def resampled(self) -> BodyResponse | None:
        """The response of one body to the record interpolated band-limited at an eighth of its step.

        None for a pulse, and for a record that would be too long, or its step too small, or its vertical acceleration
        reach -g.
        """
        self._need_one("resampled")
        finer = resampled_problem(self.problem)
        return None if finer is None else respond(finer, stop=self.stop)

    @cached_property
    def amplification(self) -> float:
        """Relative change of the peak rotation of one body per relative change of the horizontal amplitude [-].

        Infinite if the outcome changes within 1e-9 of the amplitude, nan if the body overturns or does not uplift.
        """
        self._need_one("amplification")
        return float(amplification_of(self.problem.motion, self.problem.cells, self.stop)[0])

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
        if self.problem.shape:
            return values
        numbers = {name: np.asarray(value).item() for name, value in values.items()}
        return numbers | {OUTCOME.name: self.outcome.name}

    def summary(self) -> dict[str, Any]:
        """The fields of one body and what is judged of it, `SHOWN`, as the command line and the service show them.

        Numbers, flags, texts and lists by name: angles in degrees, None in place of nan and infinity.
        """
        self._need_one("summary")
        kinds = self.problem.kinds
        fields = [one for one in (*self.fields, *JUDGED) if kinds <= one.kinds and one.name not in STRENGTHS]
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
        if motion.strength is SCALE:
            happened, margin = self.sentence, f"; {self.margin}" if self.margin else ""
            if not self.peak_is_determined:
                doubt = f" (not determined: amplification {self.amplification:.1e})"
            under += f" scaled to {strength}"
        else:
            impacts += " during the pulse"
            under += f" of {strength} and {self.period:.4g} s"
        if outcome >= Outcome.OVERTURNED_DIRECTLY and problem.body.left is not problem.body.right:
            happened += f" about the {EDGE_NAMES[int(self.edge)]} edge"
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
    problem: Problem,
    threads: int | None = None,
    stop: StopFlag | None = None,
    *,
    error_bound: bool = False,
    thresholds: bool = True,
    seconds: float = SEARCH_SECONDS,
) -> BodyResponse:
    """The responses of bodies by the solver; `thresholds`, `seconds`: see `BodyResponse`."""
    solved = problem.solve(threads, stop, error_bound=error_bound)
    return BodyResponse(problem, *solved, thresholds, seconds, stop=stop)


def respond_each(problems: Sequence[Problem], stop: StopFlag | None = None) -> list[BodyResponse]:
    """The responses of single bodies to one pulse, which are solved together, with the bounds of their errors."""
    if not problems:
        return []
    cells = np.concatenate([problem.cells for problem in problems])
    records, edges, bound = solve_with_bound(problems[0].motion, cells, None, stop)
    return [
        BodyResponse(problem, records[k : k + 1], edges[k : k + 1], bound[k : k + 1], stop=stop)
        for k, problem in enumerate(problems)
    ]


def interpolated_response(problem: Problem, found: Any, stop: StopFlag | None = None) -> BodyResponse:
    """The response of one block from fields that a data set gives: peak, outcome, impacts, exceeded_alpha, bound.

    What a data set does not hold is nan.
    """
    records = np.zeros(1, RESPONSE_RECORD)
    for one in SOLVED_FIELDS:
        if one.dtype == "f8":
            records[one.name] = math.nan
    for one in (PEAK_ROTATION, OUTCOME, IMPACTS, EXCEEDED_ALPHA):
        records[one.name] = np.ravel(getattr(found, one.name))
    edges = np.full((1, EDGE_COLUMNS), math.nan)
    edges[:, 3] = 0.0
    return BodyResponse(problem, records, edges, np.ravel(found.error_bound), stop=stop)


def changes_of(found: BodyThresholds, motion: AbstractMotion) -> list[dict[str, Any]]:
    """The thresholds of one body, of a record with the peak accelerations too, and whether it overturns above."""
    peak = motion.unit_acceleration
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
            text = EDGE_NAMES[int(value)]
        elif isinstance(value, float):
            number = float(math.degrees(value) if one.unit == "rad" else value)
            text = number if math.isfinite(number) else None
        elif isinstance(value, np.generic):
            text = value.item()
        found[one.label] = text
    return found


def _text(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
