"""Tiles joined are the whole cubes, bit for bit, for bands of any height."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import xarray as xr

from rocking._base.errors import DatasetError
from rocking._datasets.cube import write_dataset
from rocking._spectra.bands import bands, rows_with_halo
from rocking._spectra.cubes import REFINE_TOL, spectra
from rocking._spectra.tiles import join_tiles, spectrum_tile

# with bands of two rows, a halo smaller by one row on either side changes an error in the cubes of this grid
ROWS = np.linspace(0.3, 0.7, 41)
GRID: dict[str, Any] = {
    "restitution": [0.80, 0.84],
    "frequency_ratio": np.geomspace(2.0, 6.0, 60),
    "alpha": np.radians([0.0, 15.0]),
}


@pytest.fixture(scope="module")
def barred() -> np.ndarray:
    draw = np.random.default_rng(1)
    return draw.random((2, 2, ROWS.size - 1, 59)) < 0.002


@pytest.fixture(scope="module")
def whole(barred: np.ndarray) -> list[xr.Dataset]:
    return [*spectra("cosine", slenderness=ROWS, barred=barred, **GRID)]


@pytest.mark.parametrize("height", [2, 14, 50])
def test_joined_tiles_have_the_bytes_of_the_whole(
    height: int, barred: np.ndarray, whole: list[xr.Dataset], tmp_path: Any
) -> None:
    tiles = []
    for band in bands(ROWS.size, height):
        nodes = rows_with_halo(band, ROWS.size)
        bars = barred[:, :, nodes.start : nodes.stop - 1]
        tile = spectrum_tile("cosine", band, slenderness=ROWS, barred=bars, threads=1, **GRID)
        tiles.append(tmp_path / f"{band[0]}.nc")
        write_dataset(tile, tiles[-1], chunks={"restitution": 1})
    for k, (joined, expected) in enumerate(zip(join_tiles("cosine", tiles), whole, strict=True)):
        write_dataset(joined, tmp_path / f"joined-{k}.nc")
        write_dataset(expected, tmp_path / f"whole-{k}.nc")
        xr.testing.assert_identical(joined, expected)
        assert (tmp_path / f"joined-{k}.nc").read_bytes() == (tmp_path / f"whole-{k}.nc").read_bytes()
    tiles[-1].write_bytes(tiles[-1].read_bytes()[:-1])
    with pytest.raises(DatasetError, match=f"{band[0]}.nc: damaged"):
        next(join_tiles("cosine", tiles))


def test_grid_of_the_test_has_all_kinds_of_cells(whole: list[xr.Dataset]) -> None:
    for cube in whole:
        assert set(np.unique(cube.stencil)) == {-1, 0, 1, 2}
        errors = cube.interpolation_error.values
        assert (errors[errors > 0] > REFINE_TOL).any()
        assert (errors[errors > 0] <= REFINE_TOL).any()
    assert np.isfinite(whole[0].restitution_error).any()
    assert np.isfinite(whole[0].alpha_error).any()


@pytest.mark.parametrize(("rows", "height"), [(1, 1), (10, 3), (641, 60), (5, 9)])
def test_bands_cover_all_rows_evenly(rows: int, height: int) -> None:
    found = bands(rows, height)
    assert [row for first, last in found for row in range(first, last)] == [*range(rows)]
    sizes = {last - first for first, last in found}
    assert max(sizes) <= height
    assert max(sizes) - min(sizes) <= 1
