"""Measures each quantitative claim of the paper and writes the tables of verdicts and of misprints."""

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from rocking._base.output_file import write_output
from rocking._boundary.curves import curves_at
from rocking._datasets.cube import read_dataset, read_spectrum
from rocking.paper.overturning import limit_amplitude
from workflow.claims import boundaries as curves
from workflow.claims import (
    earlier_work,
    impact_times,
    non_slender,
    similarity,
    small_rotations,
    spectra,
)
from workflow.claims import excitations as of_excitations
from workflow.claims.claim import Claim
from workflow.claims.table import as_html, as_markdown, read_misprints, read_statements
from workflow.scripts.job import run

PROJECT = Path(__file__).parents[2]
STATEMENTS = PROJECT / "workflow/claims/statements.md"  # what the paper says, and what is measured
EQUATIONS = PROJECT / "docs/equations.md"  # the misprints of the paper


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
    """Collect the claims in the order of the paper and write them as JSON (`table`), Markdown (`text`), HTML (`page`).

    `boundaries`, `cubes`: of the sine. Plotted data: `collapse` of figure 6, `similar_blocks` of figure 9, `histories`
    of figures 11 and 12, `master` of figure-master-spectra, `momentum` of figure-master-housner, `excitations` of
    figure-scale-law-excitations. `restitution`: eta at which the closed forms are compared with each other.
    """
    of_sine = [read_spectrum(path) for path in cubes]
    claims: list[Claim] = [
        of_excitations.no_resonance(*of_excitations.many_cycles()),
        earlier_work.measured_restitution(earlier_work.SPECIMENS),
        earlier_work.slender_and_rough(*earlier_work.impact_conditions()),
        *section_3(boundaries, of_sine, restitution),
        *section_4(of_sine, read_dataset(collapse)),
        of_excitations.scale_law_of_excitations(read_dataset(excitations)),
        small_rotations.twofold_effect(read_dataset(master), read_dataset(momentum)),
        *sections_5_and_6(read_dataset(similar_blocks), [read_dataset(path) for path in histories]),
        earlier_work.quick_method(earlier_work.CLOSED_FORMS, earlier_work.TRACING),
    ]
    rows = read_statements(STATEMENTS)
    results = {claim.key: claim.record() for claim in claims}
    records = [rows[key] | results[key] for key in rows]
    misprints = read_misprints(EQUATIONS)
    content = {"claims": records, "misprints": misprints, **provenance}
    markdown = as_markdown(records, misprints)
    write_output(table, json.dumps(content, indent=1) + "\n")
    write_output(text, markdown)
    write_output(page, as_html(markdown))


def section_3(boundaries: Sequence[Path], cubes: Sequence[xr.Dataset], restitution: Sequence[float]) -> Iterator[Claim]:
    """Overturning of the slender block."""
    omega = np.linspace(2.0, 12.0, 201)
    on_curve = impact_times.case_1_1_curve(restitution)
    yield from curves.exact_curves([curves_at(read_dataset(path), 0.0) for path in boundaries])
    yield curves.completeness(cubes)
    yield curves.limit_separates(*curves.sides_of_limit())
    yield curves.limit_value(omega, 1 / limit_amplitude(omega))
    yield curves.overturning_in_free_rocking(curves.time_near_equilibrium(restitution))
    yield from impact_times.exact_impact(impact_times.impacts_after_pulse())
    yield impact_times.other_root(impact_times.other_roots())
    yield impact_times.approximation(on_curve, impact_times.expansion_errors())
    yield from impact_times.smallest_solutions(on_curve)
    yield impact_times.end_of_case_1_1(*impact_times.ends_of_case_1_1())
    yield from earlier_work.earlier_forms(earlier_work.hyperbolic_residuals())
    yield of_excitations.more_cycles(of_excitations.sequences())


def section_4(cubes: Sequence[xr.Dataset], collapse: xr.Dataset) -> Iterator[Claim]:
    """Orientation, self-similarity and the spectra of the slender block."""
    of_sine = spectra.spectra_of(cubes)
    yield from similarity.orientation(similarity.orientation_tests())
    yield similarity.collapse(collapse)
    yield similarity.any_excitation(similarity.histories_of_pulses())
    yield spectra.closed_form(of_sine)
    yield from spectra.time_of_peak(of_sine)
    yield spectra.peak_after_pulse(of_sine)
    yield spectra.approximation_near_limit(of_sine)
    yield spectra.no_real_root(of_sine)
    yield from spectra.scale_law(of_sine)
    yield spectra.damping(of_sine)
    yield spectra.leading_term(spectra.slow_impacts())
    yield from spectra.period(spectra.swings())


def sections_5_and_6(similar_blocks: xr.Dataset, histories: Sequence[xr.Dataset]) -> Iterator[Claim]:
    """Blocks that are not slender, at the restitution and under the pulses of figure 9."""
    eta, pulses = float(similar_blocks.attrs["restitution"]), similar_blocks.attrs["pulse_names"].split()
    cases = non_slender.threshold_cases(eta)
    spreads = small_rotations.spreads(pulses, eta)
    yield non_slender.uplift(*non_slender.uplifts())
    yield non_slender.collapse(similar_blocks)
    yield non_slender.only_if_similar(non_slender.other_slenderness(eta))
    yield non_slender.dependence_on_alpha(cases, non_slender.tips(eta))
    yield non_slender.convergence(non_slender.distances_from_closed_forms(eta))
    yield small_rotations.practice(spreads, histories, small_rotations.contacts(pulses, eta))
    yield small_rotations.larger_slenderness(spreads)
    yield non_slender.contours(cases)
    yield small_rotations.groups_for_all_cases(spreads)


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
