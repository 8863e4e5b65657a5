"""The multi-precision integration compared with an independent one, and with itself at higher precision."""

import csv
import math
from itertools import pairwise
from pathlib import Path

import pytest
from flint import arb

from reference.exact_pulses import PULSES, exact_pulse, unit_crossings
from reference.exact_response import CAPPED, NO_UPLIFT, RECOVERS, ExactResponse, working_precision
from reference.multiprecision import integrate
from reference.polynomial_roots import roots
from tests.sampling import but_long, sample

REFERENCE = Path(__file__).parents[1] / "data" / "reference" / "response.csv"
ROWS = list(csv.DictReader(REFERENCE.read_text().splitlines()))
# Every pulse, slender and rigid, every outcome, no impact to many, and two with chatter (8 and 32, slender).
SAMPLE = [0, 3, 5, 6, 8, 24, 32, 61, 90, 99, 151, 219, 259, 305, 328, 352, 380, 395]


def _solved(row: dict[str, str], bits: int = 192) -> ExactResponse:
    with working_precision(bits):
        return integrate(
            row["pulse"],
            slenderness=float(row["slenderness"]),
            frequency_ratio=float(row["frequency_ratio"]),
            restitution=float(row["restitution"]),
            alpha=arb(float(row["alpha_deg"])) * arb.pi() / 180 if row["alpha_deg"] else None,
        )


def _assert_equals_reference(row: dict[str, str]) -> None:
    found = _solved(row)
    assert found.overturned == (row["overturned"] == "1"), row
    for column in ("peak_rotation", "first_impact_time", "first_impact_velocity", "uplift_time"):
        value = getattr(found, column)
        assert (value is None) == (row[column] == ""), (column, row)
        if value is not None:  # all printed digits: the same double
            assert float(value) == float(row[column]), (column, row)
    if not found.chatter:
        assert found.impacts == int(row["impacts"]), row


@pytest.mark.parametrize("index", SAMPLE)
def test_agrees_with_the_independent_reference_to_every_printed_digit(index: int) -> None:
    _assert_equals_reference(ROWS[index])


@pytest.mark.slow
def test_agrees_with_all_of_the_independent_reference() -> None:
    for row in sample(ROWS, 6):
        _assert_equals_reference(row)


@pytest.mark.parametrize("index", but_long([5, 6, 8, 61, 219, 259], 5, 8, 61))
def test_more_bits_do_not_change_fifty_digits(index: int) -> None:
    coarse, fine = _solved(ROWS[index], 192), _solved(ROWS[index], 288)
    with working_precision(288):
        for column in ("peak_rotation", "uplift_time"):
            exact = getattr(fine, column)
            assert abs(getattr(coarse, column) - exact) <= arb("1e-50") * exact, column


@pytest.mark.parametrize("name", PULSES)
def test_every_pulse_has_unit_peak_and_is_monotone_between_its_stationary_phases(name: str) -> None:
    with working_precision(192):
        pulse = exact_pulse(name)
        ends = [pulse.start, *pulse.stationary, pulse.end]
        assert max(float(abs(pulse.value(phi))) for phi in ends) == 1.0
        for left, right in pairwise(ends):
            slopes = [float(pulse.series(left + (right - left) * k / 64, arb(1), 2)[1]) for k in range(1, 64)]
            assert all(s >= 0 for s in slopes) or all(s <= 0 for s in slopes)


def test_sum_of_sinusoids_is_the_published_product() -> None:
    """Mavroeidis & Papageorgiou (2003): -[sin(phi/c) cos(phi + n) + c sin(phi + n) (1 + cos(phi/c))] up to scale."""
    cycles, phase = 2.5, 0.7
    pulse = exact_pulse("mavroeidis_papageorgiou", cycles, phase)
    ratios = []
    for phi in (-5.0, -1.3, 0.4, 3.3, 7.0):
        carrier, envelope = phi + phase, phi / cycles
        product = -(math.sin(envelope) * math.cos(carrier) + cycles * math.sin(carrier) * (1 + math.cos(envelope)))
        ratios.append(float(pulse.value(arb(phi))) / product)
    assert max(ratios) == pytest.approx(min(ratios), rel=1e-13)
    assert ratios[0] > 0


def test_uplift_is_where_the_ground_reaches_the_threshold() -> None:
    with working_precision(192):
        pulse = exact_pulse("sine")
        first, second = unit_crossings(pulse, arb(1) / arb("0.4"))
        assert abs(first - arb("0.4").asin()) < arb("1e-50")
        assert abs(second - arb.pi() - arb("0.4").asin()) < arb("1e-50")


def test_all_roots_are_found_and_a_near_miss_is_not_a_root() -> None:
    with working_precision(192):
        known = [arb("0.1"), arb("0.1000001"), arb("0.5"), arb("0.9")]
        polynomial = [arb(1)]
        for root in known:  # times (x - root)
            polynomial = [p - root * q for p, q in zip([arb(0), *polynomial], [*polynomial, arb(0)], strict=True)]
        found = roots(polynomial, arb(1))
        assert len(found) == len(known)
        assert all(abs(x - y) < arb("1e-40") for x, y in zip(found, known, strict=True))
        grazing = arb("1e-20")  # (x - 1/3)^2 + 1e-20 has no real root
        assert roots([arb(1) / 9 + grazing, arb(-2) / 3, arb(1)], arb(1)) == []


def test_cases_with_a_known_result() -> None:
    """No uplift; restitution 0; restitution 1; the rectangular pulse at Housner's threshold a = 1/(1 - exp(-p t_1))."""
    assert integrate("sine", slenderness=1.5, frequency_ratio=2.0, restitution=0.5).outcome == NO_UPLIFT
    dead = integrate("sine", slenderness=0.95, frequency_ratio=3.0, restitution=0.0)
    assert (dead.outcome, dead.impacts, dead.chatter) == (RECOVERS, 2, True)
    lossless = {"slenderness": 0.999, "frequency_ratio": 5.0, "restitution": 1.0}
    assert integrate("sine", **lossless, max_impacts=20).outcome == CAPPED
    threshold = -math.expm1(-math.pi / 2.0)  # omega = 2
    for slenderness, overturns in ((threshold * (1 - 1e-14), True), (threshold * (1 + 1e-14), False)):
        found = integrate("rectangular", slenderness=slenderness, frequency_ratio=2.0, restitution=0.1)
        assert found.overturned is overturns


def test_small_angles_converge_to_the_slender_block() -> None:
    """The rigid equation differs from the slender one by O(alpha^2)."""
    cell = {"slenderness": 0.6, "frequency_ratio": 6.0, "restitution": 0.8}
    with working_precision(192):
        slender = integrate("ricker", **cell).peak_rotation
        near, far = (integrate("ricker", **cell, alpha=a).peak_rotation for a in (1e-8, 1e-4))
        assert slender is not None
        assert near is not None
        assert far is not None
        assert 1e7 < float((far - slender) / (near - slender)) < 1.01e8
