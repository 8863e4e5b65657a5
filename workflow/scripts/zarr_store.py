"""Writes the spectrum cubes of a pulse as one zarr store."""

from collections.abc import Sequence
from pathlib import Path

from rocking._datasets.zarr_store import write_pulse_store
from workflow.scripts.job import run


def main(*, cubes: Sequence[Path], store: Path) -> None:
    """Write the store of all restitutions of a pulse."""
    write_pulse_store(cubes, store)
    print(f"{store}: {len(cubes)} restitutions")


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
