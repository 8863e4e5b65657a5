"""Adapter between Snakemake and the scripts: a job is one call of a plain function."""

import inspect
import resource
import sys
import time
import traceback
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

from workflow.records import write_record
from workflow.run_lock import join_run


def run(task: Callable[..., None], snakemake: Any) -> None:
    """Call `task` with the named inputs, outputs and parameters of the job; its output goes to the log of the job.

    Its time and memory go to a table in `logs/benchmarks`; Snakemake would measure the client of a fork
    (`job_server.py`). The output `record` is not passed to the task: the digests of the other outputs are written to it
    afterwards. The samples of a pulse, whose name holds their digest, have no record. `snakemake` is the object that
    Snakemake provides to a script.
    """
    began = time.monotonic()
    join_run()
    paths = {name: _paths(value) for part in (snakemake.input, snakemake.output) for name, value in part.items()}
    record = paths.pop("record", None)
    log = Path(snakemake.log[0])
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("w", encoding="utf-8") as stream, redirect_stdout(stream), redirect_stderr(stream):
        try:
            task(**paths, **_arguments(task, snakemake))
            if record:
                write_record(record, (path for path in map(Path, snakemake.output) if path != record))
        except BaseException:
            traceback.print_exc()  # into the log, which Snakemake shows when a job fails
            raise
    _note_cost(log, time.monotonic() - began)


def _note_cost(log: Path, seconds: float) -> None:
    """Write time [s], largest memory [MB], load [%] and processor time [s] of this process, as Snakemake names them."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    processor = used.ru_utime + used.ru_stime
    megabytes = used.ru_maxrss / (2**20 if sys.platform == "darwin" else 2**10)
    line = "\t".join(f"{value:.2f}" for value in (seconds, megabytes, 100 * processor / seconds, processor))
    table = Path("logs/benchmarks", "-".join(log.with_suffix(".tsv").parts[1:]))
    table.parent.mkdir(parents=True, exist_ok=True)
    table.write_text(f"s\tmax_rss\tmean_load\tcpu_time\n{line}\n", encoding="utf-8")


def command_of(product: str) -> str:
    """The command that makes a product, by its path below the results without a suffix; of the attribute `history`."""
    return f"python -m workflow.run results/{product}.nc"


def _arguments(task: Callable[..., None], snakemake: Any) -> dict[str, Any]:
    """The parameters of the job; also its number of threads if the task takes it."""
    threads = {"threads": snakemake.threads} if "threads" in inspect.signature(task).parameters else {}
    return {**snakemake.params, **threads}


def _paths(value: Any) -> Path | list[Path]:
    return Path(value) if isinstance(value, str) else [Path(path) for path in value]
