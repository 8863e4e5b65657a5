"""Fragility of blocks under a suite of records: counts, intervals, fitted curves.

The outcome is not monotone in the intensity: a block that overturns under a record can survive under the same record
scaled up. Every level is therefore evaluated, and the probability at a level is estimated from the outcomes at that
level. The curve of first exceedance, in which a record counts from the lowest level on at which it reaches the limit
state, is given for comparison only: it is the usual result of incremental dynamic analysis, and its median is too low.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from rocking._base.arrays import Array, Flags
from rocking._base.errors import number
from rocking._base.units import Scalar
from rocking._dimensional.rigid_body import RigidBody
from rocking._excitation.records.record import Record, offset_doubts
from rocking._model.block import AbstractBlock, RectangularBlock
from rocking._model.labelled import variable
from rocking._numba.cancellation import StopFlag
from rocking.suites.body_arrays import HasBody, over_bodies
from rocking.suites.body_outcomes import SIGNS, body_outcomes
from rocking.suites.checks import check_demands, label
from rocking.suites.curve import LINKS, curve_probability
from rocking.suites.fits import FitStatus, counted, fit_curve
from rocking.suites.intensity import MEASURES
from rocking.suites.outcomes import check_suite, checked_records, suite_outcomes

COMPARISON = "for comparison: a record counts at and above the lowest level at which it reaches the limit state"

_MODEL_VARIABLES: dict[str, tuple[str, str]] = {
    "median_intensity": ("intensity", "intensity of probability 1/2"),
    "median_intensity_lower": ("intensity", "lower end of the confidence interval of the median"),
    "median_intensity_upper": ("intensity", "upper end of the confidence interval of the median"),
    "dispersion": ("1", "standard deviation of the logarithm of the intensity at which the limit state is reached"),
    "dispersion_lower": ("1", "lower end of the confidence interval of the dispersion"),
    "dispersion_upper": ("1", "upper end of the confidence interval of the dispersion"),
    "log_likelihood": ("1", "logarithm of the likelihood of the outcomes"),
    "deviance": ("1", "twice the difference of the log likelihood from that of the observed fractions"),
    "largest_deviation": ("1", "largest difference of the fitted curve from the observed fraction at a level"),
}


def fragility(
    records: Sequence[Record] | Record,
    blocks: Sequence[AbstractBlock] | AbstractBlock | RigidBody | HasBody,
    *,
    intensity: ArrayLike,
    measure: str = "pga",
    restitution: Scalar = "momentum",
    demand: str | float | Sequence[str | float] = "overturning",
    confidence: Scalar = 0.95,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> xr.Dataset:
    """Estimate the probability that blocks reach a limit state under a suite of records, at levels of intensity.

    Parameters
    ----------
    records : sequence of Record
        The suite. Its records count as independent and equally likely.
    blocks : Block, sequence of Block, RigidBody, or Object
        Rigid blocks (2.2), also `EquivalentBlock`. One block, not in a sequence, gives a result without the dimension
        `block`. A `RigidBody` gives the dimensions of its arguments in place of `block`; of arguments that are backed
        by dask the result is lazy, in their chunks. An `Object`, also of a mesh, gives the dimension `direction`.
        If one of the bodies has two different edges, each record is followed by its mirror image, "NAME, mirrored",
        which counts as half of the record; intervals are those of independent records.
    intensity : array_like, (levels,)
        Levels, > 0, ascending, in the unit of the measure; texts such as "0.3 g" and quantities are converted to it.
    measure : str
        "pga" [m/s2], "pgv" [m/s], "pga_ratio" PGA/(g tan alpha), "pgv_ratio" p PGV/(g tan alpha) or "frequency_ratio"
        omega_p/p: see `rocking.suites.intensity`. The last two are those of blocks with equal edges.
    restitution : "momentum", "kalliontzis(k=...)" or float
        (2.4), 0 where that is negative; or eta [-], [0, 1]. An `Object` may have its own, which a number replaces.
    demand : "overturning", "alpha", a number, or a sequence of these
        The limit state: final overturning; passage of alpha at some time; max |theta|/alpha above a threshold [-],
        (0, 1000], or overturning. One, not in a sequence, gives a result without the dimension `demand`.
    confidence : float
        Of all intervals [-], (0, 1).
    threads : int, optional
        Number of threads; by default all cores.
    stop : StopFlag, optional
        Cancels the work, which then raises `StoppedError`.

    Returns
    -------
    xarray.Dataset
        Over (block, intensity, record): the outcomes, `peak_rotation`, `overturned`, `exceeded_alpha`, `outcome`,
        `impacts`, and the `scale` of the record. Over (demand, block, intensity): `exceedances`, the number of records
        that reach the limit state, their `fraction`, and its Clopper-Pearson interval `fraction_lower`,
        `fraction_upper`. Over (demand, block, model), model = lognormal and logistic: `median_intensity`, `dispersion`,
        their intervals, `fit_status` and measures of fit (`rocking.suites.fits`); `fitted` also over intensity.
        `survives_above_first` marks the records that do not reach the limit state at some level above the first at
        which they do, and `records_surviving_above_first` names them. `first_exceedances`, `first_median_intensity`,
        ... are the curve of first exceedance, for comparison. The attribute `warnings`, where there is one, names
        records that are scaled although their offset is not small beside their shaking.
    """
    limits = check_demands(demand)
    confidence = number("confidence", confidence, 0.0, 1.0, closed="neither")
    if isinstance(blocks, HasBody):
        restitution = blocks.restitution if restitution == "momentum" else restitution
        blocks = blocks.body
    if isinstance(blocks, RectangularBlock) and blocks.shape:  # an array of blocks
        blocks = RigidBody.from_size(**blocks.parameters | blocks.labels)
    if isinstance(blocks, RigidBody) and any(getattr(value, "chunks", None) for value in blocks.labels.values()):
        threads = threads or 1

    def analyse(bodies: Sequence[AbstractBlock] | AbstractBlock | RigidBody) -> xr.Dataset:
        if isinstance(bodies, RigidBody):
            outcomes, signs = body_outcomes(records, bodies, intensity, measure, restitution, threads, stop), SIGNS
        else:
            suite, signs = check_suite(records, bodies, intensity, measure, restitution), 1
            outcomes = suite_outcomes(suite, threads=threads, stop=stop)
        result = outcomes.merge(fragility_of_outcomes(outcomes, limits, confidence, signs))
        result.attrs |= {"confidence": confidence}
        doubts = offset_doubts(checked_records(records)) if MEASURES[measure].scales_amplitude else []
        if doubts:
            result.attrs["warnings"] = "; ".join(doubts)
        return result.isel(demand=0) if isinstance(demand, str) or np.ndim(demand) == 0 else result

    if isinstance(blocks, RigidBody):
        return over_bodies(analyse, blocks)
    result = analyse(blocks)
    return result.isel(block=0) if isinstance(blocks, AbstractBlock) else result


def fragility_of_outcomes(
    outcomes: xr.Dataset, demand: Sequence[str | float] = ("overturning",), confidence: float = 0.95, signs: int = 1
) -> xr.Dataset:
    """Compute counts, intervals and fitted curves from the result of `suite_outcomes`, as `fragility` describes them.

    `signs`: columns after each other that belong to one record, 2 with its mirror image.
    """
    limits = check_demands(list(demand))
    levels = outcomes["intensity"].values
    falling = not MEASURES[outcomes.attrs["measure"]].scales_amplitude
    reached = np.stack([_reached(outcomes, limit) for limit in limits])  # (demand, block, intensity, record)
    order = -1 if falling else 1  # from the mildest level on
    first = np.logical_or.accumulate(reached[:, :, ::order], axis=2)[:, :, ::order]
    survives = np.asarray((first & ~reached).any(axis=2))
    names = outcomes["record"].values.astype(str)
    survivors = np.empty(survives.shape[:2], dtype=object)
    for index in np.ndindex(survivors.shape):
        survivors[index] = "; ".join(names[survives[index]])
    by_level, by_model = ("demand", "block", "intensity"), ("demand", "block", "model")
    fragility = xr.Dataset(
        {
            "survives_above_first": variable(
                ("demand", "block", "record"),
                survives.astype(np.int8),
                "1",
                "the limit state is not reached at a level above the first at which it is",
                flag_values=np.array([0, 1], dtype=np.int8),
                flag_meanings="no yes",
            ),
            "records_surviving_above_first": variable(
                ("demand", "block"), survivors.astype(str), "", "names of the records with survives_above_first"
            ),
        },
        {
            "demand": variable("demand", np.array([label(limit) for limit in limits]), "", "limit state"),
            "model": variable("model", np.array([*LINKS]), "", "kind of fitted curve"),
            **outcomes.coords,
        },
        {"measure": outcomes.attrs["measure"]},
    )
    for prefix, outcome, remark in (("", reached, {}), ("first_", first, {"comment": COMPARISON})):
        for name, (values, meaning) in counted(outcome, confidence, "reach the limit state", signs).items():
            fragility[prefix + name] = variable(by_level, values, "1", meaning, **remark)
        fits = _fits(outcome, levels, confidence, falling, signs)
        status = _values(fits, "status").astype(np.int8)
        fragility[f"{prefix}fit_status"] = (by_model, status, _STATUS_ATTRIBUTES | remark)
        for name, (unit, meaning) in _MODEL_VARIABLES.items():
            units = outcomes["intensity"].attrs["units"] if unit == "intensity" else unit
            fragility[prefix + name] = variable(by_model, _values(fits, name), units, meaning, **remark)
    curves = []
    for model in LINKS:
        curve = fragility.sel(model=model)
        median, dispersion = curve["median_intensity"].values, curve["dispersion"].values
        curves.append(curve_probability(model, levels, median[..., None], dispersion[..., None]))
    fitted = np.stack(curves, axis=2)
    fragility["fitted"] = variable((*by_model, "intensity"), fitted, "1", "probability of the fitted curve")
    return fragility


_STATUS_ATTRIBUTES: dict[str, Any] = {
    "units": "1",
    "long_name": "whether the outcomes determine a curve",
    "flag_values": np.array([int(status) for status in FitStatus], dtype=np.int8),
    "flag_meanings": " ".join(status.name.lower() for status in FitStatus),
    "comment": "; ".join(f"{status.name.lower()}: {status.sentence}" for status in FitStatus),
}


def _reached(outcomes: xr.Dataset, limit: str | float) -> Flags:
    """Return True for each record that reaches a limit state, (block, intensity, record)."""
    overturned = outcomes["overturned"].values.astype(bool)
    if limit == "overturning":
        return overturned
    if limit == "alpha":
        return outcomes["exceeded_alpha"].values.astype(bool)
    with np.errstate(invalid="ignore"):
        return overturned | (outcomes["peak_rotation"].values > limit)


def _fits(reached: Flags, levels: Array, confidence: float, falling: bool, signs: int) -> NDArray[np.object_]:
    """Fit the curves of each limit state and block, (demand, block, model) of `CurveFit`."""
    fits = np.empty((*reached.shape[:2], len(LINKS)), dtype=object)
    for k, n in np.ndindex(reached.shape[:2]):
        for m, model in enumerate(LINKS):
            fits[k, n, m] = fit_curve(
                reached[k, n], levels, model=model, confidence=confidence, falling=falling, signs=signs
            )
    return fits


def _values(fits: NDArray[np.object_], name: str) -> Array:
    """Return a number of each fit; `median_intensity_lower` is the first of `median_interval`, and so on."""
    name = name.replace("median_intensity", "median")
    field, end = name, None
    for number_of_end, suffix in enumerate(("_lower", "_upper")):
        if name.endswith(suffix):
            field, end = name.removesuffix(suffix) + "_interval", number_of_end
    values = [getattr(fit, field) for fit in fits.ravel()]
    if end is not None:
        values = [interval[end] for interval in values]
    return np.array(values, dtype=np.float64).reshape(fits.shape)
