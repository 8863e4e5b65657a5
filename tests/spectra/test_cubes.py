"""Cubes completed one by one from files of some restitutions are those filled at once, bit for bit."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from rocking._datasets.cube import write_dataset
from rocking._datasets.netcdf import open_netcdf
from rocking._interpolation.slices import windows_of
from rocking._spectra.cubes import REFINE_TOL, solve_cubes, spectra, with_restitution_errors

ETAS = [0.78, 0.80, 0.84, 0.85, 0.88, 0.92]
GRID: dict[str, Any] = {
    "slenderness": np.linspace(0.3, 0.7, 41),
    "frequency_ratio": np.geomspace(2.0, 6.0, 60),
    "alpha": np.radians([0.0, 15.0]),
    "threads": 1,
}


@pytest.fixture(scope="module")
def barred() -> np.ndarray:
    draw = np.random.default_rng(1)
    return draw.random((len(ETAS), 2, 40, 59)) < 0.002


@pytest.fixture(scope="module")
def whole(barred: np.ndarray) -> list[xr.Dataset]:
    return [*spectra("cosine", restitution=ETAS, barred=barred, **GRID)]


def test_cubes_completed_from_files_have_the_bytes_of_those_filled_at_once(
    barred: np.ndarray, whole: list[xr.Dataset], tmp_path: Path
) -> None:
    for k, eta in enumerate(ETAS):
        (alone,) = solve_cubes("cosine", restitution=[eta], barred=barred[k : k + 1], **GRID)
        assert np.isnan(alone.restitution_error).all()
        write_dataset(alone, tmp_path / f"{k}.nc", chunks={"alpha": 1})
    for k, expected in enumerate(whole):
        first, last = windows_of(len(ETAS), k, k + 1)
        with ExitStack() as stack:
            window = [stack.enter_context(open_netcdf(tmp_path / f"{n}.nc", cache=False)) for n in range(first, last)]
            (found,) = with_restitution_errors("cosine", window, k - first, k - first + 1, threads=1)
        xr.testing.assert_identical(found, expected)
        assert found.attrs["restitution_slices"].tolist() == ETAS[first:last]
        for name, cube in (("found", found), ("whole", expected)):
            write_dataset(cube, tmp_path / f"{name}.nc")
        assert (tmp_path / "found.nc").read_bytes() == (tmp_path / "whole.nc").read_bytes()


def test_grid_of_the_test_has_all_kinds_of_cells(whole: list[xr.Dataset]) -> None:
    for cube in whole:
        assert set(np.unique(cube.stencil)) == {-1, 0, 1, 2}
        errors = cube.interpolation_error.values
        assert (errors[errors > 0] > REFINE_TOL).any()
        assert (errors[errors > 0] <= REFINE_TOL).any()
        assert np.isfinite(cube.alpha_error).any()
    assert [bool(np.isfinite(cube.restitution_error).any()) for cube in whole] == [True] * 5 + [False]
