"""A recorded ground motion: uniformly sampled acceleration, horizontal and, where it is known, vertical.

It is linear between the samples and zero after the last.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.arrays import Array
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError, finite, in_range, number, one_of
from rocking._base.quantities import FREQUENCY_PARAMETER, SCALE
from rocking._base.units import UNITS as QUANTITIES
from rocking._base.units import Scalar
from rocking._excitation.motion import AbstractMotion
from rocking._excitation.records import measures
from rocking._excitation.records.processing import baseline, offset_remark, resample

UNITS = QUANTITIES["m/s2"]  # units of acceleration, each with its value in m/s2
MAX_ACCELERATION = 1e6  # largest acceleration of a record [m/s2]; a larger value is a fill value or a wrong unit
TIME_STEP = 1e-6, 10.0  # smallest and largest time step of a record [s]: laboratories sample at up to a megahertz
MAX_DURATION = 1e5  # longest duration of a record [s], more than a day

REFINEMENT = 8  # samples into which one is divided by band-limited interpolation, for the comparison of samplings
MAX_REFINED = 400_000  # most samples of a refined record; a longer one is not compared

MAX_INTERVAL = 50.0
"""Largest length p dt of a sample interval [tau]: no motion that moves a block is sampled so coarsely."""


@final
@dataclass(frozen=True, eq=False, repr=False, init=False)
class Record(AbstractMotion):
    """A recorded ground acceleration. Records are immutable; equal samples and steps make equal records.

    Velocity, displacement and the measures of intensity are those of the horizontal component.

    Parameters
    ----------
    acceleration : array_like (samples,)
        At least two samples, finite, not all of them zero.
    time_step : float
        Time between the samples [s], [1e-6, 10]; the duration is at most 1e5 s. A text such as "10 ms" or a quantity is
        converted.
    unit : str
        Unit of the samples, a key of `UNITS`, such as "m/s2", "gal" or "g". It has to be stated.
    name : str
        Name for output, such as station and component.
    source : str
        Where the record comes from, such as file, network or citation.
    remarks : sequence of str
        What the reader of the file found in doubt; every response to the record repeats it among its warnings.
    vertical : array_like (samples,), optional
        Vertical acceleration at the same times in the same unit, upwards positive; it may be zero.

    Attributes
    ----------
    acceleration : float64 array (samples,)
        In m/s2, read-only.
    vertical : float64 array (samples,) or None
        Likewise.

    Raises
    ------
    InvalidArgumentError
        If an argument is not as described.
    """

    acceleration: Array
    time_step: float
    name: str
    source: str
    remarks: tuple[str, ...]
    vertical: Array | None

    kind = "record"
    strength = SCALE
    arguments = (SCALE,)
    rate = FREQUENCY_PARAMETER
    highest_amplitude = 10.0
    is_scanned = True

    def __init__(
        self,
        acceleration: ArrayLike,
        time_step: Scalar,
        unit: str,
        name: str = "",
        source: str = "",
        remarks: Sequence[str] = (),
        vertical: ArrayLike | None = None,
    ) -> None:
        factor = UNITS[one_of("unit", unit, UNITS)]
        limit = MAX_ACCELERATION / factor
        samples = in_range("acceleration", acceleration, -limit, limit, unit=unit)
        if samples.ndim != 1 or samples.size < 2:
            raise InvalidArgumentError("acceleration", f"shape {samples.shape}", "one dimension, at least 2 samples")
        if not samples.any():
            raise InvalidArgumentError("acceleration", "all samples 0", "a motion that is not zero")
        step = number("time_step", time_step, *TIME_STEP, unit="s")
        if (samples.size - 1) * step > MAX_DURATION:
            allowed = f"a duration of at most {MAX_DURATION:g} s, with {samples.size} samples"
            raise InvalidArgumentError("time_step", step, allowed)
        upwards = None if vertical is None else in_range("vertical", vertical, -limit, limit, unit=unit)
        if upwards is not None and upwards.shape != samples.shape:
            allowed = f"one value for each of the {samples.size} samples of the horizontal acceleration"
            raise InvalidArgumentError("vertical", f"shape {upwards.shape}", allowed)
        texts = {"name": name, "source": source, "remarks": tuple(remarks)}
        components = {"acceleration": samples * factor}  # new arrays, which the caller cannot change
        if upwards is not None:
            components["vertical"] = upwards * factor
        for component in components.values():
            component.flags.writeable = False
        vars(self).update({"vertical": None, **components, "time_step": step, **texts})

    def __repr__(self) -> str:
        """Name, length, step and peak accelerations."""
        name = f" {self.name}" if self.name else ""
        peak = self.peak_acceleration / STANDARD_GRAVITY
        vertical = ""
        if self.vertical is not None:
            vertical = f", with vertical, {self.peak_vertical_acceleration / STANDARD_GRAVITY:.4g} g"
        return f"<rocking.Record{name}: {self.samples} samples at {self.time_step:g} s, PGA {peak:.4g} g{vertical}>"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Record) and self.digest == other.digest

    def __hash__(self) -> int:
        return hash(self.digest)

    @property
    def samples(self) -> int:
        """Number of samples."""
        return self.acceleration.size

    @property
    def duration(self) -> float:
        """Time from the first to the last sample [s]."""
        return (self.samples - 1) * self.time_step

    @property
    def times(self) -> Array:
        """Times of the samples from the first [s], shape (samples,)."""
        return np.arange(self.samples, dtype=np.float64) * self.time_step

    @cached_property
    def digest(self) -> str:
        """The sha256 of the step and the samples in m/s2 as little-endian float64, hexadecimal.

        The samples of a vertical component follow after the eight bytes "vertical", a number that no sample has.
        """
        digest = hashlib.sha256(np.concatenate([[self.time_step], self.acceleration]).astype("<f8").tobytes())
        if self.vertical is not None:
            digest.update(b"vertical" + self.vertical.astype("<f8").tobytes())
        return digest.hexdigest()

    @cached_property
    def peak_acceleration(self) -> float:
        """PGA, the largest absolute acceleration [m/s2]."""
        return float(np.abs(self.acceleration).max())

    @property
    def unit_acceleration(self) -> float:
        """The largest horizontal acceleration at the factor 1 [m/s2]: PGA."""
        return self.peak_acceleration

    def duration_at(self, period: Any) -> float:
        """Duration [s]; a record has no period."""
        del period
        return self.duration

    @property
    def drift(self) -> float:
        """Velocity at the last sample over the largest, without its sign [-]."""
        return abs(self.final_velocity) / self.peak_velocity

    def refined(self) -> Record | None:
        """Resample the record at an eighth of its step; None if that has too many samples or too small a step."""
        step = self.time_step / REFINEMENT
        if self.samples * REFINEMENT > MAX_REFINED or step < TIME_STEP[0]:
            return None
        return self.resampled(step)

    @property
    def frequency_parameters(self) -> tuple[float, float]:
        """Smallest and largest frequency parameter p of a body under the record [rad/s]."""
        return FREQUENCY_PARAMETER.lower, min(FREQUENCY_PARAMETER.upper, MAX_INTERVAL / self.time_step)

    def rate_at(self, frequency_parameter: Array, period: Array) -> Array:
        """Return p times the time step [-], checked."""
        del period
        p = in_range("frequency_parameter", frequency_parameter, *self.frequency_parameters, unit="rad/s")
        return np.asarray(p * self.time_step)

    @property
    def peak_vertical_acceleration(self) -> float:
        """The largest absolute vertical acceleration [m/s2], 0 without a vertical component."""
        return 0.0 if self.vertical is None else float(np.abs(self.vertical).max())

    @cached_property
    def velocity(self) -> Array:
        """Ground velocity at the samples [m/s], zero at the first, read-only; not corrected for a baseline."""
        return measures.velocity(self.acceleration, self.time_step)

    @cached_property
    def displacement(self) -> Array:
        """Ground displacement at the samples [m], zero at the first, read-only; not corrected for a baseline."""
        velocity: Array = self.velocity
        return measures.displacement(self.acceleration, velocity, self.time_step)

    @property
    def peak_velocity(self) -> float:
        """PGV, the largest absolute velocity at the samples [m/s]."""
        return float(np.abs(self.velocity).max())

    @property
    def peak_displacement(self) -> float:
        """PGD, the largest absolute displacement at the samples [m]."""
        return float(np.abs(self.displacement).max())

    @property
    def final_velocity(self) -> float:
        """Velocity at the last sample [m/s]: the drift that an offset of the acceleration leaves."""
        return float(self.velocity[-1])

    @property
    def final_displacement(self) -> float:
        """Displacement at the last sample [m]."""
        return float(self.displacement[-1])

    @property
    def mean_acceleration(self) -> float:
        """Mean acceleration [m/s2], the offset of the baseline: the final velocity over the duration."""
        return self.final_velocity / self.duration

    @property
    def arias_intensity(self) -> float:
        """Arias intensity pi/(2 g) integral of a^2 dt [m/s] (Arias 1970)."""
        return measures.arias_intensity(self.acceleration, self.time_step)

    @property
    def significant_duration(self) -> float:
        """Time between 5 % and 95 % of the Arias intensity [s] (Trifunac & Brady 1975)."""
        return measures.significant_duration(self.acceleration, self.time_step)

    @property
    def mean_period(self) -> float:
        """Mean period T_m [s] (Rathje et al. 1998); nan if no frequency lies between 0.25 and 20 Hz."""
        return measures.mean_period(self.acceleration, self.time_step)

    def baseline_corrected(self, *, order: int | None = 1) -> Record:
        """Remove the drift of the velocity of both components.

        The velocity is fitted by a polynomial of degree `order` + 1 that is zero at the first sample; its derivative, a
        polynomial of degree `order`, is subtracted from the acceleration.

        Parameters
        ----------
        order : int or None
            Degree of what is subtracted from the acceleration, 0 to 6; None gives the record as it is.

        Raises
        ------
        InvalidArgumentError
            If `order` is out of range, or the record has too few samples for it.
        """
        if order is None:
            return self

        def corrected(a: Array) -> Array:
            return baseline(a, measures.velocity(a, self.time_step), self.duration, order)

        return self._processed(corrected, self.time_step, f"baseline of order {order} removed")

    def mirrored(self) -> Record:
        """Return the record with the other sign of its horizontal acceleration."""
        name = f"{self.name}, mirrored" if self.name else ""
        return Record(-self.acceleration, self.time_step, "m/s2", name, self.source, self.remarks, self.vertical)

    def resampled(self, time_step: Scalar) -> Record:
        """Resample the record at another step, by band-limited interpolation with anti-aliasing.

        The answers of the solver belong to a motion that is linear between the samples; comparing them with those of a
        record resampled at a fraction of the step shows how much this assumption matters.

        Parameters
        ----------
        time_step : float
            The new step [s], [1e-6, 10]; its ratio to the old one must be a fraction of integers up to 1000. At most
            10,000,000 samples are made.

        Raises
        ------
        InvalidArgumentError
            If the step is not such a fraction, or the samples would be fewer than 2 or too many.
        """
        step = number("time_step", time_step, *TIME_STEP, unit="s")

        def resampled(a: Array) -> Array:
            return resample(a, self.time_step, step)

        return self._processed(resampled, step, f"resampled from {self.time_step:g} s, band-limited")

    def _processed(self, process: Callable[[Array], Array], time_step: float, what: str) -> Record:
        """Return the record with other samples of both components [m/s2]; its source says what was done."""
        source = f"{self.source}; {what}" if self.source else what
        vertical = None if self.vertical is None else process(self.vertical)
        return Record(process(self.acceleration), time_step, "m/s2", self.name, source, self.remarks, vertical)


SUMMARY = {
    "name": "",
    "source": "",
    "samples": "-",
    "time_step": "s",
    "peak_acceleration": "m/s2",
    "peak_vertical_acceleration": "m/s2",
    "peak_velocity": "m/s",
    "peak_displacement": "m",
    "arias_intensity": "m/s",
    "significant_duration": "s",
    "mean_period": "s",
    "final_velocity": "m/s",
}
"""Attributes of a record that the command line and the service show, in order, with their units."""


def summary_of(record: Record) -> dict[str, Any]:
    """Return the values of `SUMMARY` by name; None for a measure that the record does not have."""
    values = {name: getattr(record, name) for name in SUMMARY} | {"mean_period": finite(record.mean_period)}
    if record.vertical is None:
        values["peak_vertical_acceleration"] = None
    return values


def offset_doubts(records: Sequence[Record], limit: int = 5) -> list[str]:
    """Return remarks on the records whose offset is not small, which scaling by PGA or PGV would amplify."""
    remarks = []
    for record in records:
        text = offset_remark(record.acceleration)
        if text is not None:
            remarks.append(f"{record.name or 'a record'}: {text}")
    if len(remarks) > limit:
        remarks[limit:] = [f"{len(remarks) - limit} more records have offsets that are not small"]
    return remarks
