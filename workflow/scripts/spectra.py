"""Completes the spectrum cube of one pulse and restitution: measures the errors up to the next restitution."""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path

from rocking._datasets.cube import check_file, describe, write_dataset
from rocking._datasets.netcdf import open_netcdf
from rocking._spectra.cubes import with_restitution_errors
from workflow.pulses import pulse_of_job
from workflow.scripts.job import command_of, run


def main(
    *,
    pulse: str,
    samples: Path | list[Path],
    restitution: float,
    parts: Sequence[Path],
    cube: Path,
    provenance: Mapping[str, str],
    threads: int,
) -> None:
    """Write the cube of a restitution [-], interpolated up to the next one from the parts of its window."""
    for path in parts:
        check_file(path)
    with ExitStack() as stack:
        # not kept in memory: one angle of a cube at a time is needed of the others
        opened = [stack.enter_context(open_netcdf(path, cache=False)) for path in parts]
        own = [float(part["restitution"]) for part in opened].index(restitution)
        (whole,) = with_restitution_errors(pulse_of_job(pulse, samples), opened, own, own + 1, threads=threads)
    described = describe(whole, history=command_of(whole.attrs["id"]), **provenance)
    write_dataset(described, cube, chunks={"alpha": 1})  # one angle can be read alone
    print(f"{cube}: {whole.outcome.size} cells, {int((whole.outcome > 1).sum())} overturned")


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
