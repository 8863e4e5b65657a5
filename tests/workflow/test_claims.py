"""Claims of the paper: every one fails on data on which it must fail, and verdicts follow from numbers."""

import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from rocking._boundary.amplitude import Thresholds
from rocking._model.response import Outcome
from rocking.paper import Scaling, limit_amplitude, overturning_amplitudes
from workflow.claims import boundaries, impact_times, non_slender, similarity, small_rotations, spectra
from workflow.claims.area import node_areas, share_of_area
from workflow.claims.claim import FAILS, HOLDS, IN_RANGE, VERDICTS, Claim, verdict_of
from workflow.claims.misprints import MISPRINTS, TESTS
from workflow.scripts.claims import as_markdown

ETA = 0.85
OMEGA = np.geomspace(0.5, 14.0, 41)
SLENDERNESS = np.linspace(0.05, 0.95, 37)


def by_key(claims: list[Claim]) -> dict[str, Claim]:
    return {claim.key: claim for claim in claims}


# Data on which each claim must fail


def moved_curves() -> list[Claim]:
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
    """`count` thresholds of which the first is given."""
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


def histories(spreads: list[list[float]]) -> list[xr.Dataset]:
    """Figures 11 and 12 with one pulse and these spreads in the groups of (4.1) and (6.1)."""
    return [
        xr.Dataset({"spread": (("pulse", "group_set"), [one])}, attrs={"pulse_names": "sine", "slenderness": s})
        for one, s in zip(spreads, (0.5, 0.75), strict=True)
    ]


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
    """Periods and velocities that fall as restitution rises."""
    falling = np.array([[3.0, 2.0, 1.0]] * 4)
    return spectra.Swings(np.array([0.8, 0.85, 0.9]), falling, falling, falling)


def contact(friction: float) -> SimpleNamespace:
    return SimpleNamespace(largest_friction_demand=friction, lifts_off=False)


def impacts(factor: float) -> impact_times.Impacts:
    time = np.linspace(1, 2, 7)
    return impact_times.Impacts(time, time, factor * time, factor * time)


N = np.arange(3, dtype=np.float64)
YES, NO = np.ones(3, dtype=bool), np.zeros(3, dtype=bool)
ERRORS = {omega: (np.linspace(-0.25, 0.25, 5), np.full(5, 0.5)) for omega in (1.0, 2.0, 5.0)}
SLOW = spectra.SlowImpacts(np.full(5, 0.2), np.full(5, 0.02), np.full(5, 0.03))

MUST_FAIL: dict[str, Callable[[], list[Claim]]] = {
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
    "impact-at-1/p": lambda: impact_times.impact_about_one(curve()),
    "ad-hoc-sine-slow": lambda: impact_times.ad_hoc_function(ERRORS),
    "ad-hoc-sine-intermediate": lambda: impact_times.ad_hoc_function(ERRORS),
    "ad-hoc-time": lambda: impact_times.approximate_time(curve()),
    "minima-coincide": lambda: impact_times.smallest_solutions(curve()),
    "no-case-1.1-above-5": lambda: impact_times.end_of_case_1_1(N, np.array([4.0, 5.5, 6.0])),
    "table-1": lambda: similarity.table(("0000", "0000", "0000", "0000")),
    "homogeneous-equations": lambda: similarity.homogeneous_equations({"(2.2)": False, "(3.1)": False, "(5.1)": True}),
    "odd-exponents": lambda: similarity.odd_exponents([(m, n) for m in (-4, 0, 4) for n in (-4, -2, 0, 2, 4)]),
    "exponents-give-groups": lambda: similarity.exponents_give_groups(
        dict.fromkeys(("(4.10)", "(4.11)"), Scaling("alpha", {"a_g/g": 2, "alpha": -2}))
    ),
    "groups": lambda: similarity.groups({"theta": False, "alpha": False, "eta": True}),
    "collapse": lambda: similarity.collapse(two_histories()),
    "any-excitation": lambda: similarity.any_excitation({"sine": np.array([[0, 1.0], [0, 1.1], [0, 1.0]])}),
    "spectrum-exact": lambda: spectra.closed_form(spectra_with()),
    "peak-after-pulse": lambda: spectra.peak_after_pulse(slower_at_high_frequency()),
    "approximation-near-limit": lambda: spectra.approximation_near_limit(worse_near_limit()),
    "no-real-root": lambda: spectra.no_real_root(spectra_with(outcome=Outcome.OVERTURNED_AFTER_IMPACT)),
    "leading-term": lambda: spectra.leading_term(SLOW),
    "scale-law": lambda: spectra.scale_law(spectra_with(peak=lambda eta, s, omega: eta**9 + 0 * s * omega)),
    "damping": lambda: spectra.damping(spectra_with(peak=lambda eta, s, omega: 1 - eta + 0 * s * omega)),
    "period": lambda: spectra.period(swings()),
    "velocity-peaks": lambda: spectra.period(swings()),
    "uplift": lambda: non_slender.uplift(np.radians(np.arange(1.0, 4.0)), YES, YES),
    "similar-blocks": lambda: non_slender.collapse(similar_blocks(3)),
    "alpha-thresholds": lambda: non_slender.dependence_on_alpha([case(0.2)]),
    "contours-collapse": lambda: non_slender.dependence_on_alpha([case(0.2)]),
    "alpha-tip": lambda: non_slender.tip_of_the_loop({"sine": {0.0: 5.0, 5.0: 6.0, 10.0: 7.0}}),
    "slender-limit": lambda: non_slender.convergence(np.array([[0.04] * 6, [0.02] * 6, [0.01] * 6])),
    "practical-similarity": lambda: small_rotations.practical_similarity(spread()),
    "groups-for-all-cases": lambda: small_rotations.practical_similarity(spread()),
    "larger-slenderness": lambda: small_rotations.larger_slenderness(spread()),
    "small-rotations": lambda: small_rotations.larger_slenderness(spread()),
    "twofold-effect": lambda: small_rotations.twofold_effect(master(0.1), master(0.1)),
    "histories": lambda: small_rotations.histories(histories([[0.3, 0.4], [0.4, 0.1]])),
    "pure-rocking": lambda: small_rotations.pure_rocking({20: [contact(0.3)], 30: [contact(0.5)], 40: [contact(0.6)]}),
}


@pytest.mark.parametrize("key", MUST_FAIL)
def test_claim_fails_on_data_that_contradict_it(key: str) -> None:
    claim = by_key(MUST_FAIL[key]())[key]
    assert claim.verdict == FAILS, claim


def test_every_claim_of_the_table_has_data_on_which_it_fails(smoke_results: Path) -> None:
    records = json.loads((smoke_results / "claims.json").read_text())["claims"]
    assert [record["key"] for record in records] == sorted(MUST_FAIL, key=[r["key"] for r in records].index)


# Verdicts


def test_verdict_is_one_of_three() -> None:
    assert (verdict_of(1.0), verdict_of(0.5), verdict_of(0.49)) == VERDICTS
    assert (verdict_of(True), verdict_of(False), verdict_of(np.nan)) == (HOLDS, FAILS, FAILS)
    assert verdict_of(1 - 1e-6) == IN_RANGE
    with pytest.raises(ValueError, match="perhaps"):
        Claim("key", "place", "printed", "criterion", "found", "perhaps")


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
    some = np.where(np.linspace(1, 5, 41) < 2.0, np.nan, 3.0) * np.ones((2, 1))
    claim = by_key(impact_times.approximate_time(curve(approximate_time=some)))["ad-hoc-time"]
    assert claim.verdict == IN_RANGE
    assert claim.numbers["share"] == pytest.approx(31 / 41)
    assert claim.numbers["share_without_value"] == pytest.approx(10 / 41)


def test_another_number_of_thresholds_counts_as_a_change() -> None:
    angles = (0.0, *non_slender.ANGLES)
    other = {angle: thresholds(1.0, count=3 if angle == 10.0 else 1) for angle in angles}
    claim = by_key(non_slender.dependence_on_alpha([non_slender.Case("sine", 3.0, other)]))["alpha-thresholds"]
    assert claim.numbers["other_number_10_deg"] == 1
    assert claim.numbers["share"] == pytest.approx(2 / 3)


@pytest.mark.parametrize(("moved", "expected"), [(0, HOLDS), (1, IN_RANGE), (4, FAILS)])
def test_claim_of_similar_blocks_requires_every_threshold(moved: int, expected: str) -> None:
    assert by_key(non_slender.collapse(similar_blocks(moved)))["similar-blocks"].verdict == expected


@pytest.mark.parametrize(
    ("spreads", "expected"),
    [([[0.3, 0.1], [0.4, 0.01]], HOLDS), ([[0.4, 0.01], [0.3, 0.1]], IN_RANGE), ([[0.3, 0.4], [0.4, 0.1]], FAILS)],
)
def test_verdict_of_histories_depends_on_the_reduction_of_the_spread(spreads: list[list[float]], expected: str) -> None:
    assert by_key(small_rotations.histories(histories(spreads)))["histories"].verdict == expected


# What the claims find


def test_thresholds_converge_to_the_closed_forms_with_the_square_of_alpha() -> None:
    claim = by_key(non_slender.convergence(non_slender.distances_from_closed_forms(ETA)))["slender-limit"]
    assert claim.verdict == HOLDS
    assert 1.98 < claim.numbers["lowest_order"] <= claim.numbers["highest_order"] < 2.02


def test_groups_of_6_1_reduce_the_spread_over_slenderness() -> None:
    spreads = small_rotations.spreads(["sine", "cosine"], ETA)
    for one in spreads.values():
        band = one.band(0.5, 1.0)
        # (6.1) is exact for small rotations, (4.11) misses the uplift itself
        assert np.median(one.rigid[band]) < 0.005
        assert np.median(one.slender[band]) > 0.5
    claims = by_key([*small_rotations.practical_similarity(spreads), *small_rotations.larger_slenderness(spreads)])
    assert claims["practical-similarity"].numbers["sine, 0.5 to 1"] > 0.9
    assert claims["small-rotations"].verdict == HOLDS


def test_a_range_that_begins_somewhere_has_no_failure_beyond() -> None:
    late = curve(impact_time=np.where(np.abs(np.linspace(1, 5, 41) - 4.0) < 0.05, 3.0, 1.0) * np.ones((2, 1)))
    assert by_key(impact_times.impact_about_one(late))["impact-at-1/p"].numbers["omega_from"] == pytest.approx(4.1)


# The table


def test_table_counts_its_verdicts_and_has_a_row_for_each_claim_and_misprint(smoke_results: Path) -> None:
    content = json.loads((smoke_results / "claims.json").read_text())
    claims = [Claim(**record) for record in content["claims"]]
    table = as_markdown(claims)
    assert table == (smoke_results / "claims.md").read_text()
    assert f"{HOLDS}: {sum(claim.verdict == HOLDS for claim in claims)}" in table
    assert table.count("\n| ") == len(claims) + len(MISPRINTS) + 2
    rows = [line for line in table.splitlines() if line.startswith("| section")]
    assert {line.count(" | ") for line in rows[: len(claims)]} == {4}  # no bar within a cell
    assert [misprint["place"] for misprint in content["misprints"]] == [one.place for one in MISPRINTS]
    assert content["misprints"][0]["tests"] == [f"{TESTS}::test_3_3_uplift_phase"]
