"""A pulse of any shape, given by samples: linear between them, zero outside."""

from __future__ import annotations

import hashlib
import math
from functools import cached_property
from os import PathLike
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, float_array, in_range, number, positive
from rocking._excitation.pulse_file import read_pulse_file
from rocking._excitation.series import ExcitationSeries, Family
from rocking._excitation.shapes import AbstractPulse

MAX_SAMPLES = 100_000  # most samples of a pulse; longer motions are records
MAX_RATIO = 1e9  # largest ratio of the duration to the period and to the shortest interval [-]


@final
class SampleSeries(ExcitationSeries):
    """No coefficients: the solver reads the samples."""

    family = Family.SAMPLES


@final
class SampledPulse(AbstractPulse):
    """A pulse of any shape, linear between samples and zero outside, scaled to the peak 1.

    Responses, histories, thresholds and boundaries under it are exact for this shape: no event is missed, and there is
    no time step. Equal samples, times and period make equal pulses.

    Parameters
    ----------
    acceleration : array_like (samples,)
        Ground acceleration in any unit; 2 to `MAX_SAMPLES` numbers, or a quantity, not all of them zero.
    time : array_like (samples,), optional
        Times of the samples in any unit, ascending; equidistant without it. Quantities and texts are in seconds then.
    period : float, optional
        T_p in the unit of the times, > 0, or a text such as "0.5 s" beside times in seconds, which `frequency_ratio`
        and `period` of the functions refer to. By default the duration: from the first sample to the last.
    name : str
        For output, not empty.

    Attributes
    ----------
    phases : float64 array (samples,)
        phi = 2 pi (t - t_0)/T_p of the samples [rad], from 0 on; read-only.
    values : float64 array (samples,)
        f at the samples [-]; read-only.

    Examples
    --------
    A triangle: 0, 1, 0.

    >>> triangle = SampledPulse([0.0, 1.0, 0.0])
    >>> float(triangle.acceleration(math.pi))
    1.0
    """

    phases: Array
    values: Array

    def __init__(
        self, acceleration: ArrayLike, time: ArrayLike | None = None, period: float | None = None, name: str = "sampled"
    ) -> None:
        samples = in_range(
            "acceleration", getattr(acceleration, "magnitude", acceleration), -np.inf, np.inf, closed="neither"
        )
        if samples.ndim != 1 or not 2 <= samples.size <= MAX_SAMPLES:
            raise InvalidArgumentError("acceleration", f"shape {samples.shape}", f"2 to {MAX_SAMPLES} numbers")
        largest = float(np.abs(samples).max())
        if not largest > 0.0:
            raise InvalidArgumentError("acceleration", "all samples 0", "a motion that is not zero")
        if not (name and isinstance(name, str)):
            raise InvalidArgumentError("name", name, "a string that is not empty")
        times = np.arange(samples.size, dtype=np.float64)
        if time is not None:
            times = in_range("time", time, -1e300, 1e300, unit="s")  # their differences are finite
            if times.shape != samples.shape:
                raise InvalidArgumentError("time", f"shape {times.shape}", f"{samples.size} times, one for each sample")
        duration = float(times[-1]) - float(times[0])
        steps = np.diff(times)
        if not (steps > 0.0).all():
            first = int(np.flatnonzero(~(steps > 0.0))[0])
            allowed = f"ascending times, above {times[first]:g}"
            raise InvalidArgumentError("time", float(times[first + 1]), allowed, (first + 1,))
        if not (math.isfinite(duration) and steps.min() >= duration / MAX_RATIO):
            raise InvalidArgumentError(
                "time", f"shortest interval {steps.min():g}", f"at least {MAX_RATIO:g} of them fit"
            )
        unit = duration
        if period is not None:
            unit = number("period", period, duration / MAX_RATIO, duration * MAX_RATIO, unit="s")
        phases = times - times[0]
        if unit != 2.0 * math.pi:  # phases are their own times: the same pulse again, to the last digit
            phases = 2.0 * math.pi * (phases / unit)
        values = samples / largest
        for array in (phases, values):
            array.flags.writeable = False
        rises = np.sign(np.diff(values))
        sloped = np.flatnonzero(rises)  # an extreme may be a plateau: its end is taken
        inner = sloped[1:][np.diff(rises[sloped]) != 0.0]
        fields = {"name": name, "start": 0.0, "end": float(phases[-1]), "stationary": tuple(phases[inner].tolist())}
        vars(self).update(fields | {"phases": phases, "values": values})

    @classmethod
    def from_file(
        cls,
        path: str | PathLike[str],
        period: float | None = None,
        *,
        acceleration: str | int | None = None,
        time: str | int | None = None,
        skip: int = 0,
        delimiter: str | None = None,
        decimal: str = ".",
    ) -> SampledPulse:
        """Read a pulse from a file.

        Columns of numbers with the names `acceleration` and `time`, or without names: accelerations alone, or times and
        accelerations. Or JSON: an object with the arguments of the class as keys.

        Parameters
        ----------
        path : str or path
            The file, of at most 8 MB; without its ending it names the pulse.
        period : float, optional
            T_p in the unit of the times, by default that of a JSON file, else the duration.
        acceleration, time, skip, delimiter, decimal
            Layout of the columns, as of `rocking.read_record`.

        Raises
        ------
        InvalidArgumentError
            If the file cannot be read or does not hold a pulse: with the line, what was found and what is allowed.
        """
        stated_period = {} if period is None else {"period": positive("period", period, "-")}
        layout = {"acceleration": acceleration, "time": time, "skip": skip, "delimiter": delimiter, "decimal": decimal}
        file = read_pulse_file(path, MAX_SAMPLES, **layout)
        try:
            return cls(**file.arguments | stated_period)
        except InvalidArgumentError as error:
            raise error if error.parameter in stated_period else file.error(error) from None

    @cached_property
    def digest(self) -> str:
        """The sha256 of phases and values, hexadecimal."""
        return hashlib.sha256(np.concatenate([self.phases, self.values]).astype("<f8").tobytes()).hexdigest()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SampledPulse) and (self.name, self.digest) == (other.name, other.digest)

    def __hash__(self) -> int:
        return hash((self.name, self.digest))

    def __repr__(self) -> str:
        """Name, number of samples and duration."""
        periods = self.end / (2.0 * math.pi)
        return f"<rocking.SampledPulse {self.name}: {self.values.size} samples, {periods:.4g} periods>"

    def shape(self, phi: ArrayLike) -> Array:
        """f(phi) [-] on the window, constant outside; `phi` [rad], any shape."""
        return np.asarray(np.interp(float_array("phi", phi, unit="rad"), self.phases, self.values))

    def mirrored(self) -> SampledPulse:
        opposite = self.name.removeprefix("-") if self.name.startswith("-") else f"-{self.name}"
        return SampledPulse(-self.values, self.phases, 2.0 * math.pi, opposite)

    @cached_property
    def samples(self) -> tuple[Array, Array]:
        return self.phases, self.values

    @property
    def series(self) -> SampleSeries:
        return SampleSeries()

    def _stationary_phases(self, start: float, end: float) -> tuple[float, ...]:
        del start, end
        return self.stationary
