"""Files of a fragility for other programs, by the ending of their names."""

import json
from os import PathLike
from pathlib import Path

import xarray as xr

from rocking._base.errors import one_of
from rocking._base.output_file import write_output
from rocking._datasets.csv_text import csv_text
from rocking.suites.table import curve_table, finite_columns, fragility_table

ENDINGS = (".csv", ".json")


def write_fragility(fragility: xr.Dataset, path: str | PathLike[str]) -> None:
    """Write the fragility of blocks to a file for other programs.

    Parameters
    ----------
    fragility : xarray.Dataset
        Result of `rocking.fragility`.
    path : path
        The file; an existing one is replaced as a whole, or stays if writing fails. `.csv`: a row for each limit state,
        block and level, with counts, intervals and the fitted probabilities. `.json`: these and the fitted curves, null
        for what does not exist.

    Raises
    ------
    InvalidArgumentError
        If the name has another ending.
    """
    file = Path(path)
    ending = one_of("path", file.suffix.lower(), ENDINGS)
    levels = fragility_table(fragility)
    if ending == ".csv":
        write_output(file, csv_text(levels))
        return
    tables = {
        "measure": fragility.attrs["measure"],
        "unit": fragility["intensity"].attrs["units"],
        "levels": finite_columns(levels),
        "curves": finite_columns(curve_table(fragility)),
    }
    write_output(file, json.dumps(tables, allow_nan=False))
