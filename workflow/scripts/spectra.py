"""Joins the tiles of the spectrum cubes of one pulse: one file for each coefficient of restitution."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from rocking._datasets.cube import describe, write_dataset
from rocking._spectra.tiles import join_tiles
from workflow.parts import delete_former_parts
from workflow.pulses import pulse_of_job
from workflow.scripts.job import run


def main(
    *,
    pulse: str,
    samples: Path | list[Path],
    tiles: Sequence[Path],
    cubes: Sequence[Path],
    provenance: Mapping[str, str],
) -> None:
    """Write the cube of each restitution to the corresponding path of `cubes`; tiles are in the order of their rows."""
    for cube, path in zip(join_tiles(pulse_of_job(pulse, samples), tiles), cubes, strict=True):
        write_dataset(describe(cube, **provenance), path, chunks={"alpha": 1})  # one angle can be read alone
        print(f"{path}: {cube.outcome.size} cells, {int((cube.outcome > 1).sum())} overturned")
    delete_former_parts(tiles, pulse)


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
