"""Volume under the rocking spectrum of a record: one number for its effect on blocks of many sizes and shapes."""

import numpy as np
import xarray as xr

from rocking._base.arrays import Array
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError, in_range, integer
from rocking._base.quantities import RESTITUTION
from rocking._base.units import Scalar
from rocking._excitation.records.record import Record
from rocking._model.labelled import variable
from rocking._solver.records.record_response import record_response


def spectrum_volume(
    record: Record,
    *,
    frequency_parameter: tuple[float, float] = (1.0, 4.0),
    alpha: tuple[float, float] = (0.1, 0.4),
    restitution: Scalar = "momentum",
    points: int = 40,
) -> xr.Dataset:
    """Integrate the rocking spectrum of a record over sizes and shapes of blocks.

    The rocking spectrum is max |theta|/alpha of rigid blocks (2.2) over the frequency parameter p and the slenderness
    angle alpha (Makris & Konstantinidis 2003); here it is 1 where the block overturns or passes alpha. Its volume was
    proposed as a measure of intensity by Kavvadias et al. (2017), whose ranges and normalisation may differ. Unlike
    PGA and PGV it is not proportional to the amplitude of the record.

    Parameters
    ----------
    record : Record
        The ground motion.
    frequency_parameter, alpha : (float, float)
        Ends of the ranges: p [rad/s], > 0; slenderness angle [rad], (0, 1.5].
    restitution : "momentum" or float
        (2.4), 0 where that is negative; or eta [-], [0, 1].
    points : int
        Points of the midpoint rule in each direction [-], 2 to 1000.

    Returns
    -------
    xarray.Dataset
        `volume` [rad2/s], `mean`, the volume over the area of the ranges [-], and `overturned`, the share of the blocks
        that overturn [-].

    References
    ----------
    Makris N., Konstantinidis D. (2003), The rocking spectrum and the limitations of practical design methodologies,
    Earthquake Engineering & Structural Dynamics 32(2), 265-289. Kavvadias I. E., Papachatzakis G. A., Bantilas K. E.,
    Vasiliadis L. K., Elenas A. (2017), Rocking spectrum intensity measures for seismic assessment of rocking rigid
    blocks, Soil Dynamics and Earthquake Engineering 101, 116-124.
    """
    count = integer("points", points, 2, 1000)
    p, p_range = _middles("frequency_parameter", frequency_parameter, 1e3, count)
    angle, alpha_range = _middles("alpha", alpha, 1.5, count)
    momentum = np.maximum(1.0 - 1.5 * np.sin(angle) ** 2, 0.0)  # (2.4)
    response = record_response(
        record,
        frequency_parameter=p[:, None],
        slenderness=STANDARD_GRAVITY * np.tan(angle) / record.peak_acceleration,
        restitution=momentum if restitution == "momentum" else RESTITUTION.number(restitution),
        alpha=angle,
    )
    overturned = response.overturned
    mean = float(np.where(overturned, 1.0, np.minimum(response.peak_rotation, 1.0)).mean())
    values = {
        "volume": (mean * p_range * alpha_range, "rad2 s-1", "volume under the rocking spectrum"),
        "mean": (mean, "1", "mean of max |theta|/alpha, at most 1"),
        "overturned": (float(np.mean(overturned)), "1", "share of the blocks that overturn"),
    }
    return xr.Dataset(
        {name: variable((), value, unit, text) for name, (value, unit, text) in values.items()},
        attrs={"record": record.name},
    )


def _middles(name: str, ends: tuple[float, float], largest: float, points: int) -> tuple[Array, float]:
    """Return the middles of equal parts of a range, and its length."""
    low, high = in_range(name, ends, 0.0, largest, closed="right") if np.shape(ends) == (2,) else (1.0, 0.0)
    if not low < high:
        raise InvalidArgumentError(name, ends, "two ends of a range, ascending")
    return low + (high - low) * (np.arange(points) + 0.5) / points, float(high - low)
