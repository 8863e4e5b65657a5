"""Checks each quantitative claim of the paper and writes the tables of verdicts and of misprints."""

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from markdown_it import MarkdownIt

from rocking._boundary.curves import curves_at
from rocking._datasets.cube import read_dataset, read_spectrum
from rocking.paper.overturning import limit_amplitude
from workflow.claims import boundaries as curves
from workflow.claims import earlier_work, impact_times, non_slender, similarity, small_rotations, spectra
from workflow.claims import excitations as excitations_claims
from workflow.claims.claim import (
    ABOUT,
    CLOSE,
    FAILS,
    FAIR,
    HOLDS,
    IDENTITY,
    IN_RANGE,
    MIXED,
    PART,
    SAME,
    SMALL,
    VERDICTS,
    Claim,
    percent,
)
from workflow.claims.misprints import MISPRINTS
from workflow.scripts.job import run


def main(
    *,
    boundaries: Sequence[Path],
    cubes: Sequence[Path],
    collapse: Path,
    similar_blocks: Path,
    histories: Sequence[Path],
    master: Path,
    momentum: Path,
    excitations: Path,
    restitution: Sequence[float],
    table: Path,
    text: Path,
    page: Path,
    provenance: Mapping[str, str],
) -> None:
    """Collect the claims and write them as JSON (`table`), Markdown (`text`) and HTML (`page`).

    `boundaries`, `cubes`: of the sine. Plotted data: `collapse` of figure 6, `similar_blocks` of figure 9, `histories`
    of figures 11 and 12, `master` of figure-master-spectra, `momentum` of figure-master-housner, `excitations` of
    figure-scale-law-excitations. `restitution`: eta at which the closed forms are compared with each other.
    """
    two_blocks = read_dataset(similar_blocks)
    pulses, eta = two_blocks.attrs["pulse_names"].split(), float(two_blocks.attrs["restitution"])  # of sections 5 and 6
    of_sine = [read_spectrum(path) for path in cubes]
    claims = [
        *excitations_claims.no_resonance(*excitations_claims.many_cycles()),
        *earlier_work.measured_restitution(earlier_work.SPECIMENS),
        *section_3([*boundaries], of_sine, restitution),
        *section_4(of_sine, collapse),
        *excitations_claims.scale_law_of_excitations(read_dataset(excitations)),
        *non_slender.uplift(*non_slender.uplifts()),
        *non_slender.collapse(two_blocks),
        *non_slender.only_if_similar(non_slender.other_slenderness(eta)),
        *non_slender.dependence_on_alpha(non_slender.threshold_cases(eta)),
        *non_slender.tip_of_the_loop(non_slender.tips(eta)),
        *non_slender.convergence(non_slender.distances_from_closed_forms(eta)),
        *section_6(pulses, eta, histories),
        *small_rotations.twofold_effect(read_dataset(master), read_dataset(momentum)),
        *earlier_work.quick_method(earlier_work.CLOSED_FORMS, earlier_work.TRACING),
    ]
    records = [claim.record() for claim in claims]
    content = {
        "claims": records,
        "misprints": [misprint.record() for misprint in MISPRINTS],
        **provenance,
    }
    table.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    text.write_text(as_markdown(records), encoding="utf-8")
    body = MarkdownIt().enable("table").render(as_markdown(records))
    page.write_text(f"{HEAD}\n{body}", encoding="utf-8")


def section_3(boundaries: Sequence[Path], cubes: Sequence[xr.Dataset], restitution: Sequence[float]) -> Iterator[Claim]:
    """Overturning of the slender block."""
    yield from curves.exact_curves([curves_at(read_dataset(path), 0.0) for path in boundaries])
    yield from curves.completeness(cubes)
    yield from curves.limit_separates(*curves.sides_of_limit())
    omega = np.linspace(2.0, 12.0, 201)
    yield from curves.limit_value(omega, 1 / limit_amplitude(omega))
    yield from curves.overturning_in_free_rocking(curves.time_near_equilibrium(restitution))
    yield from impact_times.exact_impact(impact_times.impacts_after_pulse())
    yield from impact_times.other_root(impact_times.other_roots())
    on_curve = impact_times.case_1_1_curve(restitution)
    yield from impact_times.impact_about_one(on_curve)
    yield from impact_times.ad_hoc_function(impact_times.expansion_errors())
    yield from impact_times.approximate_time(on_curve)
    yield from impact_times.smallest_solutions(on_curve)
    yield from impact_times.end_of_case_1_1(*impact_times.ends_of_case_1_1())
    yield from earlier_work.earlier_forms(earlier_work.hyperbolic_residuals())
    yield from excitations_claims.more_cycles(excitations_claims.sequences())


def section_4(cubes: Sequence[xr.Dataset], collapse: Path) -> Iterator[Claim]:
    """Orientation, self-similarity and the spectra of the slender block."""
    yield from similarity.table(similarity.computed_table())
    yield from similarity.count_of_products(*similarity.independent_products())
    yield from similarity.homogeneous_equations(similarity.equation_tests())
    yield from similarity.odd_exponents(similarity.homogeneous_pairs())
    yield from similarity.exponents_give_groups(similarity.scalings())
    yield from similarity.groups(similarity.group_tests())
    yield from similarity.collapse(read_dataset(collapse))
    yield from similarity.any_excitation(similarity.histories_of_pulses())
    of_sine = spectra.spectra_of(cubes)
    for judge in (
        spectra.closed_form,
        spectra.time_of_peak,
        spectra.peak_after_pulse,
        spectra.approximation_near_limit,
        spectra.no_real_root,
        spectra.scale_law,
        spectra.damping,
    ):
        yield from judge(of_sine)
    yield from spectra.leading_term(spectra.slow_impacts())
    yield from spectra.period(spectra.swings())


def section_6(pulses: Sequence[str], restitution: float, histories: Sequence[Path]) -> Iterator[Claim]:
    """The groups of (6.1)."""
    spreads = small_rotations.spreads(pulses, restitution)
    yield from small_rotations.practical_similarity(spreads)
    yield from small_rotations.larger_slenderness(spreads)
    yield from small_rotations.histories([read_dataset(path) for path in histories])
    yield from small_rotations.pure_rocking(small_rotations.contacts(pulses, restitution))


WORDS = f"""\
Each claim has a criterion, stated without looking at the result. The words of the paper are taken to mean, as relative
differences: "exact", "equal", "collapse": {SAME:.0e}; "coincides": {percent(CLOSE)}; "small", "weak", "practically",
"accurate", "excellent": {percent(SMALL)}; "satisfactory": {percent(FAIR)}; "about": {percent(ABOUT)}. Verdict:
"{HOLDS}" if all of what was tested meets the criterion, and "{IDENTITY}" in its place if the claim is algebra or a
change of variables, which can only hold; "{IN_RANGE}" if all does within the range that follows, which covers
{percent(PART)} or more of what was tested; "{MIXED}" if {percent(PART)} or more meets it, but no such range covers as
much; else "{FAILS}". "Could fail if" says what would have contradicted the claim. "Solver" is the event-by-event
solution of this package.
a = a_g/(g alpha), or a_g/(g tan alpha) for blocks that are not slender; omega = omega_g/p; eta: coefficient of
restitution."""

HEAD = """\
<!doctype html>
<html lang="en"><meta charset="utf-8"><title>Claims of the paper</title>
<style>
  body { font: 15px/1.4 sans-serif; margin: 2em }
  table { border-collapse: collapse }
  th, td { border: 1px solid #bbb; padding: .3em .5em; text-align: left; vertical-align: top }
</style>"""

COLUMNS = ("place", "printed", "criterion", "fails_if", "found", "verdict")

INTRODUCTION = """\
These are slips of notation or printing, not of physics; what is said above is said of the right forms. The tests are in
the repository."""


def within(claim: Mapping[str, Any]) -> str:
    """The range in which the claim holds, as text after the verdict."""
    return f"; all of it for {claim['within']}" if claim["within"] else ""


def as_markdown(claims: Sequence[Mapping[str, Any]]) -> str:
    """The table of claims, from their records, with the count of each verdict above it, and the table of misprints."""
    counts = Counter(claim["verdict"] for claim in claims)
    lines = [
        "# Claims of the paper",
        "",
        ", ".join(f"{verdict}: {counts[verdict]}" for verdict in VERDICTS) + ".",
        "",
        *WORDS.splitlines(),
        "",
        "| place | the paper says | criterion | could fail if | found | verdict |",
        "|---|---|---|---|---|---|",
        *(f"| {' | '.join(claim[name] for name in COLUMNS)}{within(claim)} |" for claim in claims),
        "",
        "# Misprints of the paper",
        "",
        *INTRODUCTION.splitlines(),
        "",
        "| place | printed | right | shown by |",
        "|---|---|---|---|",
        *(misprint.row() for misprint in MISPRINTS),
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
