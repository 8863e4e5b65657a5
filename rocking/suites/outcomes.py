"""Outcomes of blocks under the records of a suite, each at several levels of intensity."""

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from rocking._base.arrays import Array
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError, in_range
from rocking._base.units import Scalar
from rocking._dimensional.problem import restitution_of
from rocking._excitation.records.record import Record
from rocking._excitation.records.vertical import flight_text
from rocking._model.block import AbstractBlock
from rocking._model.body import AbstractBody
from rocking._model.fields import EXCEEDED_ALPHA, IMPACTS, OUTCOME, OVERTURNED, PEAK_ROTATION
from rocking._model.labelled import variable
from rocking._model.response import Response
from rocking._numba.cancellation import StopFlag
from rocking._solver.records.amplification import record_amplification as record_amplification  # noqa: PLC0414  # public
from rocking._solver.records.record_response import record_response
from rocking.suites.intensity import Measure, measure_of

FIELDS = (PEAK_ROTATION, OVERTURNED, EXCEEDED_ALPHA, OUTCOME, IMPACTS)
"""Fields of the response that are kept for every record, level and block."""

DIMENSIONS = ("block", "intensity", "record")

BLOCK_COORDINATES: dict[str, tuple[str, str]] = {
    "width": ("m", "width 2b of the block"),
    "height": ("m", "height 2h of the block"),
    "half_diagonal": ("m", "half diagonal R of the block"),
    "alpha": ("rad", "slenderness angle of the block"),
    "frequency_parameter": ("rad s-1", "frequency parameter p of the block"),
    "uplift_acceleration": ("m s-2", "ground acceleration of uplift, g tan(alpha)"),
    "gravity": ("m s-2", "acceleration of gravity"),
}
"""Properties of `Block` that the data sets hold, with unit and meaning."""

RECORD_COORDINATES: dict[str, tuple[str, str]] = {
    "peak_acceleration": ("m s-2", "peak ground acceleration as recorded"),
    "peak_velocity": ("m s-1", "peak ground velocity as recorded"),
    "mean_period": ("s", "mean period of the record"),
    "time_step": ("s", "time between samples"),
}
"""Properties of `Record` that the data sets hold, with unit and meaning."""


@dataclass(frozen=True, eq=False)
class Suite:
    """Arguments of a fragility analysis, checked."""

    records: tuple[Record, ...]  # one or more
    blocks: tuple[AbstractBlock, ...]  # one or more
    levels: Array  # (levels,) intensities, > 0, ascending, in the unit of the measure
    measure: Measure  # measure of intensity
    restitution: Array  # (blocks,) eta [-] of each block

    @property
    def gravity(self) -> list[float]:
        """g of each block [m/s2]."""
        return [block.gravity for block in self.blocks]


def check_suite(
    records: Sequence[Record] | Record,
    blocks: Sequence[AbstractBlock] | AbstractBlock,
    intensity: ArrayLike,
    measure: str,
    restitution: Scalar,
) -> Suite:
    """Check the arguments of `rocking.fragility`."""
    chosen, motions = measure_of(measure), checked_records(records)
    bodies: tuple[Any, ...] = (blocks,)
    if not isinstance(blocks, AbstractBody) and isinstance(blocks, Iterable):
        bodies = tuple(blocks)
    if not bodies or not all(isinstance(body, AbstractBlock) and body.shape == () for body in bodies):
        raise InvalidArgumentError(
            "blocks",
            blocks,
            "one or more objects of rocking.Block or rocking.EquivalentBlock, or one of rocking.RigidBody, "
            "or an object that has one for each of its directions",
        )
    levels = checked_levels(intensity, chosen)
    for motion in motions:
        if not math.isfinite(chosen.of(motion, bodies[0])):
            raise InvalidArgumentError("records", motion, f"records with a finite {chosen.meaning}")
    eta = np.array([restitution_of(body, restitution) for body in bodies])
    suite = Suite(motions, bodies, levels, chosen, eta)
    for motion in motions:
        check_levels(levels, motion, problems_of(suite, motion)[0], suite.gravity)
    return suite


def checked_records(records: Any) -> tuple[Record, ...]:
    """Return one or more records, or raise `InvalidArgumentError`."""
    motions = tuple(records) if isinstance(records, Iterable) else (records,)
    if not motions or not all(isinstance(motion, Record) for motion in motions):
        raise InvalidArgumentError("records", records, "one or more objects of rocking.Record")
    return motions


def checked_levels(intensity: ArrayLike, measure: Measure) -> Array:
    """Return ascending levels in the unit of the measure, or raise `InvalidArgumentError`."""
    unit = {"m s-2": "m/s2", "m s-1": "m/s"}.get(measure.unit, "-")
    levels = np.atleast_1d(in_range("intensity", intensity, 0.0, math.inf, closed="neither", unit=unit))
    if levels.ndim != 1 or levels.size == 0 or not np.all(np.diff(levels) > 0.0):
        raise InvalidArgumentError("intensity", intensity, "one or more levels, ascending")
    return levels


def check_levels(levels: Array, record: Record, scales: Array, gravity: Sequence[float]) -> None:
    """Refuse levels at which the vertical acceleration of a record times `scales` (blocks, levels) reaches -g."""
    if record.vertical is None:
        return
    for scale, g in zip(scales, gravity, strict=True):
        for level, factor in zip(levels.tolist(), scale.tolist(), strict=True):
            text = flight_text(record, factor, g)
            if text is not None:
                allowed = f"levels at which the factor of {record.name or 'a record'} is {text}"
                raise InvalidArgumentError("intensity", level, allowed)


def different_names(names: Sequence[str]) -> list[str]:
    """Return unique names of the records: their own, with a number if several share it or there is none."""
    count, used = Counter(names), Counter[str]()
    unique = []
    for position, name in enumerate(names, start=1):
        used[name] += 1
        if not name:
            unique.append(f"record {position}")
        elif count[name] > 1:
            unique.append(f"{name} ({used[name]})")
        else:
            unique.append(name)
    return unique


def suite_outcomes(suite: Suite, *, threads: int | None = None, stop: StopFlag | None = None) -> xr.Dataset:
    """Solve the response of every block to every record at every level, by the solver for (2.2).

    Result over (block, intensity, record): `peak_rotation`, `overturned`, `exceeded_alpha`, `outcome`, `impacts` and
    `scale`, with the properties of the blocks and of the records as coordinates.
    """
    shape = tuple(map(len, (suite.blocks, suite.levels, suite.records)))
    fields = {field.name: np.empty(shape, dtype=field.file_dtype) for field in FIELDS}
    scales = np.empty(shape)
    for k, record in enumerate(suite.records):
        scales[:, :, k], frequency = problems_of(suite, record)
        response = responses_to(
            suite, record, scales[:, :, k], frequency, suite.restitution, threads=threads, stop=stop
        )
        for name, values in fields.items():
            values[:, :, k] = getattr(response, name)
    return described_outcomes(suite, fields | {"scale": scales})


def problems_of(suite: Suite, record: Record) -> tuple[Array, Array]:
    """Return the factor of a record [-] and the frequency parameter [rad/s], both (blocks, levels)."""
    recorded = np.array([suite.measure.of(record, block) for block in suite.blocks])[:, None]
    p = np.array([block.frequency_parameter for block in suite.blocks])[:, None]
    ratio = suite.levels / recorded
    if suite.measure.scales_amplitude:
        return ratio, np.broadcast_to(p, ratio.shape)
    return np.ones_like(ratio), p / ratio


def responses_to(
    suite: Suite,
    record: Record,
    scale: Array,
    frequency: Array,
    restitution: Array,
    *,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> Response:
    """Solve the responses (blocks, levels) to a record times `scale`, with `restitution` (blocks,) of each block."""
    return record_response(
        record,
        frequency_parameter=frequency,
        slenderness=slenderness_of(suite, record, scale),
        vertical_scale=vertical_scale_of(suite, record, scale),
        restitution=restitution[:, None],
        alpha=np.array([block.equation_alpha for block in suite.blocks])[:, None],
        threads=threads,
        stop=stop,
    )


def slenderness_of(suite: Suite, record: Record, scale: Array) -> Array:
    """g tan(alpha)/PGA [-] of the blocks under a record times `scale`, (blocks, levels)."""
    uplift = np.array([block.uplift_acceleration for block in suite.blocks])[:, None]
    return np.asarray(uplift / (scale * record.peak_acceleration))


def vertical_scale_of(suite: Suite, record: Record, scale: Array) -> Array | None:
    """`vertical_scale` of `record_response` for the blocks under a record times `scale`, (blocks, levels)."""
    if record.vertical is None:
        return None
    gravity = np.array([block.gravity for block in suite.blocks])[:, None]
    return np.asarray(scale * (STANDARD_GRAVITY / gravity))


def described_outcomes(suite: Suite, values: dict[str, NDArray[Any]]) -> xr.Dataset:
    """Return the arrays of `suite_outcomes` as a data set, with coordinates, units and meanings."""
    properties = {}
    for name, (unit, meaning) in BLOCK_COORDINATES.items():
        properties[name] = (np.array([getattr(block, name) for block in suite.blocks]), unit, meaning)
    restitution = variable("block", suite.restitution, "1", "coefficient of restitution eta", equation="2.3")
    outcomes = labelled_outcomes(values, suite.levels, suite.measure, suite.records, properties)
    return outcomes.assign_coords(restitution=restitution)


def labelled_outcomes(
    values: dict[str, NDArray[Any]],
    levels: Array,
    measure: Measure,
    records: Sequence[Record],
    blocks: Mapping[str, tuple[NDArray[Any], str, str]],
) -> xr.Dataset:
    """Label arrays (block, intensity, record); `blocks` has values (blocks,), unit and meaning by name."""
    attributes = {field.name: {"units": field.unit, **field.attributes} for field in FIELDS}
    attributes["scale"] = {"units": "1", "long_name": "factor by which the record is multiplied"}
    names = different_names([record.name for record in records])
    coordinates: dict[str, Any] = {
        "intensity": variable("intensity", levels, measure.unit, measure.meaning),
        "record": variable("record", np.array(names), "", "name of the record"),
        "digest": variable(
            "record",
            np.array([record.digest for record in records]),
            "",
            "sha256 of the time step and the samples in m/s2",
        ),
    }
    coordinates |= {name: variable("block", *column) for name, column in blocks.items()}
    for name, (unit, meaning) in RECORD_COORDINATES.items():
        column = np.array([getattr(record, name) for record in records])
        coordinates[name] = variable("record", column, unit, meaning)
    return xr.Dataset(
        {name: (DIMENSIONS, array, attributes[name]) for name, array in values.items()},
        coordinates,
        {"measure": measure.name},
    )


def join_outcomes(parts: Sequence[xr.Dataset], measure: str) -> xr.Dataset:
    """Join outcomes of several groups of records, of the same blocks and levels, as those of one suite."""
    joined = xr.concat(
        parts,
        "record",
        data_vars="minimal",
        coords="minimal",
        compat="override",
        join="override",
        combine_attrs="override",
    )
    names = different_names(joined["record"].values.astype(str).tolist())
    attributes = joined["record"].attrs
    return joined.assign_coords(record=("record", np.array(names), attributes)).assign_attrs(measure=measure)
