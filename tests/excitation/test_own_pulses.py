"""Pulses defined outside the package, of each family: every function takes them, by their names too."""

import json
import math

import numpy as np
import pytest
from typer.testing import CliRunner

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking._cli.app import app
from rocking._excitation import pulses
from rocking._excitation.pulses import SinusoidalPulse, register
from rocking._excitation.shapes import AbstractPulse
from tests.excitation.test_smooth_pulse import CHIRP

GROUPS = {"slenderness": 0.45, "frequency_ratio": 3.0, "restitution": 0.85}
OF_CELL = {"frequency_ratio": 3.0, "restitution": 0.85}
THREE_SINES = ((1.0, 1.0, -0.5 * math.pi), (0.6, 2.3, 0.4), (0.25, 3.1, -1.2))
OWN = [
    rocking.SampledPulse([0.0, 1.0, -0.3, 0.0], [0.0, 0.1, 0.5, 0.8], name="ramp"),
    SinusoidalPulse.of_unit_peak("three_sines", 0.0, 7.0, THREE_SINES),
    CHIRP,
]


@pytest.fixture
def own(request, monkeypatch):
    """A pulse, registered for one test."""
    monkeypatch.setattr(pulses, "_REGISTERED", {})
    register(request.param)
    return request.param


every_family = pytest.mark.parametrize("own", OWN, ids=lambda one: one.name, indirect=True)


@every_family
def test_a_name_stands_for_its_pulse_in_every_function(own):
    assert isinstance(own, AbstractPulse)
    assert rocking.pulse(own.name) is own
    assert rocking.pulse(f"-{own.name}") == own.mirrored()
    for name, pulse in ((own.name, own), (f"-{own.name}", own.mirrored())):
        assert rocking.peak_response(name, **GROUPS) == rocking.peak_response(pulse, **GROUPS)
    assert rocking.time_history(own.name, **GROUPS).equals(rocking.time_history(own, **GROUPS))
    assert rocking.thresholds(own.name, **OF_CELL) == rocking.thresholds(own, **OF_CELL)
    window = {"restitution": 0.85, "nodes": 31, "frequency_ratio": (2.0, 3.0)}
    assert rocking.overturning_boundary(own.name, **window).equals(rocking.overturning_boundary(own, **window))
    block, motion = rocking.Block(0.4, 1.6), {"peak_acceleration": 4.0, "period": 0.6}
    assert block.response(own.name, **motion).rotation == block.response(own, **motion).rotation
    options = [f"--{key.replace('_', '-')}={value}" for key, value in GROUPS.items()]
    printed = CliRunner().invoke(app, ["response", "--pulse", own.name, "--format=json", *options])
    peak = float(rocking.peak_response(own, **GROUPS).peak_rotation)
    assert json.loads(printed.stdout)["peak_rotation"] == (None if math.isnan(peak) else peak)
    with pytest.raises(InvalidArgumentError, match=r"^`name` = "):
        register(own)


@every_family
def test_functions_agree_about_the_pulse(own):
    mild = GROUPS | {"slenderness": 0.8}
    for alpha in (None, 0.2):
        peak = rocking.peak_response(own, **mild, alpha=alpha)
        history = rocking.time_history(own, **mild, alpha=alpha, contact=True, samples=2000)
        assert float(abs(history.rotation).max()) == pytest.approx(float(peak.peak_rotation), rel=1e-3)
        mirrored = rocking.peak_response(own.mirrored(), **mild, alpha=alpha)
        assert float(mirrored.peak_rotation) == pytest.approx(float(peak.peak_rotation), rel=1e-13)
        coarse = rocking.peak_response(own, **mild, alpha=alpha, relative_tolerance=1e-6)
        assert float(coarse.peak_rotation) == pytest.approx(float(peak.peak_rotation), rel=1e-6)
    threshold = float(rocking.thresholds(own, **OF_CELL).amplitude[0])
    beside = 1.0 / (threshold * np.array([1 - 1e-9, 1 + 1e-9]))
    assert rocking.peak_response(own, slenderness=beside, **OF_CELL).overturned.tolist() == [False, True]
    curves = rocking.overturning_boundary(own, restitution=0.85, frequency_ratio=(1.0, 4.0), nodes=61)
    nearest = np.abs(curves.frequency_ratio.values - 3.0).argmin()
    assert 1.0 / curves.slenderness.values[nearest] == pytest.approx(threshold, rel=0.2)
