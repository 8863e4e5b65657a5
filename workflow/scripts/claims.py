"""Checks each quantitative claim of the paper and writes the tables of verdicts and of misprints."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from rocking._base.output_file import write_output
from rocking._datasets.cube import read_dataset, read_spectrum
from workflow.claims import earlier_work, non_slender, small_rotations
from workflow.claims import excitations as excitations_claims
from workflow.claims.misprints import MISPRINTS
from workflow.claims.sections import section_3, section_4, section_6
from workflow.claims.table import as_html, as_markdown
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
    write_output(table, json.dumps(content, indent=1) + "\n")
    write_output(text, as_markdown(records))
    write_output(page, as_html(records))


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
