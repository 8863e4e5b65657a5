"""Cubes of several restitutions and angles: error bounds between slices, missing slices and large intervals."""

import shutil

import numpy as np
import pytest

from rocking._base.errors import DatasetError, InvalidArgumentError, OutsideCubeError
from rocking._datasets.cube import read_spectrum, write_dataset
from rocking._interpolation.stencils import PEAK, SQUARED
from rocking._lookup.cube import Cube, open_cube
from rocking._lookup.cube_slice import slice_of
from rocking._solver.peak_response import peak_response
from rocking._spectra.cubes import spectra, spectrum
from tests.lookup_grid import GRID, assert_answers_are_right, crossed, random_points
from tests.sampling import number

ETAS, ANGLES = np.array([0.80, 0.83, 0.85, 0.88, 0.90, 0.94]), np.radians([0.0, 5.0, 10.0, 15.0, 20.0])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sine")
    barred = np.array([[crossed(eta, float(alpha)) for alpha in ANGLES] for eta in ETAS])
    for cube in spectra("sine", restitution=ETAS, alpha=ANGLES, barred=barred, **GRID):
        write_dataset(cube, folder / f"eta-{float(cube.restitution):.2f}.nc")
    return folder


@pytest.mark.parametrize(("between_etas", "between_angles"), [(False, True), (True, False), (True, True)])
def test_bounds_hold_between_restitutions_and_angles(folder, between_etas, between_angles):
    rng = np.random.default_rng(8)
    points = random_points(number(3_000, 20_000), seed=9)
    n = len(points["slenderness"])
    points["restitution"] = rng.uniform(ETAS[0], ETAS[-1], n) if between_etas else rng.choice(ETAS, n)
    points["alpha"] = rng.uniform(ANGLES[0], ANGLES[-1], n) if between_angles else rng.choice(ANGLES, n)
    for tolerance, share in ((1e-4, 0.6), (1e-6, 0.45)):
        assert_answers_are_right(open_cube(folder), points, tolerance, share, 0.5)


def test_errors_between_slices_are_measured_in_the_middle(tmp_path):
    """They are largest there; on this grid the errors within the cells are small in comparison."""
    fine = {"slenderness": np.linspace(0.3, 0.4, 41), "frequency_ratio": np.geomspace(9.0, 10.0, 41)}
    etas = [0.5, 0.6, 0.7, 0.8, 0.9]
    for cube in spectra("sine", restitution=etas, **fine):
        write_dataset(cube, tmp_path / f"eta-{float(cube.restitution):.2f}.nc")
    lower, upper = (read_spectrum(tmp_path / f"eta-{eta:.2f}.nc") for eta in (0.7, 0.8))
    rows = 0.5 * (fine["slenderness"][1:] + fine["slenderness"][:-1])
    columns = np.sqrt(fine["frequency_ratio"][1:] * fine["frequency_ratio"][:-1])
    points = {"slenderness": rows[:, None], "frequency_ratio": columns, "restitution": 0.75}
    found = open_cube(tmp_path).response(**points, absolute_tolerance=1.0)
    expected = peak_response("sine", **points)
    between = lower.restitution_error.values[0, :-1, :-1]
    within = np.maximum(*(cube.interpolation_error.values[0, :-1, :-1] for cube in (lower, upper)))
    counts = (found.source == "cube") & ~expected.overturned & (within < 0.03 * between)
    assert counts.sum() > 40
    error = np.abs(found.peak_rotation - expected.peak_rotation)[counts]
    assert (error <= 1.1 * between[counts]).all()


def test_bounds_hold_at_a_crease_near_a_slice(tmp_path):
    """At 1/a = 0.887 and omega = 14.64 the mode of the peak changes at eta = 0.9774: the middle does not show it."""
    grid = {"slenderness": np.linspace(0.884, 0.892, 9), "frequency_ratio": np.geomspace(13.94, 15.55, 7)}
    pulse, etas = "mavroeidis_papageorgiou", [0.90, 0.92, 0.94, 0.96, 0.98, 1.0]
    for cube in spectra(pulse, restitution=etas, **grid):
        write_dataset(cube, tmp_path / f"eta-{float(cube.restitution):.2f}.nc")
    random = np.random.default_rng(5)
    points = {
        "slenderness": random.uniform(0.885, 0.891, 5000),
        "frequency_ratio": np.exp(random.uniform(np.log(14.2), np.log(15.2), 5000)),
        "restitution": random.uniform(0.96, 0.98, 5000),
    }
    case = {"slenderness": 0.8872271, "frequency_ratio": 14.640226, "restitution": 0.9779474}
    points = {name: np.append(values, case[name]) for name, values in points.items()}
    assert_answers_are_right(open_cube(tmp_path), points, 1e-3, 0.2)


def test_bounds_hold_where_one_slice_of_a_cell_has_another_form():
    """At eta = 0.90 and 15 degrees the peak is interpolated, on the other slices (1 - peak)^2."""
    grid = {"slenderness": 0.0775 + 0.0025 * np.arange(4), "frequency_ratio": np.geomspace(0.2, 15.0, 241)[224:228]}
    etas, angles = np.array([0.90, 0.92, 0.94, 0.96]), np.radians([15.0, 20.0, 25.0, 30.0])
    slices = [slice_of(cube) for cube in spectra("sine", restitution=etas, alpha=angles, **grid)]
    forms = np.array([one.layers.at(range(4))["stencil"][:, 1, 1] for one in slices])
    assert forms.ravel().tolist() == [PEAK] + 15 * [SQUARED]
    random, n = np.random.default_rng(7), 1000
    points = {
        "slenderness": random.uniform(0.08, 0.0825, n),
        "frequency_ratio": random.uniform(11.4525, 11.6603, n),
        "restitution": random.uniform(0.92, 0.96, n),
        "alpha": random.uniform(angles[0], angles[-1], n),
    }
    cube = Cube("sine", etas, slices.__getitem__)
    assert_answers_are_right(cube, points, 1e-4, 0.99)
    # from 0.90 on the two slices beside the points differ in form between the angles: no error of either is known
    points["restitution"] = random.uniform(0.9001, 0.9199, n)
    assert set(cube.response(**points).source) == {"solver"}
    points["alpha"] = angles[0]
    assert_answers_are_right(cube, points, 1e-4, 0.99)


def test_solver_is_used_only_where_a_missing_cube_is_needed(folder, tmp_path):
    for eta in ETAS[:-1]:
        shutil.copy(folder / f"eta-{eta:.2f}.nc", tmp_path)
    point = {"slenderness": 0.4, "frequency_ratio": 9.0}
    whole, part = open_cube(folder), open_cube(tmp_path)
    assert part.response(**point, restitution=0.87).source == "cube"  # from 0.83, 0.85, 0.88, 0.90
    assert whole.response(**point, restitution=0.89).source == "cube"
    assert part.response(**point, restitution=0.89).source == "solver"  # 0.94 is missing
    assert whole.used(np.array([0.86, 0.81, 0.99])) == [0, 2, 1, 3, 4]
    assert whole.used(np.array([0.92])) == [4, 2, 3, 5]
    assert whole.used(np.array([0.83, 0.79])) == [1]


def test_a_cube_names_the_restitutions_from_which_the_interval_above_it_is_interpolated(folder):
    for k, (first, last) in enumerate([(0, 4), (0, 4), (1, 5), (2, 6), (2, 6), (5, 6)]):
        cube = read_spectrum(folder / f"eta-{ETAS[k]:.2f}.nc")
        np.testing.assert_array_equal(np.atleast_1d(cube.attrs["restitution_slices"]), ETAS[first:last])


@pytest.mark.parametrize(
    ("etas", "angles", "points"),
    [
        ([0.50, 0.62, 0.70], [0.0, 0.3], {"restitution": 0.6, "alpha": 0.0}),
        ([0.50, 0.60, 0.70], [0.0, 0.5], {"restitution": 0.6, "alpha": 0.2}),
    ],
)
def test_large_intervals_are_not_interpolated(tmp_path, etas, angles, points):
    coarse = {"slenderness": np.linspace(0.3, 0.6, 13), "frequency_ratio": np.geomspace(8.0, 12.0, 13)}
    for cube in spectra("sine", restitution=etas, alpha=angles, **coarse):
        write_dataset(cube, tmp_path / f"eta-{float(cube.restitution):.2f}.nc")
    cube, place = open_cube(tmp_path), {"slenderness": 0.46, "frequency_ratio": 10.1, "absolute_tolerance": 1e-2}
    assert cube.response(**place, **points).source == "solver"
    assert cube.response(**place, restitution=0.66, alpha=0.0).source == "cube"
    with pytest.raises(OutsideCubeError, match="too far apart"):
        cube.response(**place, **points, method="cube")


def test_bounds_hold_between_uneven_slices(tmp_path):
    """In the last, wide interval the weights of the angles are large and of both signs."""
    coarse = {"slenderness": np.linspace(0.2, 0.35, 7), "frequency_ratio": np.geomspace(9.0, 27.0, 20)}
    etas, angles = [0.5, 0.6, 0.7, 0.8], np.radians([10.0, 15.0, 20.0, 45.0])
    for cube in spectra("cosine", restitution=etas, alpha=angles, **coarse):
        write_dataset(cube, tmp_path / f"eta-{float(cube.restitution):.2f}.nc")
    rng, n = np.random.default_rng(3), number(3_000, 20_000)
    points = {"slenderness": rng.uniform(0.2, 0.35, n), "frequency_ratio": rng.uniform(9.0, 27.0, n)}
    points |= {"restitution": rng.uniform(0.5, 0.8, n), "alpha": rng.uniform(angles[2], angles[3], n)}
    assert_answers_are_right(open_cube(tmp_path), points, 1e-2, 0.5)


def test_restitution_is_required_with_several_cubes(folder):
    with pytest.raises(InvalidArgumentError, match="restitution"):
        open_cube(folder).response(slenderness=0.4, frequency_ratio=9.0)
    with pytest.raises(OutsideCubeError, match=r"0\.80, 0\.94"):
        open_cube(folder).response(slenderness=0.4, frequency_ratio=9.0, restitution=0.99, method="cube")


def test_folders_without_cubes_or_with_different_grids_are_refused(folder, tmp_path):
    with pytest.raises(DatasetError, match="no spectrum cubes"):
        open_cube(tmp_path)
    shutil.copy(folder / "eta-0.80.nc", tmp_path)
    other = GRID | {"frequency_ratio": GRID["frequency_ratio"][:8]}
    write_dataset(spectrum("sine", restitution=0.85, **other), tmp_path / "eta-0.85.nc")
    with pytest.raises(DatasetError, match="different pulses or grids"):
        open_cube(tmp_path)
