"""Regions of overturning after several impacts: the semi-analytical criterion against the solver and the page."""

import math
from pathlib import Path

import numpy as np
import pytest

from rocking import paper as cf
from rocking._base.errors import InvalidArgumentError
from rocking._boundary.amplitude import thresholds
from rocking._solver.peak_response import peak_response
from tests.direct_integration import integrate
from tests.sampling import but_long

PAGE = (Path(__file__).parents[2] / "docs/equations.md").read_text(encoding="utf-8")
ETA = 0.85

REGIONS = {  # pulse, impacts: windows of omega and of a with one region of each
    ("sine", 3): ((0.7, 1.1), (1.08, 1.13)),
    ("sine", 5): ((0.55, 0.8), (1.05, 1.1)),
    ("cosine", 2, "tongue"): ((1.2, 1.5), (2.0, 3.2)),
    ("cosine", 2): ((1.5, 2.0), (1.15, 1.5)),
    ("cosine", 4): ((1.4, 1.9), (1.15, 1.3)),
}


@pytest.mark.parametrize(
    ("pulse", "omega", "impacts", "window"),
    [
        ("sine", 0.8, 3, (1.02, 1.13)),
        ("sine", 0.6, 5, (1.02, 1.13)),
        ("cosine", 1.2, 2, (1.9, 2.6)),
        ("cosine", 1.5, 2, (1.05, 1.5)),
        ("cosine", 1.5, 4, (1.02, 1.3)),
    ],
)
def test_interval_is_that_of_the_solver(pulse: str, omega: float, impacts: int, window: tuple[float, float]) -> None:
    interval = cf.overturning_interval(pulse, omega, ETA, impacts, amplitude=window)
    found = thresholds(pulse, frequency_ratio=omega, restitution=ETA)
    of_region = (found.impacts == impacts) & (found.amplitude > window[0]) & (found.amplitude < window[1])
    np.testing.assert_allclose(interval, found.amplitude[of_region], rtol=1e-9)


def test_impacts_are_those_of_direct_integration() -> None:
    a, omega = 1.10, 0.8
    impacts = cf.impacts_in_pulse("sine", a, omega, ETA, 3)
    motion = integrate(a, omega, ETA)
    times = [(impact.phase - float(cf.uplift_phase(a))) / omega for impact in impacts]
    np.testing.assert_allclose(times, motion.impact_times[:3], rtol=1e-8)
    np.testing.assert_allclose(
        np.abs([impact.velocity for impact in impacts]), np.abs(motion.impact_velocities[:3]), rtol=1e-7
    )


def test_first_impact_and_margin_are_those_of_case_1_1() -> None:
    a, omega = 1.5, 3.0
    (impact,) = cf.impacts_in_pulse("sine", a, omega, ETA, 1)
    assert (impact.phase - float(cf.uplift_phase(a))) / omega == pytest.approx(float(cf.case_1_1_impact_time(a, omega)))
    threshold = float(cf.case_1_1_amplitudes(omega, ETA).lower)
    assert cf.margin_after_impacts("sine", threshold, omega, ETA, 1) == pytest.approx(0, abs=1e-9)
    above = float(cf.case_1_2_amplitudes(omega, ETA).upper)  # the impact follows the pulse
    assert cf.impacts_in_pulse("sine", above, omega, ETA, 1) == []
    assert cf.margin_after_impacts("sine", above, omega, ETA, 1) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("region", but_long(REGIONS, ("cosine", 2)), ids=str)
def test_region_begins_at_its_tip(region: tuple) -> None:
    pulse, impacts = region[:2]
    frequencies, amplitudes = REGIONS[region]
    omega, a = cf.island_tip(pulse, ETA, impacts, frequency_ratio=frequencies, amplitude=amplitudes)
    inside = peak_response(pulse, slenderness=1 / a, frequency_ratio=omega * (1 - 1e-7), restitution=ETA)
    assert inside.overturned
    assert int(inside.impacts) == impacts
    near = np.linspace(0.99 * a, 1.01 * a, 2001)
    beyond = peak_response(pulse, slenderness=1 / near, frequency_ratio=omega * (1 + 1e-7), restitution=ETA)
    assert not np.any(beyond.overturned & (beyond.impacts == impacts))
    # the page states where it begins, and how wide it is a tenth below
    low, high = cf.overturning_interval(pulse, 0.9 * omega, ETA, impacts, amplitude=amplitudes)
    name = f"{pulse}, {impacts} impacts" + (", tongue" if len(region) == 3 else "")
    assert f"| {name} | {omega:.6f} | {a:.4f} | {low:.6f} to {high:.6f} |" in PAGE


def test_margin_is_nan_with_another_number_of_impacts() -> None:
    assert math.isnan(cf.margin_after_impacts("sine", 1.5, 3.0, ETA, 3))
    assert math.isnan(cf.margin_after_impacts("sine", 1.10, 0.8, ETA, 1))


def test_invalid_arguments_are_rejected() -> None:
    with pytest.raises(InvalidArgumentError, match="sum of sinusoids"):
        cf.impacts_in_pulse("ricker", 2.0, 1.0, ETA, 1)
    with pytest.raises(InvalidArgumentError, match="`amplitude`"):
        cf.overturning_interval("sine", 1.0, ETA, 1, amplitude=(0.5, 2.0))
    with pytest.raises(InvalidArgumentError, match="one region ends"):
        cf.island_tip("sine", ETA, 3, frequency_ratio=(3.0, 4.0), amplitude=(1.08, 1.13))
