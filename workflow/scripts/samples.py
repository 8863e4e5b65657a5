"""Writes the samples of a pulse of the configuration to the file that jobs read."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rocking._base.errors import InvalidArgumentError
from workflow.pulses import configured_pulse, samples_file, write_samples
from workflow.scripts.job import run


def main(*, pulse: Mapping[str, Any], folder: str, samples: Path) -> None:
    """Write the pulse, which `configured_pulse` makes from its entry of the configuration in `folder`, to `samples`."""
    found = configured_pulse(pulse, Path(folder))
    if isinstance(found, str) or Path(samples_file(found)) != samples:
        raise InvalidArgumentError("pulse", found, "samples that do not change during the run")
    write_samples(found, samples)
    print(f"{samples}: {found.values.size} samples")


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
