"""The block with its responses in SI units: what `rocking.Block` is."""

from __future__ import annotations

from typing import Literal

import xarray as xr
from numpy.typing import ArrayLike

from rocking.dimensional.curves import block_history, block_spectrum
from rocking.dimensional.problem import BlockProblem
from rocking.dimensional.response import BlockResponse, respond
from rocking.excitation.pulses import AbstractPulse
from rocking.model import block as geometry

Restitution = float | Literal["housner"]


class Block(geometry.Block):
    """A free-standing rigid rectangular block of uniform density (figure 1), and what pulses do to it.

    Parameters
    ----------
    half_width : float
        b [m], > 0; the base is 2b wide.
    half_height : float
        h [m], > 0; the block is 2h high.
    gravity : float
        g [m/s2], > 0.

    Raises
    ------
    InvalidArgumentError
        If a length or gravity is not finite and positive.
    """

    def response(
        self,
        excitation: str | AbstractPulse,
        *,
        peak_acceleration: float,
        period: float,
        restitution: Restitution = "housner",
    ) -> BlockResponse:
        """Outcome, peak rotation and displacement under a pulse, by the rigid equation (2.2).

        Parameters
        ----------
        excitation : str or AbstractPulse
            The pulse.
        peak_acceleration : float
            a_g [m/s2], > 0.
        period : float
            T_p = 2 pi/omega_g [s], > 0.
        restitution : float or "housner"
            eta [-], [0, 1]; or (2.4) for this geometry, 0 where that is negative.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range.

        Examples
        --------
        >>> Block(half_width=0.2, half_height=0.8).response("sine", peak_acceleration=4.0, period=0.5).overturned
        False
        """
        return respond(BlockProblem(self, excitation, peak_acceleration, period, restitution))

    def history(
        self,
        excitation: str | AbstractPulse,
        *,
        peak_acceleration: float,
        period: float,
        restitution: Restitution = "housner",
        duration: float | None = None,
        samples: int = 400,
        contact: bool = False,
    ) -> xr.Dataset:
        """Rotation against time, `rocking.dimensional.curves.block_history`.

        Parameters
        ----------
        excitation, peak_acceleration, period, restitution
            As for `response`.
        duration : float, optional
            Length [s], > 0; by default the pulse and 8/p after it.
        samples : int
            Uniform samples; the events are added.
        contact : bool
            Whether to add reactions and friction demand.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range.
        """
        problem = BlockProblem(self, excitation, peak_acceleration, period, restitution)
        return block_history(problem, duration=duration, samples=samples, contact=contact)

    def spectrum(
        self,
        excitation: str | AbstractPulse,
        *,
        peak_acceleration: float,
        period: ArrayLike,
        restitution: Restitution = "housner",
    ) -> xr.Dataset:
        """Peak rotation and displacement against the period, `rocking.dimensional.curves.block_spectrum`.

        Parameters
        ----------
        excitation, peak_acceleration, restitution
            As for `response`.
        period : array_like (periods,)
            T_p [s], > 0.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range.
        """
        return block_spectrum(
            self, excitation, peak_acceleration=peak_acceleration, period=period, restitution=restitution
        )
