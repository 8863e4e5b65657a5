"""Responses of the blocks of a suite to the motion of one file, at every level of intensity."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import xarray as xr

from rocking._datasets.cube import describe, write_dataset
from rocking._dimensional.block import Block
from rocking._excitation.records.record import Record
from rocking.suites.configuration import BlockMap, SuiteConfiguration, suite_configuration
from rocking.suites.margins import with_margins
from rocking.suites.outcomes import check_suite, suite_outcomes
from rocking.suites.sensitivity import sensitivity_outcomes
from workflow.scripts.job import attributes_of, run


def main(
    *,
    file: Path,
    suite: Mapping[str, Any],
    outcomes: Path,
    provenance: dict[str, str],
    sensitivity: Path | None = None,
) -> None:
    """Compute the outcomes of the blocks, and of the grid of blocks of the map, under the motion of a file.

    `sensitivity`, if the suite asks for it: friction demand, and outcomes with other restitution and sampling.
    """
    chosen = suite_configuration(suite, Path())
    assert isinstance(chosen.blocks, tuple)  # by `workflow.configuration`
    motion = chosen.records.read(file)
    checked = check_suite(motion, chosen.blocks, chosen.intensity, chosen.measure, chosen.restitution)
    found = with_margins(suite_outcomes(checked, threads=1), checked, threads=1)
    if chosen.map is not None:
        found = found.assign(map_overturned=_map_of(chosen, chosen.map, motion))
    product = f"suites/{chosen.name}/records/{file.name}"
    about = {"source": motion.source, **attributes_of(product, provenance)}
    described = describe(
        found,
        title=f"Rocking under {motion.name}",
        summary="Response of rigid blocks (2.2) to a recorded ground motion at several levels of intensity, "
        "solved event by event.",
        id=product,
        **about,
    )
    write_dataset(described, outcomes)
    if chosen.sensitivity is not None and sensitivity is not None:
        asked = replace(checked, levels=chosen.sensitivity.intensity)
        described = describe(
            sensitivity_outcomes(asked, chosen.sensitivity.restitution_step, threads=1),
            title=f"Friction demand, and effect of restitution and sampling, under {motion.name}",
            summary="Rigid blocks (2.2) under a recorded ground motion; rocking.suites.sensitivity states what is "
            "changed.",
            id=f"suites/{chosen.name}/sensitivity/{file.name}",
            **about,
        )
        write_dataset(described, sensitivity)
    print(f"{outcomes}: {found.overturned.size} responses")


def _map_of(suite: SuiteConfiguration, grid: BlockMap, motion: Record) -> xr.DataArray:
    """Whether blocks of each size and shape overturn at the level of the map."""
    blocks = [Block.from_slenderness_angle(alpha, size) for size in grid.half_diagonal for alpha in grid.alpha]
    checked = check_suite(motion, blocks, grid.intensity, suite.measure, suite.restitution)
    overturned = suite_outcomes(checked, threads=1).overturned
    values = overturned.values.reshape(grid.half_diagonal.size, grid.alpha.size, 1)
    return xr.DataArray(
        values,
        {
            "map_half_diagonal": xr.Variable(
                "map_half_diagonal", grid.half_diagonal, {"units": "m", "long_name": "half diagonal R of the block"}
            ),
            "map_alpha": xr.Variable(
                "map_alpha", grid.alpha, {"units": "rad", "long_name": "slenderness angle of the block"}
            ),
        },
        ("map_half_diagonal", "map_alpha", "record"),
        attrs=overturned.attrs | {"intensity": grid.intensity, "measure": suite.measure},
    )


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
