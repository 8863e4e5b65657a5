"""Cubes of several restitutions and angles as one: bounds that hold between them, levels that are missing or far."""

import shutil

import numpy as np
import pytest

from rocking.datasets.cube import read_spectrum, write_dataset
from rocking.errors import DatasetError, InvalidArgumentError, OutsideCubeError
from rocking.interpolation.stencils import NO_STENCIL, SLICE_STENCILS
from rocking.lookup.open import open_cube
from rocking.solver.peak_response import peak_response
from rocking.spectra.cubes import spectra, spectrum
from tests.lookup_grid import GRID, crossed, questions

ETAS, ANGLES = np.array([0.80, 0.83, 0.85, 0.88, 0.90, 0.94]), np.radians([0.0, 5.0, 10.0, 15.0, 20.0])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Cubes of several restitutions and angles."""
    folder = tmp_path_factory.mktemp("sine")
    barred = np.array([[crossed(eta, float(alpha)) for alpha in ANGLES] for eta in ETAS])
    for cube in spectra("sine", restitution=ETAS, alpha=ANGLES, barred=barred, **GRID):
        write_dataset(cube, folder / f"eta-{float(cube.restitution):.2f}.nc")
    return folder


@pytest.mark.parametrize(("between_etas", "between_angles"), [(False, True), (True, False), (True, True)])
def test_restitution_and_angle_are_interpolated_too(folder, between_etas, between_angles):
    rng = np.random.default_rng(8)
    asked = questions(20_000, seed=9)
    n = len(asked["slenderness"])
    asked["restitution"] = rng.uniform(ETAS[0], ETAS[-1], n) if between_etas else rng.choice(ETAS, n)
    asked["alpha"] = rng.uniform(ANGLES[0], ANGLES[-1], n) if between_angles else rng.choice(ANGLES, n)
    cube = open_cube(folder)
    for tolerance, share in ((1e-4, 0.6), (1e-6, 0.45)):
        found = cube.response(**asked, tolerance=tolerance)
        truth = peak_response("sine", **asked)
        from_cube = found.source == "cube"
        assert from_cube.mean() > share
        np.testing.assert_array_equal(found.outcome, truth.outcome)
        np.testing.assert_array_equal(found.exceeded_alpha, truth.exceeded_alpha)
        stands = from_cube & ~truth.overturned
        error = np.abs(found.peak_rotation - truth.peak_rotation)[stands]
        assert (error <= found.error_bound[stands]).all()
        assert (found.error_bound[stands] <= tolerance).all()
        counted = from_cube & (found.impacts >= 0) & ~truth.chatter
        assert counted.sum() > 0.5 * from_cube.sum()
        np.testing.assert_array_equal(found.impacts[counted], truth.impacts[counted])


def test_impacts_are_told_where_all_nodes_that_serve_agree_in_them(folder):
    """Half-way between two cells of two restitutions and two angles: 16 nodes, more where more levels serve."""
    cubes = [read_spectrum(folder / f"eta-{eta:.2f}.nc") for eta in ETAS]
    rows, columns = (0.5 * (axis[1:] + axis[:-1]) for axis in GRID.values())
    found = open_cube(folder).response(
        slenderness=rows[:, None],
        frequency_ratio=columns,
        restitution=0.5 * (ETAS[1] + ETAS[2]),
        alpha=0.5 * (ANGLES[1] + ANGLES[2]),
        tolerance=1e-2,
    )

    def all_agree(etas, angles):
        nodes = np.array([cubes[e].impacts.values[a] for e in etas for a in angles])
        corners = np.stack([nodes[:, i : i + 90, j : j + 90] for i in (0, 1) for j in (0, 1)])
        return (corners == corners[0, 0]).all(axis=(0, 1))

    from_cube = found.source == "cube"
    every, next_ones = all_agree(range(4), range(4)), all_agree((1, 2), (1, 2))
    told = found.impacts >= 0
    assert told[from_cube & every].all()
    assert not told[from_cube & ~next_ones].any()
    assert (from_cube & every).sum() > 1000
    assert (from_cube & ~next_ones).sum() > 20


def test_errors_between_levels_are_those_in_the_middle_of_the_gap(tmp_path):
    """Where they are largest; those within the cells are next to nothing on this grid."""
    fine = {"slenderness": np.linspace(0.3, 0.4, 21), "frequency_ratio": np.geomspace(9.0, 10.0, 21)}
    etas = [0.5, 0.6, 0.7, 0.8, 0.9]
    for cube in spectra("sine", restitution=etas, **fine):
        write_dataset(cube, tmp_path / f"eta-{float(cube.restitution):.2f}.nc")
    lower, upper = (read_spectrum(tmp_path / f"eta-{eta:.2f}.nc") for eta in (0.7, 0.8))
    rows = 0.5 * (fine["slenderness"][1:] + fine["slenderness"][:-1])
    columns = np.sqrt(fine["frequency_ratio"][1:] * fine["frequency_ratio"][:-1])
    asked = {"slenderness": rows[:, None], "frequency_ratio": columns, "restitution": 0.75}
    found = open_cube(tmp_path).response(**asked, tolerance=1.0)
    truth = peak_response("sine", **asked)
    between = lower.restitution_error.values[0, :-1, :-1]
    within = np.maximum(*(cube.interpolation_error.values[0, :-1, :-1] for cube in (lower, upper)))
    counts = (found.source == "cube") & ~truth.overturned & (within < 0.03 * between)
    assert counts.sum() > 40
    error = np.abs(found.peak_rotation - truth.peak_rotation)[counts]
    assert (error <= 1.1 * between[counts]).all()


def test_a_cube_that_was_made_with_another_neighbour_is_not_interpolated_towards_it(folder, tmp_path):
    for eta in (0.80, 0.85, 0.88, 0.90, 0.94):  # 0.83 is missing
        shutil.copy(folder / f"eta-{eta:.2f}.nc", tmp_path)
    question = {"slenderness": 0.4, "frequency_ratio": 9.0, "restitution": 0.82}
    assert open_cube(folder).response(**question).source == "cube"
    assert open_cube(tmp_path).response(**question).source == "solver"


def test_only_questions_that_need_a_missing_cube_go_without(folder, tmp_path):
    for eta in ETAS[:-1]:
        shutil.copy(folder / f"eta-{eta:.2f}.nc", tmp_path)
    question = {"slenderness": 0.4, "frequency_ratio": 9.0}
    whole, part = open_cube(folder), open_cube(tmp_path)
    assert part.response(**question, restitution=0.87).source == "cube"  # from 0.83, 0.85, 0.88, 0.90
    assert whole.response(**question, restitution=0.89).source == "cube"
    assert part.response(**question, restitution=0.89).source == "solver"  # 0.94 is missing
    assert whole.used(np.array([0.86, 0.81, 0.99])) == [0, 2, 1, 3, 4, 5]
    assert whole.used(np.array([0.83, 0.79])) == [1]


def test_cubes_say_which_levels_serve(folder):
    cubes = [read_spectrum(folder / f"eta-{eta:.2f}.nc") for eta in ETAS]
    for name, axis in (("restitution", ETAS), ("alpha", ANGLES)):
        codes = np.array([cube[f"{name}_levels"].values[:, :-1, :-1] for cube in cubes])
        errors = np.array([cube[f"{name}_error"].values[:, :-1, :-1] for cube in cubes])
        if name == "alpha":
            codes, errors = codes.swapaxes(0, 1), errors.swapaxes(0, 1)
        assert (codes[-1] == NO_STENCIL).all()  # nothing lies above the last
        assert np.isnan(errors[codes == NO_STENCIL]).all()
        assert np.isfinite(errors).any()
        assert len(np.unique(codes)) > 4  # boundaries and creases leave now these and now those
        for lower, gap in enumerate(codes):
            for code in set(gap[gap >= 0].tolist()):
                count, below = SLICE_STENCILS[code]
                assert 0 <= lower - below <= axis.size - count


@pytest.mark.parametrize(
    ("etas", "angles", "asked"),
    [
        ([0.50, 0.62, 0.70], [0.0, 0.3], {"restitution": 0.6, "alpha": 0.0}),
        ([0.50, 0.60, 0.70], [0.0, 0.5], {"restitution": 0.6, "alpha": 0.2}),
    ],
)
def test_levels_far_apart_are_not_interpolated_between(tmp_path, etas, angles, asked):
    coarse = {"slenderness": np.linspace(0.3, 0.6, 13), "frequency_ratio": np.geomspace(8.0, 12.0, 13)}
    for cube in spectra("sine", restitution=etas, alpha=angles, **coarse):
        write_dataset(cube, tmp_path / f"eta-{float(cube.restitution):.2f}.nc")
    cube, place = open_cube(tmp_path), {"slenderness": 0.46, "frequency_ratio": 10.1, "tolerance": 1e-2}
    assert cube.response(**place, **asked).source == "solver"
    assert cube.response(**place, restitution=0.66, alpha=0.0).source == "cube"
    with pytest.raises(OutsideCubeError, match="too far apart"):
        cube.response(**place, **asked, method="cube")


def test_bounds_hold_between_levels_that_lie_unevenly(tmp_path):
    """Beyond the dense ones the weights of the angles are large, and of both signs."""
    coarse = {"slenderness": np.linspace(0.2, 0.35, 7), "frequency_ratio": np.geomspace(9.0, 27.0, 20)}
    etas, angles = [0.5, 0.6, 0.7, 0.8], np.radians([10.0, 15.0, 20.0, 45.0])
    for cube in spectra("cosine", restitution=etas, alpha=angles, **coarse):
        write_dataset(cube, tmp_path / f"eta-{float(cube.restitution):.2f}.nc")
    rng, n = np.random.default_rng(3), 20_000
    asked = {"slenderness": rng.uniform(0.2, 0.35, n), "frequency_ratio": rng.uniform(9.0, 27.0, n)}
    asked |= {"restitution": rng.uniform(0.5, 0.8, n), "alpha": rng.uniform(angles[2], angles[3], n)}
    found = open_cube(tmp_path).response(**asked, tolerance=1e-2)
    truth = peak_response("cosine", **asked)
    from_cube = found.source == "cube"
    assert from_cube.mean() > 0.5
    np.testing.assert_array_equal(found.overturned, truth.overturned)
    assert (np.abs(found.peak_rotation - truth.peak_rotation) <= found.error_bound)[from_cube].all()


def test_several_cubes_want_to_know_the_restitution(folder):
    with pytest.raises(InvalidArgumentError, match="restitution"):
        open_cube(folder).response(slenderness=0.4, frequency_ratio=9.0)
    with pytest.raises(OutsideCubeError, match=r"0\.80, 0\.94"):
        open_cube(folder).response(slenderness=0.4, frequency_ratio=9.0, restitution=0.99, method="cube")


def test_folders_that_hold_no_cubes_or_unlike_ones_are_refused(folder, tmp_path):
    with pytest.raises(DatasetError, match="no spectrum cubes"):
        open_cube(tmp_path)
    shutil.copy(folder / "eta-0.80.nc", tmp_path)
    other = GRID | {"frequency_ratio": GRID["frequency_ratio"][:8]}
    write_dataset(spectrum("sine", restitution=0.85, **other), tmp_path / "eta-0.85.nc")
    with pytest.raises(DatasetError, match="different pulses or grids"):
        open_cube(tmp_path)
