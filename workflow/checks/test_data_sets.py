"""The data sets of a pulse: consistent, and in agreement with the solver. Run by `rule check_data_sets`."""

import itertools
import os
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray

from rocking._boundary.curves import curves_at
from rocking._boundary.search import RESOLUTION, region_code
from rocking._boundary.tracing import CHORD
from rocking._datasets.cube import read_dataset, read_spectrum, stored_pulse
from rocking._model.outcome import outcome_codes
from rocking._model.response import Outcome
from rocking._solver.peak_response import peak_response
from rocking.paper.overturning import case_1_1_margin, case_1_2_margin, overturning_amplitudes

RESULTS = Path(os.environ["ROCKING_RESULTS"])
STEPS = (1e-6, 3e-6, 1e-7, 1e-8, 1e-10, 2 * RESOLUTION)
"""How far off a boundary the outcomes on its two sides are computed, in 1/a and in log omega [-]."""

LAYERS = (3e-6, 1e-5, 3e-5, 1e-4, 3e-4)
"""How far off the neighbour may lie where regions between are too thin to be resolved, up to what a file states [-]."""

VERTICES = 3000  # vertices that are tested for each angle of a file, about, evenly spaced along its curves

TIP = 0.2
"""Frequency ratio below which the surviving region ends, near 1/a = 0.99, in layers that are not all resolved [-]."""

DATA_SETS = [Path(path).relative_to(RESULTS).as_posix() for path in os.environ["ROCKING_DATA_SETS"].split()]
"""Names of the files of the pulse, relative to `RESULTS`."""


(ERRORS,) = (name for name in DATA_SETS if name.endswith("/restitution-errors.nc"))


def listed(folder: str) -> list[str]:
    return [name for name in DATA_SETS if name.startswith(folder)]


@pytest.mark.parametrize("name", [name for name in listed("spectra/") if name != ERRORS])
def test_cube_is_consistent_and_answers_as_the_solver_at_each_angle(name: str) -> None:
    cube = read_spectrum(RESULTS / name)
    overturned = cube.outcome.values >= Outcome.OVERTURNED_DIRECTLY
    np.testing.assert_array_equal(np.isnan(cube.peak_rotation.values), overturned)
    assert np.all(cube.exceeded_alpha.values[overturned] == 1)
    np.testing.assert_array_equal(cube.peak_rotation.values > 1, (cube.exceeded_alpha.values == 1) & ~overturned)
    assert np.isfinite(cube.interpolation_error.values).any()
    rows, columns = (np.linspace(0, n - 1, 12).astype(int) for n in cube.peak_rotation.shape[1:])
    part = cube.isel(slenderness=rows, frequency_ratio=columns)
    solved = peak_response(
        stored_pulse(cube),
        slenderness=part.slenderness.values[:, None],
        frequency_ratio=part.frequency_ratio.values,
        restitution=float(cube.restitution),
        alpha=part.alpha.values[:, None, None],
    )
    # 1e-6: chatter magnifies the rounding by which two processors differ
    np.testing.assert_allclose(part.peak_rotation, solved.peak_rotation, rtol=1e-6)
    np.testing.assert_array_equal(part.outcome, solved.outcome)


def test_errors_between_cubes_are_those_of_these_cubes() -> None:
    errors = read_dataset(RESULTS / ERRORS)
    cubes = [read_spectrum(RESULTS / name) for name in listed("spectra/") if name != ERRORS]
    assert errors.restitution.values.tolist() == [float(cube.restitution) for cube in cubes]
    assert errors.attrs["cubes_content_sha256"].split() == [cube.attrs["content_sha256"] for cube in cubes]
    assert errors.sizes == {"restitution": len(cubes), **cubes[0].sizes}


@pytest.mark.parametrize("name", listed("overturning/"))
def test_outcome_changes_across_each_boundary_as_its_file_states(name: str) -> None:
    stored = read_dataset(RESULTS / name)
    assert stored.row_size.sum() == stored.sizes["point"]
    assert stored.chord_error <= CHORD
    for alpha in np.unique(stored.alpha):
        curves = curves_at(stored, alpha)
        # a curve that continues an outline repeats a point of the curve before it
        repeated = np.cumsum(curves.row_size.values)[:-1][np.diff(curves.outline.values) == 0]
        points = np.delete(np.arange(curves.sizes["point"]), repeated)
        points = left = points[:: max(1, points.size // VERTICES)]
        left = left[~_as_stated(curves, left, STEPS[0], STEPS[0])]
        assert left.size < 0.3 * points.size
        # after many impacts regions lie in layers, some thinner than a millionth and a few than the smallest step
        for step in STEPS[1:]:
            left = left[~_as_stated(curves, left, step, step)]
        resolved = stored.thinnest_uncounted_region <= LAYERS[0]
        at_tip = curves.frequency_ratio.values[left] < TIP
        assert left[~at_tip].size < (0.05 if resolved else 0.08) * points.size
        assert left.size < 0.08 * points.size
        for step in LAYERS:
            if step <= max(stored.thinnest_uncounted_region, LAYERS[0]):
                left = left[~_as_stated(curves, left, STEPS[-1], step)]
        at_tip = curves.frequency_ratio.values[left] < TIP
        assert left[~at_tip].size < 0.02 * points.size
        assert left.size < 0.05 * points.size


def _as_stated(curves: xr.Dataset, points: NDArray[np.intp], own: float, other: float) -> NDArray[np.bool_]:
    """At some points, whether the outcomes that the file states are met beside the curve, its own at a distance `own`.

    A point lies on a line of the grid along which the outcome changes, so the distances in 1/a or in log omega do.
    """
    region, neighbour = (np.repeat(_codes(curves, side), curves.row_size)[points] for side in ("", "neighbour_"))
    met = np.zeros(points.size, dtype=np.bool_)
    both = own == other  # the two points serve for either orientation of the curve
    for along_slenderness, sign in itertools.product((1.0, 0.0), (1.0,) if both else (1.0, -1.0)):
        unmet = np.flatnonzero(~met)
        distance = sign * np.array([[own], [-other]])
        outcomes = region_code(
            peak_response(
                stored_pulse(curves),
                slenderness=curves.slenderness.values[points[unmet]] + along_slenderness * distance,
                frequency_ratio=curves.frequency_ratio.values[points[unmet]]
                * np.exp((1.0 - along_slenderness) * distance),
                restitution=float(curves.restitution),
                alpha=float(curves.alpha[0]),
            )
        )
        expected = np.stack([region[unmet], neighbour[unmet]])
        met[unmet] = (outcomes == expected).all(axis=0) | (both & (outcomes == expected[::-1]).all(axis=0))
    return met


def _codes(curves: xr.Dataset, side: str) -> NDArray[np.int64]:
    """The outcome that a file states on one side of each curve, as `region_code`."""
    return outcome_codes(curves[f"{side}outcome"].values, curves[f"{side}impacts"].values)


@pytest.mark.parametrize("name", listed("overturning/sine/"))
def test_traced_boundaries_agree_with_the_closed_forms(name: str) -> None:
    curves = curves_at(read_dataset(RESULTS / name), 0.0)
    assert np.isfinite(curves.closed_form_difference).any()
    other = np.abs(curves.closed_form_difference.values) >= 1e-9
    # the outer ends of overturning after one impact are stored; near its tip a gap has ends between them
    assert other.sum() <= 0.01 * curves.sizes["point"]
    s, omega, eta = curves.slenderness.values[other], curves.frequency_ratio.values[other], float(curves.restitution)
    beside = [
        np.fmax(case_1_1_margin(1 / end, omega, eta), case_1_2_margin(1 / end, omega, eta)) > 0.0
        for end in (s - 1e-9, s + 1e-9)
    ]
    assert (beside[0] != beside[1]).all()
    # a point halfway between the two branches overturns, so the closed forms are not vacuous; below eta = 0.63 there
    # are none at this frequency
    frequency_ratio, restitution = 3.0, float(curves.restitution)
    middle = overturning_amplitudes(frequency_ratio, restitution)
    a = 0.5 * (middle.overturns_from + middle.survives_again)
    if restitution < 0.63:
        assert np.isnan(a)
        a = 1.01 * middle.direct
    assert peak_response("sine", slenderness=1 / a, frequency_ratio=frequency_ratio, restitution=restitution).overturned
