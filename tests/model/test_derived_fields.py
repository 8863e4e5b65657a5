"""Fields that are derived from others: one declaration makes them appear wherever responses do."""

import ast
import json
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rocking
from rocking._datasets.cube import read_spectrum, write_dataset
from rocking._lookup.cube import open_cube
from rocking._model.energy import residual_energy
from rocking._model.fields import DERIVED_FIELDS
from rocking._solver.bounded_response import solve_with_bound
from rocking._spectra.cubes import spectrum

ROOT = Path(__file__).parents[2]

DECLARATION = """
RETURNS = ResponseField(
    "returns", "f8", "1", "3.11", "whether the block moves back as the pulse ends",
    derive=lambda fields, groups, motion, body: (fields["end_velocity"] < 0.0) * groups["restitution"],
)
def to_rest(fields, groups, motion, body):
    "From the uplift to the end of the pulse, and in free rocking without loss to the next impact; slender [s]."
    if body is None or "frequency_ratio" not in groups:
        return np.full(fields["outcome"].shape, np.nan)
    end = (motion.end - motion.start) / groups["frequency_ratio"]
    free = np.arctanh(np.minimum(fields["end_rotation"], 0.9))
    return np.where(fields["outcome"] == 1, (end - fields["uplift_time"] + free) / body.frequency_parameter, np.nan)
TO_REST = ResponseField(
    "rocking_duration", "f8", "s", "3.11", "duration of rocking", "it does not come to rest", derive=to_rest,
    kinds=KINDS - {"edges"},
)
"""

SCRIPT = """
import json, sys, types
import importlib.util

spec = importlib.util.find_spec("rocking._model.fields")
module = importlib.util.module_from_spec(spec)
sys.modules[spec.name] = module
exec(compile(sys.argv[1], spec.origin, "exec"), vars(module))

import numpy as np, rocking
from fastapi.testclient import TestClient
from rocking_api.app import create_app
from rocking_api.settings import Settings
from rocking._spectra.cubes import spectrum
from typer.testing import CliRunner
from rocking._cli.app import app

groups = {"slenderness": [0.4, 0.3], "frequency_ratio": 5.0, "restitution": 0.85}
found = rocking.peak_response("sine", **groups)
options = ["--slenderness", "0.3", "--frequency-ratio", "5", "--restitution", "0.85"]
printed = CliRunner().invoke(app, ["response", "--pulse", "sine", *options, "--format=csv"])
query = {"pulse": "sine", "slenderness": 0.3, "frequency_ratio": 5.0, "restitution": 0.85, "method": "solver"}
with TestClient(create_app(Settings(results=sys.argv[2], max_seconds=600.0)), base_url="http://127.0.0.1") as client:
    one = client.get("/v1/response", params=query).json()
    many = client.post("/v1/response", json=query, headers={"Accept": "text/csv"}).text
    given = {"width": 0.4, "height": 1.6, "peak_acceleration": 4.0, "period": 0.5}
    one_block = client.get("/v1/blocks/response", params=given | {"pulse": "sine", "method": "solver"}).json()
    rows = client.post("/v1/blocks/response?pulse=sine", json={"blocks": [given]}).json()
block = rocking.Block(0.4, 1.6).response("sine", peak_acceleration=4.0, period=0.5)
sized = ["--width=0.4m", "--height=1.6m", "--peak-acceleration=4m/s2", "--period=0.5s", "--format=json"]
in_si = json.loads(CliRunner().invoke(app, ["response", "--pulse", "sine", *sized]).output)
cube = spectrum("sine", restitution=0.85, slenderness=np.linspace(0.2, 0.5, 4),
                frequency_ratio=np.linspace(4.0, 6.0, 4), derived=["returns"])
print(json.dumps({
    "attribute": found.returns.tolist(),
    "xarray": found.to_xarray()["returns"].values.tolist(),
    "pandas": list(found.to_pandas().columns),
    "command": printed.output,
    "one": one,
    "durations": [block.rocking_duration, block.to_dict()["rocking_duration"], block.to_pandas()["rocking_duration"],
                  block.to_xarray()["rocking_duration"].item(), one_block["rocking_duration"],
                  rows["rocking_duration"][0], in_si["rocking_duration"]],
    "units": [block.to_xarray()["rocking_duration"].attrs["units"], one_block["units"]["rocking_duration"]],
    "many": many,
    "cube": cube["returns"].values.max(),
}))
"""


def test_a_declaration_alone_makes_a_field_appear_everywhere(tmp_path):
    module = ast.parse((ROOT / "rocking/_model/fields.py").read_text())
    names = [ast.unparse(one.targets[0]) if isinstance(one, ast.Assign) else "" for one in module.body]
    place = names.index("DERIVED_FIELDS")
    module.body[place].value.elts += [ast.Name(name, ast.Load()) for name in ("RETURNS", "TO_REST")]
    module.body[place:place] = ast.parse(DECLARATION).body
    declared = ast.unparse(module)
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, declared, str(tmp_path)], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["attribute"] == found["xarray"] == [0.0, 0.85]
    assert "returns" in found["pandas"]
    assert found["one"]["returns"] == found["cube"] == 0.85
    (duration,) = set(found["durations"])
    assert 0.44 < duration < 0.6
    assert found["units"] == ["s", "s"]
    for text in (found["command"], found["many"]):
        header, row = text.strip().splitlines()
        assert float(dict(zip(header.split(","), row.split(","), strict=True))["returns"]) == 0.85


GROUPS = {
    "slenderness": np.array([0.3, 0.5, 0.8])[:, None, None],
    "frequency_ratio": np.array([1.0, 5.0, 9.0])[:, None],
    "restitution": 0.85,
}


@pytest.mark.parametrize("alpha", [None, 0.05, 0.3, 1.2])
def test_residual_energy_is_that_of_the_motion(alpha):
    """Integrated directly: the energy at the end of the pulse over that at alpha, both from rest."""
    angle = 1e-6 if alpha is None else alpha
    for s, w in [(0.6, 6.0), (0.8, 2.0)]:
        groups = {"slenderness": s, "frequency_ratio": w, "restitution": 0.0, "alpha": alpha}
        found = rocking.peak_response("half_sine", **groups)
        uplift = np.arcsin(s) / w

        def rates(tau, state, s=s, w=w):
            inside, left = angle * (1.0 - state[0]), np.tan(angle) / s * np.sin(w * tau)
            return [state[1], (-np.sin(inside) + left * np.cos(inside)) / angle]

        motion = solve_ivp(rates, (uplift, np.pi / w), [0.0, 0.0], rtol=1e-11, atol=1e-13)
        z, v = motion.y[:, -1]
        assert motion.y[0, 1:].min() > 0.0  # no impact
        potential = np.cos(angle * (1.0 - z)) - np.cos(angle)
        exact = (0.5 * (angle * v) ** 2 + potential) / (1.0 - np.cos(angle))
        tolerance = 1e-3 if alpha is None else 1e-8  # cosines of small angles cancel
        assert float(found.residual_energy) == pytest.approx(exact, rel=tolerance)


@pytest.mark.parametrize("alpha", [0.0, 0.3, 1.2])
def test_residual_energy_at_rest_and_at_the_unstable_equilibrium(alpha):
    fields = {
        "end_rotation": np.array([0.0, 1.0, 0.0]),
        "end_velocity": np.array([0.0, 0.0, np.sinc(alpha / 2 / np.pi)]),
    }
    np.testing.assert_allclose(residual_energy(fields, {"alpha": np.array(alpha)}), [0.0, 1.0, 1.0], rtol=1e-15)


def test_blocks_with_less_energy_than_the_unstable_equilibrium_survive():
    found = rocking.peak_response("sine", **GROUPS, alpha=np.array([0.0, 0.2, 0.6]))
    low = (found.residual_energy < 1.0) & (found.end_rotation < 1.0)
    assert low.any()
    assert not low.all()
    assert not found.overturned[low].any()
    assert (found.residual_energy[found.outcome == rocking.Outcome.NO_UPLIFT] == 0.0).all()


@pytest.mark.parametrize("frequency_ratio", [1e-9, 1e-3, 1e9])
def test_the_energy_is_finite_at_the_ends_of_the_ranges(frequency_ratio):
    """Where overturning is certain at rotations of 1e157 alpha, too."""
    for pulse in ("rectangular", "sine", "ricker"):
        found = rocking.peak_response(
            pulse,
            slenderness=[1e-6, 0.9],
            frequency_ratio=frequency_ratio,
            restitution=0.85,
            alpha=[[0.0], [1e-12], [1.57]],
        )
        assert np.isfinite(found.residual_energy).all()


def test_attributes_are_complete_and_no_others_exist():
    for found in (rocking.peak_response("sine", **GROUPS), solve_with_bound("sine", **GROUPS, alpha=None)):
        for field in DERIVED_FIELDS:
            assert getattr(found, field.name).dtype == np.dtype(field.dtype)
            assert getattr(found, field.name).shape == found.peak_rotation.shape
            assert field.name in dir(found)
            assert field.meaning in " ".join((type(found).__doc__ or "").split()) or field.name in type(found).__doc__
        with pytest.raises(AttributeError, match="residual_energie"):
            _ = found.residual_energie
        assert pickle.loads(pickle.dumps(found)) == found


def test_bounded_responses_have_them_where_they_are_solved(tmp_path):
    axes = {"slenderness": np.linspace(0.5, 0.7, 41), "frequency_ratio": np.geomspace(5.0, 8.0, 31)}
    cube = spectrum("sine", restitution=0.85, derived=["residual_energy"], **axes)
    write_dataset(cube, tmp_path / "cube.nc")
    stored = read_spectrum(tmp_path / "cube.nc").residual_energy
    solved = rocking.peak_response(
        "sine", slenderness=axes["slenderness"][:, None], frequency_ratio=axes["frequency_ratio"], restitution=0.85
    )
    np.testing.assert_array_equal(stored.values[0], solved.residual_energy)
    assert stored.attrs["units"] == "1"
    found = open_cube(tmp_path / "cube.nc").response(slenderness=[0.6, 0.9, 1.1], frequency_ratio=6.0)
    assert found.from_cube.tolist() == [True, False, False]
    assert np.isnan(found.residual_energy).tolist() == [True, False, False]
    assert found.residual_energy[2] == 0.0
