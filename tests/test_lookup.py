"""Answers from a cube: the right fate, a bound that holds, and the solver wherever the cube cannot promise."""

import shutil
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from threading import Thread

import numpy as np
import pytest

import rocking.lookup
from rocking.boundary import overturning_boundary
from rocking.boundary_cells import crossed_cells
from rocking.bounded_response import SOLVER_ERROR, solve_with_bound
from rocking.cube import NO_STENCIL, read_spectrum, write_dataset
from rocking.errors import DatasetError, InvalidArgumentError, OutsideCubeError
from rocking.interpolation import LEVELS
from rocking.lookup import SAFETY
from rocking.lookup_open import open_cube
from rocking.response import Outcome
from rocking.solve import peak_response
from rocking.sweep import spectra, spectrum
from rocking.sweep_layer import largest_around

ETA = 0.85
GRID = {"slenderness": np.linspace(0.05, 0.95, 91), "frequency_ratio": np.geomspace(0.5, 12.0, 91)}
ETAS, ANGLES = np.array([0.80, 0.83, 0.85, 0.88, 0.90, 0.94]), np.radians([0.0, 5.0, 10.0, 15.0, 20.0])


def crossed(eta, alpha):
    """Cells that a boundary crosses."""
    curves = overturning_boundary("sine", restitution=eta, alpha=alpha or None, nodes=101)
    curves["alpha"] = "curve", np.full(curves.sizes["curve"], alpha)
    return crossed_cells(curves, alpha, *GRID.values())


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    made = spectrum("sine", restitution=ETA, barred=crossed(ETA, 0.0)[None, None], **GRID)
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
                count, below = LEVELS[code]
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


def test_a_cube_is_opened_by_its_address_too(path):
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(SimpleHTTPRequestHandler, directory=path.parent))
    Thread(target=server.serve_forever, daemon=True).start()
    try:
        address = f"http://127.0.0.1:{server.server_port}"
        fetched = open_cube(f"{address}/{path.name}")
        asked = questions(200)
        here, there = (one.response(**asked) for one in (open_cube(path), fetched))
        np.testing.assert_array_equal(here.peak_rotation, there.peak_rotation)
        with pytest.raises(DatasetError, match="cannot be fetched"):
            open_cube(f"{address}/none.nc")
    finally:
        server.shutdown()
        server.server_close()


def test_folders_that_hold_no_cubes_or_unlike_ones_are_refused(folder, path, tmp_path):
    with pytest.raises(DatasetError, match="no spectrum cubes"):
        open_cube(tmp_path)
    shutil.copy(folder / "eta-0.80.nc", tmp_path)
    shutil.copy(path, tmp_path / "eta-0.85.nc")
    with pytest.raises(DatasetError, match="different pulses or grids"):
        open_cube(tmp_path)


def test_no_cell_that_a_boundary_crosses_is_interpolated(path):
    stencil = read_spectrum(path)["stencil"].values[0, :-1, :-1]
    curves = overturning_boundary(
        "sine", restitution=ETA, nodes=301, slenderness=(0.05, 0.95), frequency_ratio=(0.5, 12.0)
    )
    row = np.searchsorted(GRID["slenderness"], curves.slenderness.values) - 1
    column = np.searchsorted(GRID["frequency_ratio"], curves.frequency_ratio.values) - 1
    inside = (row >= 0) & (column >= 0) & (row < stencil.shape[0]) & (column < stencil.shape[1])
    assert inside.sum() > 500
    # points of a finer tracing; a few sit on the edge of a cell or belong to islands that the coarse one does not see
    assert (stencil[row[inside], column[inside]] == -1).mean() > 0.97


def test_largest_around_spreads_errors_and_keeps_what_is_unknown():
    errors = np.zeros((1, 5, 6))
    errors[0, 2, 3], errors[0, 2, 4] = 7.0, np.nan
    found = largest_around(errors)[0]
    assert np.isnan(found[2, 4])
    assert np.isnan(found).sum() == 1
    expected = np.zeros((5, 6))
    expected[1:4, 2:5] = 7.0
    expected[2, 4] = np.nan
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-6])
def test_fate_is_right_and_the_bound_holds(cube, tolerance):
    asked = questions(20_000)
    found = cube.response(**asked, tolerance=tolerance)
    truth = peak_response("sine", **asked, restitution=ETA)
    np.testing.assert_array_equal(found.outcome, truth.outcome)
    counted = (found.impacts >= 0) & ~truth.chatter
    np.testing.assert_array_equal(found.impacts[counted], truth.impacts[counted])
    assert counted.mean() > 0.9
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
    stored = read_spectrum(path)
    error = stored["interpolation_error"].values[0]
    i, j = np.argwhere(error > 0.0)[100]
    s, w = (stored[name].values for name in ("slenderness", "frequency_ratio"))
    found = cube.response(slenderness=s[i : i + 2].mean(), frequency_ratio=np.sqrt(w[j] * w[j + 1]), tolerance=1.0)
    assert found.source == "cube"
    assert found.error_bound == pytest.approx(SAFETY * float(error[i, j]) + SOLVER_ERROR, rel=1e-12)


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
    asked = {"slenderness": rng.uniform(0.3, 0.7, 2000), "frequency_ratio": rng.uniform(6.0, 11.8, 2000)}
    found = open_cube(tmp_path / "uneven.nc").response(**asked)
    truth = peak_response("sine", **asked, restitution=ETA)
    from_cube = found.source == "cube"
    assert from_cube.mean() > 0.7
    np.testing.assert_array_equal(found.outcome, truth.outcome)
    error = np.abs(found.peak_rotation - truth.peak_rotation)[~truth.overturned]
    assert (error <= found.error_bound[~truth.overturned]).all()


def test_missing_and_damaged_files_say_so(tmp_path, path):
    with pytest.raises(DatasetError, match="no such data set"):
        open_cube(tmp_path / "none.nc")
    damaged = tmp_path / "damaged.nc"
    damaged.write_bytes(path.read_bytes()[:2000])
    with pytest.raises(DatasetError, match="damaged"):
        open_cube(damaged)
