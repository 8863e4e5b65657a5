"""Files of a fragility for other programs, by the ending of their names."""

import json
from os import PathLike
from pathlib import Path

import xarray as xr

from rocking._base.errors import one_of
from rocking._base.output_file import write_output
from rocking._datasets.csv_text import csv_text
from rocking.suites.nrml import write_nrml
from rocking.suites.pelicun import write_pelicun
from rocking.suites.table import curve_table, finite, fragility_table

ENDINGS = (".csv", ".json", ".xml")

PELICUN = ".pelicun.csv"


def write_fragility(fragility: xr.Dataset, path: str | PathLike[str]) -> None:
    """Write the fragility of blocks to a file for other programs.

    Parameters
    ----------
    fragility : xarray.Dataset
        Result of `rocking.fragility`, if wanted with the variables of `annual_rate`.
    path : path
        The file; an existing one is replaced as a whole, or stays if writing fails. `.csv`: a row for each limit state,
        block and level, with counts, intervals and the fitted probabilities. `.json`: these and the fitted curves, null
        for what does not exist. `.xml`: `write_nrml`. `.pelicun.csv`: `write_pelicun`.

    Raises
    ------
    InvalidArgumentError
        If the name has another ending, or for .xml as `write_nrml`, for .pelicun.csv as `write_pelicun`.
    """
    file = Path(path)
    if file.name.lower().endswith(PELICUN):
        write_pelicun(fragility, file)
        return
    ending = one_of("path", file.suffix.lower(), ENDINGS)
    if ending == ".xml":
        write_nrml(fragility, file)
        return
    levels = fragility_table(fragility)
    if ending == ".csv":
        write_output(file, csv_text(levels))
        return
    about = {"measure": fragility.attrs["measure"], "unit": fragility["intensity"].attrs["units"]}
    tables = {"levels": finite(levels), "curves": finite(curve_table(fragility))}
    write_output(file, json.dumps({**about, **tables}, allow_nan=False))
