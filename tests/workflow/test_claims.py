"""Claims about blocks that are not slender: numbers fixed by physics, and verdicts derived from numbers."""

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from rocking.closed_form import overturning_amplitudes
from workflow.claims import non_slender, small_rotations
from workflow.claims.claim import FAILS, HOLDS, IN_RANGE, VERDICTS, Claim, verdict
from workflow.scripts.claims import as_markdown

ETA = 0.85


def by_key(claims: list[Claim]) -> dict[str, Claim]:
    return {claim.key: claim for claim in claims}


def test_verdict_is_one_of_three() -> None:
    assert (verdict(True), verdict(False), verdict(False, somewhere=False)) == VERDICTS
    with pytest.raises(ValueError, match="perhaps"):
        Claim("key", "place", "printed", "found", "perhaps")


def test_thresholds_converge_to_the_closed_forms_with_the_square_of_alpha() -> None:
    claim = by_key(non_slender.convergence(ETA))["slender-limit"]
    assert claim.verdict == HOLDS
    assert 1.98 < claim.numbers["lowest_order"] <= claim.numbers["highest_order"] < 2.02


def test_dependence_on_alpha_increases_with_alpha_and_is_small_before_the_tip() -> None:
    claims = by_key(non_slender.dependence_on_alpha(ETA))
    numbers = claims["alpha-thresholds"].numbers
    for pulse in ("sine", "cosine"):
        changes = [numbers[f"{pulse}_before_tip_{angle}_deg"] for angle in non_slender.ANGLES]
        assert changes == sorted(changes)
        assert changes[2] < non_slender.SMALL  # 15 degrees
        assert numbers[f"{pulse}_beyond_15_deg"] > non_slender.SMALL
    assert claims["alpha-thresholds"].verdict == IN_RANGE
    omega = np.linspace(2, 8, 6001)
    falls_after_impact = np.isfinite(overturning_amplitudes(omega, ETA).falls_from)
    assert claims["alpha-tip"].numbers["sine_0_deg"] == pytest.approx(omega[falls_after_impact].max(), abs=0.051)


def test_uplift_depends_on_the_tangent_of_alpha() -> None:
    claim = by_key(non_slender.uplift(ETA))["uplift"]
    assert claim.verdict == HOLDS
    assert claim.numbers["exact"] == claim.numbers["angles"] == 80


def test_expanded_equation_is_wrong_as_printed_and_correct_as_corrected() -> None:
    claim = by_key(non_slender.expanded_equation())["expanded-equation"]
    assert claim.verdict == FAILS
    assert claim.numbers["corrected"] == pytest.approx(claim.numbers["equation_of_motion"], abs=1e-15)


@pytest.mark.parametrize(("moved", "expected"), [(0, HOLDS), (1, IN_RANGE), (4, FAILS)])
def test_claim_of_similar_blocks_requires_every_threshold(moved: int, expected: str) -> None:
    above = np.array([1, 0, 1, 1])
    overturns = np.where(np.arange(4) < moved, 1 - above, above)
    figure = xr.Dataset(
        {
            "threshold_overturns_above": ("threshold", above),
            "threshold_falls_above": ("threshold", overturns),
            "threshold_falls_below": ("threshold", 1 - above),
        },
        coords={"half_diagonal": ("block", [0.5, 1.0])},
        attrs={"alpha": 0.35, "step": 1e-6},
    )
    assert by_key(non_slender.collapse(figure))["similar-blocks"].verdict == expected


@pytest.mark.parametrize(
    ("spreads", "expected"),
    [([[0.3, 0.1], [0.4, 0.01]], HOLDS), ([[0.4, 0.01], [0.3, 0.1]], IN_RANGE), ([[0.3, 0.4], [0.4, 0.1]], FAILS)],
)
def test_verdict_of_histories_depends_on_the_reduction_of_the_spread(spreads: list[list[float]], expected: str) -> None:
    figures = [
        xr.Dataset({"spread": (("pulse", "group_set"), [spread])}, attrs={"pulse_names": "sine", "slenderness": s})
        for spread, s in zip(spreads, (0.5, 0.75), strict=True)
    ]
    assert by_key(small_rotations.histories(figures))["histories"].verdict == expected


def test_groups_of_6_1_reduce_the_spread_over_slenderness() -> None:
    claims = by_key(
        [
            *small_rotations.practical_similarity(["sine", "cosine"], ETA),
            *small_rotations.larger_slenderness(["sine", "cosine"], ETA),
        ]
    )
    numbers = claims["practical-similarity"].numbers
    for pulse in ("sine", "cosine"):
        # (6.1) is exact for small rotations, (4.11) misses the uplift itself
        assert numbers[f"{pulse}, 0.5 to 1, (6.1): median"] < 0.005
        assert numbers[f"{pulse}, 0.5 to 1, (4.11): median"] > 0.5
        assert numbers[f"{pulse}, 0.5 to 1: within"] > 0.9
    assert claims["small-rotations"].verdict == HOLDS
    assert claims["groups-for-all-cases"].numbers["sine, 0.2 to 0.35"] < 0.5


def test_pure_rocking_needs_more_friction_with_increasing_alpha() -> None:
    numbers = by_key(small_rotations.pure_rocking(["sine"], ETA))["pure-rocking"].numbers
    medians = [numbers[f"median_friction_{angle}_deg"] for angle in (10, 20, 30, 40)]
    for friction, angle in zip(medians, (10, 20, 30, 40), strict=True):
        assert friction >= np.tan(np.radians(angle))  # uplift alone asks for that
    assert numbers["doubtful_20_deg"] == 0 < numbers["doubtful_40_deg"]


def test_table_counts_its_verdicts_and_has_a_row_for_each_claim(smoke_results: Path) -> None:
    records = json.loads((smoke_results / "claims.json").read_text())["claims"]
    claims = [Claim(**record) for record in records]
    table = as_markdown(claims)
    assert table == (smoke_results / "claims.md").read_text()
    assert f"{HOLDS}: {sum(claim.verdict == HOLDS for claim in claims)}" in table
    assert table.count("\n| ") == len(claims) + 1
    assert {"similar-blocks", "practical-similarity", "histories", "pure-rocking"} <= {claim.key for claim in claims}
