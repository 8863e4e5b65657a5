"""Fields that are derived from others: one declaration makes them appear wherever responses do."""

import pickle

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
