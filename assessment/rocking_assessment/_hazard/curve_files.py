"""Hazard curves as the usual services and programs write them.

| file | recognised by | values |
|---|---|---|
| OpenQuake, `hazard_curve-mean-PGA.csv` | comment with `investigation_time`, `imt`; columns `poe-0.005` | probability |
| USGS nshmp-haz, `PGA/curves.csv` | columns `lon`, `lat` and one for each level | annual rate |
| USGS Unified Hazard Tool, "Download Data" | a line `Peak Ground Acceleration` above levels and values | annual rate |
| a table of your own | two columns, `pga [UNIT]` or `pgv [UNIT]` and `annual rate [1/year]` | annual rate |

A probability P of exceedance in T years is converted to the annual rate -ln(1 - P)/T of a Poisson process. Levels at
the top with the rate zero, and at the bottom with the probability one, say nothing of the rate and are left out. PGA is
in g and PGV in cm/s in those of the services.
"""

import csv
import re
from collections.abc import Iterator, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from rocking.extension import STANDARD_GRAVITY, Array, InvalidArgumentError, UnreadableFileError, in_range, positive
from rocking_assessment._hazard.checks import check_hazard_curve

TYPES = {"PGA": ("pga", "m s-2", STANDARD_GRAVITY), "PGV": ("pgv", "m s-1", 0.01)}
"""Measure of this package, its unit, and the unit of the files in it, by the type of measure in the files."""

LABELS = {"Peak Ground Acceleration": "PGA", "Peak Ground Velocity": "PGV"}
"""Types by their names in the Unified Hazard Tool."""

TWO_COLUMNS = "two columns with the header `pga [g],annual rate [1/year]`"

MAX_BYTES = 10_000_000  # largest file that is read


def read_hazard(path: str | PathLike[str]) -> xr.DataArray:
    """Read the hazard curve of one site from a file of OpenQuake or of the USGS, or from a table of two columns.

    Parameters
    ----------
    path : path
        CSV of OpenQuake, `curves.csv` of nshmp-haz in a folder named after its measure, or the text that the Unified
        Hazard Tool gives to download; or two columns, `pga [UNIT]` or `pgv [UNIT]` and `annual rate [1/year]`, such as
        "pga [g],annual rate [1/year]". One site, PGA or PGV.

    Returns
    -------
    xarray.DataArray
        Annual rate of exceedance [1/year] over `intensity` [m/s2 or m/s], with the attribute `measure`, "pga" or "pgv":
        the argument `hazard` of `annual_rate`.

    Raises
    ------
    InvalidArgumentError
        If the file cannot be read, has another format, another measure, several sites, or no curve.
    """
    file = Path(path)
    try:
        if file.stat().st_size > MAX_BYTES:
            raise _refused(file, "its size", f"at most {MAX_BYTES} bytes")
        text = file.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise UnreadableFileError("hazard", str(file), error) from None
    except ValueError as error:
        raise _refused(file, str(error), "a text file") from None
    rows = [[cell.strip() for cell in row] for row in csv.reader(text.splitlines()) if any(row)]
    try:
        kind, levels, rates = _curve(file, rows, text)
    except ValueError as error:
        raise error if isinstance(error, InvalidArgumentError) else _refused(file, str(error), "numbers") from None
    if levels.shape != rates.shape:
        raise _refused(file, f"{levels.size} levels and {rates.size} rates", "as many")
    measure, unit, factor = TYPES[kind]
    inside = (rates > 0.0) & np.isfinite(rates)  # rates of 0 and of probability 1 say nothing
    x, annual = check_hazard_curve((levels[inside] * factor, rates[inside]))
    attributes = {"units": "year-1", "long_name": "annual rate of exceedance", "measure": measure, "source": file.name}
    return xr.DataArray(annual, {"intensity": ("intensity", x, {"units": unit})}, "intensity", "hazard", attributes)


def hazard_arrays(hazard: Any, measure: str | None = None) -> tuple[ArrayLike, ArrayLike]:
    """Intensities and annual rates of a hazard curve in any form: a file, a result of `read_hazard`, or two arrays.

    `measure` is that of the fragility, with which a curve that states one has to agree.
    """
    curve = read_hazard(hazard) if isinstance(hazard, str | PathLike) else hazard
    if isinstance(curve, xr.DataArray):
        if curve.dims != ("intensity",):
            raise InvalidArgumentError("hazard", curve.dims, "the one dimension `intensity`")
        if curve.attrs.get("measure", measure) != measure:
            raise InvalidArgumentError(
                "hazard",
                curve.attrs["measure"],
                f"a hazard curve of {measure}, the measure of the fragility or the site",
            )
        return curve["intensity"].values, curve.values
    if not isinstance(curve, Sequence | np.ndarray) or len(curve) != 2:
        raise InvalidArgumentError("hazard", hazard, "a file, or intensities and annual rates")
    return curve[0], curve[1]


def _curve(file: Path, rows: list[list[str]], text: str) -> tuple[str, Array, Array]:
    """Type of measure, levels and annual rates, in the units of the file."""
    if text.startswith("#"):
        comment = dict(re.findall(r"(\w+)='?([^',\"]*)", ",".join(rows[0])))
        if not {"imt", "investigation_time"} <= comment.keys():
            raise _refused(file, "a comment without imt and investigation_time", "a file of hazard curves of OpenQuake")
        levels, poes = _site(file, rows[1:], "poe-")
        years = positive("hazard", float(comment["investigation_time"]), "year")
        with np.errstate(divide="ignore"):
            return _checked_type(file, comment["imt"]), levels, -np.log1p(-in_range("hazard", poes, 0.0, 1.0)) / years
    header = rows[0] if rows else []
    if {"lon", "lat"} <= set(header):
        return _checked_type(file, file.resolve().parent.name), *_site(file, rows, "")
    columns = re.fullmatch(r"(pg[av]) *\[(.+)\],annual[ _]rate( *\[1/year\])?", ",".join(header), re.I)
    if columns is not None:
        kind = columns[1].upper()
        texts = [f"{level} {columns[2]}" for level, _ in rows[1:]]
        unit = {"PGA": "m/s2", "PGV": "m/s"}[kind]
        levels = in_range("hazard", texts, 0.0, np.inf, closed="neither", unit=unit)
        return kind, levels / TYPES[kind][2], np.array([float(rate) for _, rate in rows[1:]])
    lines = iter(text.splitlines())
    label = next((line.strip() for line in lines if line.strip() in LABELS), None)
    if label is None:
        raise _refused(
            file, "its content", "a hazard curve of OpenQuake, nshmp-haz or the Unified Hazard Tool, or " + TWO_COLUMNS
        )
    return LABELS[label], _numbers(lines), _numbers(lines)


def _checked_type(file: Path, kind: str) -> str:
    if kind not in TYPES:
        raise _refused(file, f"measure {kind}", f"{' or '.join(TYPES)}; curves.csv is in a folder of that name")
    return kind


def _site(file: Path, rows: list[list[str]], prefix: str) -> tuple[Array, Array]:
    """Levels and values of the one site of a table; a column of values is named by the prefix and the level."""
    header, *sites = rows
    if len(sites) != 1:
        raise _refused(file, f"{len(sites)} sites", "one: leave only its row")
    if len(sites[0]) != len(header):
        raise _refused(file, f"a row of {len(sites[0])} cells", f"{len(header)}, as in the header")
    columns = [k for k, name in enumerate(header) if re.fullmatch(rf"{prefix}[0-9.]+(e[+-]?[0-9]+)?", name, re.I)]
    levels = [float(header[k].removeprefix(prefix)) for k in columns]
    return np.array(levels), np.array([float(sites[0][k]) for k in columns])


def _numbers(lines: Iterator[str]) -> Array:
    return np.array(next(lines, "").split(), dtype=np.float64)


def _refused(file: Path, value: str, allowed: str) -> InvalidArgumentError:
    return InvalidArgumentError("hazard", f"{file}: {value}", allowed)
