"""`rocking.Block`: a rectangular block with its responses in SI units, or an array of them."""

from __future__ import annotations

from typing import final

from rocking._base.units import Scalar, Values
from rocking._boundary.restraints import Name, SavingRestraint
from rocking._boundary.scan import RESOLUTION
from rocking._dimensional.body import RespondingBody
from rocking._dimensional.restrained_block import RestrainedBlock, restrained_block, saving_restraint_of_block
from rocking._excitation.pulses import AbstractPulse
from rocking._excitation.records.record import Record
from rocking._model.block import RectangularBlock
from rocking._numba.cancellation import StopFlag


@final
class Block(RectangularBlock, RespondingBody):
    """A free-standing rigid rectangular block of uniform density (figure 1) and its responses to ground motions.

    All arguments may be arrays, which broadcast: an array of blocks; labelled ones (xarray) by the names of their
    dimensions.

    Parameters
    ----------
    width : float
        Width 2b of the base [m], > 0. Here and wherever a quantity is expected, a number is in the SI unit, and
        quantities of pint and texts such as "40 cm" are converted to it.
    height : float
        Height 2h [m], > 0.
    gravity : float
        g [m/s2], > 0.

    Examples
    --------
    >>> bool(Block(width=0.4, height=1.6).response("sine", peak_acceleration=4.0, period=0.5).overturned)
    False
    """

    def with_restraint(
        self,
        *,
        stiffness: Values = 0.0,
        prestress: Values = 0.0,
        damping: Values = 0.0,
        mass: Values | None = None,
    ) -> RestrainedBlock:
        """Hold the block by a vertical tendon along its centre line and a vertical damper at the uplifting edge.

        Parameters
        ----------
        stiffness, prestress, damping : array_like
            k [N/m] and P0 [N] of the tendon, c of the damper [N s/m], >= 0. Without a mass the groups kappa, sigma and
            zeta of `peak_response` [-].
        mass : array_like, optional
            Mass [kg], > 0, with which they are in SI units.

        Returns
        -------
        RestrainedBlock
            With the methods of a block; `tendon_force`, `tendon_stretch` and `damper_stroke` at a rotation.

        Examples
        --------
        >>> block = Block(width=0.4, height=1.6)
        >>> held = block.with_restraint(stiffness="100 kN/m", damping="4 kN s/m", mass="600 kg")
        >>> bool(held.response("sine", peak_acceleration="0.6 g", period="0.5 s").overturned)
        False
        """
        return restrained_block(self, stiffness, prestress, damping, mass)

    def saving_restraint(
        self,
        motion: str | AbstractPulse | Record,
        name: Name,
        *,
        peak_acceleration: Scalar | None = None,
        period: Scalar | None = None,
        scale: Scalar | None = None,
        restitution: Scalar = "momentum",
        stiffness: Scalar = 0.0,
        prestress: Scalar = 0.0,
        damping: Scalar = 0.0,
        mass: Scalar | None = None,
        highest: Scalar | None = None,
        resolution: Scalar = RESOLUTION,
        stop: StopFlag | None = None,
    ) -> SavingRestraint:
        """Find the smallest tendon stiffness, prestress or damping with which this block survives a motion.

        Parameters
        ----------
        motion, peak_acceleration, period, scale, restitution, stop
            As for `response`; numbers.
        name : {"stiffness", "prestress", "damping"}
            The restraint that is searched.
        stiffness, prestress, damping, mass
            The two others, as for `with_restraint`; that of `name` is not read.
        highest : float, optional
            Largest value searched, in the same unit; by default the groups 100, 100 and 3.
        resolution : float
            Largest distance of two values tried, over 1 + the group [-], [1e-4, 0.1].

        Returns
        -------
        SavingRestraint
            `lowest`, the smallest value; `safe`, the smallest from which on the block survives all that were tried:
            more of a restraint can overturn it again.

        Examples
        --------
        >>> Block(0.4, 1.6).saving_restraint("sine", "damping", peak_acceleration="0.6 g", period="0.5 s", mass=600)
        <rocking.SavingRestraint: damping: it survives from 1626.98 N s/m on>
        """
        held = {"stiffness": stiffness, "prestress": prestress, "damping": damping}
        held.pop(name, None)
        strength = {"peak_acceleration": peak_acceleration, "period": period, "scale": scale}
        return saving_restraint_of_block(
            self,
            motion,
            name,
            mass=mass,
            held=held,
            highest=highest,
            resolution=resolution,
            restitution=restitution,
            **strength,
            stop=stop,
        )
