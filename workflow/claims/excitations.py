"""Claims on other excitations than one sine: more cycles, resonance, and the scale law under each pulse and record."""

from collections.abc import Mapping

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rocking._excitation.pulses import pulse
from rocking._solver.peak_response import peak_response
from workflow.claims.area import Flags, Floats, node_areas, share_of_area
from workflow.claims.claim import ABOUT, PART, SMALL, Claim

SLENDERNESS, OMEGA = np.linspace(0.02, 0.98, 300), np.geomspace(0.2, 15.0, 300)
RESTITUTION = 0.85
GRID = f"300 x 300 blocks, 1/a 0.02 to 0.98, omega 0.2 to 15, eta = {RESTITUTION}"

FEW, MANY, EVERY = 8, 32, 2  # cycles compared for resonance, on every second row and column of the grid [-]


def responses(cycles: int, step: int = 1) -> tuple[Flags, Floats, NDArray[np.int32]]:
    """Whether blocks of every `step`-th row and column overturn, their peaks theta/alpha, and numbers of impacts."""
    s, omega = SLENDERNESS[::step, None], OMEGA[::step]
    motion = pulse("sine", cycles=cycles)
    response = peak_response(motion, slenderness=s, frequency_ratio=omega, restitution=RESTITUTION)
    return response.overturned, response.peak_rotation, response.impacts


def sequences() -> dict[int, int]:
    """How many numbers of impacts before overturning there are, by cycles of the sine."""
    counts = {}
    for cycles in (1, 2, 3, 4):
        overturned, _, impacts = responses(cycles)
        counts[cycles] = np.unique(impacts[overturned]).size
    return counts


def more_cycles(count: Mapping[int, int]) -> Claim:
    """More cycles, more ways to overturn."""
    return Claim(
        "more-cycles",
        float((np.diff(list(count.values())) > 0).mean()),
        {f"{cycles} cycles": number for cycles, number in count.items()},
    )


def many_cycles() -> tuple[Flags, Flags, Floats]:
    """Where blocks overturn under `FEW` and `MANY` cycles, and the factor by which the peak grows."""
    (few, peak, _), (many, later, _) = responses(FEW, EVERY), responses(MANY, EVERY)
    with np.errstate(invalid="ignore", divide="ignore"):
        return few, many, later / peak


def no_resonance(few: Flags, many: Flags, growth: Floats) -> Claim:
    """At one frequency of excitation neither overturning nor peaks grow with the number of cycles."""
    areas, everywhere = node_areas(SLENDERNESS[::EVERY], OMEGA[::EVERY]), np.ones_like(few)
    changed = share_of_area(few != many, everywhere, areas)
    grown = share_of_area(growth > 1 + ABOUT, ~few & ~many & np.isfinite(growth), areas)
    return Claim(
        "no-resonance", float(np.mean([changed <= SMALL, grown <= SMALL])), {"changed": changed, "grown": grown}
    )


def scale_law_of_excitations(figure: xr.Dataset) -> Claim:
    """(4.16) under the nine pulses and the records of its figure."""
    names = figure.attrs["excitation_names"].split()
    share, exponent = figure.share.values, np.round(figure.median_exponent.values, 6) + 0.0  # no -0
    numbers = dict(zip([f"share, {name}" for name in names], share.tolist(), strict=True))
    numbers |= dict(zip([f"median exponent, {name}" for name in names], exponent.tolist(), strict=True))
    return Claim("scale-law-excitations", float((share >= PART).mean()), numbers)
