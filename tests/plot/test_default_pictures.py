"""The default pictures of xarray: labels from the attributes of the data sets fit into a figure of the default size."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import rocking
from rocking._spectra.cubes import spectrum
from tests.suites.motions import noise

BLOCK = rocking.Block(width=0.4, height=1.6)
GROUPS = {"slenderness": 0.3, "frequency_ratio": 5.0, "restitution": 0.85}


def grid(**values):
    return rocking.peak_response("sine", **(GROUPS | values)).to_xarray().peak_rotation


def record_history():
    return rocking.time_history(noise(3), frequency_parameter=3.0, slenderness=0.3, restitution=0.85)


PICTURES = {
    "history": lambda: rocking.time_history("sine", **GROUPS).rotation,
    "ground": lambda: rocking.time_history("sine", **GROUPS).ground_acceleration,
    "block history": lambda: BLOCK.history("sine", peak_acceleration=4.0, period=0.5).top_displacement,
    "block velocity": lambda: BLOCK.history("sine", peak_acceleration=4.0, period=0.5).angular_velocity,
    "record": lambda: record_history().rotation,
    "record over tau": lambda: record_history().swap_dims(time="tau").rotation,
    "spectrum": lambda: grid(frequency_ratio=np.linspace(1.0, 9.0, 20)),
    "amplitudes": lambda: grid(slenderness=np.linspace(0.1, 0.9, 20)),
    "restitutions": lambda: grid(restitution=np.linspace(0.7, 1.0, 20)),
    "angles": lambda: grid(alpha=np.linspace(0.1, 0.4, 20)),
    "map": lambda: grid(slenderness=np.linspace(0.1, 0.9, 9)[:, None], frequency_ratio=np.linspace(1.0, 9.0, 20)),
    "block spectrum": lambda: (
        BLOCK.spectrum("sine", peak_acceleration=4.0, period=np.linspace(0.1, 0.5, 9)).top_displacement
    ),
    "fraction": lambda: rocking.fragility([noise(1), noise(2)], BLOCK, intensity=np.geomspace(1, 20, 6)).fraction,
    "boundary": lambda: BLOCK.boundary("sine", period=(0.5, 0.8)).peak_acceleration,
}


@pytest.fixture(scope="module")
def cube():
    return spectrum(
        "sine",
        restitution=0.85,
        alpha=np.array([0.0, 0.3]),
        slenderness=np.linspace(0.1, 0.9, 9),
        frequency_ratio=np.geomspace(1.0, 9.0, 9),
    )


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
