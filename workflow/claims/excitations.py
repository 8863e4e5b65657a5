"""Claims on other excitations than one sine: more cycles, resonance, and the scale law under each pulse and record."""

import math
from collections.abc import Iterator, Mapping

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rocking._excitation.sinusoids import SinusoidalPulse
from rocking._solver.peak_response import peak_response
from workflow.claims.area import MEASURE, Flags, Floats, node_areas, share_of_area
from workflow.claims.claim import ABOUT, PART, SMALL, Claim, percent

SLENDERNESS, OMEGA = np.linspace(0.02, 0.98, 300), np.geomspace(0.2, 15.0, 300)
RESTITUTION = 0.85
GRID = f"300 x 300 blocks, 1/a 0.02 to 0.98, omega 0.2 to 15, eta = {RESTITUTION}"

FEW, MANY, EVERY = 8, 32, 2  # cycles compared for resonance, on every second row and column of the grid [-]
LAW = 0.10  # error of the scale law up to which a spectrum is "approximated" by it [-]


def sines(cycles: int) -> SinusoidalPulse:
    """Full cycles of the sine."""
    stationary = tuple((k + 0.5) * math.pi for k in range(2 * cycles))
    return SinusoidalPulse(f"sine_{cycles}", 0.0, 2 * math.pi * cycles, stationary, ((1.0, 1.0, -math.pi / 2),))


def responses(cycles: int, step: int = 1) -> tuple[Flags, Floats, NDArray[np.int32]]:
    """Whether blocks of every `step`-th row and column overturn, their peaks theta/alpha, and numbers of impacts."""
    s, omega = SLENDERNESS[::step, None], OMEGA[::step]
    found = peak_response(sines(cycles), slenderness=s, frequency_ratio=omega, restitution=RESTITUTION)
    return found.overturned, found.peak_rotation, found.impacts


def sequences() -> dict[int, int]:
    """How many numbers of impacts before overturning there are, by cycles of the sine."""
    found = {cycles: responses(cycles) for cycles in (1, 2, 3, 4)}
    return {cycles: np.unique(impacts[overturned]).size for cycles, (overturned, _, impacts) in found.items()}


def more_cycles(count: Mapping[int, int]) -> Iterator[Claim]:
    """More cycles, more ways to overturn."""
    steps = np.diff(list(count.values())) > 0
    yield Claim(
        key="more-cycles",
        place="section 3, end",
        printed="for excitations with more loading cycles more overturning sequences would arise",
        criterion="how many numbers of impacts come before overturning rises with each cycle of a sine that is added, "
        f"from 1 to 4; {GRID}",
        fails_if="after some cycles the block overturns or has come to rest, so that no sequence is added",
        found=f"{', '.join(map(str, count.values()))} numbers of impacts for {min(count)} to {max(count)} cycles",
        share=float(steps.mean()),
        numbers={f"{cycles} cycles": number for cycles, number in count.items()},
    )


def many_cycles() -> tuple[Flags, Flags, Floats]:
    """Where blocks overturn under `FEW` and `MANY` cycles, and the factor by which the peak grows."""
    (few, peak, _), (many, later, _) = responses(FEW, EVERY), responses(MANY, EVERY)
    with np.errstate(invalid="ignore", divide="ignore"):
        return few, many, later / peak


def no_resonance(few: Flags, many: Flags, growth: Floats) -> Iterator[Claim]:
    """At one frequency of excitation neither overturning nor peaks grow with the number of cycles."""
    areas, everywhere = node_areas(SLENDERNESS[::EVERY], OMEGA[::EVERY]), np.ones_like(few)
    survive = ~few & ~many & np.isfinite(growth)
    changed = share_of_area(few != many, everywhere, areas)
    grown = share_of_area(growth > 1 + ABOUT, survive, areas)
    met = changed <= SMALL, grown <= SMALL
    yield Claim(
        key="no-resonance",
        place="section 1",
        printed="rocking resonance at a constant frequency is impossible, as the effective frequency changes with the "
        "amplitude",
        criterion=f"from {FEW} to {MANY} cycles of a sine the outcome changes on at most {percent(SMALL)} of the area, "
        f"and the peak of the blocks that survive both grows by more than {percent(ABOUT)} on at most "
        f"{percent(SMALL)}; {MEASURE}, every second row and column of {GRID}; share of the two",
        fails_if="peaks grow with the number of cycles, fourfold as of a linear oscillator in resonance, and blocks "
        "overturn in the end",
        found=f"the outcome changes on {percent(changed)}; the peak grows by more than {percent(ABOUT)} on "
        f"{percent(grown)}",
        share=float(np.mean(met)),
        numbers={"changed": changed, "grown": grown},
    )


def scale_law_of_excitations(figure: xr.Dataset) -> Iterator[Claim]:
    """(4.16) under the nine pulses and the records of its figure."""
    names = figure.attrs["excitation_names"].split()
    share, exponent = figure.share.values, np.round(figure.median_exponent.values, 6) + 0.0  # no -0
    held = share >= PART
    yield Claim(
        key="scale-law-excitations",
        place="section 4a, end",
        printed="the scaling with eta squared under other excitations, which the paper leaves to be investigated",
        criterion=f"as for the sine, within {percent(LAW)} on at least {percent(PART)} of the area on which blocks "
        f"survive for all eta; {MEASURE} for the pulses, in (1/a, log p) for the records; share of the excitations",
        fails_if="the largest rotation comes before any impact, so that eta does not matter, or after several",
        found=f"for {int(held.sum())} of {held.size}; share of area and median exponent: "
        + "; ".join(f"{name} {percent(one)}, {n:.2f}" for name, one, n in zip(names, share, exponent, strict=True)),
        share=float(held.mean()),
        numbers={f"share, {name}": float(one) for name, one in zip(names, share, strict=True)}
        | {f"median exponent, {name}": float(n) for name, n in zip(names, exponent, strict=True)},
    )
