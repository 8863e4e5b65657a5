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
        True: the default shapes include those that leave the ground moving, half sine and rectangular.
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
        descriptions = [name for name, is_given in ways.items() if is_given]
        if len(descriptions) != 1:
            raise InvalidArgumentError("site", " and ".join(descriptions) or None, "one of pgv, periods and records")
        if not self.records and self.pga is None:
            raise InvalidArgumentError("pga", None, "a peak ground acceleration, with pgv or periods")
        if self.floor_periods is not None:
            values = self.floor_periods if isinstance(self.floor_periods, (list, tuple)) else (self.floor_periods,)
            periods = [number("floor_periods", period, *MODE_PERIODS, unit="s") for period in values]
            damping = in_range("floor_damping", self.floor_damping, 0.0, 1.0, closed="left")
            participation = in_range("floor_participation", self.floor_participation, -100.0, 100.0)
            modes: dict[str, Any] = {
                "floor_periods": tuple(periods),
                "floor_damping": damping,
                "floor_participation": participation,
            }
            modal = broadcast(modes, [np.array(periods), damping, participation])
            for name, of_modes in zip(modes, modal, strict=True):
                vars(self)[name] = tuple(of_modes.tolist())
        if self.hazard is not None:
            if not self.records:
                raise InvalidArgumentError("hazard", "no records", "a suite of records with a hazard curve")
            from rocking_assessment._hazard.curve_files import hazard_arrays  # noqa: PLC0415  (xarray takes longer to load)

            vars(self)["hazard"] = check_hazard_curve(hazard_arrays(self.hazard, "pga"))
        if self.periods is not None:
            shortest_longest: Any = self.periods
            ends = in_range("periods", shortest_longest, *LENGTH, unit="s")
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
        """`motions`, which are computed once; `stop` cancels the work, which is long on a floor."""
        motions: list[Motion] | None = vars(self).get("_motions")
        if motions is not None:
            return motions
        motions = self._records() if self.records else self._pulses()
        if self.floor_periods is not None:
            size = 0
            for k, motion in enumerate(motions):
                motions[k] = self._on_floor(motion, stop)
                size += motions[k].motion.samples  # type: ignore[operator]
                if size > MOST_SAMPLES:
                    allowed = f"periods at which all motions together have at most {MOST_SAMPLES} samples"
                    raise InvalidArgumentError("floor_periods", self.floor_periods, allowed)
        vars(self)["_motions"] = motions
        return motions

    def _records(self) -> list[Motion]:
        motions = []
        for group, pair in enumerate(vars(self)["records"]):
            components = rotated(*pair) if len(pair) > 1 else [("", pair[0])]
            name = pair[0].name or f"record {group + 1}"
            measured = components[:: PAIR_ANGLES // 2]  # along the two measured components
            peak = max(record.peak_acceleration for _, record in measured)
            ground = peak if self.pga is None else vars(self)["pga"]
            for angle, record in components:
                acceleration = ground / peak * record.peak_acceleration
                motions.append(Motion(name + angle, record, acceleration, 1.0, group, ground))
        return motions

    def _pulses(self) -> list[Motion]:
        pga, pgv, pulses = vars(self)["pga"], vars(self)["pgv"], vars(self)["shapes"]
        if pulses is None:
            pulses = [as_pulse(name) for name in PULSE_NAMES]
            pulses = [pulse for pulse in pulses if self.moving_ground or impulse_of(pulse).ends_at_rest]
        if pgv is not None:
            period = 2.0 * math.pi * pgv / pga  # at which a pulse with an impulse of 1 has the velocity
            periods = [period / impulse_of(pulse).largest for pulse in pulses]
            return [
                Motion(pulse.name, pulse, pga, t, k, pga)
                for k, (pulse, t) in enumerate(zip(pulses, periods, strict=True))
            ]
        shortest, longest = vars(self)["periods"]
        periods = np.geomspace(shortest, longest, PERIODS if shortest < longest else 1).tolist()
        motions: list[Motion] = []
        for pulse in pulses:
            for t in periods:
                motions.append(Motion(f"{pulse.name}, {t:.3g} s", pulse, pga, t, len(motions), pga))
        return motions

    def _on_floor(self, motion: Motion, stop: StopFlag | None) -> Motion:
        ground = sampled(motion)
        site: dict[str, Any] = vars(self)
        floor = floor_motion(
            ground,
            periods=site["floor_periods"],
            damping=site["floor_damping"],
            participation=site["floor_participation"],
            stop=stop,
        )
        peak = floor.peak_acceleration * (motion.peak_acceleration / ground.peak_acceleration)
        return replace(motion, motion=floor, peak_acceleration=peak, period=1.0, below=motion)


def record_doubts(site: Site) -> list[str]:
    """Warnings about the records, in words: their remarks, and an offset of a record that is scaled by its PGA."""
    records: list[Record] = []
    doubts = []
    for pair in vars(site)["records"]:
        records += pair
    for record in records:
        doubts += [f"{record.name or 'a record'}: {remark}" for remark in record.remarks]
    if site.pga is not None or site.hazard is not None:
        doubts += offset_doubts(records)
    return [*dict.fromkeys(text.replace("; ", ", ") for text in doubts)]


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
    record = motion.motion
    if not isinstance(record, Record) or record.vertical is None:
        return motion.peak_acceleration
    scale = motion.peak_acceleration / record.peak_acceleration
    weight = 1.0 + scale * record.vertical / STANDARD_GRAVITY
    return float(np.max(scale * np.abs(record.acceleration) / np.maximum(weight, 0.01)))
