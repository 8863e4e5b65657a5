"""Friction demand of a suite of records, and how its outcomes depend on the restitution and on the sampling.

At each level every block is solved under every record four times: as `rocking.fragility` does, with a smaller and with
a larger coefficient of restitution, and with the record interpolated band-limited at half its step. The largest
friction demand |H|/N is that of the first of them, over the whole motion, impacts excluded
(`rocking._history.contact.ContactExtremes`).

The friction demand takes 94 % of the time, 4 to 33 ms for a record of 2,500 to 7,000 samples; the four outcomes take
about 1.5 ms. All of these are therefore computed at a few levels, not at those of a fragility curve.
"""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from rocking._base.arrays import Array
from rocking._base.errors import number
from rocking._base.units import Scalar
from rocking._excitation.records.record import Record
from rocking._history.contact import contact_extremes
from rocking._history.motion import build_record_motion
from rocking._model.block import AbstractBlock
from rocking._model.fields import OUTCOME, OVERTURNED, PEAK_ROTATION
from rocking._model.labelled import variable
from rocking._numba.cancellation import StopFlag
from rocking.suites.fits import counted
from rocking.suites.outcomes import (
    DIMENSIONS,
    Suite,
    check_levels,
    check_suite,
    described_outcomes,
    problems_of,
    responses_to,
    slenderness_of,
    vertical_scale_of,
)

RESTITUTION_STEP = 0.05  # change of the coefficient of restitution by default [-]
REFINEMENT = 2  # samples into which one is divided by band-limited interpolation

VARIANTS = {
    "low_restitution": "with the smaller restitution",
    "high_restitution": "with the larger restitution",
    "resampled": "with the record interpolated band-limited at half its step",
}
"""The changes, made one at a time, with their meaning."""

FRICTION_DEMAND = "largest friction demand |H|/N over the motion, impacts excluded"


def suite_sensitivity(
    records: Sequence[Record] | Record,
    blocks: Sequence[AbstractBlock] | AbstractBlock,
    *,
    intensity: ArrayLike,
    measure: str = "pga",
    restitution: Scalar = "momentum",
    restitution_step: Scalar = RESTITUTION_STEP,
    confidence: Scalar = 0.95,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> xr.Dataset:
    """Friction demand under a suite of records, and how restitution and sampling change the share that overturns.

    Parameters
    ----------
    records, blocks, intensity, measure, restitution, confidence, threads, stop
        As for `rocking.fragility`; a few levels.
    restitution_step : float
        Change of the coefficient of restitution [-], (0, 1]; eta stays within [0, 1].

    Returns
    -------
    xarray.Dataset
        Over (block, intensity, record): `peak_rotation`, `overturned`, `outcome` and `scale` as `rocking.fragility`
        gives them; `friction_demand`, the largest abs(H)/N [-], infinite if the block would lift off, nan for an
        `EquivalentBlock`, whose contact forces are not known; `overturned_low_restitution`,
        `overturned_high_restitution` and `overturned_resampled`. Over (block, intensity):
        `exceedances`, the number of records that overturn the block, their `fraction` with its Clopper-Pearson interval
        `fraction_lower`, `fraction_upper`; for each of the three changes the fraction, such as `fraction_resampled`,
        and the number of records with another outcome, such as `changed_resampled`;
        `records_changed_by_sampling`, which names them; `friction_demand_median` and `friction_demand_largest` over the
        records. Coordinates `restitution`, `restitution_low` and `restitution_high` over block, `resampled_time_step`
        [s] over record. One block, not in a sequence, gives a result without the dimension `block`.
    """
    suite = check_suite(records, blocks, intensity, measure, restitution)
    restitution_step = number("restitution_step", restitution_step, 0.0, 1.0, closed="right")
    confidence = number("confidence", confidence, 0.0, 1.0, closed="neither")
    outcomes = sensitivity_outcomes(suite, restitution_step, threads=threads, stop=stop)
    sensitivity = outcomes.merge(sensitivity_of_outcomes(outcomes, confidence))
    sensitivity.attrs |= {"confidence": confidence}
    return sensitivity.isel(block=0) if isinstance(blocks, AbstractBlock) else sensitivity


def sensitivity_outcomes(
    suite: Suite, restitution_step: float, *, threads: int | None = None, stop: StopFlag | None = None
) -> xr.Dataset:
    """Solve the variables of `suite_sensitivity` over (block, intensity, record)."""
    shape = tuple(map(len, (suite.blocks, suite.levels, suite.records)))
    fields = {field.name: np.empty(shape, dtype=field.file_dtype) for field in (PEAK_ROTATION, OVERTURNED, OUTCOME)}
    changed = {name: np.empty(shape, dtype=OVERTURNED.file_dtype) for name in VARIANTS}
    scales, friction = np.empty(shape), np.empty(shape)
    low = np.clip(suite.restitution - restitution_step, 0.0, 1.0)
    high = np.clip(suite.restitution + restitution_step, 0.0, 1.0)
    for k, record in enumerate(suite.records):
        scale, frequency = problems_of(suite, record)
        resampled = record.resampled(record.time_step / REFINEMENT)
        check_levels(suite.levels, resampled, problems_of(suite, resampled)[0], suite.gravity)
        response = responses_to(suite, record, scale, frequency, suite.restitution, threads=threads, stop=stop)
        for name, values in fields.items():
            values[:, :, k] = getattr(response, name)
        variants = (record, low), (record, high), (resampled, suite.restitution)
        for name, (motion, eta) in zip(VARIANTS, variants, strict=True):
            response = responses_to(suite, motion, scale, frequency, eta, threads=threads, stop=stop)
            changed[name][:, :, k] = response.overturned
        scales[:, :, k] = scale
        friction[:, :, k] = _friction_demands(suite, record, scale, frequency, stop)
    outcomes = described_outcomes(suite, fields | {"scale": scales})
    overturned = outcomes["overturned"].attrs
    for name, meaning in VARIANTS.items():
        attributes = overturned | {"long_name": f"{overturned['long_name']}, {meaning}"}
        outcomes[f"overturned_{name}"] = (DIMENSIONS, changed[name], attributes)
    outcomes["friction_demand"] = variable(DIMENSIONS, friction, "1", FRICTION_DEMAND)
    steps = np.array([record.time_step / REFINEMENT for record in suite.records])
    return outcomes.assign_coords(
        restitution_low=variable("block", low, "1", "smaller coefficient of restitution", equation="2.3"),
        restitution_high=variable("block", high, "1", "larger coefficient of restitution", equation="2.3"),
        resampled_time_step=variable("record", steps, "s", "time step of the interpolated record"),
    )


def sensitivity_of_outcomes(outcomes: xr.Dataset, confidence: float) -> xr.Dataset:
    """Count the variables of `suite_sensitivity` over (block, intensity), from those over the records as well."""
    by_level = ("block", "intensity")
    overturned = outcomes["overturned"].transpose(*DIMENSIONS).values.astype(bool)
    names = outcomes["record"].values.astype(str)
    columns = counted(overturned, confidence, "overturn the block")
    for name, meaning in VARIANTS.items():
        variant = outcomes[f"overturned_{name}"].transpose(*DIMENSIONS).values.astype(bool)
        changed = variant != overturned
        fraction, number = variant.mean(axis=-1), changed.sum(axis=-1).astype(np.int32)
        columns[f"fraction_{name}"] = fraction, f"fraction of records that overturn the block, {meaning}"
        columns[f"changed_{name}"] = number, f"number of records with another outcome, {meaning}"
    demand = outcomes["friction_demand"].transpose(*DIMENSIONS).values
    median = np.quantile(demand, 0.5, axis=-1, method="inverted_cdf")  # also where some are infinite
    columns["friction_demand_median"] = median, f"not exceeded under half of the records: {FRICTION_DEMAND}"
    columns["friction_demand_largest"] = demand.max(axis=-1), f"largest of all records: {FRICTION_DEMAND}"
    sensitivity = xr.Dataset(
        {name: variable(by_level, values, "1", meaning) for name, (values, meaning) in columns.items()},
        outcomes.coords,
        {"measure": outcomes.attrs["measure"]},
    )
    resampled = outcomes["overturned_resampled"].transpose(*DIMENSIONS).values.astype(bool) != overturned
    records = np.empty(resampled.shape[:2], dtype=object)
    for index in np.ndindex(records.shape):
        records[index] = "; ".join(names[resampled[index]])
    meaning = "names of the records with changed_resampled"
    sensitivity["records_changed_by_sampling"] = variable(by_level, records.astype(str), "", meaning)
    return sensitivity


def _friction_demands(suite: Suite, record: Record, scale: Array, frequency: Array, stop: StopFlag | None) -> Array:
    """Solve the largest friction demand of each block at each level, (blocks, levels)."""
    demands = np.full(scale.shape, np.nan)
    slenderness, vertical = slenderness_of(suite, record, scale), vertical_scale_of(suite, record, scale)
    for k, (block, eta) in enumerate(zip(suite.blocks, suite.restitution.tolist(), strict=True)):
        if not block.contact_is_known:
            continue
        for n in range(suite.levels.size):
            motion = build_record_motion(
                record,
                frequency_parameter=float(frequency[k, n]),
                slenderness=float(slenderness[k, n]),
                restitution=eta,
                alpha=block.equation_alpha,
                vertical_scale=None if vertical is None else float(vertical[k, n]),
                stop=stop,
            )
            demands[k, n] = contact_extremes(motion).largest_friction_demand
    return demands
