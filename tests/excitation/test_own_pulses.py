"""Pulses defined outside the package, of each family: every function takes them, by their names too."""

import json
import math

import numpy as np
import pytest
from fastapi.testclient import TestClient
from rocking_api.app import create_app
from rocking_api.settings import Settings
from typer.testing import CliRunner

import rocking
from rocking import precompile
from rocking._base.errors import DatasetError, InvalidArgumentError
from rocking._cli.app import app
from rocking._datasets.cube import write_dataset
from rocking._excitation import pulses
from rocking._excitation.pulses import PULSE_NAMES, SinusoidalPulse, pulse_number, register
from rocking._excitation.shapes import AbstractPulse
from rocking._lookup.collection import CubeCollection
from rocking._lookup.cube import open_cube
from rocking._spectra.cubes import spectrum
from tests.direct_integration import integrate
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
def registered(request, monkeypatch):
    """A pulse, registered for one test."""
    monkeypatch.setattr(pulses, "_REGISTERED", {})
    register(request.param)
    return request.param


every_family = pytest.mark.parametrize("registered", OWN, ids=lambda pulse: pulse.name, indirect=True)


@every_family
def test_a_name_stands_for_its_pulse_in_every_function(registered):
    assert isinstance(registered, AbstractPulse)
    assert rocking.pulse(registered.name) is registered
    assert rocking.pulse(f"-{registered.name}") == registered.mirrored()
    for name, pulse in ((registered.name, registered), (f"-{registered.name}", registered.mirrored())):
        assert rocking.peak_response(name, **GROUPS) == rocking.peak_response(pulse, **GROUPS)
    assert rocking.time_history(registered.name, **GROUPS).equals(rocking.time_history(registered, **GROUPS))
    assert rocking.thresholds(registered.name, **OF_CELL) == rocking.thresholds(registered, **OF_CELL)
    window = {"restitution": 0.85, "nodes": 31, "frequency_ratio": (2.0, 3.0)}
    assert rocking.overturning_boundary(registered.name, **window).equals(
        rocking.overturning_boundary(registered, **window)
    )
    block, motion = rocking.Block(0.4, 1.6), {"peak_acceleration": 4.0, "period": 0.6}
    assert block.response(registered.name, **motion).rotation == block.response(registered, **motion).rotation
    options = ["--width=0.4m", "--height=1.6m", "--peak-acceleration=4m/s2", "--period=0.6s"]
    printed = CliRunner().invoke(app, ["response", "--pulse", registered.name, "--format=json", *options])
    assert (
        json.loads(printed.stdout)["peak_rotation"] == block.response(registered, **motion).summary()["peak_rotation"]
    )
    for wrong in (registered, registered.mirrored(), rocking.pulse("sine")):
        with pytest.raises(InvalidArgumentError, match=r"^`name` = "):
            register(wrong)
    with pytest.raises(InvalidArgumentError, match=r"^`pulse` = "):
        register(registered.name)
    with pytest.raises(InvalidArgumentError, match=rf"^`pulse` = .*{registered.name}"):
        rocking.pulse("four_sines")


@every_family
def test_functions_agree_about_the_pulse(registered):
    mild = GROUPS | {"slenderness": 0.8}
    for alpha in (None, 0.2):
        peak = rocking.peak_response(registered, **mild, alpha=alpha)
        history = rocking.time_history(registered, **mild, alpha=alpha, contact=True, samples=2000)
        assert float(abs(history.rotation).max()) == pytest.approx(float(peak.peak_rotation), rel=1e-3)
        mirrored = rocking.peak_response(registered.mirrored(), **mild, alpha=alpha)
        assert float(mirrored.peak_rotation) == pytest.approx(float(peak.peak_rotation), rel=1e-13)
        coarse = rocking.peak_response(registered, **mild, alpha=alpha, relative_tolerance=1e-6)
        assert float(coarse.peak_rotation) == pytest.approx(float(peak.peak_rotation), rel=1e-6)
    threshold = float(rocking.thresholds(registered, **OF_CELL).amplitude[0])
    beside = 1.0 / (threshold * np.array([1 - 1e-9, 1 + 1e-9]))
    assert rocking.peak_response(registered, slenderness=beside, **OF_CELL).overturned.tolist() == [False, True]
    curves = rocking.overturning_boundary(registered, restitution=0.85, frequency_ratio=(1.0, 4.0), nodes=61)
    nearest = np.abs(curves.frequency_ratio.values - 3.0).argmin()
    assert 1.0 / curves.slenderness.values[nearest] == pytest.approx(threshold, rel=0.2)


@pytest.mark.parametrize(
    ("start", "end", "terms", "parameter"),
    [
        (0.0, 7.0, ((1.0, 2.0), (3.0, 4.0)), "terms"),
        (0.0, 7.0, ((0.0, 2.0, 0.0),), "terms"),
        (7.0, 0.0, ((1.0, 2.0, 0.0),), "end"),
        ("now", 7.0, ((1.0, 2.0, 0.0),), "start"),
    ],
)
def test_sums_without_a_peak_are_refused(start, end, terms, parameter):
    with pytest.raises(InvalidArgumentError, match=f"`{parameter}`"):
        SinusoidalPulse.of_unit_peak("burst", start, end, terms)


def test_response_is_that_of_direct_integration():
    pulse, (amplitude, omega, eta) = OWN[1], (1.0 / 0.6, 3.0, 0.85)
    response = rocking.peak_response(pulse, slenderness=0.6, **OF_CELL)
    start = rocking.paper.first_uplift_phase(pulse, amplitude)
    motion = integrate(amplitude, omega, eta, shape=pulse.shape, start=start, end=pulse.end)
    assert len(motion.impact_times) == response.impacts > 0
    assert float(response.first_impact_time) == pytest.approx(motion.impact_times[0], abs=1e-8)
    assert float(response.end_rotation) == pytest.approx(abs(motion.rotation), abs=1e-8)


def test_numbers_in_files_never_change():
    stored = ("sine", "cosine", "half_sine", "rectangular", "c1", "c2", "ricker", "ricker_antisymmetric")
    stored += ("mavroeidis_papageorgiou",)
    assert PULSE_NAMES[: len(stored)] == stored
    assert [pulse_number(name) for name in stored] == list(range(9))


def test_a_cube_of_a_sampled_pulse_and_http_by_its_name(tmp_path, monkeypatch):
    monkeypatch.setattr(pulses, "_REGISTERED", {})
    ramp, groups = OWN[0], GROUPS | {"slenderness": 0.6}
    register(ramp)
    axes = {"slenderness": np.linspace(0.55, 0.65, 21), "frequency_ratio": np.geomspace(2.8, 3.2, 21)}
    path = tmp_path / "spectra" / "ramp" / "eta-0.85.nc"
    write_dataset(spectrum("ramp", restitution=0.85, **axes), path)
    solved = float(rocking.peak_response(ramp, **groups).peak_rotation)
    precompile.main()
    with TestClient(create_app(Settings(results=tmp_path))) as client:
        listed = client.get("/v1/pulses").json()["pulses"][-1]
        assert (listed["name"], listed["duration"]) == ("ramp", 1.0)
        answer = client.get("/v1/response", params=groups | {"pulse": "ramp", "absolute_tolerance": 1e-2}).json()
        assert answer["source"] == "cube"
        assert answer["peak_rotation"] == pytest.approx(solved, abs=answer["error_bound"])
        for end in ("", ".nc", "/subset", ".zarr/zarr.json", ".zarr/.zmetadata"):
            response = client.get(f"/v1/datasets/spectra/ramp/eta-0.85{end}")
            assert response.status_code == 200 or ".zarr" in end, response.text
        assert client.get("/health").json()["problems"] == {}
    monkeypatch.setattr(pulses, "_REGISTERED", {})  # as in another process
    cube = open_cube(path)
    assert cube.pulse == ramp
    assert float(cube.response(**groups, method="solver").peak_rotation) == solved
    register(rocking.SampledPulse([0.0, 1.0, 0.0], name="ramp"))
    with pytest.raises(DatasetError, match="other samples"):
        CubeCollection(tmp_path).response("ramp", **groups, method="cube")
    answer, used = CubeCollection(tmp_path).response("ramp", **groups)
    assert (answer.source.item(), used) == ("solver", ())
