"""Fragility of the blocks of a suite from their outcomes under its records."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import xarray as xr

from rocking._base.output_file import write_output
from rocking._datasets.csv_text import csv_text
from rocking._datasets.cube import describe, read_dataset, write_dataset
from rocking.suites.configuration import suite_configuration
from rocking.suites.fragility import fragility_of_outcomes
from rocking.suites.outcomes import join_outcomes
from rocking.suites.sensitivity import sensitivity_of_outcomes
from rocking.suites.table import fragility_table, sensitivity_table
from workflow.scripts.job import attributes_of, run


def main(
    *,
    files: Sequence[Path],
    suite: Mapping[str, Any],
    outcomes: Path,
    fragility: Path,
    table: Path,
    provenance: dict[str, str],
    sensitivities: Sequence[Path] = (),
    sensitivity: Path | None = None,
    sensitivity_rows: Path | None = None,
) -> None:
    """Join the outcomes of all records, count them, and fit curves.

    `files`: outcomes under each motion. Outputs: `outcomes` of all, `fragility` and `table` with counts, intervals and
    curves. If the suite asks for it: `sensitivities`, friction demand and changed outcomes under each motion, which go
    to `sensitivity` and, by level, to `sensitivity_rows`.
    """
    chosen = suite_configuration(suite, Path())
    joined = _joined(files, chosen.measure)
    found = fragility_of_outcomes(joined, chosen.demand, chosen.confidence)
    about = {
        "suite": chosen.name,
        "measure": chosen.measure,
        **attributes_of(f"suites/{chosen.name}/fragility", provenance),
    }
    described: dict[Path, xr.Dataset] = {
        outcomes: joined.assign_attrs(
            title=f"Outcomes of the suite {chosen.name}",
            summary="Response of rigid blocks (2.2) to each record at each level of intensity, solved event by event.",
        ),
        fragility: found.assign_attrs(
            title=f"Fragility under the suite {chosen.name}",
            summary="Number of records that reach a limit state at each level of intensity, with binomial intervals, "
            "and curves fitted by maximum likelihood; rocking.suites.fits states how.",
            confidence=chosen.confidence,
        ),
    }
    if sensitivity is not None and sensitivity_rows is not None:
        changed = _joined(sensitivities, chosen.measure)
        changed = changed.merge(sensitivity_of_outcomes(changed, chosen.confidence))
        write_output(sensitivity_rows, csv_text(sensitivity_table(changed)))
        described[sensitivity] = changed.assign_attrs(
            title=f"Friction demand, and effect of restitution and sampling, under the suite {chosen.name}",
            summary="Largest friction demand of each block under each record at some levels of intensity, and whether "
            "it overturns with another restitution or sampling; rocking.suites.sensitivity states what is changed.",
            confidence=chosen.confidence,
        )
    for path, dataset in described.items():
        name = f"suites/{chosen.name}/{path.stem}"
        write_dataset(describe(dataset, id=name, **about), path)
    write_output(table, csv_text(fragility_table(found)))
    print(f"{fragility}: {joined.sizes['record']} records, {joined.sizes['block']} blocks")


def _joined(files: Sequence[Path], measure: str) -> xr.Dataset:
    return join_outcomes([read_dataset(path).drop_attrs(deep=False) for path in files], measure)


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
