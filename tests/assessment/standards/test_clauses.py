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
        angle = standards.asce43_rocking_angle(of_velocity(v), b, h)
        # v omega (1 - beta) = 2 g f1/theta with omega^2 = 2 g f1/(C3 theta^2 h): f1 = v^2 (1 - beta)^2/(2 g C3 h)
        rise = (v * (1 - damping)) ** 2 / (2 * G * 4 / 3 * (1 + (b / h) ** 2) * h)
        assert np.cos(angle) + b / h * np.sin(angle) - 1 == pytest.approx(rise, rel=1e-9)
    with_vertical = standards.asce43_rocking_angle(of_velocity(0.3), b, h, vertical_spectrum=of_velocity(0.6))
    assert with_vertical > standards.asce43_rocking_angle(of_velocity(0.3), b, h)
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
    velocity = standards.ishiyama_velocity(b, h, r)
    assert velocity == pytest.approx(0.4 * stop, rel=1e-9)
    pga, pgv = [2 * G, 0.9 * G * b / h, 2 * G], [0.99 * velocity, 9.0, 1.01 * velocity]
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
    demand = standards.circolare2009_floor_acceleration(3.0, 0.5, [1, 1000], ground_acceleration=0.5)
    assert demand == pytest.approx([1.5, 1.5 * 3000 / 2001])  # one storey: gamma = 1
    floor = {"displacement": 0.1, "period": 0.5, "height_ratio": 1.0, "storeys": 1}
    resonant = standards.circolare2009_floor_displacement(**floor, secant_period=0.5, ground_displacement=0.1)
    stiff = standards.circolare2009_floor_displacement(**floor, secant_period=1e-3, ground_displacement=0.0)
    assert resonant == pytest.approx(0.1 / np.sqrt(0.02))
    assert stiff == pytest.approx(0.1 * (1e-3 / 0.5) ** 2, rel=0.01)  # follows the floor


def test_a_body_on_a_floor_passes_the_check_at_the_ground_too() -> None:
    """On the lowest floor, height 0, the shape of the first mode is 0 and the demand is that of the ground."""
    assert standards.circolare2009_floor_acceleration(3.0, 0.0, 2, ground_acceleration=1.2) == pytest.approx(1.2)
    floor = {"displacement": 0.1, "period": 0.5, "height_ratio": 0.0, "storeys": 2}
    lowest = standards.circolare2009_floor_displacement(**floor, secant_period=2.0, ground_displacement=0.07)
    assert lowest == pytest.approx(0.07)
    spectrum = standards.circolare2019_floor_spectrum(0.0, [0.4, 0.6], 0.5, ground_acceleration=1.3)
    assert spectrum == pytest.approx([0.0, 1.3])  # (C7.2.5): beyond T_1


@pytest.mark.parametrize(("b", "h"), [(0.2, 0.8), (0.5, 0.9)])
def test_circolare2019_follows_the_statics_of_the_displaced_block(b: float, h: float) -> None:
    """Moments about the edge in the rotated position; periods from the secant at the limit displacement."""
    for theta in np.array([0.0, 0.2, 0.5, 0.9]) * np.arctan2(b, h):
        turn = np.array([[np.cos(theta), np.sin(theta)], [-np.sin(theta), np.cos(theta)]])
        x, y = turn @ [-b, h]  # centre of mass from the edge, after a rotation towards it
        capacity = standards.circolare2019_capacity(x + b, b, h, confidence_factor=1.35)
        assert capacity == pytest.approx(G * -x / y / 1.35, rel=1e-12)
    assert standards.circolare2019_activation(b, h) == pytest.approx(standards.circolare2019_capacity(0.0, b, h))
    for state, share, factor in (("SLV", 0.4, 0.84), ("SLC", 0.6, 0.78)):
        limit = standards.circolare2019_displacement_capacity(b, state)
        assert limit == pytest.approx(share * b)
        secant = 2 * np.pi * np.sqrt(limit / standards.circolare2019_capacity(limit, b, h))
        assert standards.circolare2019_period(b, h, state) == pytest.approx(factor * secant, rel=1e-12)
        assert standards.circolare2019_nonlinear_check([0.99 * limit, 1.01 * limit], b, state).tolist() == [True, False]
    with pytest.raises(rocking.InvalidArgumentError, match="limit_state"):
        standards.circolare2019_period(b, h, "SLD")


def test_circolare2019_agrees_with_a_computation_by_hand() -> None:
    """Block 0.4 m by 1.6 m: a(0.08 m) = 9.80665 0.12/0.81584 = 1.44243 m/s2, a(0.12 m) = 9.80665 0.08/0.82073."""
    assert standards.circolare2019_capacity([0.08, 0.12, 0.3], 0.2, 0.8) == pytest.approx(
        [1.442432, 0.955894, 0.0], rel=1e-6
    )
    assert standards.circolare2019_period(0.2, 0.8) == pytest.approx(1.242958, rel=1e-6)  # 5.277876 sqrt(0.055462)
    assert standards.circolare2019_period(0.2, 0.8, "SLC") == pytest.approx(1.736442, rel=1e-6)
    assert standards.circolare2019_linear_check([4.90, 4.91], 0.2, 0.8).tolist() == [True, False]
    # a parapet 1 m by 0.3 m of 18 kN/m3 and 1 GPa: 6.2 3.3333 1 sqrt(18e3/(1e9 9.80665))
    period = standards.circolare2019_elastic_period(1.0, 0.3, 18e3, 1e9)
    assert period == pytest.approx(0.0279992, rel=1e-5)
    # its branch (2 pi/0.028)^2 d is below the curve of the rigid block up to some 0.06 mm
    curve = standards.circolare2019_capacity([2e-5, 1e-3], 0.15, 0.5, elastic_period=period)
    assert curve == pytest.approx([1.007157, 2.920636], rel=1e-5)


def test_circolare2019_floors_agree_with_a_computation_by_hand() -> None:
    """Three storeys, T_1 = 0.4 s, damping 10 %, S_e(T_1) = 5 m/s2: a_Z = 5 9/7 0.8 sqrt(1.04) = 5.244706 m/s2."""
    peak = standards.circolare2019_floor_acceleration(5.0, 0.8, 3, 0.1)
    assert peak == pytest.approx(5.244706, rel=1e-6)
    # eta(8 %) = 0.877058; 1.1 0.877058/sqrt(0.1) = 3.050851: largest from 0.32 to 0.44 s
    periods, dampings = [1e-6, 0.16, 0.35, 1.2], {"damping": 0.08, "first_damping": 0.1}
    spectrum = standards.circolare2019_floor_spectrum(peak, periods, 0.4, 0.0, **dampings)
    below, above = 1 + 2.050851 * 0.5**1.6, 1 + 2.050851 * (1.2 / 0.44 - 1) ** 1.2
    assert spectrum == pytest.approx([5.244706, 16.00082 / below, 16.00082, 16.00082 / above], rel=1e-4)
    demand = standards.circolare2019_floor_displacement(peak, [0.35, 1.2], 0.4, 0.0, **dampings)
    assert demand == pytest.approx([16.00082 * 0.35**2 / 39.478418, 16.00082 / above * 1.44 / 39.478418], rel=1e-5)
    # where the spectrum falls faster than 1/T^2 grows, the displacement stays that at 1.1 T_1
    stays = standards.circolare2019_floor_displacement(peak, 0.45, 0.4, 0.0, damping=0.08, first_damping=1e-6)
    factor = 1.1 * 0.877058 / 1e-3
    assert stays == pytest.approx(factor * peak * 0.44**2 / 39.478418, rel=1e-5)


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
