"""Blocks with their responses in SI units: what `rocking.Block` and `rocking.EquivalentBlock` have in common."""

from __future__ import annotations

from typing import TYPE_CHECKING, final, overload

from numpy.typing import ArrayLike

from rocking._base.errors import needed, reject_given
from rocking._base.units import Scalar
from rocking._dimensional.curves import (
    block_boundary,
    block_history,
    block_record_history,
    block_spectrum,
)
from rocking._dimensional.problem import BlockProblem
from rocking._dimensional.record_response import BlockRecordResponse, respond_to_record
from rocking._dimensional.response import BlockResponse, respond
from rocking._excitation.pulses import AbstractPulse
from rocking._excitation.records.record import Record
from rocking._history.time_history import DEFAULT_SAMPLES
from rocking._model.block import AbstractBlock, RectangularBlock

if TYPE_CHECKING:
    import xarray as xr

Restitution = Scalar  # or "momentum"


class RespondingBlock(AbstractBlock):
    """What pulses and records do to anything that rocks like a block."""

    @overload
    def response(
        self,
        motion: str | AbstractPulse,
        *,
        peak_acceleration: Scalar,
        period: Scalar,
        restitution: Restitution = "momentum",
    ) -> BlockResponse: ...

    @overload
    def response(
        self, motion: Record, *, scale: Scalar = 1.0, restitution: Restitution = "momentum", thresholds: bool = True
    ) -> BlockRecordResponse: ...

    def response(
        self,
        motion: str | AbstractPulse | Record,
        *,
        peak_acceleration: Scalar | None = None,
        period: Scalar | None = None,
        scale: Scalar | None = None,
        restitution: Restitution = "momentum",
        thresholds: bool = True,
    ) -> BlockResponse | BlockRecordResponse:
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
            Factor of a record [-], (0, 1e6]; 1 by default.
        restitution : float or "momentum"
            eta [-], [0, 1]; or (2.4) for this geometry, 0 where that is negative.
        thresholds : bool
            Whether the scales of a record at which the outcome changes are searched, when they, the warnings or the
            text of the response are first asked for, in tenths of a second; of a pulse they always are.

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
        asked = self._motion(motion, peak_acceleration, period, scale, restitution)
        if isinstance(asked, BlockProblem):
            return respond(asked)
        record, factor = asked
        return respond_to_record(self, record, scale=factor, restitution=restitution, thresholds=thresholds)

    @overload
    def history(
        self,
        motion: str | AbstractPulse,
        *,
        peak_acceleration: Scalar,
        period: Scalar,
        restitution: Restitution = "momentum",
        duration: Scalar | None = None,
        samples: int | None = None,
        contact: bool = False,
    ) -> xr.Dataset: ...

    @overload
    def history(
        self,
        motion: Record,
        *,
        scale: Scalar = 1.0,
        restitution: Restitution = "momentum",
        duration: Scalar | None = None,
        samples: int | None = None,
        contact: bool = False,
    ) -> xr.Dataset: ...

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
        """Rotation against time, `block_history` and `block_record_history` of `rocking._dimensional.curves`.

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
        asked = self._motion(motion, peak_acceleration, period, scale, restitution)
        if isinstance(asked, BlockProblem):
            count = DEFAULT_SAMPLES if samples is None else samples
            return block_history(asked, duration=duration, samples=count, contact=contact)
        record, factor = asked
        return block_record_history(
            self, record, scale=factor, restitution=restitution, duration=duration, samples=samples, contact=contact
        )

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

    def _motion(
        self,
        motion: str | AbstractPulse | Record,
        peak_acceleration: Scalar | None,
        period: Scalar | None,
        scale: Scalar | None,
        restitution: Restitution,
    ) -> BlockProblem | tuple[Record, Scalar]:
        """The problem under a pulse, or the record and its factor."""
        if isinstance(motion, Record):
            reject_given("a record: state `scale`", peak_acceleration=peak_acceleration, period=period)
            return motion, 1.0 if scale is None else scale
        reject_given("a pulse: state `peak_acceleration`", scale=scale)
        strength = needed("a pulse", peak_acceleration=peak_acceleration)
        return BlockProblem(self, motion, strength, needed("a pulse", period=period), restitution)


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
