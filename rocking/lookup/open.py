"""Opens a cube: a file, a folder with the cubes of one pulse, or the address of a file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rocking.errors import DatasetError
from rocking.lookup.cube import Cube
from rocking.lookup.cube_slice import fetch_slice, open_slice


def open_cube(source: Path | str) -> Cube:
    """Read spectrum cubes into memory.

    Parameters
    ----------
    source : path or str
        A file such as `results/spectra/sine/eta-0.85.nc`, its http or https address, or a folder such as
        `results/spectra/sine`, whose files are then interpolated in restitution too.

    Raises
    ------
    DatasetError
        If a file is missing, damaged, or not a spectrum cube, or if the files of a folder do not belong together.
    """
    if str(source).startswith(("http://", "https://")):
        levels = [fetch_slice(str(source))]
    elif Path(source).is_dir():
        levels = [open_slice(path) for path in sorted(Path(source).glob("eta-?.??.nc"))]
        if not levels:
            raise DatasetError(f"{source}: holds no spectrum cubes; `make reproduce` builds them")
    else:
        levels = [open_slice(source)]
    for level in levels:
        if level.pulse != levels[0].pulse or not level.fits(levels[0]):
            raise DatasetError(f"{source}: cubes of different pulses or grids; build them again")
    return Cube(levels[0].pulse, np.array([level.restitution for level in levels]), levels.__getitem__)
