"""Claims of the paper: every one fails on data on which it must fail, and verdicts follow from numbers."""

import json
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from rocking._boundary.amplitude import Thresholds
from rocking._model.response import Outcome
from rocking.paper import limit_amplitude, overturning_amplitudes
from tests.workflow_fixtures import PROJECT
from workflow.claims import (
    boundaries,
    earlier_work,
    excitations,
    impact_times,
    non_slender,
    similarity,
    small_rotations,
    spectra,
)
from workflow.claims.area import node_areas, share_of_area
from workflow.claims.claim import (
    FAILS,
    HOLDS,
    IDENTITY,
    IN_RANGE,
    MEASURED,
    MIXED,
    VERDICTS,
    Claim,
    Range,
    holding_range,
)
from workflow.claims.table import as_markdown, read_misprints, read_statements

STATEMENTS = PROJECT / "workflow/claims/statements.md"
EQUATIONS = PROJECT / "docs/equations.md"

ETA = 0.85
OMEGA = np.geomspace(0.5, 14.0, 41)
SLENDERNESS = np.linspace(0.05, 0.95, 37)


Claims = Claim | Iterable[Claim]


def by_key(claims: Claims) -> dict[str, Claim]:
    listed = [claims] if isinstance(claims, Claim) else claims
    return {claim.key: claim for claim in listed}


# Data on which each claim must fail


def moved_curves() -> Claims:
    """Traced points of all three modes, a millionth away from the closed forms."""
    closed = overturning_amplitudes(3.0, ETA)
    amplitude = [float(closed.direct), float(closed.survives_again), float(closed.overturns_from)]
    curves = xr.Dataset(
        {
            "row_size": ("curve", [1, 1, 1]),
            "outcome": ("curve", [Outcome.OVERTURNED_DIRECTLY, *[Outcome.OVERTURNED_AFTER_IMPACT] * 2]),
            "impacts": ("curve", [0, 1, 1]),
            "slenderness": ("point", 1 / np.array(amplitude)),
            "frequency_ratio": ("point", [3.0, 3.0, 3.0]),
            "closed_form_difference": ("point", [1e-6, 1e-6, 1e-6]),
        },
        coords={"restitution": ETA},
    )
    return boundaries.exact_curves([curves])


def cube(**replaced: np.ndarray | float) -> xr.Dataset:
    """Spectrum cube of slender blocks that overturn nowhere, with peaks that do not depend on anything."""
    shape = (1, SLENDERNESS.size, OMEGA.size)
    values = {"outcome": Outcome.RECOVERS, "impacts": 1, "peak_rotation": 0.5, "peak_mode": 0} | replaced
    return xr.Dataset(
        {
            name: (("alpha", "slenderness", "frequency_ratio"), np.broadcast_to(value, shape))
            for name, value in values.items()
        },
        coords={"alpha": [0.0], "slenderness": SLENDERNESS, "frequency_ratio": OMEGA, "restitution": ETA},
    )


def opposite_outcomes() -> xr.Dataset:
    """A cube in which a block overturns exactly where the closed forms say that it survives."""
    closed, a = overturning_amplitudes(OMEGA, ETA), 1 / SLENDERNESS[:, None]
    falls = ((a > closed.overturns_from) & (a < closed.survives_again)) | (a > closed.direct)
    return cube(outcome=np.where(falls, Outcome.RECOVERS, Outcome.OVERTURNED_DIRECTLY))


def spectra_with(mode: int = 3, peak: Callable[..., np.ndarray] | None = None, **replaced: float) -> spectra.Spectra:
    """Two restitutions, peaks a function of eta, 1/a and omega."""
    made = []
    for eta in (0.8, 0.9):
        values = 0.5 if peak is None else peak(eta, SLENDERNESS[:, None], OMEGA)
        made.append(cube(peak_rotation=values, peak_mode=mode, **replaced).assign_coords(restitution=eta))
    return spectra.spectra_of(made)


def slower_at_high_frequency(*_: object) -> spectra.Spectra:
    """Peaks in free rocking (odd mode) at low omega only."""
    return spectra_with(mode=np.where(OMEGA < 2, 3, 2))


def worse_near_limit() -> spectra.Spectra:
    """An error of (4.13) that falls with the distance from (3.31)."""
    made = spectra_with()
    distance = np.clip(SLENDERNESS[:, None] - 1 / limit_amplitude(OMEGA), 0.0, 1.0)
    return made._replace(peak=made.closed * (1 + 1 / (1 + 20 * distance)))


def curve(**replaced: np.ndarray) -> impact_times.Curve:
    """A curve of case 1.1 with impact times of 3 and approximations far away."""
    omega = np.linspace(1.0, 5.0, 41)
    ones = np.ones((2, omega.size))
    given = {
        "amplitude": 1.5 * ones, "semi_analytical": 2.5 * ones, "impact_time": 3 * ones, "approximate_time": 5 * ones,
    } | replaced  # fmt: skip
    return impact_times.Curve(omega, np.array([0.8, 0.9]), **given)


def thresholds(amplitude: float, count: int = 1) -> Thresholds:
    return Thresholds(
        amplitude + np.arange(count),
        np.arange(count) % 2 == 0,
        np.zeros(count, dtype=np.int8),
        np.zeros(count, dtype=np.int32),
    )


def case(change: float) -> non_slender.Case:
    """Thresholds that change by as much with every angle."""
    angles = (0.0, *non_slender.ANGLES)
    return non_slender.Case("sine", 3.0, {angle: thresholds(1 + change * k) for k, angle in enumerate(angles)})


def spread(**replaced: np.ndarray) -> dict[str, small_rotations.Spread]:
    """Peaks that depend on alpha more in the groups of (6.1) than in those of (4.11)."""
    s, omega = np.linspace(0.2, 0.98, 40), np.geomspace(1.0, 8.0, 20)
    ones = np.ones((s.size, omega.size))
    given = {
        "slender": 0.1 * ones, "rigid": 0.2 * ones, "survive": ones > 0, "rotation": np.linspace(0.05, 0.95, 20) * ones,
    } | replaced  # fmt: skip
    return {"sine": small_rotations.Spread(s, omega, **given)}


def similar_blocks(moved: int) -> xr.Dataset:
    """Four thresholds of figure 9, of which so many are not where they are stated."""
    above = np.array([1, 0, 1, 1])
    overturns = np.where(np.arange(4) < moved, 1 - above, above)
    return xr.Dataset(
        {
            "threshold_overturns_above": ("threshold", above),
            "threshold_falls_above": ("threshold", overturns),
            "threshold_falls_below": ("threshold", 1 - above),
        },
        coords={"half_diagonal": ("block", [0.5, 1.0])},
        attrs={"alpha": 0.35, "step": 1e-6},
    )


def master(spread: float) -> xr.Dataset:
    """A map of master spectra that vary as much with alpha everywhere."""
    return xr.Dataset(
        {"spread": (("pulse", "slenderness", "frequency_ratio"), np.full((1, 2, 2), spread))},
        coords={"alpha": [0.0, 0.5], "frequency_ratio": [1.0, 2.0]},
        attrs={"pulse_names": "sine"},
    )


def two_histories() -> xr.Dataset:
    """Figure 6 with two blocks that differ by a thousandth."""
    tau = np.linspace(0, 1, 5)
    rows = np.stack([np.sin(tau), 1.001 * np.sin(tau)])
    return xr.Dataset(
        {
            "rotation": (("block", "sample"), rows),
            "tau": (("block", "sample"), np.stack([tau, tau])),
            "master_rotation": ("tau_master", rows[0]),
        },
        coords={"tau_master": tau},
    )


def swings() -> spectra.Swings:
    falling = np.array([[3.0, 2.0, 1.0]] * 4)
    return spectra.Swings(np.array([0.8, 0.85, 0.9]), falling, falling, falling)


def law_of_excitations(*shares: float) -> xr.Dataset:
    return xr.Dataset(
        {"share": ("excitation", [*shares]), "median_exponent": ("excitation", [2.0] * len(shares))},
        attrs={"excitation_names": " ".join("abc"[: len(shares)])},
    )


def impacts(factor: float) -> impact_times.Impacts:
    time = np.linspace(1, 2, 7)
    return impact_times.Impacts(time, time, factor * time, factor * time)


N = np.arange(3, dtype=np.float64)
YES, NO = np.ones(3, dtype=bool), np.zeros(3, dtype=bool)
SLOW = spectra.SlowImpacts(np.full(5, 0.2), np.full(5, 0.02), np.full(5, 0.03))

MUST_FAIL: dict[str, Callable[[], Claims]] = {
    "curve-case-2": moved_curves,
    "curve-case-1.2": moved_curves,
    "curve-case-1.1": moved_curves,
    "complete": lambda: boundaries.completeness([opposite_outcomes()]),
    "limit-separates": lambda: boundaries.limit_separates(N, YES, YES),
    "limit-0.4": lambda: boundaries.limit_value(N, np.array([0.7, 0.6, 0.5])),
    "free-rocking": lambda: boundaries.overturning_in_free_rocking(np.array([-0.3, -0.1, 5.0])),
    "impact-time-exact": lambda: impact_times.exact_impact(impacts(1 + 1e-6)),
    "impact-velocity": lambda: impact_times.exact_impact(impacts(1 + 1e-6)),
    "other-root": lambda: impact_times.other_root(np.array([2.0, 3.0, 0.5])),
    "plots-agree": lambda: impact_times.smallest_solutions(curve()),
    "minima-coincide": lambda: impact_times.smallest_solutions(curve()),
    "no-case-1.1-above-5": lambda: impact_times.end_of_case_1_1(N, np.array([4.0, 5.5, 6.0])),
    "table-1": lambda: similarity.orientation({"table-1": similarity.printed_entries(["0000"] * 4)}),
    "homogeneous-equations": lambda: similarity.orientation({"homogeneous-equations": [False, False, True]}),
    "odd-exponents": lambda: similarity.orientation({"odd-exponents": similarity.odd_pairs([(0, 0), (2, 1)])}),
    "exponents-give-groups": lambda: similarity.orientation({"exponents-give-groups": [False, True]}),
    "groups": lambda: similarity.orientation({"groups": [False, True, True]}),
    "five-products": lambda: similarity.orientation({"five-products": [False]}),
    "collapse": lambda: similarity.collapse(two_histories()),
    "any-excitation": lambda: similarity.any_excitation({"sine": np.array([[0, 1.0], [0, 1.1], [0, 1.0]])}),
    "spectrum-exact": lambda: spectra.closed_form(spectra_with()),
    "peak-after-pulse": lambda: spectra.peak_after_pulse(slower_at_high_frequency()),
    "approximation-near-limit": lambda: spectra.approximation_near_limit(worse_near_limit()),
    "no-real-root": lambda: spectra.no_real_root(spectra_with(outcome=Outcome.OVERTURNED_AFTER_IMPACT)),
    "leading-term": lambda: spectra.leading_term(SLOW),
    "scale-law": lambda: spectra.scale_law(spectra_with(peak=lambda eta, s, omega: eta**9 + 0 * s * omega)),
    "one-spectrum": lambda: spectra.scale_law(spectra_with(peak=lambda eta, s, omega: eta**9 + 0 * s * omega)),
    "damping": lambda: spectra.damping(spectra_with(peak=lambda eta, s, omega: 1 - eta + 0 * s * omega)),
    "period": lambda: spectra.period(swings()),
    "velocity-peaks": lambda: spectra.period(swings()),
    "uplift": lambda: non_slender.uplift(np.radians(np.arange(1.0, 4.0)), YES, YES),
    "similar-blocks": lambda: non_slender.collapse(similar_blocks(3)),
    "contours-collapse": lambda: non_slender.contours([case(0.2)]),
    "slender-limit": lambda: non_slender.convergence(np.array([[0.04] * 6, [0.02] * 6, [0.01] * 6])),
    "groups-for-all-cases": lambda: small_rotations.groups_for_all_cases(spread()),
    "larger-slenderness": lambda: small_rotations.larger_slenderness(spread()),
    "twofold-effect": lambda: small_rotations.twofold_effect(master(0.1), master(0.1)),
    "no-resonance": lambda: excitations.no_resonance(
        *(np.arange(22_500).reshape(150, 150) % 2 == k for k in (0, 1)), np.full((150, 150), 4.0)
    ),
    "restitution-not-of-geometry": lambda: earlier_work.measured_restitution(
        [earlier_work.Specimen("1", (0.1, 0.1, 0.1), (0.98, 0.9, 1.0))]
    ),
    "restitution-conditions": lambda: earlier_work.slender_and_rough(N, N + 1, NO),
    "earlier-form-3.10": lambda: earlier_work.earlier_forms({"3.10": N + 1}),
    "earlier-form-3.31": lambda: earlier_work.earlier_forms({"3.31": N + 1}),
    "more-cycles": lambda: excitations.more_cycles({1: 5, 2: 5, 3: 4}),
    "time-of-peak": lambda: spectra.time_of_peak(spectra_with(mode=1)),
    "positive-root": lambda: spectra.time_of_peak(spectra_with(peak=lambda eta, s, omega: 1.5 + eta + 0 * s * omega)),
    "scale-law-excitations": lambda: excitations.scale_law_of_excitations(law_of_excitations(0.3, 0.6, 0.4)),
    "only-if-similar": lambda: non_slender.only_if_similar({20.0: np.zeros(4)}),
    "quick-method": lambda: earlier_work.quick_method(2.0, 1.0),
}


@pytest.mark.parametrize("key", MUST_FAIL)
def test_claim_fails_on_data_that_contradict_it(key: str) -> None:
    claim = by_key(MUST_FAIL[key]())[key]
    assert claim.verdict == FAILS, claim


def test_every_claim_that_is_judged_has_data_on_which_it_fails(smoke_results: Path) -> None:
    records = json.loads((smoke_results / "claims.json").read_text())["claims"]
    assert [record["key"] for record in records] == [*read_statements(STATEMENTS)]
    assert {record["key"] for record in records if record["verdict"] != MEASURED} == MUST_FAIL.keys()


# Verdicts


def judged(share: float | None, within: float | None = None, *, identity: bool = False) -> str:
    stated = None if within is None else Range("omega 1 to 2", within)
    return Claim("key", share, within=stated, identity=identity).verdict


def test_verdicts() -> None:
    verdicts = judged(1.0, identity=True), judged(1.0), judged(0.7, 0.5), judged(0.5), judged(0.49), judged(None)
    assert verdicts == VERDICTS == (IDENTITY, HOLDS, IN_RANGE, MIXED, FAILS, MEASURED)
    assert judged(1 - 1e-6, 0.49) == MIXED  # what holds is no range
    assert {judged(np.nan), judged(0.0), judged(0.99, identity=True)} == {FAILS}
    assert judged(True) == HOLDS


def test_stated_range_covers_most_and_holds_everywhere_in_it() -> None:
    omega, eta = np.linspace(1.0, 5.0, 41), np.array([0.8, 0.9])[:, None]
    good = (omega > 2.05) & (omega < 4.05) & np.ones((2, 1), dtype=bool)
    good[1, 0] = True
    found = holding_range(good, {"omega": omega, "eta": eta})
    assert found == Range("omega 2.1 to 4", pytest.approx(20 / 41))
    # what was not tested cannot fail, and areas count in place of cases
    assert holding_range(good, {"eta": eta}, tested=good) == Range("eta 0.8 to 0.9", 1.0)
    weighted = holding_range(good, {"omega": omega}, weights=np.where(omega < 3.05, 1.0, 0.0))
    assert weighted is not None
    assert weighted.share == pytest.approx(10 / 21)
    assert holding_range(~good & good, {"omega": omega}) is None


def test_shares_are_areas_and_not_counts_of_nodes() -> None:
    s, omega = np.array([0.1, 0.2, 0.9, 0.95, 1.0]), np.array([1.0, 2.0, 8.0])
    areas = node_areas(s, omega)
    assert areas.sum() == pytest.approx(0.9 * np.log(8.0))
    upper = np.broadcast_to(s[:, None] > 0.5, areas.shape)
    assert upper.mean() == pytest.approx(0.6)  # three of five nodes
    assert share_of_area(upper, np.ones_like(upper), areas) == pytest.approx(0.45 / 0.9)  # from 0.55 to 1
    linear = node_areas(s, omega, logarithmic=False)
    fast = np.broadcast_to(omega > 3, areas.shape)
    assert share_of_area(fast, np.ones_like(fast), linear) == pytest.approx(3 / 7)
    assert np.isnan(share_of_area(fast, np.zeros_like(fast), areas))


def test_missing_values_count_as_failures() -> None:
    some = np.where(np.linspace(1, 5, 41) < 2.0, np.nan, 1.5) * np.ones((2, 1))
    claim = by_key(impact_times.smallest_solutions(curve(semi_analytical=some)))["minima-coincide"]
    assert claim.verdict == IN_RANGE
    assert claim.share == pytest.approx(31 / 41)
    assert claim.numbers["no solution"] == 20
    approximation = impact_times.approximation(curve(approximate_time=2 * some), {})
    assert approximation.numbers["share of the curve without a real (3.29)"] == pytest.approx(10 / 41)


def test_another_number_of_thresholds_counts_as_a_change() -> None:
    angles = (0.0, *non_slender.ANGLES)
    other = {angle: thresholds(1.0, count=3 if angle == 10.0 else 1) for angle in angles}
    claim = non_slender.dependence_on_alpha([non_slender.Case("sine", 3.0, other)], {})
    assert claim.numbers["other number at 10 degrees"] == 1
    assert claim.numbers["share at 10 degrees"] == 0
    assert claim.numbers["share at 5 degrees"] == 1


# What the claims find


def test_thresholds_converge_to_the_closed_forms_with_the_square_of_alpha() -> None:
    claim = by_key(non_slender.convergence(non_slender.distances_from_closed_forms(ETA)))["slender-limit"]
    assert claim.verdict == HOLDS
    assert 1.98 < claim.numbers["lowest power"] <= claim.numbers["highest power"] < 2.02


def test_measured_values_are_those_of_the_pages() -> None:
    for page in ("restitution", "shaking-table"):
        text = (PROJECT / f"docs/{page}.md").read_text()
        for one in earlier_work.SPECIMENS:
            eta, low, high = one.restitution
            assert f"{eta:.2f} ({low:.2f} to {high:.2f})" in text
            assert f"{one.alpha[0]:.3f}" in text
    times = f"{earlier_work.CLOSED_FORMS:g} ms against {earlier_work.TRACING:g} ms"
    assert times in (PROJECT / "docs/benchmarks.md").read_text()


def test_conditions_in_hyperbolic_functions_hold_on_their_own_curves_only() -> None:
    with pytest.MonkeyPatch.context() as patch:
        for names, verdict in (((), IDENTITY), (("limit_amplitude", "case_2_amplitude"), FAILS)):
            former = [getattr(earlier_work, name) for name in names]
            for name, other in zip(names, reversed(former), strict=True):
                patch.setattr(earlier_work, name, other)
            claims = by_key(earlier_work.earlier_forms(earlier_work.hyperbolic_residuals()))
            assert {claim.verdict for claim in claims.values()} == {verdict}


# The table


def test_table_counts_its_verdicts_and_has_a_row_for_each_claim_and_misprint(smoke_results: Path) -> None:
    content = json.loads((smoke_results / "claims.json").read_text())
    claims = content["claims"]
    misprints = read_misprints(EQUATIONS)
    table = as_markdown(claims, misprints)
    assert table == (smoke_results / "claims.md").read_text()
    for verdict in VERDICTS:
        assert f"{verdict}: {sum(claim['verdict'] == verdict for claim in claims)}" in table
    assert all(claim["within"] for claim in claims if claim["verdict"] == IN_RANGE)
    assert {claim["verdict"] for claim in claims if claim["within"]} <= {IN_RANGE, MIXED}
    assert table.count("\n| ") == len(claims) + len(misprints) + 2
    rows = [line for line in table.splitlines() if line.startswith("| section")]
    assert {line.count(" | ") for line in rows[: len(claims)]} == {4}  # no bar within a cell
    assert content["misprints"] == misprints
