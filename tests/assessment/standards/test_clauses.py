"""The clauses against derivations of their own: energy, decay, statics, and quoted rules."""

import inspect
import re
from pathlib import Path

import numpy as np
import pytest
from rocking_assessment import standards
from scipy.integrate import quad
from scipy.optimize import brentq

import rocking

ROOT = Path(__file__).parents[3]
G = 9.80665
BODIES = [(0.2, 0.8, None), (0.05, 0.6, 0.4), (0.5, 0.9, 0.3)]  # b, h, gyration


def momentum_restitution(b: float, h: float, r: float | None) -> float:
    """(2.4) from the body itself."""
    body = rocking.RigidBody(left=b, right=b, height=h, gyration=r) if r else rocking.Block(2 * b, 2 * h)
    return float(body.right.restitution)


@pytest.mark.parametrize(("b", "h", "r"), BODIES)
def test_asce43_has_energy_and_decay_of_an_equivalent_oscillator(b: float, h: float, r: float | None) -> None:
    """The oscillator stores the work against gravity, and loses in a cycle what two impacts take."""
    alpha, radius = np.arctan2(b, h), np.hypot(b, h)
    inertia = (r * r if r else radius**2 / 3) + radius**2
    for theta in np.array([0.01, 0.3, 1.0]) * alpha:
        work = quad(lambda angle: G * radius * np.sin(alpha - angle), 0.0, theta, epsabs=1e-14)[0]  # per mass
        assert 0.5 * standards.asce43_capacity(theta, b, h) * h * theta == pytest.approx(work, rel=1e-10)
        omega = 2 * np.pi * standards.asce43_effective_frequency(theta, b, h, r)
        assert 0.5 * inertia * omega**2 * theta**2 == pytest.approx(work, rel=1e-10)
    cycle = momentum_restitution(b, h, r) ** 2
    zeta = brentq(lambda x: np.exp(-2 * np.pi * x / np.sqrt(1 - x * x)) - cycle, 0.0, 0.999, xtol=1e-14)
    assert standards.asce43_effective_damping(b, h, r) == pytest.approx(zeta, rel=1e-10)
    assert standards.asce43_capacity(alpha, b, h, 2.0) < standards.asce43_capacity(alpha, b, h)


def test_asce43_angle_and_sliding_are_where_demand_meets_capacity() -> None:
    """A spectrum v omega of constant velocity has one angle; constants are below or above at all angles."""

    def of_velocity(v: float):  # type: ignore[no-untyped-def]
        return lambda frequency, damping: v * 2 * np.pi * frequency * (1 - damping)

    b, h = 0.2, 0.8
    damping = float(standards.asce43_effective_damping(b, h))
    for v in (0.3, 0.7):
        found = standards.asce43_rocking_angle(of_velocity(v), b, h)
        # v omega (1 - beta) = 2 g f1/theta with omega^2 = 2 g f1/(C3 theta^2 h): f1 = v^2 (1 - beta)^2/(2 g C3 h)
        rise = (v * (1 - damping)) ** 2 / (2 * G * 4 / 3 * (1 + (b / h) ** 2) * h)
        assert np.cos(found) + b / h * np.sin(found) - 1 == pytest.approx(rise, rel=1e-9)
    more = standards.asce43_rocking_angle(of_velocity(0.3), b, h, vertical_spectrum=of_velocity(0.6))
    assert more > standards.asce43_rocking_angle(of_velocity(0.3), b, h)
    assert standards.asce43_rocking_angle(lambda f, _: 0.5 * f**0, b, h) == 0.0
    assert np.isnan(standards.asce43_rocking_angle(lambda f, _: 50 * f**0, b, h))
    slope, mu = 0.4, 0.3 * (1 - 0.4 * 0.2)
    slip = standards.asce43_sliding_distance(of_velocity(slope / 0.9), 0.3, 0.2 * G)
    assert slip == pytest.approx(slope**2 / (2 * mu * G), rel=1e-9)  # f_es = c_s/(2 pi v): delta = v^2/c_s
    assert standards.asce43_sliding_distance(lambda f, _: 0.1 * f**0, 0.3) == 0.0
    with pytest.raises(rocking.InvalidArgumentError, match="half_width"):
        standards.asce43_rocking_angle(of_velocity(0.3), 1.0, 0.5)


@pytest.mark.parametrize(("b", "h", "r"), BODIES)
def test_ishiyama_is_a_share_of_the_sudden_stop(b: float, h: float, r: float | None) -> None:
    """Momentum at the edge after the ground stops, and the energy up to the point of balance."""
    radius = np.hypot(b, h)
    inertia = (r * r if r else radius**2 / 3) + radius**2

    def left(v: float) -> float:
        return 0.5 * inertia * (v * h / inertia) ** 2 - G * (radius - h)  # energy beyond the balance, per mass

    stop = brentq(left, 0.0, 100.0, xtol=1e-13)
    found = standards.ishiyama_velocity(b, h, r)
    assert found == pytest.approx(0.4 * stop, rel=1e-9)
    pga, pgv = [2 * G, 0.9 * G * b / h, 2 * G], [0.99 * found, 9.0, 1.01 * found]
    assert standards.ishiyama_check(pga, pgv, b, h, r).tolist() == [True, True, False]


def test_slender_bodies_follow_the_quoted_rules() -> None:
    """10 B/sqrt(H) in cm and s; West's formula is the uplift of the body."""
    width, height = 10.0, 200.0  # cm
    velocity = 100 * standards.ishiyama_velocity(width / 200, height / 200)
    assert velocity == pytest.approx(10 * width / np.sqrt(height), rel=0.03)
    block = rocking.Block(0.4, 1.6)
    assert standards.west_acceleration(0.2, 0.8) == pytest.approx(float(block.uplift_acceleration))
    assert standards.static_check([2.4, 2.5], 0.2, 0.8).tolist() == [True, False]


def test_circolare_follows_the_linear_capacity_curve() -> None:
    """Point and secant of a straight curve from a_0 at rest to zero at d_0 = b; demands on floors in their limits."""
    b, h = 0.2, 0.8
    d, a = np.linspace(0, b, 1001), np.linspace(G * b / h, 0, 1001)
    ds = 0.4 * 0.4 * b
    slope = np.interp(ds, d, a) / ds
    assert standards.circolare2009_secant_period(b, h) == pytest.approx(2 * np.pi / np.sqrt(slope), rel=1e-9)
    assert standards.circolare2009_displacement_capacity(b) == pytest.approx(0.08)
    assert standards.circolare2009_nonlinear_check([0.0799, 0.0801], b).tolist() == [True, False]
    limit = 2 * G * b / h
    assert standards.circolare2009_linear_check([0.99 * limit, 1.01 * limit], b, h).tolist() == [True, False]
    assert not standards.circolare2009_linear_check(0.99 * limit, b, h, confidence_factor=1.2)
    demand = standards.circolare2009_floor_acceleration(3.0, 0.5, [1, 1000])  # one storey: gamma = 1
    assert demand == pytest.approx([1.5, 1.5 * 3000 / 2001])
    resonant, stiff = standards.circolare2009_floor_displacement(0.1, 0.5, [0.5, 1e-3], 1.0, 1)
    assert resonant == pytest.approx(0.1 / np.sqrt(0.02))
    assert stiff == pytest.approx(0.1 * (1e-3 / 0.5) ** 2, rel=0.01)  # follows the floor


def test_the_page_lists_each_function_once_with_a_test() -> None:
    """`docs/assessment/standards.md` names the functions of the package, and tests that exist."""
    rows = [
        line.split("|")[1:-1]
        for line in (ROOT / "docs/assessment/standards.md").read_text().splitlines()
        if "| `" in line
    ]
    named = [re.findall(r"`(\w+)`", row[2])[0] for row in rows]
    public = [name for name in dir(standards) if inspect.isfunction(getattr(standards, name))]
    assert sorted(named) == sorted(public)
    tests = {name for row in rows for name in re.findall(r"`(test_\w+)`", row[3])}
    assert tests <= set(globals())
    assert all(row[4].strip() for row in rows)
