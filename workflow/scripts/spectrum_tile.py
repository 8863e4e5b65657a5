"""Computes some rows of the spectrum cubes of one pulse, at all coefficients of restitution.

They are a part of the files that `workflow/scripts/spectra.py` writes.
"""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rocking._boundary.cells import crossed_cells
from rocking._datasets.cube import read_dataset, write_dataset
from rocking._spectra.tiles import rows_with_halo, spectrum_tile
from workflow.pulses import pulse_of_job
from workflow.scripts.axes import stepped
from workflow.scripts.job import run


def main(
    *,
    pulse: str,
    samples: Path | list[Path],
    band: tuple[int, int],
    restitution: Sequence[float],
    grid: Mapping[str, Any],
    boundaries: Sequence[Path],
    part: Path,
    threads: int,
) -> None:
    """Fill the rows of a band [first, last) of the configured grid, for all restitutions [-], into one file.

    Cells that are crossed by the overturning boundaries, read from `boundaries`, are not interpolated.
    """
    columns = grid["frequency_ratio"]
    slenderness = stepped(**grid["slenderness"])
    frequency_ratio = np.geomspace(columns["low"], columns["high"], columns["points"])
    alpha = [math.radians(angle) for angle in grid["alpha_deg"]]
    nodes = rows_with_halo(band, slenderness.size)
    cells = slice(nodes.start, nodes.stop - 1)
    barred = np.empty((len(boundaries), len(alpha), cells.stop - cells.start, frequency_ratio.size - 1), dtype=bool)
    for bars, path in zip(barred, boundaries, strict=True):
        curves = read_dataset(path)
        for k, angle in enumerate(alpha):
            # on the whole axes: a curve is widened by a share of each cell
            bars[k] = crossed_cells(curves, angle, slenderness, frequency_ratio)[cells]
    tile = spectrum_tile(
        pulse_of_job(pulse, samples),
        band,
        restitution=restitution,
        slenderness=slenderness,
        frequency_ratio=frequency_ratio,
        alpha=alpha,
        barred=barred,
        derived=grid.get("derived", ()),
        threads=threads,
    )
    write_dataset(tile, part, chunks={"restitution": 1, "alpha": 1})
    print(f"{part}: {tile.outcome.size} cells, {int((tile.outcome > 1).sum())} overturned")


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
