"""A pulse defined outside the package: responses, histories, boundaries, a cube and HTTP responses for it."""

import numpy as np
import pytest
from fastapi.testclient import TestClient
from rocking_api.app import create_app
from rocking_api.settings import Settings

import rocking
from rocking import precompile
from rocking._base.errors import DatasetError, InvalidArgumentError
from rocking._datasets.cube import write_dataset
from rocking._excitation import pulses
from rocking._excitation.pulses import PULSE_NAMES, SinusoidalPulse, pulse_number, register
from rocking._lookup.collection import CubeCollection
from rocking._lookup.cube import open_cube
from rocking._spectra.cubes import spectrum
from tests.direct_integration import integrate

GROUPS = {"slenderness": 0.6, "frequency_ratio": 3.0, "restitution": 0.85}


@pytest.fixture
def pulse(monkeypatch):
    """A sum of three sinusoids with their own phases, registered for one test."""
    monkeypatch.setattr(pulses, "_REGISTERED", {})
    made = SinusoidalPulse.of_unit_peak(
        "three_sines", 0.0, 7.0, ((1.0, 1.0, -0.5 * np.pi), (0.6, 2.3, 0.4), (0.25, 3.1, -1.2))
    )
    register(made)
    return made


@pytest.mark.parametrize(
    ("start", "end", "terms", "parameter"),
    [
        (0.0, 7.0, ((1.0, 2.0), (3.0, 4.0)), "terms"),
        (0.0, 7.0, ((1.0, -2.0, 0.0),), "terms"),
        (0.0, 7.0, ((0.0, 2.0, 0.0),), "terms"),
        (0.0, 7.0, (), "terms"),
        (7.0, 0.0, ((1.0, 2.0, 0.0),), "end"),
        ("now", 7.0, ((1.0, 2.0, 0.0),), "start"),
    ],
)
def test_sums_without_a_peak_are_refused(start, end, terms, parameter):
    with pytest.raises(InvalidArgumentError) as caught:
        SinusoidalPulse.of_unit_peak("burst", start, end, terms)
    assert caught.value.parameter == parameter


def test_response_is_that_of_direct_integration(pulse):
    found = rocking.peak_response("three_sines", **GROUPS)
    amplitude = 1.0 / GROUPS["slenderness"]
    motion = integrate(
        amplitude,
        GROUPS["frequency_ratio"],
        GROUPS["restitution"],
        shape=pulse.shape,
        start=rocking.paper.first_uplift_phase(pulse, amplitude),
        end=pulse.end,
    )
    assert len(motion.impact_times) == found.impacts > 0
    assert float(found.first_impact_time) == pytest.approx(motion.impact_times[0], abs=1e-8)
    assert float(found.end_rotation) == pytest.approx(abs(motion.rotation), abs=1e-8)
    mirrored = rocking.peak_response("-three_sines", **GROUPS)
    np.testing.assert_array_equal(mirrored.peak_rotation, found.peak_rotation)


def test_names_that_cannot_be_registered(pulse, monkeypatch):
    monkeypatch.setattr(pulses, "_REGISTERED", {"three_sines": pulse})
    mirrored = pulse.mirrored()
    for wrong in (pulse, mirrored, rocking.pulse("sine")):
        with pytest.raises(InvalidArgumentError, match=r"^`name` = "):
            register(wrong)
    with pytest.raises(InvalidArgumentError, match=r"^`pulse` = "):
        register("three_sines")
    with pytest.raises(InvalidArgumentError, match=r"^`pulse` = .*three_sines"):
        rocking.pulse("four_sines")


def test_numbers_in_files_never_change():
    stored = ("sine", "cosine", "half_sine", "rectangular", "c1", "c2", "ricker", "ricker_antisymmetric")
    stored += ("mavroeidis_papageorgiou",)
    assert PULSE_NAMES[: len(stored)] == stored
    assert [pulse_number(name) for name in stored] == list(range(9))


@pytest.fixture
def ramp(monkeypatch):
    monkeypatch.setattr(pulses, "_REGISTERED", {})
    made = rocking.SampledPulse([0.0, 1.0, -0.3, 0.0], [0.0, 0.1, 0.5, 0.8], name="ramp")
    register(made)
    return made


def test_a_cube_of_a_sampled_pulse_and_http_by_its_name(ramp, tmp_path, monkeypatch):
    axes = {"slenderness": np.linspace(0.55, 0.65, 21), "frequency_ratio": np.geomspace(2.8, 3.2, 21)}
    path = tmp_path / "spectra" / "ramp" / "eta-0.85.nc"
    write_dataset(spectrum("ramp", restitution=0.85, **axes), path)
    solved = float(rocking.peak_response(ramp, **GROUPS).peak_rotation)
    precompile.main()
    with TestClient(create_app(Settings(results=tmp_path))) as client:
        listed = client.get("/v1/pulses").json()["pulses"][-1]
        assert (listed["name"], listed["duration"]) == ("ramp", 1.0)
        found = client.get("/v1/response", params=GROUPS | {"pulse": "ramp", "absolute_tolerance": 1e-2}).json()
        assert found["source"] == "cube"
        assert found["peak_rotation"] == pytest.approx(solved, abs=found["error_bound"])
        for end in ("", ".nc", "/subset", ".zarr/zarr.json", ".zarr/.zmetadata"):
            response = client.get(f"/v1/datasets/spectra/ramp/eta-0.85{end}")
            assert response.status_code == 200 or ".zarr" in end, response.text
        assert client.get("/health").json()["problems"] == {}
    monkeypatch.setattr(pulses, "_REGISTERED", {})  # as in another process
    cube = open_cube(path)
    assert cube.pulse == ramp
    assert float(cube.response(**GROUPS, method="solver").peak_rotation) == solved
    register(rocking.SampledPulse([0.0, 1.0, 0.0], name="ramp"))
    with pytest.raises(DatasetError, match="other samples"):
        CubeCollection(tmp_path).response("ramp", **GROUPS, method="cube")
    found, used = CubeCollection(tmp_path).response("ramp", **GROUPS)
    assert (found.source.item(), used) == ("solver", ())
