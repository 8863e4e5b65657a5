"""Measures the errors of interpolation between the spectrum cubes of a pulse."""

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from rocking._datasets.cube import check_file, describe, write_dataset
from rocking._datasets.netcdf import open_netcdf
from rocking._spectra.cubes import restitution_errors
from workflow.pulses import configured_pulse
from workflow.scripts.job import attributes_of, run


def main(*, pulse: Any, cubes: Sequence[Path], errors: Path, provenance: dict[str, str], threads: int) -> None:
    """Write the errors from each cube to the next one; `pulse`: entry of the configuration; `cubes`: all, ascending."""
    for path in cubes:
        check_file(path)
    with ExitStack() as stack:
        # not kept in memory: one angle of each cube at a time is needed
        opened = [stack.enter_context(open_netcdf(path, cache=False)) for path in cubes]
        measured = restitution_errors(configured_pulse(pulse), opened, threads=threads)
    described = describe(measured, **attributes_of(measured.attrs["id"], provenance))
    write_dataset(described, errors, chunks={"restitution": 1, "alpha": 1})
    print(f"{errors}: {measured.sizes['restitution']} restitutions")


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
