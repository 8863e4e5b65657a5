"""Claims of section 6: accuracy and limits of the groups of (6.1) for blocks of any slenderness."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from rocking._history.contact import PRACTICAL_FRICTION, ContactExtremes, contact_extremes
from rocking._history.motion import build_motion
from rocking._solver.peak_response import peak_response
from workflow.claims.area import MEASURE, Flags, Floats, node_areas, share_of_area
from workflow.claims.claim import SMALL, Claim, Range, holding_range, percent

ALPHA = np.radians([0, 5, 10, 15, 20])  # slenderness angles compared [rad]; 0 is the slender limit

SLENDERNESS = np.linspace(0.20, 0.98, 79)
OMEGA = np.geomspace(1.0, 8.0, 60)

BANDS = ((0.20, 0.35), (0.35, 0.50), (0.50, 0.65), (0.65, 0.80), (0.80, 1.00))
"""Ranges of g tan(alpha)/a_g that are compared [-]."""

SIZES = ((0.0, 0.2), (0.2, 0.5), (0.5, 1.0))  # ranges of theta_max/alpha of the slender block that are compared [-]
LIKELY = 0.5  # share of blocks from which something is "likely" [-]


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


def _where(found: Mapping[str, Spread]) -> str:
    omega = next(iter(found.values())).frequency_ratio
    return f"alpha 0 to {np.degrees(ALPHA[-1]):.0f} degrees, omega {omega[0]:g} to {omega[-1]:g}"


def _range(found: Mapping[str, Spread], good: Callable[[Spread], Flags], low: float) -> Range | None:
    """The range of g tan(alpha)/a_g, from `low` on, or of omega in which all blocks of all pulses are good."""
    one = next(iter(found.values()))
    return holding_range(
        [good(spread) for spread in found.values()],
        {"g tan(alpha)/a_g": one.slenderness[:, None], "omega": one.frequency_ratio},
        tested=[spread.band(low, 1.0) for spread in found.values()],
        weights=one.areas,
    )


def practical_similarity(found: Mapping[str, Spread]) -> Iterator[Claim]:
    """(6.1) for g tan(alpha)/a_g from 0.5 to 1, and for all values, compared with (4.11)."""
    within, closer, rows = {}, {}, []
    for pulse, spread in found.items():
        for low, high in ((0.2, 0.5), (0.5, 1.0)):
            band, name = spread.band(low, high), f"{pulse}, {low:g} to {high:g}"
            within[name] = share_of_area(spread.rigid <= SMALL, band, spread.areas)
            closer[name] = share_of_area(spread.rigid < spread.slender, band, spread.areas)
            rows.append(
                f"{name}: {percent(within[name])}, median {percent(float(np.median(spread.rigid[band])))}, largest "
                f"{percent(float(spread.rigid[band].max()))} (in the groups of (4.11) the median is "
                f"{percent(float(np.median(spread.slender[band])))})"
            )
    near_one = [share for name, share in within.items() if name.endswith("0.5 to 1")]
    yield Claim(
        key="practical-similarity",
        fails_if="cos(alpha) acts by more than the scale of the rotation",
        place="section 6, below (6.1)",
        printed="(6.1) makes the response practically self-similar for 0.5 < g tan(alpha)/a_g < 1",
        criterion=f"the peaks in these groups vary with alpha by at most {percent(SMALL)} of that of the slender "
        f"block, where all survive; {_where(found)}, {MEASURE}, for each pulse",
        found="on " + "; ".join(rows),
        share=min(near_one),
        within=_range(found, lambda one: one.rigid <= SMALL, 0.5),
        numbers=within,
    )
    yield Claim(
        key="groups-for-all-cases",
        fails_if="the groups of (4.11) do better in a range",
        place="section 6, end",
        printed="the groups of (6.1) are proposed for all cases",
        criterion="the peaks vary less with alpha than in the groups of (4.11), for 0.2 to 0.5 and for 0.5 to 1, for "
        f"each pulse; {_where(found)}, {MEASURE}",
        found="on " + ", ".join(f"{percent(share, 3)} ({name})" for name, share in closer.items()),
        share=min(closer.values()),
        within=_range(found, lambda one: one.rigid < one.slender, 0.2),
        numbers=closer,
    )


def larger_slenderness(found: Mapping[str, Spread]) -> Iterator[Claim]:
    """Whether (6.1) is more accurate for large g tan(alpha)/a_g (figure 13) and for small rotations (figure 10)."""
    by_slenderness, by_rotation, halves = {}, {}, {}
    for pulse, spread in found.items():
        halves[pulse] = [float(np.median(spread.rigid[spread.band(*limits)])) for limits in ((0.2, 0.5), (0.5, 1.0))]
        by_slenderness[pulse] = [float(np.median(spread.rigid[spread.band(*limits)])) for limits in BANDS]
        rotation = spread.rotation
        by_rotation[pulse] = [
            float(np.median(spread.rigid[spread.survive & (rotation > low) & (rotation <= high)]))
            for low, high in SIZES
        ]

    def rows(medians: Mapping[str, Sequence[float]], ranges: Sequence[tuple[float, float]]) -> str:
        return "; ".join(
            f"{pulse}: " + ", ".join(f"{percent(v)} ({a:g} to {b:g})" for v, (a, b) in zip(values, ranges, strict=True))
            for pulse, values in medians.items()
        )

    def numbers(medians: Mapping[str, Sequence[float]], ranges: Sequence[tuple[float, float]]) -> dict[str, float]:
        return {
            f"{pulse}, {a:g} to {b:g}": v
            for pulse, values in medians.items()
            for v, (a, b) in zip(values, ranges, strict=True)
        }

    falls = [upper < lower for lower, upper in halves.values()]
    rises = np.concatenate([np.diff(values) > 0 for values in by_rotation.values()])
    yield Claim(
        key="larger-slenderness",
        fails_if="the variation rises with g tan(alpha)/a_g",
        place="section 6, figure 13",
        printed="the groups of (6.1) are most effective for larger g tan(alpha)/a_g",
        criterion="the median variation of the peaks with alpha is smaller for g tan(alpha)/a_g from 0.5 to 1 than "
        f"from 0.2 to 0.5; {_where(found)}; share of the pulses",
        found=f"for {sum(falls)} of {len(falls)} pulses: "
        + "; ".join(f"{pulse}: {percent(b)} against {percent(a)}" for pulse, (a, b) in halves.items())
        + ". In narrower ranges: "
        + rows(by_slenderness, BANDS),
        share=float(np.mean(falls)),
        numbers=numbers(by_slenderness, BANDS),
    )
    yield Claim(
        key="small-rotations",
        fails_if="the variation is as large for small rotations",
        place="section 5, end, and section 6",
        printed="while rotations are small the dependence on alpha is weak",
        criterion=f"the median variation of the peaks with alpha in the groups of (6.1) is at most {percent(SMALL)} "
        "for the smallest rotations and rises from each range of theta_max/alpha of the slender block to the next, for "
        f"each pulse; {_where(found)}; share of the steps",
        found=f"at {int(rises.sum())} of {rises.size} steps: " + rows(by_rotation, SIZES),
        share=float(rises.mean()) * float(all(values[0] <= SMALL for values in by_rotation.values())),
        numbers=numbers(by_rotation, SIZES),
    )


def twofold_effect(one_restitution: xr.Dataset, momentum: xr.Dataset) -> Iterator[Claim]:
    """The variation with alpha in the groups of (6.1), at one restitution and with that of (2.4)."""
    pulses = one_restitution.attrs["pulse_names"].split()
    median = {
        name: [float(np.nanmedian(figure.spread[k])) for k in range(len(pulses))]
        for name, figure in (("one", one_restitution), ("momentum", momentum))
    }
    met = [fixed <= SMALL < varied for fixed, varied in zip(median["one"], median["momentum"], strict=True)]
    angle, omega = float(np.degrees(one_restitution.alpha.max())), one_restitution.frequency_ratio.values
    yield Claim(
        key="twofold-effect",
        fails_if="the damping hardly changes the peaks, or alpha changes them at one restitution",
        place="section 4a, end",
        printed="with the restitution of (2.4) the slenderness alpha has a twofold effect, through g tan(alpha)/a_g "
        "and through the damping",
        criterion="at equal g tan(alpha)/a_g and omega the median variation of the peaks with alpha, in the groups of "
        f"(6.1), is at most {percent(SMALL)} with one restitution and more with that of (2.4); alpha 0 to {angle:.0f} "
        f"degrees, omega {omega[0]:g} to {omega[-1]:g}; share of the pulses",
        found="; ".join(
            f"{pulse}: {percent(fixed)} with one restitution, {percent(varied)} with (2.4)"
            for pulse, fixed, varied in zip(pulses, median["one"], median["momentum"], strict=True)
        ),
        share=float(np.mean(met)),
        numbers={
            f"{pulse}, {name}": value
            for name, values in median.items()
            for pulse, value in zip(pulses, values, strict=True)
        },
    )


def histories(figures: Sequence[xr.Dataset]) -> Iterator[Claim]:
    """Figures 11 and 12: largest distance between blocks in the slender groups and in those of (6.1)."""
    rows, numbers, ratios = [], {}, []
    for number, figure in zip((11, 12), figures, strict=True):
        s = float(figure.attrs["slenderness"])
        for pulse, (left, right) in zip(figure.attrs["pulse_names"].split(), figure.spread.values, strict=True):
            rows.append(f"{percent(right)} instead of {percent(left)} (figure {number}, {s:g}, {pulse})")
            numbers |= {f"figure_{number}_{pulse}_4.11": float(left), f"figure_{number}_{pulse}_6.1": float(right)}
            ratios.append(left / right)
    first = len(figures[0].spread)
    met = [min(ratios) > 2, min(ratios[first:]) > max(ratios[:first])]
    yield Claim(
        key="histories",
        fails_if="the times of the impacts depend on alpha in these groups too",
        place="section 6, figures 11 and 12",
        printed="in the groups of (6.1) responses depend notably less on alpha, even more evidently so at 0.75",
        criterion="the largest difference between histories of blocks of different alpha is less than half of that in "
        "the groups of (4.1) in each panel, and the reduction is larger in each panel of figure 12 than in those of "
        "figure 11; share of the two",
        found="difference as a share of the peak of the slender block: " + "; ".join(rows),
        share=float(np.mean(met)) if met[0] else 0.0,
        numbers=numbers,
    )


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


def pure_rocking(found: Mapping[int, Sequence[ContactExtremes]]) -> Iterator[Claim]:
    """Whether pure rocking is doubtful for angles beyond those of figure 11."""
    doubtful = {
        angle: float(np.mean([one.largest_friction_demand > PRACTICAL_FRICTION or one.lifts_off for one in ones]))
        for angle, ones in found.items()
    }
    demand = {angle: float(np.median([one.largest_friction_demand for one in ones])) for angle, ones in found.items()}
    first, *larger = found
    met = [doubtful[angle] >= LIKELY for angle in larger]
    yield Claim(
        key="pure-rocking",
        fails_if="blocks of these angles need little friction",
        place="section 6, below (6.1)",
        printed="for larger alpha than in figure 11 pure rocking, without sliding or bouncing, would likely break down",
        criterion=f"beyond the largest angle of figure 11, {first} degrees, at {' and '.join(map(str, larger))} "
        f"degrees, at least {percent(LIKELY)} of the blocks that survive need a friction coefficient above "
        f"{PRACTICAL_FRICTION} or lose contact; a grid of 144 blocks, sine and cosine; share of these angles",
        found="share of such blocks and median friction coefficient: "
        + ", ".join(f"{percent(doubtful[angle])}, {demand[angle]:.2f} ({angle} degrees)" for angle in found),
        share=float(np.mean(met)),
        numbers={f"doubtful_{angle}_deg": doubtful[angle] for angle in found}
        | {f"median_friction_{angle}_deg": demand[angle] for angle in found},
    )
