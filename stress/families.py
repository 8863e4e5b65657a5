"""The families of hard cases, each with the reason why it is hard."""

from __future__ import annotations

from argparse import ArgumentParser

from stress.cells import Draw, Family
from stress.edges import ALPHA, GRAZING, ISLAND, OUTCOME, PULSE_END, EdgeFamily

THREE_LOBES = ("cosine", "c1", "c2", "ricker", "ricker_antisymmetric", "mavroeidis_papageorgiou")
"""Pulses that accelerate to one side, back, and to the first side again."""

SEVERAL_LOBES = ("sine", *THREE_LOBES)

MANY_IMPACTS = 20_000
"""Number of impacts that separates the two families of nearly elastic blocks."""


def _ordinary(draw: Draw) -> tuple[float, float, float]:
    return draw.uniform(0.05, 0.95), draw.log(0.3, 12.0), draw.uniform(0.3, 1.0)


def _onset(draw: Draw) -> tuple[float, float, float]:
    return 1.0 - draw.log(1e-12, 1e-2), draw.log(0.3, 12.0), draw.uniform(0.0, 0.95)


def _chatter(draw: Draw) -> tuple[float, float, float]:
    return 1.0 - draw.log(1e-6, 0.1), draw.log(0.02, 2.0), draw.uniform(0.8, 0.98)


def _uplift_again(draw: Draw) -> tuple[float, float, float]:
    return 1.0 - draw.log(1e-4, 0.2), draw.log(0.3, 12.0), draw.uniform(0.0, 0.6)


def _strong(draw: Draw) -> tuple[float, float, float]:
    slenderness = draw.log(1e-4, 1e-1)
    return slenderness, min(draw.log(0.3, 30.0) / slenderness, 1e4), draw.uniform(0.0, 1.0)


def _impulse(draw: Draw) -> tuple[float, float, float]:
    return draw.uniform(0.02, 0.98), draw.log(1e2, 1e4), draw.uniform(0.0, 1.0)


def _slow(draw: Draw) -> tuple[float, float, float]:
    """Draw blocks under a slow pulse.

    Two of three are close to the onset of uplift, since a slow pulse overturns every block that it uplifts clearly.
    """
    omega = draw.log(1e-4, 1e-1)
    gap = omega * omega * draw.log(1e-2, 10.0)
    return draw.one_of(1.0 - gap, 1.0 - gap, draw.uniform(0.05, 0.95)), omega, draw.uniform(0.0, 0.9)


def _restitution(draw: Draw) -> tuple[float, float, float]:
    return draw.uniform(0.1, 0.95), draw.log(0.5, 12.0), draw.one_of(0.0, 1e-3, 1.0 - 1e-12, 1.0)


def _elastic(draw: Draw) -> tuple[float, float, float]:
    return 1.0 - draw.log(5e-5, 1e-3), draw.log(0.02, 0.1), draw.one_of(0.9999, 1.0 - 1e-6, 1.0 - 1e-12, 1.0)


def _unending(draw: Draw) -> tuple[float, float, float]:
    return 1.0 - draw.log(7e-5, 1.5e-4), draw.log(0.015, 0.03), draw.uniform(0.9999, 0.99994)


def _line(draw: Draw) -> tuple[float, float, float]:
    return 0.0, draw.log(0.5, 12.0), draw.uniform(0.5, 1.0)


def _island_line(draw: Draw) -> tuple[float, float, float]:
    return 0.0, draw.uniform(0.45, 1.2), draw.uniform(0.8, 1.0)


def _extreme_angle(draw: Draw) -> float:
    return draw.one_of(draw.log(1e-8, 1e-2), draw.uniform(0.8, 1.55))


FAMILIES: tuple[Family | EdgeFamily, ...] = (
    Family("ordinary", "random cells, for comparison", _ordinary),
    Family("onset", "1/a = 1 - 1e-2 to 1 - 1e-12: the net acceleration is a small difference of large numbers", _onset),
    Family(
        "chatter", "100 impacts or more", _chatter, pulses=SEVERAL_LOBES, accept=lambda r: r.impacts >= 100, size=168
    ),
    Family(
        "uplift-again",
        "at rest during the pulse, then uplift again",
        _uplift_again,
        pulses=SEVERAL_LOBES,
        accept=lambda r: r.uplifts >= 2,
    ),
    EdgeFamily("grazing", "an impact at a very small velocity, or just none", _line, GRAZING, pulses=THREE_LOBES),
    EdgeFamily(
        "touching-alpha", "the peak is just below or above alpha, and the block survives", _line, ALPHA, edges=60
    ),
    EdgeFamily(
        "pulse-end", "the last impact just before or after the end of the pulse, as in (3.31)", _line, PULSE_END
    ),
    EdgeFamily("separatrix", "1e-3 to 1e-12 from another outcome", _line, OUTCOME),
    EdgeFamily(
        "islands",
        "1e-3 to 1e-12 from overturning after three, five or more impacts",
        _island_line,
        ISLAND,
        line=(0.86, 0.98, 16),
        pulses=SEVERAL_LOBES,
        edges=54,
        max_impacts=60,
    ),
    EdgeFamily(
        "last-bits",
        "1e-12 to 1e-16 from another outcome: rounding of the input decides",
        _line,
        OUTCOME,
        nearest=1e-16,
        farthest=1e-12,
        requirements=("digits", "bounds", "times"),
    ),
    Family("strong", "1/a down to 1e-4", _strong),
    Family("impulse", "omega up to 1e4: flights as short as 1e-4", _impulse),
    Family("quasi-static", "omega down to 1e-4: e^(p T) would overflow", _slow),
    Family("restitution", "eta of 0, 1e-3, 1 - 1e-12, 1", _restitution),
    Family("angles", "alpha of 1e-8 to 1.55 rad", _ordinary, angle=_extreme_angle, rigid=(True,)),
    Family(
        "nearly-elastic",
        "eta from 0.9999 under slow pulses: thousands of impacts without rest",
        _elastic,
        pulses=("sine", "half_sine", "c1"),
        accept=lambda r: 2_000 <= r.impacts < MANY_IMPACTS,
        size=12,
    ),
    Family(
        "unending",
        "the same with 20,000 to 60,000 impacts",
        _unending,
        pulses=("sine",),
        accept=lambda r: MANY_IMPACTS < r.impacts <= 60_000,
        size=4,
    ),
)

BY_NAME = {family.name: family for family in FAMILIES}


def select_families(names: list[str], parser: ArgumentParser) -> list[str]:
    """Return the named families, all if no name is given; an unknown name ends the command with an error."""
    if wrong := sorted(set(names) - set(BY_NAME)):
        parser.error(f"no such family: {', '.join(wrong)}")
    return names or list(BY_NAME)
