"""Fills the spectrum cube of one pulse and restitution."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rocking._boundary.curves import crossed_cells
from rocking._datasets.cube import describe, read_dataset, write_dataset
from rocking._spectra.cubes import solve_cubes
from workflow.pulses import configured_pulse
from workflow.scripts.axes import stepped
from workflow.scripts.job import attributes_of, run


def main(
    *,
    pulse: Any,
    restitution: float,
    grid: Mapping[str, Any],
    boundaries: Path,
    cube: Path,
    provenance: dict[str, str],
    threads: int,
) -> None:
    """Solve the configured grid at a restitution [-]; cells that its boundaries cross are not interpolated.

    `pulse`: entry of the configuration.
    """
    columns = grid["frequency_ratio"]
    slenderness = stepped(**grid["slenderness"])
    frequency_ratio = np.geomspace(columns["low"], columns["high"], columns["points"])
    alpha = [math.radians(angle) for angle in grid["alpha_deg"]]
    curves = read_dataset(boundaries)
    barred = [crossed_cells(curves, angle, slenderness, frequency_ratio) for angle in alpha]
    (solved,) = solve_cubes(
        configured_pulse(pulse),
        restitution=[restitution],
        slenderness=slenderness,
        frequency_ratio=frequency_ratio,
        alpha=alpha,
        barred=np.array([barred]),
        derived=grid.get("derived", ()),
        threads=threads,
    )
    described = describe(solved, **attributes_of(solved.attrs["id"], provenance))
    write_dataset(described, cube, chunks={"alpha": 1})  # one angle can be read alone
    print(f"{cube}: {solved.outcome.size} cells, {int((solved.outcome > 1).sum())} overturned")


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
