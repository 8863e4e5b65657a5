"""Compiled lookups against their definition in plain Python, on made-up cubes with all kinds of cells."""

from types import SimpleNamespace

import numpy as np
import pytest

from rocking._base.errors import InvalidArgumentError, StoppedError
from rocking._datasets.cube import DIMENSIONS, RESTITUTION_ERROR, VARIABLES, build_spectrum_dataset
from rocking._interpolation.slices import slice_window
from rocking._interpolation.stencils import NO_STENCIL, OVERTURNS, SQUARED
from rocking._lookup.cube import MIN_CHUNK, SAFETY, Cube, Points
from rocking._lookup.cube_slice import slice_of
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.bounded_response import SOLVER_ERROR
from tests.sampling import number

ETAS = np.array([0.70, 0.75, 0.78, 0.85, 0.90, 0.95])
ALPHAS = np.radians([0.0, 4.0, 10.0, 15.0, 22.0])
COUNT = number(400, 2000)
ROWS, COLUMNS = np.cumsum([0.1, *[0.02, 0.05, 0.1] * 5]), np.geomspace(0.5, 12.0, 22)

NAMES = (*VARIABLES, *RESTITUTION_ERROR)


def make_variables(rng):
    """Variables of a cube whose cells overturn in the upper rows, and are rarely without a stencil."""
    shape = len(ALPHAS), len(ROWS), len(COLUMNS)
    overturns = np.broadcast_to((np.arange(len(ROWS)) > 9)[:, None], shape[1:]) & (rng.random(shape) < 0.995)
    stencil = np.where(overturns, OVERTURNS, rng.random(shape) < 0.5)
    stencil[:, :, :11] = np.where(overturns, OVERTURNS, SQUARED)[:, :, :11]  # the same form in all slices
    stencil[rng.random(shape) < 0.01] = NO_STENCIL
    inner = np.zeros(shape, dtype=bool)
    inner[:, 1:-2, 1:-2] = True
    stencil[~inner & (stencil != OVERTURNS)] = NO_STENCIL
    errors = {name: 10.0 ** rng.uniform(-8.0, -5.0, shape) for name in NAMES if name.endswith("_error")}
    for name in ("restitution_error", "alpha_error"):
        errors[name][rng.random(shape) < 0.03] = np.nan
    columns = np.arange(len(COLUMNS))
    return errors | {
        "peak_rotation": 0.5 + 0.6 * rng.random(shape),
        "stencil": stencil,
        "outcome": np.where(overturns, int(Outcome.OVERTURNED_AFTER_IMPACT), int(Outcome.RECOVERS)),
        "impacts": np.broadcast_to(1 + 4 * (columns // 12), shape) + (rng.random(shape) < 0.001),
        "peak_mode": np.broadcast_to(np.where(columns < 18, 0, 11), shape),
    }


@pytest.fixture(scope="module")
def cubes():
    rng = np.random.default_rng(11)
    axes = dict(zip(DIMENSIONS, (ALPHAS, ROWS, COLUMNS), strict=True))
    found = []
    for eta in ETAS:
        made = make_variables(rng)
        variables = {name: made.get(name, np.zeros_like(made["outcome"])) for name in NAMES}
        cube = build_spectrum_dataset(variables, pulse="sine", restitution=eta, axes=axes)
        found.append(cube.assign_attrs(restitution_slices=ETAS, impacts_before_rest=11))
    return found


def window_of(axis, value):
    """First, number and lower one of the slices from which a value is interpolated; None outside of them."""
    below = np.searchsorted(axis, value, side="right") - 1
    if below < 0 or value > axis[-1]:
        return None
    if axis[below] == value:
        return below, 1, below
    return *slice_window(axis.size, below), below


def weights_of(nodes, x):
    return [np.prod([(x - m) / (node - m) for m in nodes if m != node]) for node in nodes]


def impacts_of(cells):
    """The number that all 4 x 8 nodes of all cells have, if it is at most 5 or the peak is on the last arc; else -1."""
    numbers = {int(one) for cell in cells for one in cell.impacts.flat}
    certain = all((mode // 2 == min(numbers)) or min(numbers) <= 5 for cell in cells for mode in cell.modes.flat)
    return min(numbers) if len(numbers) == 1 and certain else -1


def overturning(cells):
    """What is known where one cell at least overturns."""
    kinds = {(int(cell.outcome), int(cell.corner), cell.stencil) for cell in cells}
    if len(kinds) > 1:
        return None
    outcome, _, _ = kinds.pop()
    return outcome, impacts_of(cells), True, np.nan, np.nan


def form_between_angles(cells, measured):
    """Whether (1 - peak)^2 is interpolated between angles, as where its error was measured; None if that differs."""
    squared = {all(row[e].stencil == SQUARED for row in cells) for e in measured}
    return squared.pop() if len(squared) == 1 else None


def peak_from(values, cells, weights, squared_angles):
    """Interpolated peak, first between slices, then between angles, each with the formula of its measured error."""
    squared = np.array([[cell.stencil == SQUARED for cell in row] for row in cells])
    by_angle, by_slice = weights

    def back(value):
        return 1.0 - np.sqrt(max(value, 0.0))

    between = []
    for own, forms in zip(values, squared, strict=True):
        alike = forms.all()
        peaks = [back(value) if form and not alike else value for value, form in zip(own, forms, strict=True)]
        on_angle = by_slice @ peaks
        if alike and not squared_angles:
            on_angle = back(on_angle)
        elif squared_angles and not alike:
            on_angle = (1.0 - on_angle) ** 2
        between.append(on_angle)
    return back(by_angle @ between) if squared_angles else by_angle @ between


def expected(cubes, point, tolerance):
    """Outcome, impacts, whether alpha is passed, peak and bound of a point; None if the cubes do not determine them."""
    s, w, eta, alpha = point
    windows = window_of(ETAS, eta), window_of(ALPHAS, alpha)
    inside = ROWS[0] <= s <= ROWS[-1] and COLUMNS[0] <= w <= COLUMNS[-1] and s < 1.0
    if None in windows or not inside:
        return None
    (e0, size, e_lower), (a0, count, a_lower) = windows
    i = min(np.searchsorted(ROWS, s, side="right") - 1, len(ROWS) - 2)
    j = min(np.searchsorted(COLUMNS, w, side="right") - 1, len(COLUMNS) - 2)

    def cell_at(e, a):
        part = {name: cubes[e][name].values[a] for name in NAMES}
        values = {name: part[name][i, j] for name in NAMES if name != "impacts"}
        around = np.s_[max(i - 1, 0) : i + 3, max(j - 1, 0) : j + 3]
        wide = np.s_[max(i - 1, 0) : i + 3, max(j - 3, 0) : j + 5]
        known = {"corner": part["impacts"][i, j], "impacts": part["impacts"][wide], "modes": part["peak_mode"][wide]}
        return SimpleNamespace(**values, **known, nodes=part["peak_rotation"][around])

    cells = [[cell_at(e, a) for e in range(e0, e0 + size)] for a in range(a0, a0 + count)]
    flat = [cell for row in cells for cell in row]
    by_slice = np.array(weights_of(ETAS[e0 : e0 + size], eta))
    by_angle = np.array(weights_of(ALPHAS[a0 : a0 + count] ** 2, alpha**2))
    error = sum(
        abs(one * other) * float(cell.interpolation_error)
        for row, one in zip(cells, by_angle, strict=True)
        for cell, other in zip(row, by_slice, strict=True)
    )
    if size > 1:
        error += sum(abs(by_angle[k]) * float(cell_at(e_lower, a0 + k).restitution_error) for k in range(count))
    if count > 1:
        either = [cell_at(e, a_lower).alpha_error for e in range(e_lower, e_lower + 1 + (size > 1))]
        error += float(np.maximum.reduce(either))
    if any(cell.stencil == NO_STENCIL for cell in flat) or np.isnan(error):
        return None
    if any(cell.stencil == OVERTURNS for cell in flat):
        return overturning(flat)
    bound = SAFETY * error + SOLVER_ERROR
    x, y = weights_of(ROWS[i - 1 : i + 3], s), weights_of(np.log(COLUMNS[j - 1 : j + 3]), np.log(w))
    values = [
        [x @ ((1.0 - cell.nodes) ** 2 if cell.stencil == SQUARED else cell.nodes) @ y for cell in row] for row in cells
    ]
    measured = [e_lower - e0] if size == 1 else [e_lower - e0, e_lower - e0 + 1]
    squared_angles = form_between_angles(cells, measured) if count > 1 else False
    if squared_angles is None:  # no error between the angles is known of either formula
        return None
    peak = peak_from(np.array(values), cells, (by_angle, by_slice), squared_angles)
    if bound > tolerance or abs(peak - 1.0) <= bound:
        return None
    return int(Outcome.RECOVERS), impacts_of(flat), peak > 1.0, max(peak, 0.0), bound


def random_points(between, count):
    rng = np.random.default_rng(12)
    eta, alpha = (
        rng.uniform(axis[0] - 0.02 * np.ptp(axis), axis[-1] + 0.02 * np.ptp(axis), count)
        if free
        else rng.choice(axis, count)
        for axis, free in zip((ETAS, ALPHAS), between, strict=True)
    )
    inner = rng.choice(ROWS, count), rng.choice(COLUMNS, count)  # some points lie on the nodes
    s = np.where(rng.random(count) < 0.1, inner[0], rng.uniform(0.08, 1.02, count))
    w = np.where(rng.random(count) < 0.1, inner[1], np.exp(rng.uniform(np.log(0.45), np.log(13.0), count)))
    return Points(s, w, eta, np.abs(alpha))


@pytest.mark.parametrize("between", [(False, False), (True, False), (False, True), (True, True)])
def test_lookups_follow_their_definition(cubes, between):
    slices = [slice_of(cube) for cube in cubes]
    cube, points = Cube("sine", ETAS, slices.__getitem__), random_points(between, COUNT)
    known, found = cube.interpolate(points, 1e-4)
    seen = {"unknown": 0, "survives": 0, "overturns": 0}
    for k in range(COUNT):
        fields = points.slenderness[k], points.frequency_ratio[k], points.restitution[k], points.alpha[k]
        answer = expected(cubes, fields, 1e-4)
        assert known[k] == (answer is not None), fields
        seen["unknown"] += answer is None
        if answer is None:
            continue
        seen["overturns" if np.isnan(answer[3]) else "survives"] += 1
        assert (found.outcome[k], found.impacts[k], found.exceeded_alpha[k]) == answer[:3], fields
        np.testing.assert_allclose((found.peak_rotation[k], found.error_bound[k]), answer[3:], rtol=1e-9, atol=1e-13)
    assert min(seen.values()) > COUNT / 40, seen


def test_responses_do_not_depend_on_the_other_points(cubes):
    slices = [slice_of(cube) for cube in cubes]
    cube, points = Cube("sine", ETAS, slices.__getitem__), random_points((True, True), 500)
    known, found = cube.interpolate(points, 1e-4)
    order = np.random.default_rng(13).permutation(500)
    for part in (order, order[:1], order[:15], order[:16], order[:33]):
        again, other = cube.interpolate(points[part], 1e-4)
        np.testing.assert_array_equal(again, known[part])
        for name in ("peak_rotation", "error_bound", "outcome", "impacts"):
            np.testing.assert_array_equal(getattr(other, name)[again], getattr(found, name)[part][again])


def test_threads_share_large_arrays_and_are_stopped(cubes):
    slices = [slice_of(cube) for cube in cubes]
    cube, few = Cube("sine", ETAS, slices.__getitem__), random_points((True, True), 1000)
    many = Points(*(np.tile(getattr(few, name), 3 * MIN_CHUNK // 1000) for name in few.__dataclass_fields__))
    known, found = cube.interpolate(many, 1e-4, threads=1)
    again, other = cube.interpolate(many, 1e-4, threads=3)
    np.testing.assert_array_equal(again, known)
    for name in ("peak_rotation", "error_bound", "outcome", "impacts"):
        np.testing.assert_array_equal(getattr(other, name)[known], getattr(found, name)[known])
    stop = StopFlag()
    stop.set()
    with pytest.raises(StoppedError):
        cube.response(**vars(many), stop=stop)
    with pytest.raises(InvalidArgumentError, match="`threads` = 0"):
        cube.response(**vars(few), threads=0)
