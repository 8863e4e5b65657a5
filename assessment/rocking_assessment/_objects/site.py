"""Ground motions of a site."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from rocking.extension import (
    PAIR_ANGLES,
    PULSE_NAMES,
    STANDARD_GRAVITY,
    AbstractPulse,
    InvalidArgumentError,
    Record,
    Scalar,
    Values,
    as_pulse,
    broadcast,
    checked_pair,
    floor_motion,
    impulse_of,
    in_range,
    number,
    offset_doubts,
    rotated,
)
from rocking.extension import PERIODS as MODE_PERIODS
from rocking_assessment._hazard.checks import check_hazard_curve

if TYPE_CHECKING:
    import xarray as xr

    from rocking.extension import StopFlag

STRENGTHS = 1e-3, 1e3  # smallest and largest PGA [m/s2] and PGV [m/s]
LENGTH = 0.01, 10.0  # shortest and longest period of a pulse, and ratio of PGV to PGA [s]

SHAPE_PIECES = 2000
"""Linear pieces for a pulse that is not given by samples [-]: from its largest value they depart by 2e-6."""

MOST_SAMPLES = 20_000_000  # most samples of all motions of a floor together [-]
PERIODS = 12  # periods of each shape where the site has a range of periods, in equal ratios from its ends [-]


@dataclass(frozen=True)
class Motion:
    """One motion of a site."""

    name: str  # for output
    motion: AbstractPulse | Record  # the ground motion
    peak_acceleration: float  # at the site [m/s2]; on a floor, that of the floor
    period: float  # of a pulse [s]; 1 for a record
    group: int  # motions of one group are one event: the components of a pair, and a pair at other angles
    ground: float  # peak ground acceleration that belongs to `peak_acceleration` [m/s2]
    below: Motion | None = None  # of a floor: the motion of the ground


@dataclass(frozen=True)
class Site:
    """The ground motions of a site.

    One of: PGA and PGV; PGA and a range of periods; a suite of records, scaled to the PGA if it is given, and with it a
    hazard curve of PGA.

    Parameters
    ----------
    pga : float
        Peak ground acceleration [m/s2], 0.001 to 1000, or a text such as "0.3 g".
    pgv : float
        Peak ground velocity [m/s], 0.001 to 1000, 0.01 to 10 s times the PGA. Each pulse shape has the period at which
        its largest velocity equals it.
    periods : (float, float)
        Shortest and longest period of the pulses [s], 0.01 to 10, shortest <= longest; `PERIODS` of them are
        assessed.
    records : Record, or sequence of Record or (Record, Record)
        The suite; its records count as independent and equally likely, with their vertical components. Two horizontal
        components of one station are assessed at angles every 15 degrees from the first towards the second one and
        count as one record, which overturns an object if it does so at an angle. The PGA of a pair is the larger one.
    hazard : path, xarray.DataArray or (array_like, array_like)
        Peak ground accelerations [m/s2], ascending, and annual rates of exceedance [1/year]; with records. A file, or a
        result, of `rocking_assessment.read_hazard`.
    shapes : sequence of str or AbstractPulse, optional
        Pulse shapes; by default all pulses by name that leave the ground at rest.
    moving_ground : bool
        Whether the default shapes include those that leave the ground moving: half sine, rectangular.
    floor_periods, floor_damping, floor_participation : float or sequence of float
        Modes of a building of which the objects are on a floor, as `periods`, `damping` and `participation` of
        `rocking.floor_motion`; without periods they are on the ground. Factors are on the motion of the ground.
    """

    pga: Scalar | None = None
    pgv: Scalar | None = None
    periods: tuple[Scalar, Scalar] | None = None
    records: Record | Sequence[Record | tuple[Record, Record]] = ()
    hazard: str | PathLike[str] | xr.DataArray | tuple[ArrayLike, ArrayLike] | None = None
    shapes: Sequence[str | AbstractPulse] | None = None
    moving_ground: bool = False
    floor_periods: Values | None = None
    floor_damping: Values = 0.05
    floor_participation: Values = 1.0

    def __post_init__(self) -> None:
        for name, unit in (("pga", "m/s2"), ("pgv", "m/s")):
            if getattr(self, name) is not None:
                value = number(name, getattr(self, name), *STRENGTHS, unit=unit)
                vars(self)[name] = value  # a frozen dataclass
        records = self.records if isinstance(self.records, Iterable) else (self.records,)
        vars(self)["records"] = tuple(map(checked_pair, records))
        ways = {"pgv": self.pgv is not None, "periods": self.periods is not None, "records": bool(self.records)}
        stated = [name for name, there in ways.items() if there]
        if len(stated) != 1:
            raise InvalidArgumentError("site", " and ".join(stated) or None, "one of pgv, periods and records")
        if not self.records and self.pga is None:
            raise InvalidArgumentError("pga", None, "a peak ground acceleration, with pgv or periods")
        if self.floor_periods is not None:
            given = self.floor_periods if isinstance(self.floor_periods, (list, tuple)) else (self.floor_periods,)
            periods = tuple(number("floor_periods", one, *MODE_PERIODS, unit="s") for one in given)
            damping = in_range("floor_damping", self.floor_damping, 0.0, 1.0, closed="left")
            participation = in_range("floor_participation", self.floor_participation, -100.0, 100.0)
            modes: dict[str, Any] = {
                "floor_periods": periods,
                "floor_damping": damping,
                "floor_participation": participation,
            }
            modal = broadcast(modes, [np.array(periods), damping, participation])
            vars(self).update(zip(modes, (tuple(one.tolist()) for one in modal), strict=True))
        if self.hazard is not None:
            if not self.records:
                raise InvalidArgumentError("hazard", "no records", "a suite of records with a hazard curve")
            from rocking_assessment._hazard.curve_files import hazard_arrays  # noqa: PLC0415  (xarray takes longer to load)

            vars(self)["hazard"] = check_hazard_curve(hazard_arrays(self.hazard, "pga"))
        if self.periods is not None:
            given_periods: Any = self.periods
            ends = in_range("periods", given_periods, *LENGTH, unit="s")
            if ends.shape != (2,) or ends[0] > ends[1]:
                raise InvalidArgumentError("periods", self.periods, "the shortest and the longest period")
            vars(self)["periods"] = tuple(ends.tolist())
        if self.pgv is not None and not LENGTH[0] <= vars(self)["pgv"] / vars(self)["pga"] <= LENGTH[1]:
            raise InvalidArgumentError("pgv", self.pgv, f"{LENGTH[0]:g} to {LENGTH[1]:g} s times pga")
        if self.shapes is not None:
            if not len(self.shapes):
                raise InvalidArgumentError("shapes", self.shapes, "one or more pulses")
            vars(self)["shapes"] = tuple(as_pulse(shape) for shape in self.shapes)

    @property
    def motions(self) -> list[Motion]:
        """The motions, each once; of a pulse its mirror image is not listed, which is assessed as well."""
        return self.find_motions(None)

    def find_motions(self, stop: StopFlag | None) -> list[Motion]:
        """`motions`, which are found once; `stop` cancels the work, which is long on a floor."""
        if "_motions" not in self.__dict__:
            vars(self)["_motions"] = self._found(stop)
        found: list[Motion] = self.__dict__["_motions"]
        return found

    def _found(self, stop: StopFlag | None) -> list[Motion]:
        found = self._records() if self.records else self._pulses()
        if self.floor_periods is None:
            return found
        floors, size = [], 0
        for one in found:
            floors.append(self._on_floor(one, stop))
            size += floors[-1].motion.samples  # type: ignore[operator]
            if size > MOST_SAMPLES:
                allowed = f"periods at which all motions together have at most {MOST_SAMPLES} samples"
                raise InvalidArgumentError("floor_periods", self.floor_periods, allowed)
        return floors

    def _records(self) -> list[Motion]:
        found = []
        for group, given in enumerate(vars(self)["records"]):
            components = rotated(*given) if len(given) > 1 else [("", given[0])]
            name = given[0].name or f"record {group + 1}"
            peak = max(one.peak_acceleration for _, one in components[:: PAIR_ANGLES // 2])  # of the given ones
            ground = _floats(self.pga)[0] if self.pga is not None else peak
            found += [
                Motion(name + angle, one, ground / peak * one.peak_acceleration, 1.0, group, ground)
                for angle, one in components
            ]
        return found

    def _pulses(self) -> list[Motion]:
        pga, pgv, periods = (_floats(value) for value in (self.pga, self.pgv, self.periods))
        shapes = self.shapes
        if shapes is None:
            named = map(as_pulse, PULSE_NAMES)
            shapes = [shape for shape in named if self.moving_ground or impulse_of(shape).ends_at_rest]
        pulses = [as_pulse(shape) for shape in shapes]
        if pgv:
            unit = 2.0 * math.pi * pgv[0] / pga[0]
            chosen = [(one.name, one, unit / impulse_of(one).largest) for one in pulses]
        else:
            tried = np.geomspace(periods[0], periods[1], PERIODS if periods[0] < periods[1] else 1).tolist()
            chosen = [(f"{one.name}, {t:.3g} s", one, t) for one in pulses for t in tried]
        return [Motion(name, one, pga[0], t, group, pga[0]) for group, (name, one, t) in enumerate(chosen)]

    def _on_floor(self, motion: Motion, stop: StopFlag | None) -> Motion:
        ground = sampled(motion)
        modes: Any = (self.floor_periods, self.floor_damping, self.floor_participation)
        names = "periods", "damping", "participation"
        found = floor_motion(ground, **dict(zip(names, modes, strict=True)), stop=stop)
        scale = motion.peak_acceleration / ground.peak_acceleration
        return replace(
            motion, motion=found, peak_acceleration=found.peak_acceleration * scale, period=1.0, below=motion
        )


def record_doubts(site: Site) -> list[str]:
    """Warnings about the records, in words: their remarks, and an offset of a record that is scaled by its PGA."""
    records = [record for pair in vars(site)["records"] for record in pair]
    found = [f"{one.name or 'a record'}: {remark}" for one in records for remark in one.remarks]
    if site.pga is not None or site.hazard is not None:
        found += offset_doubts(records)
    return [*dict.fromkeys(text.replace("; ", ", ") for text in found)]


def sampled(motion: Motion) -> Record:
    """A pulse at the strength of the site as a record of linear pieces."""
    pulse = motion.motion
    if isinstance(pulse, Record):
        return pulse
    phases = np.linspace(pulse.start, pulse.end, SHAPE_PIECES + 1)
    step = (phases[1] - phases[0]) * motion.period / (2.0 * math.pi)
    return Record(pulse.shape(phases) * motion.peak_acceleration, step, "m/s2", motion.name)


def static_acceleration(motion: Motion) -> float:
    """Acceleration that tilts a body at rest as much as the motion with its vertical component [m/s2]."""
    given = motion.motion
    if not isinstance(given, Record) or given.vertical is None:
        return motion.peak_acceleration
    scale = motion.peak_acceleration / given.peak_acceleration
    weight = 1.0 + scale * given.vertical / STANDARD_GRAVITY
    return float(np.max(scale * np.abs(given.acceleration) / np.maximum(weight, 0.01)))


def _floats(value: Any) -> list[float]:
    """One number or several that have been checked, none for None."""
    return [] if value is None else np.atleast_1d(value).tolist()
