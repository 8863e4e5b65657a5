"""Pulses given by samples in a configuration: cubes and boundaries like those of a named pulse."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import rocking
from rocking._datasets.cube import read_dataset, read_spectrum, stored_pulse
from rocking._lookup.collection import CubeCollection
from tests.sampling import ALL, number
from tests.workflow_fixtures import AFTERWARDS, SMOKE, rules_to_run, snakemake
from workflow.configuration import ConfigurationError, check
from workflow.pulses import configured_pulse, relative_entry

TRIANGLE = rocking.SampledPulse([0.0, 1.0, 0.0], name="triangle")
RAMP = rocking.SampledPulse([0.0, 3.0, -1.0, 0.0], [0.0, 0.1, 0.3, 0.7], 0.5, "ramp")


def configuration(pulses: list[Any]) -> dict[str, Any]:
    found: dict[str, Any] = yaml.safe_load(SMOKE.read_text())
    for name in ("figures", "claims"):
        del found[name]
    found |= {"title": "Sampled pulses", "pulses": pulses, "restitution": [0.85]}
    found["grid"] |= {"alpha_deg": [0], "slenderness": {"breaks": [0.2, 0.8], "steps": [0.05]}}
    found["grid"]["frequency_ratio"]["points"] = 21
    found["boundary"] |= {"nodes": 41, "nodes_rigid": 31}
    return found


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("saw", "pulses.1: `pulse` = 'saw' is not allowed; allowed: one of sine, cosine"),
        ({"acceleration": [0, 1, 0]}, "pulses.1: `name` = None"),
        ({"name": "sine", "acceleration": [0, 1, 0]}, "no name of the catalogue"),
        ({"name": "../up", "acceleration": [0, 1, 0]}, "pulses.1: `name` = '../up'"),
        ({"name": "a", "acceleration": [0, 1, 0], "dt": 1}, "pulses.1: `key` = 'dt'"),
        ({"name": "a", "acceleration": [0, "x", 0]}, "pulses.1: `acceleration` = "),
        ({"name": "a", "acceleration": [0, 1, 0], "time": [0, 2, 1]}, "pulses.1: `time` = 1.0 at index 2"),
        ({"name": "a", "file": "none.csv"}, "none.csv': no such file"),
        ({"name": "a", "file": "bad.csv"}, "bad.csv, line 2: x"),
        ({"name": "a", "file": "bad.csv", "acceleration": [0, 1]}, "either a file or the key acceleration"),
    ],
    ids=str,
)
def test_invalid_samples_are_refused_in_one_line(entry: Any, message: str, tmp_path: Path) -> None:
    (tmp_path / "bad.csv").write_text("1\nx\n")
    with pytest.raises(ConfigurationError) as caught:
        check(configuration(["sine", entry]), tmp_path)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_two_pulses_have_two_names() -> None:
    entries = [{"name": "a", "acceleration": samples} for samples in ([0, 1, 0], [0, 1, 1])]
    with pytest.raises(ConfigurationError, match="different names"):
        check(configuration(entries))


def test_samples_of_a_file_are_those_of_a_list(tmp_path: Path) -> None:
    values, times = np.random.default_rng(3).uniform(-1.0, 1.0, (2, 500))
    pulse = rocking.SampledPulse(values, np.cumsum(np.abs(times)) / 7.0, 0.3, "noise")
    rows = zip(pulse.phases.tolist(), values.tolist(), strict=True)
    (tmp_path / "noise.csv").write_text("".join(f"{t},{a}\n" for t, a in rows))
    entry = {"name": "other", "file": "noise.csv", "period": 2.0 * np.pi}
    found = configured_pulse(entry, tmp_path)
    assert isinstance(found, rocking.SampledPulse)
    assert (found.name, found.digest) == ("other", pulse.digest)
    assert configured_pulse(relative_entry(entry, str(tmp_path))) == found


@pytest.mark.long
def test_data_sets_of_sampled_pulses_without_figures_and_claims(tmp_path: Path) -> None:
    (tmp_path / "ramp.csv").write_text("time,acceleration\n0,0\n0.1,3\n0.3,-1\n0.7,0\n")
    triangle = {"name": "triangle", "acceleration": [0, 2, 0], "time": [0, 0.5, 1]}
    ramp = {"name": "ramp", "file": "ramp.csv", "period": 0.5}
    entries, pulses = number([triangle], [triangle, ramp]), number([TRIANGLE], [TRIANGLE, RAMP])
    written = tmp_path / "data.yaml"
    written.write_text(yaml.safe_dump(configuration(entries)))
    run = tmp_path / "run"
    run.mkdir()
    finished = snakemake(run, configuration=written)
    assert finished.returncode == 0, finished.stdout
    listed = json.loads((run / "results/manifest.json").read_text())["products"]
    kinds = "spectra", "overturning"
    files = {f"{kind}/{pulse.name}/eta-0.85.nc" for kind in kinds for pulse in pulses}
    files |= {f"spectra/{pulse.name}/restitution-errors.nc" for pulse in pulses}
    assert set(listed) == files | {"stac"} | {f"zarr/{pulse.name}.zarr" for pulse in pulses}
    verdicts = (run / "results/checks.txt").read_text()
    assert "failed" not in verdicts
    assert [name for name in listed if f"[{name}]" not in verdicts] == []
    for pulse in pulses:
        for kind in kinds:
            assert listed[f"{kind}/{pulse.name}/eta-0.85.nc"]["pulse_sha256"] == pulse.digest
        _check_cube(run / "results", pulse)
    assert not ALL or "Nothing to be done" in snakemake(run, configuration=written).stdout

    triangle["acceleration"] = [0, 2, 1]  # other samples make the products of this pulse again
    written.write_text(yaml.safe_dump(configuration(entries)))
    planned = snakemake(run, "--dry-run", configuration=written)
    again = {"overturning", "spectra", "restitution_errors", "zarr_store", "check_data_sets"}
    assert rules_to_run(planned.stdout) == again | {"stac", *AFTERWARDS}, planned.stdout
    assert "of the triangle pulse" in planned.stdout
    assert "of the ramp pulse" not in planned.stdout


def test_a_pulse_of_the_catalogue_has_its_parameters_in_its_text(tmp_path):
    name = "mavroeidis_papageorgiou(cycles=3,phase=0.5rad)"
    assert configured_pulse("mavroeidis_papageorgiou(phase=0.5 rad, cycles=3)", tmp_path) == name
    assert rocking.pulse(name) == rocking.pulse("mavroeidis_papageorgiou", cycles=3, phase=0.5)


def _check_cube(results: Path, pulse: rocking.SampledPulse) -> None:
    """Files hold the samples, by which another process asks the solver; `workflow/checks` compares their nodes."""
    path = results / f"spectra/{pulse.name}/eta-0.85.nc"
    cube = read_spectrum(path)
    assert stored_pulse(cube) == pulse
    assert int(cube.pulse) == -1
    assert cube.pulse.attrs["pulse_digest"] == pulse.digest
    curves = read_dataset(results / f"overturning/{pulse.name}/eta-0.85.nc")
    assert stored_pulse(curves) == pulse
    assert curves.sizes["curve"] > 0
    point = {"slenderness": 0.43, "frequency_ratio": 2.2, "restitution": 0.85}
    outside = {"slenderness": 0.1, "frequency_ratio": 20.0, "restitution": 0.85}
    code = f"import rocking; cube = rocking.open_cube({str(path)!r})\n"
    for given, method in ((point, "solver"), (outside, "auto")):
        code += f"print(float(cube.response(**{given!r}, method={method!r}).peak_rotation))\n"
    printed = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True, check=True).stdout
    expected = [float(rocking.peak_response(pulse, **given).peak_rotation) for given in (point, outside)]
    assert printed == "".join(f"{value}\n" for value in expected)
    assert CubeCollection(results).problems() == {}
