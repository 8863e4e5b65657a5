"""Ground motions of a site."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._base.errors import InvalidArgumentError, number
from rocking._base.units import Scalar
from rocking._excitation.impulse import impulse_of
from rocking._excitation.pulses import PULSE_NAMES, AbstractPulse, as_pulse
from rocking._excitation.records.record import Record
from rocking.suites.hazard_curve import check_hazard_curve

Array = NDArray[np.float64]

STRENGTHS = 1e-3, 1e3
"""Smallest and largest PGA [m/s2] and PGV [m/s]."""

LENGTH = 0.01, 10.0
"""Shortest and longest period of a pulse, and ratio of PGV to PGA [s]."""

PERIODS = 12
"""Periods of each shape where the site has a range of periods, in equal ratios from its ends [-]."""


@dataclass(frozen=True)
class Motion:
    """One motion of a site.

    Attributes
    ----------
    name : str
        For output.
    motion : AbstractPulse or Record
        The ground motion.
    peak_acceleration : float
        At the site [m/s2].
    period : float
        Of a pulse [s]; 1 for a record.
    """

    name: str
    motion: AbstractPulse | Record
    peak_acceleration: float
    period: float


@dataclass(frozen=True)
class Site:
    """How strongly the ground of a site moves.

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
    records : sequence of Record
        The suite; its records count as independent and equally likely.
    hazard : (array_like, array_like)
        Peak ground accelerations [m/s2], ascending, and annual rates of exceedance [1/year]; with records.
    shapes : sequence of str or AbstractPulse, optional
        Pulse shapes; by default all pulses by name that leave the ground at rest.
    moving_ground : bool
        Whether the default shapes include those that leave the ground moving: half sine, rectangular.

    Raises
    ------
    InvalidArgumentError
        If the combination or a value is not as described.
    """

    pga: Scalar | None = None
    pgv: Scalar | None = None
    periods: tuple[Scalar, Scalar] | None = None
    records: Sequence[Record] = ()
    hazard: tuple[ArrayLike, ArrayLike] | None = None
    shapes: Sequence[str | AbstractPulse] | None = None
    moving_ground: bool = False

    def __post_init__(self) -> None:
        for name, unit in (("pga", "m/s2"), ("pgv", "m/s")):
            if getattr(self, name) is not None:
                value = number(name, getattr(self, name), *STRENGTHS, unit=unit)
                object.__setattr__(self, name, value)  # a frozen dataclass
        object.__setattr__(self, "records", tuple(self.records))
        ways = (self.pgv is not None) + (self.periods is not None) + bool(self.records)
        if ways != 1:
            raise InvalidArgumentError("site", f"{ways} of pgv, periods, records", "exactly one of them")
        if not self.records and self.pga is None:
            raise InvalidArgumentError("pga", None, "a peak ground acceleration, with pgv or periods")
        if self.hazard is not None:
            if not self.records:
                raise InvalidArgumentError("hazard", "no records", "a suite of records with a hazard curve")
            check_hazard_curve(self.hazard)
        if self.periods is not None:
            low, high = (number("periods", value, *LENGTH, unit="s") for value in self.periods)
            if low > high:
                raise InvalidArgumentError("periods", (low, high), "the shortest and the longest period")
            object.__setattr__(self, "periods", (low, high))
        if self.pgv is not None and not LENGTH[0] <= vars(self)["pgv"] / vars(self)["pga"] <= LENGTH[1]:
            raise InvalidArgumentError("pgv", self.pgv, f"{LENGTH[0]:g} to {LENGTH[1]:g} s times pga")
        if self.shapes is not None:
            if not len(self.shapes):
                raise InvalidArgumentError("shapes", self.shapes, "one or more pulses")
            object.__setattr__(self, "shapes", tuple(as_pulse(shape) for shape in self.shapes))

    @property
    def motions(self) -> list[Motion]:
        """The motions, each once; of a pulse its mirror image is not listed, which is assessed as well."""
        pga, pgv, periods = (_floats(value) for value in (self.pga, self.pgv, self.periods))
        if self.records:
            return [
                Motion(record.name or f"record {k}", record, (pga or [record.peak_acceleration])[0], 1.0)
                for k, record in enumerate(self.records, start=1)
            ]
        shapes = self.shapes
        if shapes is None:
            named = map(as_pulse, PULSE_NAMES)
            shapes = [shape for shape in named if self.moving_ground or impulse_of(shape).ends_at_rest]
        if pgv:
            unit = 2.0 * math.pi * pgv[0] / pga[0]
            return [Motion(one.name, one, pga[0], unit / impulse_of(one).largest) for one in map(as_pulse, shapes)]
        tried = np.geomspace(periods[0], periods[1], PERIODS if periods[0] < periods[1] else 1).tolist()
        return [Motion(f"{one.name}, {t:.3g} s", one, pga[0], t) for one in map(as_pulse, shapes) for t in tried]

    @property
    def hazard_curve(self) -> tuple[Array, Array] | None:
        """Peak ground accelerations [m/s2] and annual rates of exceedance [1/year], where they are given."""
        return None if self.hazard is None else check_hazard_curve(self.hazard)


def _floats(value: Any) -> list[float]:
    """One number or several that have been checked, none for None."""
    return [] if value is None else np.atleast_1d(value).tolist()
