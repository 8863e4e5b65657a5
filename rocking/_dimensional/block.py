"""Blocks with their responses in SI units: what `rocking.Block` and `rocking.EquivalentBlock` have in common."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, final, overload

from rocking._base.errors import integer
from rocking._base.units import Scalar, Values
from rocking._dimensional.body import Motion, RespondingBody, as_numbers
from rocking._dimensional.body_response import BodyResponse
from rocking._dimensional.problem import BlockProblem
from rocking._dimensional.response import BlockResponse, respond
from rocking._model.block import AbstractBlock, RectangularBlock
from rocking._numba.cancellation import StopFlag

if TYPE_CHECKING:
    import xarray as xr


class RespondingBlock(AbstractBlock, RespondingBody):
    """The responses of one block, by the equation of motion of equal edges, (2.2), or the linear one (3.1)."""

    @overload  # of numbers the response has margins
    def response(
        self,
        motion: Motion,
        *,
        peak_acceleration: Scalar | None = None,
        period: Scalar | None = None,
        scale: Scalar | None = None,
        restitution: Scalar = "momentum",
        thresholds: bool = True,
        threads: int | None = None,
        stop: StopFlag | None = None,
    ) -> BlockResponse: ...

    @overload
    def response(self, motion: Motion, *, peak_acceleration: xr.DataArray, **others: Any) -> xr.Dataset: ...

    @overload
    def response(
        self,
        motion: Motion,
        *,
        peak_acceleration: Values | None = None,
        period: Values | None = None,
        scale: Values | None = None,
        restitution: Values = "momentum",
        threads: int | None = None,
        stop: StopFlag | None = None,
    ) -> BodyResponse: ...

    def response(  # type: ignore[misc]  # as of bodies
        self,
        motion: Motion,
        *,
        peak_acceleration: Values | None = None,
        period: Values | None = None,
        scale: Values | None = None,
        restitution: Values = "momentum",
        thresholds: bool = True,
        threads: int | None = None,
        stop: StopFlag | None = None,
    ) -> BlockResponse | BodyResponse | xr.Dataset:
        """Outcome, peak rotation and displacement under a pulse or a record, by the rigid equation (2.2).

        Arrays of arguments broadcast; their response is that of `RigidBody`, without margins.

        Parameters
        ----------
        motion : str, AbstractPulse or Record
            The pulse, or a recorded ground motion.
        peak_acceleration : array_like
            a_g [m/s2], > 0; of a pulse.
        period : array_like
            T_p = 2 pi/omega_g [s], > 0; of a pulse.
        scale : array_like
            Factor of a record, of both its components [-], (0, 1e6]; 1 by default.
        restitution : array_like or "momentum"
            eta [-], [0, 1]; or (2.4) for this geometry, 0 where that is negative.
        thresholds : bool
            Whether the strengths of the motion at which the outcome changes are searched, when they, the warnings or
            the text of the response to a record are first asked for, in tenths of a second; not for arrays.
        threads : int, optional
            Number of threads for arrays, >= 1; by default all cores.
        stop : StopFlag, optional
            Cancels the work: it raises `StoppedError` soon after another thread sets the flag.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range, missing, or has no meaning for the kind of motion; for arrays where the
            equation of motion is the linear one (3.1).

        Examples
        --------
        >>> Block(width=0.4, height=1.6).response("sine", peak_acceleration=4.0, period=0.5).overturned
        False
        >>> Block("40 cm", "160 cm").response("sine", peak_acceleration="0.4 g", period="500 ms").overturned
        False
        """
        if threads is not None:
            threads = integer("threads", threads, 1, math.inf)
        numbers = as_numbers(peak_acceleration=peak_acceleration, period=period, scale=scale, restitution=restitution)
        if numbers:
            return respond(BlockProblem(self, motion, **numbers), thresholds=thresholds, stop=stop)
        return super().response(
            motion,
            peak_acceleration=peak_acceleration,
            period=period,
            scale=scale,
            restitution=restitution,
            threads=threads,
            stop=stop,
        )


@final
class Block(RectangularBlock, RespondingBlock):
    """A free-standing rigid rectangular block of uniform density (figure 1), and what ground motions do to it.

    Many blocks of different sizes are a `RigidBody.from_size(width, height)` of arrays.

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
