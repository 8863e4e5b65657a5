"""Solves the spectrum cube of one pulse and restitution, the part that `workflow/scripts/spectra.py` completes."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rocking._boundary.curves import crossed_cells
from rocking._datasets.cube import read_dataset, write_dataset
from rocking._spectra.cubes import solve_cubes
from workflow.pulses import pulse_of_job
from workflow.scripts.axes import stepped
from workflow.scripts.job import run


def main(
    *,
    pulse: str,
    samples: Path | list[Path],
    restitution: float,
    grid: Mapping[str, Any],
    boundaries: Path,
    part: Path,
    threads: int,
) -> None:
    """Solve the configured grid at a restitution [-]; cells that its boundaries cross are not interpolated."""
    columns = grid["frequency_ratio"]
    slenderness = stepped(**grid["slenderness"])
    frequency_ratio = np.geomspace(columns["low"], columns["high"], columns["points"])
    alpha = [math.radians(angle) for angle in grid["alpha_deg"]]
    curves = read_dataset(boundaries)
    barred = [crossed_cells(curves, angle, slenderness, frequency_ratio) for angle in alpha]
    (solved,) = solve_cubes(
        pulse_of_job(pulse, samples),
        restitution=[restitution],
        slenderness=slenderness,
        frequency_ratio=frequency_ratio,
        alpha=alpha,
        barred=np.array([barred]),
        derived=grid.get("derived", ()),
        threads=threads,
    )
    write_dataset(solved, part, chunks={"alpha": 1})
    print(f"{part}: {solved.outcome.size} cells, {int((solved.outcome > 1).sum())} overturned")


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
