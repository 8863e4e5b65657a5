"""GET /v1/pulses: the catalogue of excitations."""

import json

import numpy as np
import pytest

import rocking
from rocking import precompile
from rocking._cli.app import app
from rocking._excitation import pulses
from rocking._excitation.pulses import PULSE_NAMES
from tests.api.conftest import assert_problem, client_of
from tests.excitation.test_smooth_pulse import CHIRP


def test_pulses_are_those_of_the_package(client):
    found = client.get("/v1/pulses", params={"samples": 33}).json()["pulses"]
    assert [one["name"] for one in found][: len(PULSE_NAMES)] == list(PULSE_NAMES)
    for one in found[: len(PULSE_NAMES)]:
        pulse = rocking.pulse(one["name"])
        phase = np.linspace(pulse.start, pulse.end, 33)
        np.testing.assert_allclose(one["time"], (phase - pulse.start) / (2 * np.pi), atol=5.1e-5)
        np.testing.assert_allclose(one["acceleration"], pulse.shape(phase), atol=5.1e-5)
        assert one["duration"] == pytest.approx((pulse.end - pulse.start) / (2 * np.pi))
        assert one["definition"].endswith((".", ")"))
    durations = {one["name"]: one["duration"] for one in found}
    assert durations["half_sine"] == durations["rectangular"] == 0.5
    last = next(one for one in found if one["name"] == "mavroeidis_papageorgiou")
    assert {one["name"]: one["default"] for one in last["parameters"]} == {"cycles": 2.0, "phase": 0.0}
    assert {one["name"]: one["range"] for one in last["parameters"]}["cycles"] == "(1, 20]"


def test_a_pulse_takes_its_parameters_in_its_text(client, capsys):
    text = "mavroeidis_papageorgiou(cycles=3, phase=90deg)"
    groups = {"slenderness": 0.5, "frequency_ratio": 4.0, "restitution": 0.9}
    expected = rocking.peak_response(rocking.pulse("mavroeidis_papageorgiou", cycles=3, phase=np.pi / 2), **groups)
    answer = client.get("/v1/response", params={"pulse": text, **groups}).json()
    assert answer["peak_rotation"] == pytest.approx(float(expected.peak_rotation), rel=1e-12)
    options = [f"--{name.replace('_', '-')}={value}" for name, value in groups.items()]
    with pytest.raises(SystemExit, match="0"):
        app(["response", f"--pulse={text}", *options, "--format=json"])
    assert json.loads(capsys.readouterr().out)["peak_rotation"] == pytest.approx(answer["peak_rotation"], rel=1e-12)
    assert_problem(client.get("/v1/response", params={"pulse": "sine(cycles=2)", **groups}), 422, "cycles")


def test_a_registered_pulse_is_listed_and_solved(tmp_path, monkeypatch):
    monkeypatch.setattr(pulses, "_REGISTERED", {})
    pulses.register(CHIRP)
    precompile.main()  # the service refuses requests while it compiles
    groups = {"slenderness": 0.45, "frequency_ratio": 3.0, "restitution": 0.85}
    with client_of(tmp_path) as client:
        listed = {pulse["name"]: pulse for pulse in client.get("/v1/pulses").json()["pulses"]}
        assert listed["chirp"]["duration"] == pytest.approx(4.0)
        response = client.get("/v1/response", params=groups | {"pulse": "chirp", "method": "solver"})
        assert response.status_code == 200, response.text
        solved = float(rocking.peak_response(CHIRP, **groups).peak_rotation)
        assert response.json()["peak_rotation"] == pytest.approx(solved, abs=1e-4)
