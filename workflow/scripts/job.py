"""Adapter between Snakemake and the scripts: a job is one call of a plain function."""

import inspect
import os
import traceback
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

import llvmlite.binding


def run(task: Callable[..., None], snakemake: Any) -> None:
    """Call `task` with the inputs, outputs and parameters of the job that it takes; its output goes to the log.

    `snakemake` is the object that Snakemake provides to a script. Inputs and outputs with a name are paths.
    """
    arguments: dict[str, Any] = {"threads": snakemake.threads}
    for files in (snakemake.input, snakemake.output):
        arguments |= {name: _paths(value) for name, value in files.items()}
    arguments |= dict(snakemake.params.items())
    taken = inspect.signature(task).parameters
    with Path(snakemake.log[0]).open("w", encoding="utf-8") as log, redirect_stdout(log), redirect_stderr(log):
        try:
            task(**{name: value for name, value in arguments.items() if name in taken})
        except BaseException:
            traceback.print_exc()  # into the log, which Snakemake shows when a job fails
            raise


def attributes_of(product: str, provenance: dict[str, str]) -> dict[str, str]:
    """Attributes of a data set by its path below the results: the command that makes it, and where it comes from.

    The last digits depend on the instructions of the processor, whose LLVM name is stated.
    """
    processor = os.environ.get("NUMBA_CPU_NAME") or str(llvmlite.binding.get_host_cpu_name())
    return {"history": f"snakemake results/{product}.nc", "processor": processor, **provenance}


def _paths(value: Any) -> Path | list[Path]:
    if isinstance(value, str):
        return Path(value)
    return [Path(path) for path in value]
