"""Cubes solved one by one, and the errors between them, are those of cubes filled at once, bit for bit."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from rocking._datasets.cube import read_dataset, write_dataset
from rocking._datasets.netcdf import open_netcdf
from rocking._lookup.collection import CubeCollection
from rocking._lookup.cube import open_cube
from rocking._lookup.cube_slice import ERRORS_NAME
from rocking._spectra.cubes import REFINE_TOL, restitution_errors, solve_cubes, spectra

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


def test_errors_between_cubes_of_files_are_those_of_cubes_filled_at_once(
    barred: np.ndarray, whole: list[xr.Dataset], tmp_path: Path
) -> None:
    """Bit for bit, with one cube at a time and with all; and the lookup finds them in the file beside the cubes."""
    for k, eta in enumerate(ETAS):
        (alone,) = solve_cubes("cosine", restitution=[eta], barred=barred[k : k + 1], **GRID)
        xr.testing.assert_identical(alone.drop_attrs(), whole[k].drop_vars("restitution_error").drop_attrs())
        write_dataset(alone, tmp_path / f"eta-{eta:.2f}.nc", chunks={"alpha": 1})
        write_dataset(whole[k], tmp_path / "whole" / f"eta-{eta:.2f}.nc")
    with ExitStack() as stack:
        paths = sorted(tmp_path.glob("*.nc"))
        cubes = [stack.enter_context(open_netcdf(path, cache=False)) for path in paths]
        errors = restitution_errors("cosine", cubes, threads=1)
    for k, cube in enumerate(whole):
        np.testing.assert_array_equal(errors.restitution_error[k], cube.restitution_error)
    draw = np.random.default_rng(2)
    points = {
        "slenderness": draw.uniform(0.3, 0.7, 2000),
        "frequency_ratio": draw.uniform(2.0, 6.0, 2000),
        "restitution": draw.uniform(ETAS[0], ETAS[-1], 2000),
    }
    # without the file nothing is interpolated between restitutions
    assert (open_cube(tmp_path).response(**points).source == "solver").all()
    write_dataset(errors, tmp_path / f"{ERRORS_NAME}.nc")
    found, expected = (open_cube(folder).response(**points) for folder in (tmp_path, tmp_path / "whole"))
    assert (found.source == "cube").mean() > 0.3
    for name in ("source", "peak_rotation", "error_bound", "outcome"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))


def test_errors_measured_with_another_cube_are_not_used(whole: list[xr.Dataset], tmp_path: Path) -> None:
    """As after a change of one cube alone: points in intervals that it belongs to are solved."""
    cubes = [cube.drop_vars("restitution_error").drop_attrs(deep=False) for cube in whole]
    cubes = [cube.assign_attrs(content_sha256=f"{k}", impacts_before_rest=99) for k, cube in enumerate(cubes)]
    errors = restitution_errors("cosine", cubes, threads=1).assign_attrs(content_sha256="")
    folder = tmp_path / "spectra" / "cosine"
    for k, cube in enumerate(whole):
        path = folder / f"eta-{ETAS[k]:.2f}.nc"
        write_dataset(cube.drop_vars("restitution_error").assign_attrs(restitution_slices=ETAS[k]), path)
        cubes[k] = read_dataset(path)
    digests = [cube.attrs["content_sha256"] for cube in cubes]
    digests[-1] = "of another cube"
    write_dataset(errors.assign_attrs(cubes_content_sha256=" ".join(digests)), folder / f"{ERRORS_NAME}.nc")
    point = {"slenderness": 0.42, "frequency_ratio": 5.5, "absolute_tolerance": 1e-2}
    collection = CubeCollection(tmp_path)
    for opened in (open_cube(folder), collection.cube("cosine")):
        sources = [str(opened.response(**point, restitution=eta).source) for eta in (0.79, 0.82, 0.845, 0.86, 0.90)]
        assert sources == ["cube", "cube", "cube", "solver", "solver"]
    assert collection.problems() == {}
    digests[-1] = cubes[-1].attrs["content_sha256"]
    write_dataset(errors.assign_attrs(cubes_content_sha256=" ".join(digests)), folder / f"{ERRORS_NAME}.nc")
    assert str(collection.cube("cosine").response(**point, restitution=0.86).source) == "cube"


def test_grid_of_the_test_has_all_kinds_of_cells(whole: list[xr.Dataset]) -> None:
    for cube in whole:
        assert set(np.unique(cube.stencil)) == {-1, 0, 1, 2}
        errors = cube.interpolation_error.values
        assert (errors[errors > 0] > REFINE_TOL).any()
        assert (errors[errors > 0] <= REFINE_TOL).any()
        assert np.isfinite(cube.alpha_error).any()
    assert [bool(np.isfinite(cube.restitution_error).any()) for cube in whole] == [True] * 5 + [False]
