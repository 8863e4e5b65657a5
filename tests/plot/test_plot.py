"""Pictures hold what they are drawn from, and labels of the default pictures of xarray fit into them."""

import subprocess
import sys

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.figure import Figure

import rocking
from rocking import plot
from rocking._base.errors import InvalidArgumentError
from rocking._spectra.cubes import spectrum
from rocking.plot.output import new_figure, save_figure
from tests.suites.motions import noise

BLOCK = rocking.Block(width=0.4, height=1.6)
PULSE = {"peak_acceleration": 4.0, "period": 0.5}
GROUPS = {"slenderness": 0.3, "frequency_ratio": 5.0, "restitution": 0.85}


@pytest.fixture
def ax():
    return Figure(layout="constrained").add_subplot()


def shaded(ax):
    """Ends of the shaded ranges."""
    ends = [path.vertices[:, 0] for part in ax.collections for path in part.get_paths()]
    return [(x.min(), x.max()) for x in ends]


def test_history_of_a_block_in_degrees(ax):
    data = BLOCK.history("sine", **PULSE)
    assert plot.history(data, ax) is ax
    curve = ax.lines[3]
    np.testing.assert_array_equal(curve.get_xdata(), data.time)
    np.testing.assert_allclose(curve.get_ydata(), np.degrees(data.rotation), rtol=1e-12)
    assert ax.lines[1].get_ydata()[0] == pytest.approx(np.degrees(BLOCK.alpha))
    assert ax.lines[4].get_xdata()[0] == data.impact_time[0]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("time [s]", r"rotation $\theta$ [deg]")
    assert ax.get_title("right") == "rocks and comes to rest"
    assert ax.get_ylim()[1] > np.degrees(BLOCK.alpha)


def test_a_small_rotation_fills_the_axis(ax):
    data = BLOCK.history("sine", peak_acceleration=2.7, period=0.5)
    largest = np.degrees(abs(data.rotation).max().item())
    assert 0.0 < largest < 0.1 * np.degrees(BLOCK.alpha)
    plot.history(data, ax)
    np.testing.assert_allclose(ax.get_ylim(), (-1.2 * largest, 1.2 * largest))
    assert ax.get_title("left") == r"$\alpha$ = 14 deg"


def test_ground_acceleration_with_the_smallest_one_that_starts_rocking(ax):
    data = BLOCK.history("sine", **PULSE)
    plot.ground_acceleration(data, ax)
    assert ax.lines[1].get_ydata()[0] == pytest.approx(BLOCK.uplift_acceleration)
    assert ax.lines[3].get_ydata().max() == pytest.approx(4.0, rel=1e-3)
    assert "m/s" in ax.get_ylabel()


def test_pictures_of_a_body_with_two_edges(ax):
    body = rocking.RigidBody(0.12, 0.18, 0.4)
    data = body.history("sine", peak_acceleration=4.0, period=0.6)
    right, left = np.degrees(float(body.right.alpha)), np.degrees(float(body.left.alpha))
    for picture, expected in (
        (plot.history(data, ax), {right, -left}),
        (plot.ground_acceleration(data), {9.80665 * 0.12 / 0.4, -9.80665 * 0.18 / 0.4}),
    ):
        limits = {round(float(line.get_ydata()[0]), 6) for line in picture.lines if len(line.get_ydata()) == 2}
        assert {round(value, 6) for value in expected} <= limits
    assert ax.get_xlim() == (0.0, float(data["time"][-1]))
    assert "period" in plot.spectrum(body.spectrum("sine", peak_acceleration=4.0, period=[0.3, 0.6, 0.9])).get_xlabel()
    assert "period" in plot.boundary(body.boundary("sine", period=(0.4, 1.5))).get_xlabel()


def test_history_of_a_record_and_in_groups(ax):
    record = noise(3)
    found = rocking.time_history(record, frequency_parameter=3.0, slenderness=0.3, restitution=0.85)
    assert plot.history(found, ax).get_xlabel() == "time [s]"
    history = rocking.time_history("sine", **GROUPS)
    assert plot.history(history, color="k").get_xlabel() == r"time $\tau=p\,t$ [-]"


def test_response_between_its_thresholds(ax):
    found = BLOCK.response("sine", **PULSE)
    plot.response(found, ax)
    point = ax.lines[-1]
    assert (point.get_xdata()[0], point.get_ydata()[0]) == pytest.approx((4.0, np.degrees(found.rotation)))
    assert shaded(ax) == [pytest.approx((found.thresholds[0].value, 8.0), rel=1e-6)]
    groups = plot.response(rocking.peak_response("sine", **GROUPS))
    assert shaded(groups) == [pytest.approx((3.980175, 5.356347), rel=1e-6)]  # falls from, safe again


def test_spectrum_is_interrupted_where_the_block_overturns(ax):
    data = BLOCK.spectrum("sine", peak_acceleration=5.0, period=np.linspace(0.1, 1.0, 91)[::-1])
    plot.spectrum(data, ax, label="eta")
    ((low, high),) = shaded(ax)
    overturned = data.period.values[data.overturned.values]
    assert (low, high) == (overturned.min(), overturned.max())
    assert np.isnan(ax.lines[0].get_ydata()).sum() == overturned.size
    assert np.all(np.diff(ax.lines[0].get_xdata()) > 0)
    assert [text.get_text() for text in ax.legend().get_texts()] == ["eta", "overturns"]


def test_a_lone_survivor_of_a_spectrum_is_a_dot(ax):
    data = BLOCK.spectrum("sine", peak_acceleration=3.0, period=np.linspace(0.2, 0.5, 7))
    for lost in (1, 3):
        data["outcome"].values[lost], data["rotation"].values[lost] = 3, np.nan
    plot.spectrum(data, ax)
    (line, dot) = ax.lines
    assert dot.get_marker() == "."
    np.testing.assert_array_equal(dot.get_xdata(), data.period.values[[0, 2]])
    assert dot.get_color() == line.get_color()


def test_boundary_in_groups_and_in_si_units(ax):
    window = 2 * np.pi / (np.array([4.0, 2.0]) * BLOCK.frequency_parameter)
    curves = BLOCK.boundary("sine", restitution=0.85, period=tuple(window))
    x = np.concatenate([line.get_xdata() for line in plot.boundary(curves, ax).lines])
    assert (np.nanmin(x), np.nanmax(x)) == pytest.approx(tuple(window), rel=1e-9)
    names = ["overturns after impacts", "overturns without impact"]
    assert [text.get_text() for text in ax.get_legend().get_texts()] == names
    groups = plot.boundary(curves.drop_vars(["period", "peak_acceleration"]))
    direct = groups.lines[2]
    nearest = np.nanargmin(np.abs(direct.get_xdata() - 3.0))
    found = rocking.thresholds("sine", frequency_ratio=direct.get_xdata()[nearest], restitution=0.85, alpha=BLOCK.alpha)
    assert direct.get_ydata()[nearest] == pytest.approx(found.amplitude[-1], rel=1e-6)


def test_the_key_of_a_map_lists_what_is_in_it():
    grid = {"slenderness": np.linspace(0.5, 0.9, 5)[:, None], "frequency_ratio": np.linspace(6.0, 9.0, 6)}
    found = rocking.peak_response("sine", restitution=0.85, alpha=0.2, **grid)
    assert not found.overturned.any()
    assert plot.control_map(found.to_xarray()).figure.legends == []
    grid = {"slenderness": np.linspace(0.1, 1.2, 9)[:, None], "frequency_ratio": np.linspace(1.0, 6.0, 6)}
    found = rocking.peak_response("sine", restitution=0.85, alpha=0.2, **grid)
    (legend,) = plot.control_map(found.to_xarray()).figure.legends
    outcomes = {"never uplifts": 0, "overturns after impacts": 2, "overturns without impact": 3}
    present = [name for name, code in outcomes.items() if (found.outcome == code).any()]
    assert [text.get_text() for text in legend.get_texts()] == present


def test_cube_has_a_panel_for_each_angle(ax):
    axes = {"alpha": np.array([0.0, 0.3])[:, None, None], "slenderness": np.linspace(0.2, 0.9, 5)[:, None]}
    found = rocking.peak_response("sine", frequency_ratio=np.linspace(1.0, 6.0, 6), restitution=0.85, **axes)
    data = found.to_xarray()
    panels = plot.cube(data)
    assert [one.get_title("right") for one in panels] == ["slender limit", "alpha = 17.2 deg"]
    with pytest.raises(InvalidArgumentError, match="one for each of 2 angles"):
        plot.cube(data, [ax])


def test_fragility_of_one_block(ax):
    levels = np.geomspace(1.0, 20.0, 8)
    data = rocking.fragility([noise(seed) for seed in range(4)], [BLOCK], intensity=levels, restitution=0.85)
    plot.fragility(data.isel(block=0), ax)
    observed = ax.containers[0].lines[0]
    np.testing.assert_array_equal(observed.get_ydata(), data.fraction.isel(block=0))
    assert ax.get_ylabel() == "probability of overturning [-]"
    with pytest.raises(InvalidArgumentError, match=r"of one block and one limit state: data\.isel\(block=0\)"):
        plot.fragility(data, ax)


@pytest.mark.parametrize("picture", [plot.history, plot.ground_acceleration, plot.spectrum, plot.boundary])
def test_other_data_are_refused_by_name(picture, ax):
    with pytest.raises(InvalidArgumentError, match="`data` = "):
        picture(rocking.peak_response("sine", **GROUPS).to_xarray(), ax)
    several = rocking.peak_response("sine", **GROUPS | {"slenderness": [0.3, 0.4]})
    with pytest.raises(InvalidArgumentError, match="`found` = "):
        plot.response(several, ax)
    with pytest.raises(InvalidArgumentError, match="to_xarray"):
        plot.spectrum(several, ax)
    with pytest.raises(InvalidArgumentError, match=r"rocking\.plot\.history"):
        plot.response(BLOCK.response(noise(3), thresholds=False))
    assert not ax.has_data()


def test_files_of_equal_pictures_are_equal(tmp_path):
    for ending in ("png", "svg"):
        for name in "ab":
            with mpl.rc_context(plot.STYLE):
                figure = new_figure(f"{name}.{ending}", (2.0, 1.5))
                plot.response(rocking.peak_response("sine", **GROUPS), figure.add_subplot())
                save_figure(figure, tmp_path / f"{name}.{ending}")
        first, second = ((tmp_path / f"{name}.{ending}").read_bytes() for name in "ab")
        assert first == second


def test_without_matplotlib_the_extra_is_named():
    program = (
        "import sys; sys.modules['matplotlib'] = None; import importlib.util as u; u.find_spec = lambda name: None\n"
        "import rocking\n"
        "rocking.Block\n"
        "try: rocking.plot\n"
        "except ModuleNotFoundError as error: print(error)"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert "pip install 'rocking[plot]'" in done.stdout


def grid(**values):
    return rocking.peak_response("sine", **(GROUPS | values)).to_xarray().peak_rotation


def record_history():
    return rocking.time_history(noise(3), frequency_parameter=3.0, slenderness=0.3, restitution=0.85)


PICTURES = {
    "history": lambda: rocking.time_history("sine", **GROUPS).rotation,
    "ground": lambda: rocking.time_history("sine", **GROUPS).ground_acceleration,
    "block velocity": lambda: BLOCK.history("sine", peak_acceleration=4.0, period=0.5).angular_velocity,
    "record over tau": lambda: record_history().swap_dims(time="tau").rotation,
    "spectrum": lambda: grid(frequency_ratio=np.linspace(1.0, 9.0, 20)),
    "angles": lambda: grid(alpha=np.linspace(0.1, 0.4, 20)),
    "map": lambda: grid(slenderness=np.linspace(0.1, 0.9, 9)[:, None], frequency_ratio=np.linspace(1.0, 9.0, 20)),
    "block spectrum": lambda: BLOCK.spectrum("sine", peak_acceleration=4.0, period=PERIODS).displacement,
    "fraction": lambda: rocking.fragility([noise(1), noise(2)], BLOCK, intensity=np.geomspace(1, 20, 6)).fraction,
    "boundary": lambda: BLOCK.boundary("sine", period=(0.5, 0.8)).peak_acceleration,
}
PERIODS = np.linspace(0.1, 0.5, 9)


@pytest.fixture(scope="module")
def cube():
    axes = {"slenderness": np.linspace(0.1, 0.9, 9), "frequency_ratio": np.geomspace(1.0, 9.0, 9)}
    return spectrum("sine", restitution=0.85, alpha=np.array([0.0, 0.3]), **axes)


def outside(picture):
    """Labels of axes that reach beyond the figure."""
    with plt.rc_context({"backend": "agg"}):
        figure = plt.figure()
        try:
            picture.plot()
            figure.canvas.draw()
            frame = figure.bbox
            return [
                label.get_text()
                for ax in figure.axes
                for label in (ax.xaxis.label, ax.yaxis.label)
                for box in [label.get_window_extent()]
                if box.x0 < frame.x0 or box.y0 < frame.y0 or box.x1 > frame.x1 or box.y1 > frame.y1
            ]
        finally:
            plt.close(figure)


@pytest.mark.parametrize("name", PICTURES)
def test_labels_fit(name):
    assert outside(PICTURES[name]()) == []


@pytest.mark.parametrize("name", ["peak_rotation", "outcome", "impacts", "interpolation_error", "alpha_error"])
def test_labels_of_a_cube_fit(cube, name):
    layer = cube[name].isel(alpha=1)
    for picture in (layer, layer.isel(slenderness=3), layer.isel(frequency_ratio=3), cube[name][:, 3, 3]):
        assert outside(picture) == []
