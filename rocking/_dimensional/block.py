"""`rocking.Block`: a rectangular block with its responses in SI units, or an array of them."""

from __future__ import annotations

from typing import final

from rocking._dimensional.body import RespondingBody
from rocking._model.block import RectangularBlock


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
