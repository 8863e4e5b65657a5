"""A pulse fitted to the velocity of a record, and how far it may stand for the record.

The fit describes a record: period, amplitude and phase of its dominant pulse. It does not replace it. What the pulse
leaves out, the cycles before and after it and the higher frequencies, moves blocks as well, so that the amplitude at
which the pulse overturns a block is usually larger than that of the record: the fitted pulse is unconservative. The fit
therefore comes with the ratio of the two amplitudes for blocks of several sizes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.arrays import Array
from rocking._base.equality import EqualByValue
from rocking._base.errors import InvalidArgumentError, finite, float_array, one_of
from rocking._base.quantities import HIGHEST_SCALE
from rocking._boundary.amplitude import thresholds
from rocking._dimensional.block import Block
from rocking._dimensional.thresholds import overturning_scale
from rocking._excitation.pulses import AbstractPulse
from rocking._excitation.records.record import Record
from rocking._model.block import AbstractBlock
from rocking._model.labelled import variable
from rocking._numba.cancellation import StopFlag
from rocking.suites.velocity_pulses import FAMILIES, VelocityPulse, fit_velocity

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

COMPARED_ALPHA = 0.2  # slenderness angle of the blocks of the comparison [rad]: five times as high as wide
COMPARED_HALF_DIAGONALS = (1.0, 4.0, 16.0)  # their half diagonals R [m]
HIGHEST_AMPLITUDE = 1000.0  # largest a = a_g/(g tan alpha) searched for overturning [-]


@dataclass(frozen=True, eq=False, repr=False)
class PulseFit(EqualByValue):
    """Pulse that explains most of the energy of the velocity of a record.

    Attributes
    ----------
    pulse : AbstractPulse
        Shape of its acceleration, of unit peak, for `rocking.peak_response` and the others.
    period : float
        T_p [s]; omega_g = 2 pi/T_p.
    peak_acceleration : float
        a_g of the pulse [m/s2], > 0.
    velocity : VelocityPulse
        Velocity of the pulse: `family`, `amplitude` [m/s], `centre` [s], and for Mavroeidis & Papageorgiou `cycles` [-]
        and `phase` [rad].
    explained : float
        Share of the sum of squares of the velocity of the record that the pulse takes away [-], [0, 1].
    blocks : tuple of Block
        Blocks of the comparison, with the restitution (2.4).
    record_scale : (blocks,) array
        Lowest factor at which the record overturns each block [-]; nan if it does not up to
        a_g = 1000 g tan(alpha).
    pulse_scale : (blocks,) array
        Lowest factor at which the pulse does.
    """

    pulse: AbstractPulse
    period: float
    peak_acceleration: float
    velocity: VelocityPulse
    explained: float
    blocks: tuple[AbstractBlock, ...]
    record_scale: Array
    pulse_scale: Array

    @property
    def scale_ratio(self) -> Array:
        """Overturning scale of the pulse over that of the record (blocks,); above 1 the pulse is unconservative."""
        return np.asarray(self.pulse_scale / self.record_scale)

    def __repr__(self) -> str:
        """Family, period, amplitude, share of energy, and the ratio of the scales for each block."""
        ratios = ", ".join(
            f"{ratio:.2f} (R = {block.half_diagonal:g} m)"
            for ratio, block in zip(self.scale_ratio.tolist(), self.blocks, strict=True)
        )
        return (
            f"<rocking.suites.PulseFit {self.velocity.family}: "
            f"period {self.period:.4g} s, a_g {self.peak_acceleration:.3g} m/s2, "
            f"{100.0 * self.explained:.0f} % of the velocity; overturns at {ratios} times the record>"
        )

    def to_xarray(self) -> xr.Dataset:
        """Return the pulse, and over `block` the comparison, as a data set with units and meanings."""
        import xarray as xr  # noqa: PLC0415  (takes longer to load than the solver)

        velocity, blocks = self.velocity, self.blocks
        pulse = {
            "period": (self.period, "s", "period of the pulse"),
            "peak_acceleration": (self.peak_acceleration, "m s-2", "peak acceleration of the pulse"),
            "velocity_amplitude": (velocity.amplitude, "m s-1", "amplitude of its velocity"),
            "centre": (velocity.centre, "s", "its centre, from the first sample of the record"),
            "cycles": (velocity.cycles, "1", "number of its cycles, of Mavroeidis & Papageorgiou"),
            "phase": (velocity.phase, "rad", "its phase, of Mavroeidis & Papageorgiou"),
            "explained": (self.explained, "1", "share of the sum of squares of the velocity of the record"),
        }
        scales = {
            "record_scale": (self.record_scale, "1", "lowest factor at which the record overturns the block"),
            "pulse_scale": (self.pulse_scale, "1", "lowest factor at which the pulse overturns the block"),
            "scale_ratio": (self.scale_ratio, "1", "pulse_scale over record_scale; above 1 it is unconservative"),
        }
        bodies = {
            "alpha": ([block.alpha for block in blocks], "rad", "slenderness angle of the block"),
            "half_diagonal": ([block.half_diagonal for block in blocks], "m", "half diagonal of the block"),
        }
        variables: dict[str, Any] = {name: variable((), *value) for name, value in pulse.items()}
        variables |= {name: variable("block", *column) for name, column in scales.items()}
        coordinates: dict[str, Any] = {name: variable("block", *column) for name, column in bodies.items()}
        return xr.Dataset(variables, coordinates, {"family": velocity.family})

    def to_pandas(self) -> pd.DataFrame:
        """Return `to_xarray` as a table with a row for each block."""
        return self.to_xarray().to_dataframe()

    def acceleration(self, time: ArrayLike) -> Array:
        """Acceleration of the pulse [m/s2] at times [s] from the first sample of the record."""
        phase = 2.0 * math.pi / self.period * (float_array("time", time, unit="s") - self.velocity.centre)
        return np.asarray(self.peak_acceleration * self.pulse.acceleration(phase))


def summary_of(fit: PulseFit) -> dict[str, Any]:
    """Return the numbers of a fitted pulse by name, None for those it has not; the ratio is that of the first block."""
    velocity = fit.velocity
    return {
        "pulse": velocity.family,
        "period": fit.period,
        "peak_acceleration": fit.peak_acceleration,
        "centre": velocity.centre,
        "cycles": finite(velocity.cycles),
        "phase": finite(velocity.phase),
        "explained": fit.explained,
        "scale_ratio": finite(float(fit.scale_ratio[0])),
    }


def fit_pulse(
    record: Record,
    *,
    family: str | None = None,
    blocks: Sequence[AbstractBlock] | AbstractBlock | None = None,
    stop: StopFlag | None = None,
) -> PulseFit:
    """Fit a pulse to the velocity of a record, and compare the factors at which both overturn blocks.

    Parameters
    ----------
    record : Record
        Its velocity is used as it is: an offset of the acceleration is fitted as well, see
        `Record.baseline_corrected`.
    family : str, optional
        "mavroeidis_papageorgiou", "ricker" or "ricker_antisymmetric"; by default that which takes most energy.
    blocks : Block or sequence of Block, optional
        Blocks of the comparison; by default alpha = 0.2 rad, R = 1, 4 and 16 m.
    stop : StopFlag, optional
        Cancels the work, which then raises `StoppedError`.

    Raises
    ------
    InvalidArgumentError
        If an argument is not as described, or the record has fewer than 16 samples or no velocity.
    """
    if not isinstance(record, Record):
        raise InvalidArgumentError("record", record, "a rocking.Record, such as rocking.read_record returns")
    families = FAMILIES if family is None else (one_of("family", family, FAMILIES),)
    if blocks is None:
        blocks = [Block.from_slenderness_angle(COMPARED_ALPHA, size) for size in COMPARED_HALF_DIAGONALS]
    compared: tuple[Any, ...] = (blocks,) if isinstance(blocks, AbstractBlock) else tuple(blocks)
    if not all(isinstance(block, AbstractBlock) and block.shape == () for block in compared):
        raise InvalidArgumentError("blocks", blocks, "objects of rocking.Block")
    fits = [fit_velocity(record.velocity, record.time_step, name) for name in families]
    best = max(fits, key=lambda fit: fit.explained)
    pulse, peak = best.acceleration_pulse()
    record_scale, pulse_scale = [], []
    for block in compared:
        highest = min(HIGHEST_AMPLITUDE * block.uplift_acceleration / record.peak_acceleration, HIGHEST_SCALE)
        record_scale.append(overturning_scale(record, block, highest=highest, stop=stop))
        pulse_scale.append(_overturning_acceleration(pulse, best.period, block, stop) / peak)
    return PulseFit(
        pulse, best.period, peak, best, best.explained, compared, np.array(record_scale), np.array(pulse_scale)
    )


def _overturning_acceleration(
    pulse: AbstractPulse, period: float, block: AbstractBlock, stop: StopFlag | None
) -> float:
    """Return the lowest peak acceleration [m/s2] that overturns a block with the restitution (2.4), by (2.2)."""
    overturning = thresholds(
        pulse,
        frequency_ratio=2.0 * math.pi / period / block.frequency_parameter,
        restitution=block.inelastic_restitution,
        alpha=block.equation_alpha,
        highest=HIGHEST_AMPLITUDE,
        stop=stop,
    )
    if not overturning.amplitude.size:
        return math.nan
    return float(block.uplift_acceleration * overturning.amplitude[0])
