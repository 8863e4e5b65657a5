"""Tiles of spectrum cubes: bands of rows computed one by one in bounded memory, and joined to whole cubes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from rocking._datasets.cube import AXES, DIMENSIONS, build_spectrum_dataset, check_file, read_slice
from rocking._excitation.sampled import SampledPulse
from rocking._spectra.bands import rows_with_halo
from rocking._spectra.cubes import spectra


def spectrum_tile(
    pulse: str | SampledPulse,
    band: tuple[int, int],
    *,
    restitution: ArrayLike,
    slenderness: ArrayLike,
    barred: NDArray[np.bool_] | None = None,
    **grid: Any,
) -> xr.Dataset:
    """The rows of a band of the spectrum cubes of one pulse, at all restitutions.

    Parameters
    ----------
    pulse : str or SampledPulse
        Name of the pulse, or a pulse given by samples.
    band : (int, int)
        First row of nodes, and the one after the last.
    restitution : array_like, shape (l,)
        eta [-], [0, 1], ascending.
    slenderness : array_like, shape (n,), n >= 4
        1/a [-], of all rows of the cubes, > 0, ascending.
    barred : bool array, shape (l, k, rows - 1, m - 1), optional
        Cells that are not interpolated, in `rows_with_halo` of the band.
    **grid
        Other arguments as for `spectra`.

    Returns
    -------
    xarray.Dataset
        The variables of a cube over (restitution, alpha, slenderness, frequency_ratio).

    Raises
    ------
    InvalidArgumentError
        If a value is out of range.
    """
    etas, rows = (np.asarray(values, dtype=np.float64) for values in (restitution, slenderness))
    around = rows_with_halo(band, rows.size)
    own = slice(band[0] - around.start, band[1] - around.start)
    variables: dict[str, NDArray[Any]] = {}
    for k, cube in enumerate(spectra(pulse, restitution=etas, slenderness=rows[around], barred=barred, **grid)):
        part = cube.isel(slenderness=own)
        for name, values in part.data_vars.items():
            whole = variables.setdefault(str(name), np.empty((etas.size, *values.shape), dtype=values.dtype))
            whole[k] = values.values
    axes = {name: (name, part[name].values, AXES[name]) for name in DIMENSIONS}
    dimensions = ("restitution", *DIMENSIONS)
    return xr.Dataset({name: (dimensions, values) for name, values in variables.items()}, {"restitution": etas, **axes})


def join_tiles(pulse: str | SampledPulse, tiles: Sequence[Path]) -> Iterator[xr.Dataset]:
    """The spectrum cubes of which files of tiles hold the bands, in ascending order; one for each restitution in turn.

    One restitution at a time is in memory.

    Raises
    ------
    DatasetError
        If a file is missing or damaged.
    """
    for path in tiles:
        check_file(path)
    etas = read_slice(tiles[0], **dict.fromkeys(DIMENSIONS, 0))["restitution"].values
    for k, eta in enumerate(etas):
        parts = [read_slice(path, restitution=k) for path in tiles]
        axes = {name: parts[0][name].values for name in DIMENSIONS}
        axes["slenderness"] = np.concatenate([part["slenderness"].values for part in parts])
        variables = {
            str(name): np.concatenate([part[name].values for part in parts], axis=1) for name in parts[0].data_vars
        }
        del parts
        cube = build_spectrum_dataset(variables, pulse=pulse, restitution=float(eta), axes=axes)
        yield cube.assign_attrs(restitution_slices=etas)
