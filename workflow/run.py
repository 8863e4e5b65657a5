"""Makes products that are missing, out of date or not as recorded: `python -m workflow.run [options of Snakemake]`.

The command may be repeated after any interruption, including `kill -9`. It refuses to start while another run is
active.
"""

import argparse
import os
import shutil
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from snakemake.cli import main as snakemake

from workflow.records import forget_false_records
from workflow.run_lock import FOLDER, RUN_ID, RunningError, acquire, end_with

MEMORY_SHARE = 0.8
"""Share of the memory of the machine that the jobs of a run may use together [-], by what their rules state."""


def main(arguments: Sequence[str]) -> None:
    """Lock the folder, delete records that do not match their products, and call Snakemake."""
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    parser.add_argument("--directory", "-d", type=Path, default=Path())
    parser.add_argument("--configfile", "--configfiles", type=Path, nargs="+", default=[])
    options = parser.parse_known_args(arguments)[0]
    for path in options.configfile:
        if not path.is_file():
            sys.exit(f"--configfile {path}: no such file")
    if RUN_ID in os.environ:
        end_with(int(os.environ[RUN_ID]))
    try:
        acquire(options.directory)
    except RunningError as error:
        sys.exit(str(error))
    use_temporary_folder(options.directory)
    for difference in forget_false_records(options.directory):
        print(f"{difference}; it is made again", flush=True)
    snakemake([*_memory_limit(arguments), *arguments])


def _memory_limit(arguments: Sequence[str]) -> list[str]:
    """The option of Snakemake that keeps the memory of all jobs together below a share of that of this machine."""
    if any(argument.partition("=")[0] in ("--resources", "--res", "--workflow-profile") for argument in arguments):
        return []  # another engine has its own limits
    if "SC_PHYS_PAGES" not in os.sysconf_names:
        return []  # POSIX does not have this name
    megabytes = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") * MEMORY_SHARE / 1e6
    return [f"--resources=mem_mb={megabytes:.0f}"]


def use_temporary_folder(directory: Path) -> None:
    """Make this process and its jobs write temporary files to `.snakemake/tmp` in the directory of the run.

    What an earlier run left there is deleted first, so that a killed run leaves no temporary file for good. The caller
    must hold the lock of the directory.
    """
    folder = (directory / FOLDER / "tmp").resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(exist_ok=True)
    os.environ["TMPDIR"] = tempfile.tempdir = str(folder)


if __name__ == "__main__":
    main(sys.argv[1:])
