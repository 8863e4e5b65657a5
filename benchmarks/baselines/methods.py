"""All methods that are compared: the package, and those of the other integrators that are installed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib.util import find_spec
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.baselines import runge_kutta, scipy_ivp
from benchmarks.baselines.event_loop import RICKER, SINE, respond, respond_many
from benchmarks.cells import Cells
from rocking._solver.peak_response import peak_response

OPTIONAL = ("heyoka", "numbalsoda", "diffrax")
"""Baselines that are not dependencies of the project; those that cannot be imported are omitted."""

CODES = {"sine": SINE, "ricker": RICKER}

Peaks = NDArray[np.float64]


class Method(NamedTuple):
    """Peak rotations of cells at a setting; methods marked `slow` get a sample of the cells."""

    name: str
    peaks: Callable[[Any, Cells], Peaks]
    settings: tuple[float | None, ...]
    slow: bool = False


def package_peaks(tolerance: float | None, cells: Cells) -> Peaks:
    """Return peak rotations by the package on one core, nan where overturned.

    All cells share one pulse; a tolerance of None is the smallest.
    """
    return peak_response(
        str(cells.pulse[0]),
        slenderness=cells.slenderness,
        frequency_ratio=cells.frequency_ratio,
        restitution=cells.restitution,
        alpha=cells.alpha,
        threads=1,
        relative_tolerance=tolerance,
    ).peak_rotation


def compiled_peaks(integrate_flight: Any) -> Callable[[Any, Cells], Peaks]:
    """Return the peak function of a baseline with a compiled flight; the cells share pulse, restitution and alpha."""

    def peaks(setting: Any, cells: Cells) -> Peaks:
        found = np.empty(len(cells))
        common = float(cells.restitution[0]), float(cells.alpha[0]), CODES[str(cells.pulse[0])]
        respond_many(integrate_flight, setting, cells.slenderness, cells.frequency_ratio, *common, found)
        return found

    return peaks


def python_peaks(
    integrate_flight: Callable[..., Any], wrapped: Callable[[float], Any] = float
) -> Callable[[Any, Cells], Peaks]:
    """Return the peak function of a baseline with a flight in Python, which is called with its setting `wrapped`."""

    def peaks(setting: float, cells: Cells) -> Peaks:
        columns = (cells.slenderness, cells.frequency_ratio, cells.restitution, cells.alpha)
        code = CODES[str(cells.pulse[0])]
        rows = zip(*columns, strict=True)
        return np.array([respond.py_func(integrate_flight, wrapped(setting), *map(float, row), code) for row in rows])

    return peaks


def scipy_method(method: str, settings: tuple[float, ...]) -> Method:
    """Return the baseline that uses `solve_ivp` with the given method."""
    return Method(
        f"scipy {method}", python_peaks(scipy_ivp.integrate_flight, lambda rtol: (method, rtol)), settings, slow=True
    )


def methods(pulse: str) -> Iterator[Method]:
    """Yield the package and the installed baselines for a pulse."""
    rtols = tuple(10.0**-k for k in (3, 4, 6, 8, 10, 12, 13))
    yield Method("rocking", package_peaks, (1e-3, *rtols[1:-1], None))
    if find_spec("heyoka"):
        from benchmarks.baselines import heyoka_taylor  # noqa: PLC0415  # optional

        yield Method("heyoka", python_peaks(heyoka_taylor.integrate_flight), (*rtols, 1e-15))
    if find_spec("numbalsoda"):
        from benchmarks.baselines import numbalsoda_ivp  # noqa: PLC0415  # optional

        yield Method("numbalsoda DOP853", compiled_peaks(numbalsoda_ivp.dop853_flight), rtols)
        yield Method("numbalsoda LSODA", compiled_peaks(numbalsoda_ivp.lsoda_flight), rtols)
    if find_spec("diffrax"):
        from benchmarks.baselines import diffrax_dopri8  # noqa: PLC0415  # optional

        yield Method("diffrax Dopri8", diffrax_dopri8.peaks, rtols[2:6])
    steps = tuple(2**k * (1 if pulse == "sine" else 4) for k in (5, 6, 8, 10, 12))  # the wavelet is longer
    yield Method("RK4, fixed steps", compiled_peaks(runge_kutta.integrate_flight), steps)
    yield scipy_method("RK45", rtols[:5])
    yield scipy_method("DOP853", rtols)
    yield scipy_method("LSODA", rtols)
    yield scipy_method("Radau", rtols[:3])
