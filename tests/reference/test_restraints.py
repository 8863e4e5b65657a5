"""Multi-precision integration of restrained blocks: against the independent table, the literal moments, and itself."""

import csv
import math
from pathlib import Path

import pytest
from flint import arb

from reference.equation_of_motion import Motion, Restraint
from reference.exact_pulses import exact_pulse
from reference.exact_response import working_precision
from reference.multiprecision import integrate

TABLE = Path(__file__).parents[1] / "data" / "reference" / "restraints.csv"
ROWS = list(csv.DictReader(TABLE.read_text().splitlines()))
GROUPS = {"kappa": "stiffness", "sigma": "prestress", "zeta": "damping"}


def test_outcome_and_peak_of_each_case_of_the_table() -> None:
    """The table is made by DOP853, good to 1e-9."""
    with working_precision(192):
        for row in ROWS:
            cell = {name: float(row[name]) for name in ("slenderness", "frequency_ratio", "restitution")}
            cell |= {argument: float(row[column]) for column, argument in GROUPS.items()}
            response = integrate(row["pulse"], **cell)
            assert response.overturned == (row["overturned"] == "1"), row
            if not response.overturned:
                assert float(response.peak_rotation) == pytest.approx(float(row["peak_rotation"]), rel=1e-9), row


@pytest.mark.parametrize("alpha", [None, 0.3, 1.2])
def test_acceleration_is_that_of_the_stated_moments(alpha: float | None) -> None:
    """(P0 + 2 k b sin(theta/2)) b cos(theta/2) and 4 b^2 c theta', over m g R alpha."""
    kappa, sigma, zeta = 0.7, 0.4, 0.2
    z, w, step, a, omega, time = 0.8, -0.3, 0.125, 3.0, 2.0, 0.6
    with working_precision(192):
        restraint = Restraint(arb(kappa), arb(sigma), arb(zeta))
        motion = Motion(exact_pulse("sine"), arb(a), arb(omega), None if alpha is None else arb(alpha), restraint)
        series = motion.expand(arb(time), arb(z), arb(w), -1, arb(step), 4, False)
        acceleration = 2.0 * float(series[2]) / step**2
    forced = -a * math.sin(omega * time)
    if alpha is None:
        expected = z - 1.0 - forced - sigma - kappa * z
    else:
        theta, sine = alpha * z, math.sin(alpha)
        gravity = math.sin(alpha - theta) + forced * math.tan(alpha) * math.cos(alpha - theta)
        tendon = (sigma * sine + 2.0 * kappa * math.sin(0.5 * theta)) * math.cos(0.5 * theta)
        expected = -(gravity + tendon) / alpha
    assert acceleration == pytest.approx(expected - 2.0 * zeta * w, rel=1e-13)


def test_small_angles_converge_to_the_slender_block() -> None:
    cell = {"slenderness": 0.6, "frequency_ratio": 2.0, "restitution": 0.8}
    cell |= {"stiffness": 0.4, "prestress": 0.1, "damping": 0.2}
    with working_precision(192):
        slender = integrate("sine", **cell).peak_rotation
        near, far = (integrate("sine", **cell, alpha=alpha).peak_rotation for alpha in (1e-8, 1e-4))
        assert 1e7 < float((far - slender) / (near - slender)) < 1.01e8


@pytest.mark.parametrize("alpha", [None, 0.4])
def test_more_bits_do_not_change_fifty_digits(alpha: float | None) -> None:
    cell = {"slenderness": 0.5, "frequency_ratio": 3.0, "restitution": 0.9, "alpha": alpha}
    cell |= {"stiffness": 1.7, "prestress": 0.2, "damping": 0.1}
    peaks = []
    for bits in (192, 288):
        with working_precision(bits):
            peaks.append(integrate("cosine", **cell).peak_rotation)
    with working_precision(288):
        assert abs(peaks[0] - peaks[1]) <= arb("1e-50") * peaks[1]
