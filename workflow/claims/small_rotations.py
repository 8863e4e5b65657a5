"""Claims of section 6: accuracy and limits of the groups of (6.1) for blocks of any slenderness."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from rocking._history.contact import PRACTICAL_FRICTION, ContactExtremes, contact_extremes
from rocking._history.motion import build_motion
from rocking._solver.peak_response import peak_response
from workflow.claims.area import Flags, Floats, node_areas, share_of_area
from workflow.claims.claim import SMALL, Claim, holding_range

ALPHA = np.radians([0, 5, 10, 15, 20])  # slenderness angles compared [rad]; 0 is the slender limit

SLENDERNESS = np.linspace(0.20, 0.98, 79)
OMEGA = np.geomspace(1.0, 8.0, 60)

BANDS = ((0.20, 0.35), (0.35, 0.50), (0.50, 0.65), (0.65, 0.80), (0.80, 1.00))
"""Ranges of g tan(alpha)/a_g that are compared [-]."""

SIZES = ((0.0, 0.2), (0.2, 0.5), (0.5, 1.0))  # ranges of theta_max/alpha of the slender block that are compared [-]


class Spread(NamedTuple):
    """Spread of the scaled peaks over alpha relative to the slender block, arrays (slenderness, omega)."""

    slenderness: Floats  # (slenderness,)
    frequency_ratio: Floats  # (omega,)
    slender: Floats  # in the groups of (4.11)
    rigid: Floats  # in the groups of (6.1)
    survive: Flags  # whether the blocks of all angles do, in both groups
    rotation: Floats  # theta_max/alpha of the slender block

    @property
    def areas(self) -> Floats:
        """Area of each node."""
        return node_areas(self.slenderness, self.frequency_ratio)

    def band(self, low: float, high: float) -> Flags:
        """Where all survive and g tan(alpha)/a_g is in a range."""
        return self.survive & ((low <= self.slenderness) & (self.slenderness < high))[:, None]


def spreads(pulses: Sequence[str], restitution: float) -> dict[str, Spread]:
    """The spread over alpha for each pulse, for blocks that share the groups of (4.11), and those of (6.1)."""
    return {pulse: _spread(pulse, restitution) for pulse in pulses}


def _spread(pulse: str, restitution: float) -> Spread:
    s = SLENDERNESS[:, None, None]
    tangent = np.ones(ALPHA.size)  # tan(alpha)/alpha
    tangent[1:] = np.tan(ALPHA[1:]) / ALPHA[1:]
    # slenderness group of (2.2), and scale of theta, in the groups of (4.11) and of (6.1)
    peaks = [
        scale
        * peak_response(
            pulse, slenderness=group, frequency_ratio=OMEGA[:, None], restitution=restitution, alpha=ALPHA
        ).peak_rotation
        for group, scale in ((s * tangent, s), (s, s / np.sinc(ALPHA / np.pi)))
    ]
    survive = np.all([np.isfinite(peak).all(axis=-1) for peak in peaks], axis=0)
    slender, rigid = (np.ptp(peak, axis=-1) / peak[..., 0] for peak in peaks)
    return Spread(SLENDERNESS, OMEGA, slender, rigid, survive, peaks[1][..., 0] / SLENDERNESS[:, None])


WHERE = f"alpha 0 to {np.degrees(ALPHA[-1]):.0f} degrees, omega {OMEGA[0]:g} to {OMEGA[-1]:g}"


def medians(spread: Spread, ranges: Sequence[tuple[float, float]]) -> list[float]:
    """Median variation with alpha in the groups of (6.1), by range of g tan(alpha)/a_g."""
    return [float(np.median(spread.rigid[spread.band(*limits)])) for limits in ranges]


def practice(
    spreads: Mapping[str, Spread], figures: Sequence[xr.Dataset], contact: Mapping[int, Sequence[ContactExtremes]]
) -> Claim:
    """The adjectives of section 6: practically self-similar, weak, notable, likely."""
    numbers = {}
    for pulse, spread in spreads.items():
        for low, high in ((0.2, 0.5), (0.5, 1.0)):
            band = spread.band(low, high)
            numbers[f"{pulse}, {low:g} to {high:g}"] = share_of_area(spread.rigid <= SMALL, band, spread.areas)
    for pulse, spread in spreads.items():
        for low, high in SIZES:
            chosen = spread.survive & (spread.rotation > low) & (spread.rotation <= high)
            numbers[f"{pulse}, theta/alpha {low:g} to {high:g}"] = float(np.median(spread.rigid[chosen]))
    for number, figure in zip((11, 12), figures, strict=True):
        for pulse, (slender, rigid) in zip(figure.attrs["pulse_names"].split(), figure.spread.values, strict=True):
            numbers[f"figure {number}, {pulse}, (4.1)"] = float(slender)
            numbers[f"figure {number}, {pulse}, (6.1)"] = float(rigid)
    for angle, blocks in contact.items():
        demand = np.array([block.largest_friction_demand for block in blocks])
        doubtful = (demand > PRACTICAL_FRICTION) | np.array([block.lifts_off for block in blocks])
        numbers[f"doubtful at {angle} degrees"] = float(doubtful.mean())
        numbers[f"friction at {angle} degrees"] = float(np.median(demand))
    return Claim("practice", None, numbers)


def groups_for_all_cases(spreads: Mapping[str, Spread]) -> Claim:
    """Variation with alpha in the groups of (6.1) and in those of (4.11)."""
    closer = {}
    for pulse, spread in spreads.items():
        for low, high in ((0.2, 0.5), (0.5, 1.0)):
            smaller = spread.rigid < spread.slender
            closer[f"{pulse}, {low:g} to {high:g}"] = share_of_area(smaller, spread.band(low, high), spread.areas)
    first = next(iter(spreads.values()))
    within = holding_range(
        [spread.rigid < spread.slender for spread in spreads.values()],
        {"g tan(alpha)/a_g": first.slenderness[:, None], "omega": first.frequency_ratio},
        tested=[spread.band(0.2, 1.0) for spread in spreads.values()],
        weights=first.areas,
    )
    return Claim("groups-for-all-cases", min(closer.values()), closer, within=within)


def larger_slenderness(spreads: Mapping[str, Spread]) -> Claim:
    """Whether (6.1) is more accurate for large g tan(alpha)/a_g."""
    numbers, falls = {}, []
    for pulse, spread in spreads.items():
        below, above = medians(spread, ((0.2, 0.5), (0.5, 1.0)))
        falls.append(above < below)
        for (low, high), median in zip(BANDS, medians(spread, BANDS), strict=True):
            numbers[f"{pulse}, {low:g} to {high:g}"] = median
    return Claim("larger-slenderness", float(np.mean(falls)), numbers)


def twofold_effect(one_restitution: xr.Dataset, momentum: xr.Dataset) -> Claim:
    """The variation with alpha in the groups of (6.1), at one restitution and with that of (2.4)."""
    numbers, met = {}, []
    for k, pulse in enumerate(one_restitution.attrs["pulse_names"].split()):
        fixed, varied = (float(np.nanmedian(figure.spread[k])) for figure in (one_restitution, momentum))
        numbers |= {f"{pulse}, one restitution": fixed, f"{pulse}, (2.4)": varied}
        met.append(fixed <= SMALL < varied)
    return Claim("twofold-effect", float(np.mean(met)), numbers)


CONTACT_ANGLES = (20, 30, 40)
"""Slenderness angles, that of figure 11 and larger ones, at which the contact is examined [deg]."""


def contacts(pulses: Sequence[str], restitution: float) -> dict[int, list[ContactExtremes]]:
    """Extremes of the contact forces of the blocks that survive, on a coarse grid of the groups, by angle."""
    return {
        angle: [one for pulse in pulses for one in _contacts(pulse, angle, restitution)] for angle in CONTACT_ANGLES
    }


def _contacts(pulse: str, angle: float, restitution: float) -> list[ContactExtremes]:
    s, omega = (grid.ravel() for grid in np.meshgrid(np.linspace(0.3, 0.95, 12), np.geomspace(1.0, 8.0, 12)))
    alpha = float(np.radians(angle))
    survive = ~peak_response(
        pulse, slenderness=s, frequency_ratio=omega, restitution=restitution, alpha=alpha
    ).overturned
    return [
        contact_extremes(build_motion(pulse, slenderness=a, frequency_ratio=w, restitution=restitution, alpha=alpha))
        for a, w in zip(s[survive], omega[survive], strict=True)
    ]
