"""Bodies that are released from a rotation: Housner's closed form, energy, and an integrator of SciPy."""

import json
import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from typer.testing import CliRunner

import rocking
from rocking import InvalidArgumentError, RigidBody
from rocking._cli.app import app


@pytest.mark.parametrize("share", [0.01, 0.5, 0.999])
def test_times_of_the_slender_block_are_those_of_housner(share: float) -> None:
    """A quarter period is acosh(1/(1 - theta/alpha))/p; each impact leaves eta^2 of the kinetic energy."""
    p, eta = 2.0, 0.9
    body = rocking.EquivalentBlock(0.2, p, restitution=eta, uplift_acceleration=2.0)
    found = body.history(start=-0.2 * share, duration=60.0)
    at = math.acosh(1.0 / (1.0 - share)) / p
    for time in found["impact_time"].values[:6]:
        assert time == pytest.approx(at, rel=1e-10)
        share = 1.0 - math.sqrt(1.0 - eta**2 * (1.0 - (1.0 - share) ** 2))
        at += 2.0 * math.acosh(1.0 / (1.0 - share)) / p


Array = NDArray[np.float64]

BODIES: dict[str, Any] = {
    "leaning": RigidBody(left=0.2, right=0.3, height=1.0, inclination=0.03),
    "wall": RigidBody(left=0.2, right=0.3, height=1.0, sides="right", rebound=0.6),
    "block": rocking.Block(0.4, 1.6),
}


@pytest.mark.parametrize("name", BODIES)
def test_it_moves_as_an_integrator_says(name: str) -> None:
    body = BODIES[name]
    edges = {1.0: body.right, -1.0: body.left}
    sign, z, w, at = 1.0, 0.15, 0.0, 0.0
    found = body.history(start=0.15, duration=6.0, samples=50)
    for count in range(4):
        alpha, p = (float(getattr(edges[sign], each)) for each in ("alpha", "frequency_parameter"))

        def rate(_: float, y: Array, alpha: float = alpha, p: float = p) -> list[float]:
            return [y[1], -p * p * math.sin(alpha - y[0])]

        def ground(_: float, y: Array) -> float:
            return float(y[0])

        vars(ground).update(terminal=True, direction=-1.0)
        solved = solve_ivp(rate, (at, 9.0), [z, w], "DOP853", rtol=1e-12, atol=1e-14, events=ground, dense_output=True)
        assert solved.sol is not None
        inside = (found["time"] > at) & (found["time"] < solved.t[-1])
        times = found["time"].values[inside]
        np.testing.assert_allclose(found["rotation"].values[inside], sign * solved.sol(times)[0], atol=1e-10)
        assert found["impact_time"][count] == pytest.approx(solved.t[-1], rel=1e-10)
        at, z, w = solved.t[-1], 0.0, -max(float(edges[sign].restitution), 0.0) * solved.y[1, -1]
        sign *= 1.0 if name == "wall" else -1.0


def test_without_losses_energy_is_constant() -> None:
    body = rocking.Block(0.4, 1.6)
    found = body.history(start="5 deg", restitution=1.0, duration=10.0)
    theta, velocity = np.abs(found["rotation"].values), found["angular_velocity"].values
    energy = 0.5 * (velocity / body.frequency_parameter) ** 2 + np.cos(body.alpha - theta)
    np.testing.assert_allclose(energy, energy[0], rtol=1e-11)
    assert found.sizes["impact"] > 5
    assert not np.any(found["ground_acceleration"])


def test_it_may_overturn_about_the_other_edge() -> None:
    body = RigidBody(left=0.02, right=0.3, height=1.0, gyration=1.0)
    high, low, over = (body.history(start=start) for start in (0.25, 5e-4, 0.4))
    assert (high.outcome, low.outcome) == ("OVERTURNED_AFTER_IMPACT", "RECOVERS")
    assert high["rotation"].values[-1] < -float(body.left.alpha)
    assert (over.outcome, over.impacts) == ("OVERTURNED_DIRECTLY", 0)
    contact = rocking.Block(0.4, 1.6).history(start=0.05, contact=True)
    assert contact["normal_reaction"].min() > 0.5


@pytest.mark.parametrize(
    ("body", "wrong", "name"),
    [
        ("block", {"start": 0.0}, "start"),
        ("block", {"start": 2.0}, "start"),
        ("block", {"start": 0.1, "peak_acceleration": 3.0}, "peak_acceleration"),
        ("block", {"start": 0.1, "motion": "sine"}, "motion"),
        ("block", {}, "motion"),
        ("wall", {"start": -0.1}, "no wall blocks"),
        ("wall", {"start": 0.1, "contact": True}, "contact"),
    ],
)
def test_refused(body: str, wrong: dict[str, Any], name: str) -> None:
    with pytest.raises(InvalidArgumentError, match=name):
        BODIES[body].history(**wrong)


def test_command() -> None:
    size = ["history", "--width", "40cm", "--height", "1.6m"]
    out = CliRunner().invoke(app, [*size, "--start", "3deg", "--duration", "2s", "--format", "json"])
    found = rocking.Block(0.4, 1.6).history(start="3 deg", duration="2 s")
    np.testing.assert_array_equal(json.loads(out.stdout)["rotation"], found["rotation"].values)
    for more, text in ((["--start", "3deg", "--pulse", "sine"], "--pulse"), ([], "--start")):
        out = CliRunner().invoke(app, [*size, *more])
        assert out.exit_code == 2
        assert text in out.output
