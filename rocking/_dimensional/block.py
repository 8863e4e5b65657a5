"""Blocks with their responses in SI units: what `rocking.Block` and `rocking.EquivalentBlock` have in common."""

from __future__ import annotations

from typing import TYPE_CHECKING, final

from numpy.typing import ArrayLike

from rocking._base.errors import positive, reject_given
from rocking._base.units import Scalar
from rocking._dimensional.curves import block_boundary, block_history, block_spectrum
from rocking._dimensional.problem import BlockProblem
from rocking._dimensional.response import BlockResponse, respond
from rocking._dimensional.thresholds import BodyThresholds, block_thresholds, scale_thresholds
from rocking._excitation.pulses import AbstractPulse
from rocking._excitation.records.record import Record
from rocking._model.block import AbstractBlock, RectangularBlock
from rocking._numba.cancellation import StopFlag

if TYPE_CHECKING:
    import xarray as xr

Restitution = Scalar  # or "momentum"


class RespondingBlock(AbstractBlock):
    """What pulses and records do to anything that rocks like a block."""

    def response(
        self,
        motion: str | AbstractPulse | Record,
        *,
        peak_acceleration: Scalar | None = None,
        period: Scalar | None = None,
        scale: Scalar | None = None,
        restitution: Restitution = "momentum",
        thresholds: bool = True,
    ) -> BlockResponse:
        """Outcome, peak rotation and displacement under a pulse or a record, by the rigid equation (2.2).

        Parameters
        ----------
        motion : str, AbstractPulse or Record
            The pulse, or a recorded ground motion.
        peak_acceleration : float
            a_g [m/s2], > 0; of a pulse.
        period : float
            T_p = 2 pi/omega_g [s], > 0; of a pulse.
        scale : float
            Factor of a record, of both its components [-], (0, 1e6]; 1 by default.
        restitution : float or "momentum"
            eta [-], [0, 1]; or (2.4) for this geometry, 0 where that is negative.
        thresholds : bool
            Whether the strengths of the motion at which the outcome changes are searched, when they, the warnings or
            the text of the response to a record are first asked for, in tenths of a second.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range, missing, or has no meaning for the kind of motion.

        Examples
        --------
        >>> Block(width=0.4, height=1.6).response("sine", peak_acceleration=4.0, period=0.5).overturned
        False
        >>> Block("40 cm", "160 cm").response("sine", peak_acceleration="0.4 g", period="500 ms").overturned
        False
        """
        problem = BlockProblem(self, motion, peak_acceleration, period, restitution, scale=scale)
        return respond(problem, thresholds=thresholds)

    def thresholds(
        self,
        motion: str | AbstractPulse | Record,
        *,
        period: Scalar | None = None,
        restitution: Restitution = "momentum",
        highest: Scalar | None = None,
        stop: StopFlag | None = None,
    ) -> BodyThresholds:
        """Every peak acceleration of a pulse, or factor of a record, at which the outcome changes.

        Parameters
        ----------
        motion, period, restitution
            As for `response`.
        highest : float, optional
            Highest peak acceleration [m/s2] or factor [-] searched, > 0; by default 100 times that of uplift under a
            pulse, 10 times under a record.
        stop : StopFlag, optional
            Cancels the work: it raises `StoppedError` soon after another thread sets the flag.

        Raises
        ------
        InvalidArgumentError
            As for `response`.
        StoppedError
            If `stop` was set.
        """
        if isinstance(motion, Record):
            reject_given("a record", period=period)
            return scale_thresholds(motion, self, restitution=restitution, highest=highest, stop=stop)
        problem = BlockProblem(self, motion, self.uplift_acceleration, period, restitution)
        return block_thresholds(problem, None if highest is None else positive("highest", highest, "m/s2"), stop)

    def history(
        self,
        motion: str | AbstractPulse | Record,
        *,
        peak_acceleration: Scalar | None = None,
        period: Scalar | None = None,
        scale: Scalar | None = None,
        restitution: Restitution = "momentum",
        duration: Scalar | None = None,
        samples: int | None = None,
        contact: bool = False,
    ) -> xr.Dataset:
        """Rotation against time, `rocking._dimensional.curves.block_history`.

        Parameters
        ----------
        motion, peak_acceleration, period, scale, restitution
            As for `response`.
        duration : float, optional
            Length [s], > 0; by default the pulse or the record, and 8/p after it.
        samples : int, optional
            Uniform samples; by default 400 under a pulse, and those of a record. The events are added.
        contact : bool
            Whether to add reactions and friction demand.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range, missing, or has no meaning for the kind of motion.
        """
        problem = BlockProblem(self, motion, peak_acceleration, period, restitution, scale=scale)
        return block_history(problem, duration=duration, samples=samples, contact=contact)

    def spectrum(
        self,
        motion: str | AbstractPulse,
        *,
        peak_acceleration: Scalar,
        period: ArrayLike,
        restitution: Restitution = "momentum",
    ) -> xr.Dataset:
        """Peak rotation and displacement against the period, `rocking._dimensional.curves.block_spectrum`.

        Parameters
        ----------
        motion, peak_acceleration, restitution
            As for `response`.
        period : array_like (periods,)
            T_p [s], > 0.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range.
        """
        return block_spectrum(self, motion, peak_acceleration=peak_acceleration, period=period, restitution=restitution)

    def boundary(
        self,
        motion: str | AbstractPulse,
        *,
        restitution: Restitution = "momentum",
        period: tuple[float, float] | None = None,
    ) -> xr.Dataset:
        """Peak accelerations and periods at which the outcome changes, `rocking._dimensional.curves.block_boundary`.

        Parameters
        ----------
        motion : str or AbstractPulse
            The pulse.
        restitution : float or "momentum"
            As for `response`.
        period : (float, float), optional
            Window of T_p [s], 0 < low < high; by default the frequency ratios from 0.2 to 15.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range.
        """
        return block_boundary(self, motion, restitution=restitution, period=period)


@final
class Block(RectangularBlock, RespondingBlock):
    """A free-standing rigid rectangular block of uniform density (figure 1), and what pulses do to it.

    Parameters
    ----------
    width : float
        Width 2b of the base [m], > 0. Here and wherever a quantity is expected, a number is in the SI unit, and
        quantities of pint and texts such as "40 cm" are converted to it.
    height : float
        Height 2h [m], > 0.
    gravity : float
        g [m/s2], > 0.

    Raises
    ------
    InvalidArgumentError
        If a length or gravity is not finite and positive.
    """
