"""`rocking plot`: a file for each picture, and errors that name the option."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from PIL import Image
from typer.testing import CliRunner

import rocking
from rocking._cli.app import app
from tests.cli.test_cli import GROUPS, UNITS, refused, run
from tests.sampling import but_long

BLOCK = UNITS[:6]
SUITE = Path(__file__).parents[2] / "workflow/config/suite.yaml"
NAPA = str(Path(__file__).parents[2] / "workflow/motions/napa_HNE.csv")
AMPLITUDE = ["--peak-acceleration", "0.5g"]


COMMANDS = [
    ["response", *UNITS],
    ["response", *GROUPS],
    ["history", *UNITS, "--duration", "2s"],
    ["history", *GROUPS],
    ["spectrum", *BLOCK, *AMPLITUDE],
    ["spectrum", *GROUPS[:4], *GROUPS[6:]],
    ["boundary", *BLOCK, "--period-min", "0.4s", "--period-max", "0.8s"],
    ["map", *BLOCK],
    ["map", "--pulse", "sine", "--restitution", "0.85"],
    ["fragility", str(SUITE)],
    ["record", NAPA, *BLOCK[2:], "--scale", "1.2", "--duration", "8s"],
]


@pytest.mark.parametrize(
    "command",
    but_long(COMMANDS, *(one for one in COMMANDS if "--width" in one or one[0] == "fragility")),
    ids=lambda command: f"{command[0]} {'units' if '--width' in command else 'groups'}",
)
def test_a_picture_in_a_file(command, tmp_path):
    path = tmp_path / "picture.png"
    assert run("plot", *command, "--output", str(path)) == ""
    with Image.open(path) as picture:
        # something is drawn: more than the white of an empty figure, in more than black
        colours = picture.convert("RGB").resize((100, 100)).getcolors(10_000)
    assert len(colours) > 20
    assert max(count for count, _ in colours) < 9_500


@pytest.mark.parametrize("blocks", [1, 2])
def test_the_legend_of_a_fragility_is_not_cut(blocks, monkeypatch, tmp_path):
    given = yaml.safe_load(SUITE.read_text())
    suite = given["suite"]
    suite["records"] |= {"folder": str(SUITE.parents[1] / "motions"), "pattern": "synthetic_3*.csv"}
    suite |= {"blocks": suite["blocks"][:blocks], "demand": ["overturning"]}
    suite["intensity"] = {"low": 2.0, "high": 20.0, "points": 6}
    configuration = tmp_path / "suite.yaml"
    configuration.write_text(yaml.safe_dump(given | {"suite": suite}))
    figures = []
    monkeypatch.setattr("rocking.plot.output.save_figure", lambda figure, _: figures.append(figure))
    run("plot", "fragility", str(configuration), "--output", str(tmp_path / "picture.png"))
    (figure,) = figures
    figure.canvas.draw()
    (legend,) = figure.legends
    box = legend.get_window_extent()
    assert figure.bbox.x0 <= box.x0
    assert box.x1 <= figure.bbox.x1


def test_a_picture_under_a_pulse_in_a_file(tmp_path):
    path, pulse = tmp_path / "picture.png", tmp_path / "triangle.csv"
    pulse.write_text("0\n1\n0\n")
    assert run("plot", "response", "--pulse", str(pulse), *UNITS[2:], "--output", str(path)) == ""
    assert path.stat().st_size > 1000


def test_a_map_of_a_block_is_over_its_accelerations_and_periods(monkeypatch, tmp_path):
    drawn = []
    monkeypatch.setattr("rocking.plot.control_map", lambda *given: drawn.append(given[0]))
    run("plot", "map", *BLOCK, "-o", str(tmp_path / "map.png"))
    (data,) = drawn
    rotation = data["peak_rotation"].transpose("peak_acceleration", "period")[::40, ::40]
    found = rocking.Block("0.4 m", "1.6 m").response(
        "sine", peak_acceleration=rotation["peak_acceleration"].values[:, None], period=rotation["period"].values
    )
    assert (rotation > 0.0).any()
    np.testing.assert_allclose(rotation, found.to_xarray()["peak_rotation"], rtol=1e-8)


def test_a_picture_of_a_motion_does_not_hide_the_warnings(tmp_path):
    """The outcome under this record depends on the interpolation between its samples."""
    block = ["--width", "0.3m", "--height", "1.5m"]
    path = tmp_path / "picture.png"
    printed = run("record", NAPA, *block)
    warnings = [line for line in printed.splitlines() if line.startswith("warning: ")]
    assert warnings
    drawn = CliRunner().invoke(app, ["plot", "record", NAPA, *block, "-o", str(path)])
    assert (drawn.stdout, drawn.stderr.splitlines()) == ("", warnings)
    assert path.stat().st_size > 1000


@pytest.mark.slow
def test_picture_of_a_cube(smoke_results, tmp_path):
    path = tmp_path / "cube.svg"
    run("plot", "cube", str(smoke_results / "spectra/sine/eta-0.85.nc"), "-o", str(path))
    text = path.read_text()
    assert "<!-- slender limit -->" in text
    assert "<!-- alpha = 20 deg -->" in text


def test_errors_name_the_option_or_the_file(tmp_path):
    missing = str(tmp_path / "no" / "folder.png")
    for said, *words in (
        ("--output", "response", *GROUPS),  # there is no display
        ("a name that ends in .png or .svg", "response", *GROUPS, "-o", "picture.gif"),
        ("a file that can be written", "response", *GROUPS, "-o", missing),
        ("--slenderness", "map", *GROUPS, "-o", "picture.png"),
        ("FILE", "record", missing, *BLOCK[2:], "-o", "picture.png"),
        ("FILE", "cube", str(tmp_path / "none.nc"), "-o", "picture.png"),
        ("missing unit: write 3s", "history", *UNITS, "--duration", "3", "-o", "picture.png"),
    ):
        assert said in refused("plot", *words)
