"""Solves the spectrum cubes of one pulse at some coefficients of restitution, which share the starts of the motions.

They are a part from which `workflow/scripts/spectra.py` writes files.
"""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from rocking._boundary.cells import crossed_cells
from rocking._datasets.cube import read_dataset, write_dataset
from rocking._spectra.cubes import solve_cubes
from workflow.parts import delete_former_parts
from workflow.pulses import pulse_of_job
from workflow.scripts.axes import stepped
from workflow.scripts.job import run


def main(
    *,
    pulse: str,
    samples: Path | list[Path],
    restitution: Sequence[float],
    grid: Mapping[str, Any],
    boundaries: Sequence[Path],
    part: Path,
    threads: int,
) -> None:
    """Solve the configured grid at some restitutions [-], into one file.

    Cells that are crossed by the overturning boundaries, read from the file of each restitution, are not interpolated.
    """
    columns = grid["frequency_ratio"]
    slenderness = stepped(**grid["slenderness"])
    frequency_ratio = np.geomspace(columns["low"], columns["high"], columns["points"])
    alpha = [math.radians(angle) for angle in grid["alpha_deg"]]
    curves = map(read_dataset, boundaries)
    barred = [[crossed_cells(one, angle, slenderness, frequency_ratio) for angle in alpha] for one in curves]
    cubes = solve_cubes(
        pulse_of_job(pulse, samples),
        restitution=restitution,
        slenderness=slenderness,
        frequency_ratio=frequency_ratio,
        alpha=alpha,
        barred=np.array(barred),
        derived=grid.get("derived", ()),
        threads=threads,
    )
    solved = xr.concat([*cubes], "restitution", combine_attrs="override", coords="minimal", compat="override")
    write_dataset(solved, part, chunks={"restitution": 1, "alpha": 1})
    delete_former_parts(part)
    print(f"{part}: {solved.outcome.size} cells, {int((solved.outcome > 1).sum())} overturned")


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
