"""Bodies of every kind as options of the commands."""

import json

import numpy as np
import pytest

import rocking
from tests.cli.test_cli import UNITS, refused, run


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (("--width=40cm", "--height=1.6m", "--gyration=0.5m"), "offset_mass(width=0.4m,height=1.6m,gyration=50cm)"),
        ((*UNITS[2:6], "--offset=3cm"), "offset_mass(width=0.4m, height=1.6m, offset=3cm)"),
        (("--diameter", "40cm", "--height", "1.6 m"), "cylinder(diameter=0.4m, height=160cm)"),
        (("--left=12cm", "--right=18cm", "--mass-height=40cm"), "two_edges(left=0.12m, right=0.18m, mass_height=0.4m)"),
        (("--body", "hollow(width=40cm, height=1.6m, wall=2cm)"), "hollow(width=0.4m, height=1.6m, wall=0.02m)"),
        (("--body", "frame(width=40cm, height=3m, mass_ratio=2)"), "frame(width=0.4m, height=3m, mass_ratio=2)"),
    ],
)  # fmt: skip
def test_kinds_of_bodies_are_options(options, text):
    motion = ("--pulse", "sine", "--peak-acceleration", "0.4 g", "--period", "0.5s")
    found = json.loads(run("response", *options, *motion, "--format", "json"))
    expected = rocking.body(text).response("sine", peak_acceleration="0.4 g", period="0.5 s")
    assert found["peak_rotation"] == expected.summary()["peak_rotation"]
    moved = rocking.body(text).history("sine", peak_acceleration="0.4 g", period="0.5 s")
    history = json.loads(run("history", *options, *motion, "--format", "json"))
    assert history["rotation_deg"] == np.degrees(moved["rotation"].values).tolist()
    spectrum = json.loads(run("spectrum", *options, *motion[:4], "--points", "3", "--format", "json"))
    assert len(spectrum["period"]) == len(spectrum["peak_rotation_deg"]) == 3


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--width", "1m", "--left", "1m"), "--body"),
        (("--body", "hollow(width=40cm)", "--width", "1m"), "--width"),
        (("--body", "hollow(width=40cm)"), "--height"),
        (("--width", "40 cm", "--height", "1.6m", "--gyration", "5"), "missing unit: write 5m"),
    ],
)  # fmt: skip
def test_what_describes_no_body_is_refused_by_its_option(options, message):
    assert message in refused(
        *("response", *options), *("--pulse", "sine", "--peak-acceleration", "1g", "--period", "1s")
    )
