"""Answers from a cube: the right fate, a bound that holds, and the solver wherever the cube cannot promise."""

import numpy as np
import pytest

import rocking.lookup
from rocking.bounded_response import SOLVER_ERROR, solve_with_bound
from rocking.cube import write_dataset
from rocking.errors import DatasetError, InvalidArgumentError, OutsideCubeError
from rocking.lookup import SAFETY, open_cube
from rocking.response import Outcome
from rocking.solve import peak_response
from rocking.sweep import spectrum

ETA = 0.85


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    made = spectrum(
        "sine",
        restitution=ETA,
        slenderness=np.linspace(0.05, 0.95, 91),
        frequency_ratio=np.geomspace(0.5, 12.0, 91),
    )
    path = tmp_path_factory.mktemp("cube") / "eta-0.85.nc"
    write_dataset(made, path)
    return path


@pytest.fixture(scope="module")
def cube(path):
    return open_cube(path)


def questions(count, seed=5):
    rng = np.random.default_rng(seed)
    frequency_ratio = np.exp(rng.uniform(np.log(0.5), np.log(12.0), count))
    return {"slenderness": rng.uniform(0.05, 0.95, count), "frequency_ratio": frequency_ratio}


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-6])
def test_fate_is_right_and_the_bound_holds(cube, tolerance):
    asked = questions(20_000)
    found = cube.response(**asked, tolerance=tolerance)
    truth = peak_response("sine", **asked, restitution=ETA)
    np.testing.assert_array_equal(found.outcome, truth.outcome)
    np.testing.assert_array_equal(found.impacts, truth.impacts)
    np.testing.assert_array_equal(found.exceeded_alpha, truth.exceeded_alpha)
    np.testing.assert_array_equal(found.overturned, truth.overturned)
    stands = ~truth.overturned
    error = np.abs(found.peak_rotation - truth.peak_rotation)[stands]
    assert np.all(error <= found.error_bound[stands])
    from_cube = found.source == "cube"
    assert np.all(found.error_bound[from_cube & stands] <= tolerance)
    assert np.isnan(found.error_bound[~stands]).all()
    assert from_cube[~stands].mean() > 0.8  # where all blocks around overturn alike, no tolerance is needed
    assert from_cube.mean() > (0.5 if tolerance > 1e-5 else 0.2)  # a coarse cube still answers most


def test_method_cube_is_refused_or_right(cube):
    asked = questions(300, seed=6)
    refused = 0
    for s, w in zip(*asked.values(), strict=True):
        try:
            found = cube.response(slenderness=s, frequency_ratio=w, method="cube")
        except OutsideCubeError as error:
            assert error.parameter in ("method", "tolerance")  # noqa: PT017  (many points in one test)
            refused += 1
            continue
        truth = peak_response("sine", slenderness=s, frequency_ratio=w, restitution=ETA)
        assert found.source == "cube"
        assert found.outcome == truth.outcome
        assert truth.overturned or abs(found.peak_rotation - truth.peak_rotation) <= found.error_bound <= 1e-4
    assert 0 < refused < 150


@pytest.mark.parametrize(
    ("question", "parameter"),
    [
        ({"slenderness": 0.01, "frequency_ratio": 3.0}, "slenderness"),
        ({"slenderness": 0.96, "frequency_ratio": 3.0}, "slenderness"),
        ({"slenderness": 0.5, "frequency_ratio": 12.5}, "frequency_ratio"),
        ({"slenderness": 0.5, "frequency_ratio": 3.0, "alpha": 0.3}, "alpha"),
        ({"slenderness": 0.5, "frequency_ratio": 6.0, "tolerance": 1e-13}, "tolerance"),
        ({"slenderness": 1 / 1.42727, "frequency_ratio": 3.0}, "method"),  # beside the first golden threshold
    ],
)
def test_what_a_cube_cannot_answer_names_the_reason(cube, question, parameter):
    with pytest.raises(OutsideCubeError) as caught:
        cube.response(**question, method="cube")
    assert caught.value.parameter == parameter


def test_outside_the_cube_the_solver_answers(cube):
    found = cube.response(slenderness=[0.01, 0.5], frequency_ratio=[3.0, 40.0])
    truth = peak_response("sine", slenderness=[0.01, 0.5], frequency_ratio=[3.0, 40.0], restitution=ETA)
    assert list(found.source) == ["solver", "solver"]
    np.testing.assert_array_equal(found.peak_rotation, truth.peak_rotation)


def test_method_solver_never_reads_the_cube(cube):
    asked = questions(50)
    found = cube.response(**asked, method="solver")
    np.testing.assert_array_equal(found.peak_rotation, peak_response("sine", **asked, restitution=ETA).peak_rotation)
    assert set(found.source) == {"solver"}


@pytest.mark.parametrize("method", rocking.lookup.METHODS)
def test_from_slenderness_one_on_nothing_moves(cube, method):
    found = cube.response(slenderness=[1.0, 1.5, 1e308], frequency_ratio=[1.0, 99.0, 1e-3], method=method)
    assert set(found.outcome) == {Outcome.NO_UPLIFT}
    np.testing.assert_array_equal(found.peak_rotation, 0.0)
    np.testing.assert_array_equal(found.error_bound, 0.0)


def test_shapes_broadcast(cube):
    found = cube.response(slenderness=np.linspace(0.3, 0.9, 4)[:, None], frequency_ratio=[1.0, 2.0, 3.0])
    assert found.peak_rotation.shape == found.source.shape == (4, 3)
    alone = cube.response(slenderness=0.3, frequency_ratio=1.0)
    assert alone.peak_rotation.shape == alone.outcome.shape == ()
    assert alone.outcome == found.outcome[0, 0]
    assert cube.response(slenderness=[], frequency_ratio=[]).peak_rotation.shape == (0,)


@pytest.mark.parametrize(
    ("wrong", "parameter"),
    [
        ({"slenderness": 0.0}, "slenderness"),
        ({"slenderness": np.nan}, "slenderness"),
        ({"slenderness": np.inf}, "slenderness"),
        ({"frequency_ratio": -1.0}, "frequency_ratio"),
        ({"tolerance": -1e-9}, "tolerance"),
        ({"method": "guess"}, "method"),
    ],
)
def test_wrong_questions_are_refused(cube, wrong, parameter):
    with pytest.raises(InvalidArgumentError) as caught:
        cube.response(**({"slenderness": 0.5, "frequency_ratio": 3.0} | wrong))
    assert caught.value.parameter == parameter


def test_solver_bound_grows_beside_a_separatrix():
    falls_from = 3.980175  # golden table, sine, omega 5, eta 0.85: to 1e-6
    slenderness = 1.0 / (falls_from - np.array([1.0, 1e-2, 1e-4]))
    found = solve_with_bound("sine", slenderness=slenderness, frequency_ratio=5.0, restitution=ETA, alpha=None)
    assert np.all(found.outcome == Outcome.SAFE)
    assert np.all(np.diff(found.error_bound) > 0)
    assert np.all(found.error_bound >= SOLVER_ERROR * found.peak_rotation)


def test_bound_is_the_measured_error_times_the_safety_factor(cube, path):
    stored = rocking.lookup.read_spectrum(path)["interpolation_error"].values[0]
    i, j = np.argwhere(np.isfinite(stored))[100]
    s, w = cube.slenderness[i : i + 2].mean(), np.sqrt(cube.frequency_ratio[j] * cube.frequency_ratio[j + 1])
    found = cube.response(slenderness=s, frequency_ratio=w, tolerance=1.0, method="cube")
    assert found.error_bound == SAFETY * stored[i, j] + SOLVER_ERROR


def test_uneven_axis_is_refused(tmp_path):
    uneven = spectrum(
        "sine", restitution=ETA, slenderness=[0.1, 0.2, 0.3, 0.5], frequency_ratio=np.geomspace(1.0, 8.0, 4)
    )
    write_dataset(uneven, tmp_path / "uneven.nc")
    with pytest.raises(DatasetError, match="slenderness"):
        open_cube(tmp_path / "uneven.nc")


def test_missing_and_damaged_files_say_so(tmp_path, path):
    with pytest.raises(DatasetError, match="no such data set"):
        open_cube(tmp_path / "none.nc")
    damaged = tmp_path / "damaged.nc"
    damaged.write_bytes(path.read_bytes()[:2000])
    with pytest.raises(DatasetError, match="damaged"):
        open_cube(damaged)
