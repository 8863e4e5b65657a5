"""All methods that are compared: the package, and those of the other integrators that are installed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib.util import find_spec
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.baselines import runge_kutta, scipy_ivp
from benchmarks.baselines.event_loop import RICKER, SINE, respond, respond_many
from benchmarks.tables import Table
from rocking._solver.peak_response import peak_response

OPTIONAL = ("heyoka",)
"""Baselines that are not dependencies of the project; one that cannot be imported is omitted."""

CODES = {"sine": SINE, "ricker": RICKER}

Peaks = NDArray[np.float64]


class Method(NamedTuple):
    """Peak rotations of cells at a setting; methods marked `slow` get a sample of the cells."""

    name: str
    peaks: Callable[[Any, Table], Peaks]
    settings: tuple[float | None, ...]
    slow: bool = False


def package_peaks(tolerance: float | None, cells: Table) -> Peaks:
    """Return peak rotations by the package on one core, nan where overturned.

    All cells share one pulse; a tolerance of None is the smallest.
    """
    return peak_response(str(cells.pulse[0]), **cells.inputs(), threads=1, relative_tolerance=tolerance).peak_rotation


def compiled_peaks(integrate_flight: Any) -> Callable[[Any, Table], Peaks]:
    """Return the peak function of a baseline with a compiled flight; the cells share pulse, restitution and alpha."""

    def peaks(setting: Any, cells: Table) -> Peaks:
        found = np.empty(len(cells))
        common = float(cells["restitution"][0]), float(cells["alpha"][0]), CODES[str(cells.pulse[0])]
        respond_many(integrate_flight, setting, cells["slenderness"], cells["frequency_ratio"], *common, found)
        return found

    return peaks


def python_peaks(
    integrate_flight: Callable[..., Any], wrapped: Callable[[float], Any] = float
) -> Callable[[Any, Table], Peaks]:
    """Return the peak function of a baseline with a flight in Python, which is called with its setting `wrapped`."""

    def peaks(setting: float, cells: Table) -> Peaks:
        code, rows = CODES[str(cells.pulse[0])], zip(*cells.inputs().values(), strict=True)
        return np.array([respond.py_func(integrate_flight, wrapped(setting), *map(float, row), code) for row in rows])

    return peaks


def methods(pulse: str) -> Iterator[Method]:
    """Yield the package and the installed baselines for a pulse."""
    rtols = tuple(10.0**-k for k in (3, 4, 6, 8, 10, 12, 13))
    yield Method("rocking", package_peaks, (1e-3, *rtols[1:-1], None))
    if find_spec("heyoka"):
        from benchmarks.baselines import heyoka_taylor  # noqa: PLC0415  # optional

        yield Method("heyoka", python_peaks(heyoka_taylor.integrate_flight), (*rtols, 1e-15))
    steps = tuple(2**k * (1 if pulse == "sine" else 4) for k in (5, 6, 8, 10, 12))  # the wavelet is longer
    yield Method("RK4, fixed steps", compiled_peaks(runge_kutta.integrate_flight), steps)
    for name, settings in (("RK45", rtols[:5]), ("DOP853", rtols), ("LSODA", rtols), ("Radau", rtols[:3])):
        peaks = python_peaks(scipy_ivp.integrate_flight, lambda rtol, name=name: (name, rtol))
        yield Method(f"scipy {name}", peaks, settings, slow=True)
