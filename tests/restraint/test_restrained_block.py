"""Blocks with tendon and damper in SI units: groups, responses, thresholds, and the restraint that saves a block."""

import numpy as np
import pytest

import rocking
from rocking import restraint

BLOCK = rocking.Block(0.4, 1.6)
MASS = 600.0
HELD = {"stiffness": 5e4, "prestress": 800.0, "damping": 3000.0}
PULSE = {"peak_acceleration": 6.5, "period": 0.5}


def groups() -> dict[str, float]:
    """The groups of `HELD` by their definition."""
    b, radius, g = BLOCK.half_width, BLOCK.half_diagonal, BLOCK.gravity
    return {
        "stiffness": HELD["stiffness"] * b**2 / (MASS * g * radius),
        "prestress": HELD["prestress"] / (MASS * g),
        "damping": 1.5 * (b / radius) ** 2 * HELD["damping"] / (MASS * BLOCK.frequency_parameter),
    }


def test_response_is_that_in_the_groups() -> None:
    held = BLOCK.with_restraint(**HELD, mass=MASS)
    response = held.response("sine", **PULSE)
    in_groups = rocking.peak_response(
        "sine",
        slenderness=BLOCK.uplift_acceleration / 6.5,
        frequency_ratio=2.0 * np.pi / 0.5 / BLOCK.frequency_parameter,
        restitution=BLOCK.momentum_restitution,
        alpha=BLOCK.alpha,
        **groups(),
    )
    assert float(response.rotation) == pytest.approx(float(in_groups.peak_rotation) * BLOCK.alpha, rel=1e-12)
    direct = BLOCK.with_restraint(**groups()).response("sine", **PULSE)
    assert float(direct.rotation) == pytest.approx(float(response.rotation), rel=1e-12)


def test_forces_and_strokes() -> None:
    held = BLOCK.with_restraint(**HELD, mass=MASS)
    assert float(held.tendon_force(0.0)) == pytest.approx(800.0)
    assert float(held.tendon_force(-0.1)) == pytest.approx(800.0 + 5e4 * 0.4 * np.sin(0.05))
    assert float(held.tendon_stretch(0.1)) == pytest.approx(0.4 * np.sin(0.05))
    assert float(held.damper_stroke(0.1)) == pytest.approx(0.4 * np.sin(0.1))
    assert float(held.uplift_acceleration) == pytest.approx(BLOCK.uplift_acceleration * (1.0 + 800.0 / MASS / 9.80665))


def test_arrays_of_restraints_broadcast() -> None:
    damping = np.array([0.0, 1000.0, 4000.0])
    response = BLOCK.with_restraint(damping=damping, mass=MASS).response("sine", **PULSE)
    assert response.rotation.shape == (3,)
    for k in range(3):
        alone = BLOCK.with_restraint(damping=damping[k], mass=MASS).response("sine", **PULSE)
        assert response.rotation[k] == pytest.approx(float(alone.rotation), rel=1e-12, nan_ok=True)


def test_thresholds_are_those_of_the_responses() -> None:
    held = BLOCK.with_restraint(**HELD, mass=MASS)
    for change in held.thresholds("sine", period=0.5):
        for factor, above in ((1.0 + 2e-6, True), (1.0 - 2e-6, False)):
            overturned = bool(held.response("sine", peak_acceleration=change.value * factor, period=0.5).overturned)
            assert overturned == (change.overturns_above == above)


def test_thresholds_of_a_record() -> None:
    record = rocking.Record(np.sin(np.arange(0.0, 20.0, 0.1)) * np.hanning(200), 0.02, "g")
    held = BLOCK.with_restraint(**HELD, mass=MASS)
    lowest = float(held.thresholds(record).lowest)
    assert bool(held.response(record, scale=lowest).overturned)
    assert not bool(held.response(record, scale=lowest * (1.0 - 1e-5)).overturned)
    assert lowest > float(BLOCK.thresholds(record).lowest)


@pytest.mark.parametrize("name", ["stiffness", "prestress", "damping"])
def test_block_survives_with_the_saving_restraint_only(name: str) -> None:
    saving = BLOCK.saving_restraint("sine", name, **PULSE, mass=MASS)
    assert saving.lowest > 0.0
    for factor, survives in ((1.0 + 1e-6, True), (1.0 - 1e-6, False)):
        held = BLOCK.with_restraint(**{name: saving.lowest * factor}, mass=MASS)
        assert bool(held.response("sine", **PULSE).overturned) != survives
    beyond = BLOCK.with_restraint(**{name: np.geomspace(saving.safe, saving.highest, 50) * (1.0 + 1e-9)}, mass=MASS)
    assert not beyond.response("sine", **PULSE).overturned.any()


def test_saving_damper_lies_on_the_closed_form() -> None:
    """Where the block overturns without impact only: the damper at which its amplitude is that of the pulse."""
    saving = rocking.saving_restraint("sine", "damping", slenderness=1 / 10.0, frequency_ratio=5.0, restitution=0.5)
    assert float(restraint.direct_amplitude(5.0, damping=saving.safe)) == pytest.approx(10.0, rel=1e-6)


def test_a_block_that_survives_needs_none() -> None:
    saving = rocking.saving_restraint("sine", "prestress", slenderness=0.9, frequency_ratio=5.0, restitution=0.9)
    assert saving.lowest == saving.safe == 0.0
    assert "without any" in repr(saving)


def test_history_and_release_lose_energy_to_the_damper() -> None:
    held = BLOCK.with_restraint(damping=3000.0, mass=MASS)
    free, damped = (body.history(start="8 deg").impact_time.values[:4] for body in (BLOCK, held))
    assert (np.diff(damped)[1:] < np.diff(free)[1:]).all()
    history = held.history("sine", **PULSE, samples=4000)
    peak = np.abs(history.rotation.values).max()
    assert peak == pytest.approx(float(held.response("sine", **PULSE).rotation), rel=1e-5)


def test_text_of_a_body() -> None:
    text = "anchored(width=40cm, height=160cm, mass=600kg, stiffness=50 kN/m, prestress=0.8 kN, damping=3 kN s/m)"
    described = rocking.body(text).response("sine", **PULSE)
    assert float(described.rotation) == float(
        BLOCK.with_restraint(**HELD, mass=MASS).response("sine", **PULSE).rotation
    )


def test_what_is_not_a_restraint_is_refused() -> None:
    with pytest.raises(rocking.InvalidArgumentError, match="damping"):
        BLOCK.with_restraint(damping=-1.0)
    with pytest.raises(rocking.InvalidArgumentError, match="stiffness"):
        BLOCK.with_restraint(stiffness="3 kg", mass=MASS)
    with pytest.raises(rocking.InvalidArgumentError, match="name"):
        BLOCK.saving_restraint("sine", "mass", **PULSE)
