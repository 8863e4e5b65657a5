"""Checks each quantitative claim of the paper and writes the table of verdicts."""

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from rocking.boundary.curves import curves_at
from rocking.datasets.cube import read_dataset, read_spectrum
from workflow.claims import boundaries as curves
from workflow.claims import impact_times, non_slender, similarity, small_rotations, spectra
from workflow.claims.claim import Claim
from workflow.scripts.job import run


def main(
    *,
    boundaries: Sequence[Path],
    cubes: Sequence[Path],
    collapse: Path,
    similar_blocks: Path,
    histories: Sequence[Path],
    restitution: Sequence[float],
    table: Path,
    text: Path,
    provenance: Mapping[str, str],
) -> None:
    """Collect the claims and write them as JSON (`table`) and as Markdown (`text`).

    Parameters
    ----------
    boundaries, cubes : sequences of paths
        Traced boundaries and spectrum cubes of the sine.
    collapse : path
        Plotted data of figure 6.
    similar_blocks : path
        Plotted data of figure 9.
    histories : sequence of paths
        Plotted data of figures 11 and 12.
    restitution : sequence
        eta [-] at which the closed forms are compared with each other.
    table, text : path
        Outputs.
    provenance : mapping
        Digests of the code and settings.
    """
    traced = [curves_at(read_dataset(path), 0.0) for path in boundaries]  # these claims are about slender blocks
    filled = [read_spectrum(path) for path in cubes]
    two_blocks = read_dataset(similar_blocks)
    pulses, eta = two_blocks.attrs["pulse_names"].split(), float(two_blocks.attrs["restitution"])  # of sections 5 and 6
    claims = [
        *curves.exact_curves(traced),
        *curves.completeness(filled),
        *curves.limit(),
        *curves.transcription(),
        *impact_times.exact_impact(),
        *impact_times.ad_hoc(restitution),
        *impact_times.end_of_case_1_1(restitution),
        *similarity.orientation(),
        *similarity.collapse(read_dataset(collapse)),
        *spectra.closed_form(filled),
        *spectra.no_real_root(restitution),
        *spectra.leading_term(),
        *spectra.scale_law(filled),
        *spectra.period(),
        *non_slender.expanded_equation(),
        *non_slender.uplift(eta),
        *non_slender.collapse(two_blocks),
        *non_slender.dependence_on_alpha(eta),
        *non_slender.convergence(eta),
        *small_rotations.practical_similarity(pulses, eta),
        *small_rotations.larger_slenderness(pulses, eta),
        *small_rotations.histories([read_dataset(path) for path in histories]),
        *small_rotations.pure_rocking(pulses, eta),
    ]
    content = {"claims": [claim.record() for claim in claims], **provenance}
    table.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    text.write_text(as_markdown(claims), encoding="utf-8")


def as_markdown(claims: Sequence[Claim]) -> str:
    """The table of claims, one row each, with the count of each verdict above it."""
    counts = Counter(claim.verdict for claim in claims)
    lines = [
        "# Claims of the paper",
        "",
        ", ".join(f"{verdict}: {count}" for verdict, count in sorted(counts.items())) + ".",
        "",
        "| place | paper | found | verdict |",
        "|---|---|---|---|",
        *(f"| {claim.place} | {claim.printed} | {claim.found} | {claim.verdict} |" for claim in claims),
    ]
    return "\n".join(line.replace("|tau - 1|", "abs(tau - 1)") for line in lines) + "\n"


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
