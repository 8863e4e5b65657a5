"""Opens a cube: a file, a folder with the cubes of one pulse, or the address of a file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rocking._base.errors import DatasetError
from rocking._lookup.cube import Cube
from rocking._lookup.cube_slice import fetch_slice, open_slice


def open_cube(source: Path | str) -> Cube:
    """Read spectrum cubes into memory.

    Parameters
    ----------
    source : path or str
        A file such as `results/spectra/sine/eta-0.85.nc`, its http or https address, or a folder such as
        `results/spectra/sine`; the files of a folder are interpolated in restitution as well.

    Raises
    ------
    DatasetError
        If a file is missing, damaged, or not a spectrum cube, or if the files of a folder differ in pulse or axes.
    """
    if str(source).startswith(("http://", "https://")):
        slices = [fetch_slice(str(source))]
    elif Path(source).is_dir():
        slices = [open_slice(path) for path in sorted(Path(source).glob("eta-?.??.nc"))]
        if not slices:
            raise DatasetError(f"{source}: holds no spectrum cubes; `make reproduce` builds them")
    else:
        slices = [open_slice(source)]
    for one in slices:
        if one.pulse != slices[0].pulse or not one.fits(slices[0]):
            raise DatasetError(f"{source}: cubes of different pulses or grids; build them again")
    return Cube(slices[0].pulse, np.array([one.restitution for one in slices]), slices.__getitem__)
