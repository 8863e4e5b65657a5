"""Assessment of a block: margins, contact with the ground, and where the answer is in doubt."""

from __future__ import annotations

from dataclasses import dataclass

from rocking._dimensional.block_warnings import NOT_FOUND, warnings_of_block, warnings_of_changes
from rocking._dimensional.margins import Margins, acceleration_thresholds, margins_of
from rocking._dimensional.problem import BlockProblem
from rocking._dimensional.threshold import Threshold
from rocking._history.contact import ContactExtremes, contact_extremes
from rocking._history.motion import build_motion
from rocking._model.parameters import FREQUENCY_RATIO
from rocking._numba.cancellation import StopFlag, run_with_timeout

SEARCH_SECONDS = 12.0
"""Time limit of the search along one line [s]."""

RELATIVE_OFFSET = 1e-9
"""Relative distance below the lowest change of outcome at which the contact is judged [-]."""


@dataclass(frozen=True)
class Assessment:
    """What is known about a block under a pulse beside its response.

    Attributes
    ----------
    problem : BlockProblem
        The block and the pulse.
    thresholds : tuple of Threshold, or None
        Peak accelerations at which the outcome changes at this period, ascending [m/s2]; None if not found in time.
    margins : Margins or None
        Distances to another outcome; None if not found in time.
    contact : ContactExtremes
        Extremes of the contact forces during the motion.
    contact_below : ContactExtremes or None
        The same just below the lowest of `thresholds`; None if there is none.
    """

    problem: BlockProblem
    thresholds: tuple[Threshold, ...] | None
    margins: Margins | None
    contact: ContactExtremes
    contact_below: ContactExtremes | None

    @property
    def sentence(self) -> str:
        """The outcome in words, without a subject; first whether the rocking model does not apply."""
        return self.contact.sentence

    @property
    def rocking_model_applies(self) -> bool:
        """False if pure rocking needs a coefficient of friction beyond 1, or the block lifts off."""
        return self.contact.rocking_applies

    @property
    def largest_safe_acceleration(self) -> float | None:
        """Peak acceleration [m/s2] below which this block does not overturn under this pulse at this period.

        None if no change of outcome was found, or if the rocking model does not apply just below the lowest.
        """
        return self.thresholds[0].value if self.thresholds and self._is_safe_below else None

    @property
    def margin(self) -> str:
        """Below which peak acceleration the block does not overturn, in words; as `largest_safe_acceleration`."""
        if self.thresholds is None:
            return "from which peak acceleration it overturns was not found in time"
        if not self.thresholds:
            return "no peak acceleration was found that overturns it at this period"
        if not self._is_safe_below:
            return "below which peak acceleration it is safe is not known: the rocking model does not apply"
        return f"it does not overturn below {self.thresholds[0].text()} m/s2 at this period"

    @property
    def largest_safe_friction_demand(self) -> float | None:
        """Coefficient of friction that it needs just below that acceleration [-]; None likewise, or if not known."""
        below = self.contact_below
        if below is None or not self._is_safe_below or not self.problem.block.contact_is_known:
            return None
        return below.largest_friction_demand

    @property
    def _is_safe_below(self) -> bool:
        return self.contact_below is not None and self.contact_below.rocking_applies

    @property
    def warnings(self) -> list[str]:
        """Where the answer, one about pure rocking, is in doubt."""
        searched = {"peak accelerations": self.thresholds, "periods and sizes": self.margins}
        return [
            *self.contact.warnings,
            *self._warnings_of_the_problem(),
            *self._warnings_of_safety(),
            *(NOT_FOUND.format(name) for name, result in searched.items() if result is None),
        ]

    @property
    def notes(self) -> list[str]:
        """What else is worth knowing."""
        found = self.margins
        if found and found.smallest_surviving_half_diagonal != found.surviving_from_half_diagonal is not None:
            return ["larger is not always safer: above the smallest block that survives, some larger ones overturn"]
        return []

    def _warnings_of_the_problem(self) -> list[str]:
        problem, margins = self.problem, self.margins
        periods = [one for one in margins.periods if one.value == margins.nearest_period] if margins else []
        return [
            *problem.warnings,
            *warnings_of_block(problem.block, problem.restitution, self.contact.outcome),
            *warnings_of_changes(problem.peak_acceleration, self.thresholds or (), "peak acceleration", " m/s2"),
            *warnings_of_changes(problem.period, periods, "period", " s"),
        ]

    def _warnings_of_safety(self) -> list[str]:
        below = self.contact_below
        if below is None or below.rocking_applies or not self.thresholds:
            return []
        needs = f"it needs a coefficient of friction of {below.largest_friction_demand:.3g}"
        why = "the block lifts off" if below.lifts_off else needs
        lowest = f"{self.thresholds[0].text()} m/s2, the lowest acceleration at which it overturns"
        return [f"no largest safe acceleration is given: just below {lowest} by the rocking model, {why}"]


def assess(
    problem: BlockProblem,
    *,
    seconds: float = SEARCH_SECONDS,
    stop: StopFlag | None = None,
    served: tuple[float, float] = (FREQUENCY_RATIO.lower, FREQUENCY_RATIO.upper),
) -> Assessment:
    """Find margins and contact forces.

    Parameters
    ----------
    problem : BlockProblem
        The block and the pulse.
    seconds : float
        Time limit of each of the two searches for changes of outcome [s].
    stop : StopFlag, optional
        Cancels the work.
    served : (float, float)
        Frequency ratios beyond which periods are not searched [-].

    Raises
    ------
    StoppedError
        If `stop` was set.
    """
    flag = StopFlag() if stop is None else stop
    thresholds = run_with_timeout(lambda part: acceleration_thresholds(problem, part), seconds, flag)
    margins = run_with_timeout(lambda part: margins_of(problem, thresholds or (), part, served), seconds, flag)
    contact = _contact(problem, problem.groups["slenderness"], flag)
    below = None
    if thresholds:
        uplift = problem.block.uplift_acceleration
        below = _contact(problem, uplift / thresholds[0].value * (1.0 + RELATIVE_OFFSET), flag)
    return Assessment(problem, thresholds, margins, contact, below)


def _contact(problem: BlockProblem, slenderness: float, stop: StopFlag) -> ContactExtremes:
    """Contact with the ground during the motion at another slenderness 1/a."""
    groups = {**problem.groups, "slenderness": slenderness}
    found = contact_extremes(build_motion(problem.pulse, **groups, stop=stop))  # type: ignore[arg-type]
    return found if problem.block.contact_is_known else found.without_forces()
