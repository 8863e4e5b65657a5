"""Computes the spectrum cubes of one pulse, one file for each coefficient of restitution."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rocking.boundary.cells import crossed_cells
from rocking.datasets.cube import describe, read_dataset, write_dataset
from rocking.spectra.cubes import spectra
from workflow.scripts.axes import stepped
from workflow.scripts.job import run


def main(
    *,
    pulse: str,
    restitution: Sequence[float],
    grid: Mapping[str, Any],
    boundaries: Sequence[Path],
    cubes: Sequence[Path],
    provenance: Mapping[str, str],
) -> None:
    """Fill one cube per restitution [-] over the configured grid and write it to the corresponding path of `cubes`.

    Cells that are crossed by the overturning boundaries, read from `boundaries`, are not interpolated.
    """
    columns = grid["frequency_ratio"]
    axes: dict[str, Any] = {
        "slenderness": stepped(**grid["slenderness"]),
        "frequency_ratio": np.geomspace(columns["low"], columns["high"], columns["points"]),
        "alpha": [math.radians(angle) for angle in grid["alpha_deg"]],
    }
    plane = axes["slenderness"], axes["frequency_ratio"]
    curves = [read_dataset(path) for path in boundaries]
    barred = np.array([[crossed_cells(one, alpha, *plane) for alpha in axes["alpha"]] for one in curves])
    for cube, path in zip(spectra(pulse, restitution=restitution, barred=barred, **axes), cubes, strict=True):
        write_dataset(describe(cube, **provenance), path)
        print(f"{path}: {cube.outcome.size} cells, {int((cube.outcome > 1).sum())} overturned")


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
