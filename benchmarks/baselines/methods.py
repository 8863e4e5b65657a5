"""Who takes part: the package, and the general integrators that this environment has."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib.util import find_spec
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.baselines import runge_kutta, scipy_ivp
from benchmarks.baselines.event_loop import RICKER, SINE, rock, rock_many
from benchmarks.cells import Cells
from rocking.solver.peak_response import peak_response

OPTIONAL = ("heyoka", "numbalsoda", "diffrax")
"""Peers that are no dependencies of the project: those that cannot be imported are left out."""

CODES = {"sine": SINE, "ricker": RICKER}

Peaks = NDArray[np.float64]


class Method(NamedTuple):
    """Peaks of cells at a setting; `slow` methods get a sample of the cells."""

    name: str
    peaks: Callable[[Any, Cells], Peaks]
    settings: tuple[float | None, ...]
    slow: bool = False


def ours(tolerance: float | None, cells: Cells) -> Peaks:
    """Peak rotation by the package on one core, nan where overturned; None is its tightest. One pulse for all cells."""
    return peak_response(
        str(cells.pulse[0]),
        slenderness=cells.slenderness,
        frequency_ratio=cells.frequency_ratio,
        restitution=cells.restitution,
        alpha=cells.alpha,
        threads=1,
        tolerance=tolerance,
    ).peak_rotation


def compiled(fly: Any) -> Callable[[Any, Cells], Peaks]:
    """A peer with a compiled flight; the cells share pulse, restitution and alpha."""

    def peaks(setting: Any, cells: Cells) -> Peaks:
        found = np.empty(len(cells))
        common = float(cells.restitution[0]), float(cells.alpha[0]), CODES[str(cells.pulse[0])]
        rock_many(fly, setting, cells.slenderness, cells.frequency_ratio, *common, found)
        return found

    return peaks


def plain(fly: Callable[..., Any], wrapped: Callable[[float], Any] = float) -> Callable[[Any, Cells], Peaks]:
    """A peer with a flight in Python, which is given its setting `wrapped`."""

    def peaks(setting: float, cells: Cells) -> Peaks:
        columns = (cells.slenderness, cells.frequency_ratio, cells.restitution, cells.alpha)
        code = CODES[str(cells.pulse[0])]
        rows = zip(*columns, strict=True)
        return np.array([rock.py_func(fly, wrapped(setting), *map(float, row), code) for row in rows])

    return peaks


def by_scipy(method: str, settings: tuple[float, ...]) -> Method:
    """scipy's `solve_ivp` with that method."""
    return Method(f"scipy {method}", plain(scipy_ivp.flight, lambda rtol: (method, rtol)), settings, slow=True)


def methods(pulse: str) -> Iterator[Method]:
    """Ours, and the peers that this environment has, for a pulse."""
    rtols = tuple(10.0**-k for k in (3, 4, 6, 8, 10, 12, 13))
    yield Method("rocking", ours, (1e-3, *rtols[1:-1], None))
    if find_spec("heyoka"):
        from benchmarks.baselines import heyoka_taylor  # noqa: PLC0415  # optional

        yield Method("heyoka", plain(heyoka_taylor.flight), (*rtols, 1e-15))
    if find_spec("numbalsoda"):
        from benchmarks.baselines import numbalsoda_ivp  # noqa: PLC0415  # optional

        yield Method("numbalsoda DOP853", compiled(numbalsoda_ivp.dop853_flight), rtols)
        yield Method("numbalsoda LSODA", compiled(numbalsoda_ivp.lsoda_flight), rtols)
    if find_spec("diffrax"):
        from benchmarks.baselines import diffrax_dopri8  # noqa: PLC0415  # optional

        yield Method("diffrax Dopri8", diffrax_dopri8.peaks, rtols[2:6])
    steps = tuple(2**k * (1 if pulse == "sine" else 4) for k in (5, 6, 8, 10, 12))  # the wavelet lasts longer
    yield Method("RK4, fixed steps", compiled(runge_kutta.flight), steps)
    yield by_scipy("RK45", rtols[:5])
    yield by_scipy("DOP853", rtols)
    yield by_scipy("LSODA", rtols)
    yield by_scipy("Radau", rtols[:3])
