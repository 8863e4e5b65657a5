"""Responses from one cube: correct outcomes, error bounds that hold, and the solver where no bound is known."""

import math
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from threading import Thread

import numpy as np
import pytest

import rocking._lookup.cube
from rocking._base.errors import DatasetError, InvalidArgumentError, OutsideCubeError
from rocking._base.quantities import FREQUENCY_RATIO, SLENDERNESS
from rocking._datasets.cube import read_spectrum, write_dataset
from rocking._lookup.cube import Cube, open_cube
from rocking._lookup.cube_slice import slice_of
from rocking._model.response import Outcome
from rocking._solver.bounded_response import SOLVER_ERROR, solve_with_bound
from rocking._solver.peak_response import peak_response
from rocking._spectra.cubes import spectrum
from tests.lookup_grid import GRID, assert_answers_are_right, crossed, random_points
from tests.sampling import number

ETA = 0.85


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    made = spectrum("sine", restitution=ETA, barred=crossed(ETA, 0.0)[None, None], **GRID)
    path = tmp_path_factory.mktemp("cube") / "eta-0.85.nc"
    write_dataset(made, path)
    return path


@pytest.fixture(scope="module")
def cube(path):
    return open_cube(path)


def test_cube_is_opened_by_its_address(path):
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(SimpleHTTPRequestHandler, directory=path.parent))
    Thread(target=server.serve_forever, daemon=True).start()
    try:
        address = f"http://127.0.0.1:{server.server_port}"
        fetched = open_cube(f"{address}/{path.name}")
        points = random_points(200)
        here, there = (one.response(**points) for one in (open_cube(path), fetched))
        np.testing.assert_array_equal(here.peak_rotation, there.peak_rotation)
        with pytest.raises(DatasetError, match="cannot be fetched"):
            open_cube(f"{address}/none.nc")
    finally:
        server.shutdown()
        server.server_close()


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-6])
def test_outcome_is_correct_and_the_bound_holds(cube, tolerance):
    points = random_points(number(5_000, 20_000))
    # a coarse cube is sufficient for most points
    assert_answers_are_right(cube, points, tolerance, 0.5 if tolerance > 1e-5 else 0.2, 0.8)
    found = cube.response(**points, absolute_tolerance=tolerance)
    expected = peak_response("sine", **points, restitution=ETA)
    np.testing.assert_array_equal(found.outcome, expected.outcome)
    from_cube, survives = found.source == "cube", ~expected.overturned
    assert np.all(found.error_bound[from_cube & survives] <= tolerance)
    assert np.isnan(found.error_bound[~survives]).all()
    assert from_cube[~survives].mean() > 0.8  # where all corners overturn in the same way there is no error


COUNTED = {
    "many small impacts": ("sine", 0.86, 0.0, np.arange(0.85, 0.9755, 0.001), (0.88, 1.10)),
    "overturning after them": ("c2", 0.86, math.radians(10.0), np.arange(0.92, 0.9405, 0.001), (0.50, 0.64)),
    "low restitution": ("sine", 0.50, 0.0, np.arange(0.85, 0.9755, 0.001), (0.5, 0.6)),
}
"""Pulse, restitution, angle [rad], rows and window of columns where nodes agree on the number of impacts and the truth
between them does not."""


@pytest.mark.parametrize("case", COUNTED)
def test_a_number_of_impacts_is_certain_or_absent(case):
    pulse, eta, alpha, rows, window = COUNTED[case]
    columns = np.geomspace(0.2, 15.0, 241)  # those of the small atlas
    columns = columns[(columns > window[0]) & (columns < window[1])]
    made = slice_of(spectrum(pulse, restitution=eta, alpha=[alpha], slenderness=rows, frequency_ratio=columns))
    rng, n = np.random.default_rng(3), number(30_000, 100_000)
    points = {"slenderness": rng.uniform(rows[0], rows[-1], n), "frequency_ratio": rng.uniform(*window, n)}
    points["slenderness"][0], points["frequency_ratio"][0] = 0.9604342476543689, 0.9827455534145197  # 33, not 34
    points |= {"restitution": eta, "alpha": alpha}
    cube = Cube(pulse, np.array([eta]), [made].__getitem__)
    found = assert_answers_are_right(cube, points, 1e-4, 0.05)
    assert found["counted"] < found["answered"]


@pytest.mark.parametrize(
    ("point", "parameter"),
    [
        ({"slenderness": 0.01, "frequency_ratio": 3.0}, "slenderness"),
        ({"slenderness": 0.96, "frequency_ratio": 3.0}, "slenderness"),
        ({"slenderness": 0.5, "frequency_ratio": 12.5}, "frequency_ratio"),
        ({"slenderness": 0.5, "frequency_ratio": 3.0, "alpha": 0.3}, "alpha"),
        ({"slenderness": 0.5, "frequency_ratio": 6.0, "absolute_tolerance": 1e-13}, "absolute_tolerance"),
        ({"slenderness": 1 / 1.42727, "frequency_ratio": 3.0}, "method"),  # beside the first golden threshold
    ],
)
def test_method_cube_names_the_parameter_that_prevents_a_response(cube, point, parameter):
    with pytest.raises(OutsideCubeError) as caught:
        cube.response(**point, method="cube")
    assert caught.value.parameter == parameter


def test_solver_is_used_outside_of_the_cube(cube):
    found = cube.response(slenderness=[0.01, 0.5], frequency_ratio=[3.0, 40.0])
    expected = peak_response("sine", slenderness=[0.01, 0.5], frequency_ratio=[3.0, 40.0], restitution=ETA)
    assert list(found.source) == ["solver", "solver"]
    np.testing.assert_array_equal(found.peak_rotation, expected.peak_rotation)


def test_method_solver_does_not_use_the_cube(cube):
    points = random_points(50)
    found = cube.response(**points, method="solver")
    np.testing.assert_array_equal(found.peak_rotation, peak_response("sine", **points, restitution=ETA).peak_rotation)
    assert set(found.source) == {"solver"}


@pytest.mark.parametrize("method", rocking._lookup.cube.METHODS)
def test_no_uplift_from_slenderness_one_on(cube, method):
    found = cube.response(slenderness=[1.0, 1.5, 1e308], frequency_ratio=[1.0, 99.0, 1e-3], method=method)
    assert set(found.outcome) == {Outcome.NO_UPLIFT}
    np.testing.assert_array_equal(found.peak_rotation, 0.0)
    np.testing.assert_array_equal(found.error_bound, 0.0)


def test_arguments_broadcast(cube):
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
        ({"absolute_tolerance": -1e-9}, "absolute_tolerance"),
        ({"method": "guess"}, "method"),
    ],
)
def test_invalid_arguments_are_refused(cube, wrong, parameter):
    with pytest.raises(InvalidArgumentError) as caught:
        cube.response(**({"slenderness": 0.5, "frequency_ratio": 3.0} | wrong))
    assert caught.value.parameter == parameter


def test_too_few_nodes_are_refused(tmp_path, path):
    short = read_spectrum(path).isel(slenderness=slice(3))
    write_dataset(short, tmp_path / "short.nc")
    with pytest.raises(DatasetError, match="at least 4 nodes"):
        open_cube(tmp_path / "short.nc")


def test_axes_may_be_spaced_unevenly(tmp_path):
    rows = np.r_[np.linspace(0.3, 0.6, 16), np.linspace(0.6, 0.7, 21)[1:]]
    made = spectrum("sine", restitution=ETA, slenderness=rows, frequency_ratio=np.r_[6.0:9.0:0.1, 9.0:12.0:0.2])
    write_dataset(made, tmp_path / "uneven.nc")
    rng = np.random.default_rng(2)
    points = {"slenderness": rng.uniform(0.3, 0.7, 2000), "frequency_ratio": rng.uniform(6.0, 11.8, 2000)}
    assert_answers_are_right(open_cube(tmp_path / "uneven.nc"), points, 1e-4, 0.7)


def test_cubes_of_other_axes_answer_points_on_their_own_restitution(tmp_path, cube):
    made = spectrum("sine", restitution=0.9, slenderness=np.linspace(0.3, 0.8, 41), frequency_ratio=np.r_[6.0:9.0:0.1])
    write_dataset(made, tmp_path / "other.nc")
    other = open_cube(tmp_path / "other.nc")
    both = Cube("sine", np.array([ETA, 0.9]), [cube.slice_at(0), other.slice_at(0)].__getitem__)
    points, restitution = random_points(2000), np.random.default_rng(4).choice([ETA, 0.9, 0.87], 2000)
    found = both.response(**points, restitution=restitution)
    for eta, alone in ((ETA, cube), (0.9, other), (0.87, None)):
        on = restitution == eta
        part = {name: values[on] for name, values in points.items()}
        method = "solver" if alone is None else "auto"  # slices of other axes are not interpolated between
        expected = (alone or cube).response(**part, restitution=eta, method=method)
        np.testing.assert_array_equal(found.peak_rotation[on], expected.peak_rotation)
        np.testing.assert_array_equal(found.source[on], expected.source)
        assert alone is None or (found.source[on] == "cube").any()


def test_solver_bound_is_the_change_when_all_groups_shrink_together():
    rng = np.random.default_rng(7)
    groups = {"slenderness": rng.uniform(0.1, 0.9, 200), "frequency_ratio": rng.uniform(0.5, 9.0, 200)}
    groups["restitution"] = rng.uniform(0.6, 1.0, 200)
    smaller = {name: value * (1 - SOLVER_ERROR) for name, value in groups.items()}
    found = solve_with_bound("sine", **groups, alpha=0.2)
    peak, beside = (peak_response("sine", **these, alpha=0.2).peak_rotation for these in (groups, smaller))
    expected = SOLVER_ERROR * peak + 3 * np.abs(beside - peak)
    np.testing.assert_allclose(found.error_bound, expected, rtol=1e-12)
    assert np.isfinite(expected).sum() > 100


def test_the_ends_of_the_ranges_are_solved_with_a_bound():
    groups = {"slenderness": 0.5, "frequency_ratio": 5.0, "restitution": 0.8}
    for end in ({"frequency_ratio": FREQUENCY_RATIO.lower}, {"slenderness": SLENDERNESS.lower}, {"restitution": 0.0}):
        found = solve_with_bound("sine", **groups | end, alpha=None)
        assert found.outcome == peak_response("sine", **groups | end).outcome
    with pytest.raises(InvalidArgumentError, match=r"`frequency_ratio` = 1e-10 is"):
        solve_with_bound("sine", **groups | {"frequency_ratio": 1e-10}, alpha=None)
