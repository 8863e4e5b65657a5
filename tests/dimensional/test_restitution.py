"""Named restitutions: momentum, and the impact at a share of the half base (Kalliontzis et al. 2016)."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

import rocking
from rocking._cli.app import app

TEXT = "kalliontzis(k=0.7)"
MOTION = {"motion": "sine", "peak_acceleration": 4.0, "period": 0.5}


def by_momentum(b: float, h: float, r: float, k: float) -> float:
    """From the angular momentum about the point of impact; before, the body rotates about the mirrored point."""
    impact, centre = np.array([k * b, 0.0]), np.array([0.0, h])
    before, after = (1.0 * np.array([-(centre - pivot)[1], (centre - pivot)[0]]) for pivot in (-impact, impact))
    momenta = [r * r + np.linalg.det([centre - impact, velocity]) for velocity in (before, after)]
    return float(momenta[0] / momenta[1])


@pytest.mark.parametrize(("width", "height"), [(0.4, 1.6), (1.0, 1.2), (0.05, 2.0)])
@pytest.mark.parametrize("k", [0.3, 0.7, 1.0])
def test_each_entry_takes_the_number_that_momentum_gives(width, height, k):
    """Bodies, groups, thresholds, histories and objects of an assessment."""
    b, h = width / 2, height / 2
    eta, text = by_momentum(b, h, np.hypot(b, h) / np.sqrt(3), k), f"kalliontzis(k={k})"
    sine = np.sin(np.arctan2(b, h)) ** 2
    assert eta == pytest.approx((4 - 3 * sine * (1 + k * k)) / (4 - 3 * sine * (1 - k * k)))
    block = rocking.Block(width, height)
    for body in (block, rocking.RigidBody.from_size(np.array([width]), height), rocking.Block([width, 0.2], height)):
        named, stated = (body.response(**MOTION, restitution=one, thresholds=False) for one in (text, eta))
        np.testing.assert_allclose(np.ravel(named.rotation)[0], np.ravel(stated.rotation)[0], rtol=1e-9)
        assert np.ravel(named.outcome)[0] == np.ravel(stated.outcome)[0]
    groups = {"slenderness": 0.4, "frequency_ratio": 5.0, "alpha": block.alpha}
    named, stated = (rocking.peak_response("ricker", **groups, restitution=one) for one in (text, eta))
    assert named.peak_rotation == pytest.approx(stated.peak_rotation, rel=1e-9, nan_ok=True)


def test_thresholds_and_fragility_follow():
    """The same as with the number; k = 1 is momentum to the last digit."""
    block, texts = rocking.Block(0.3, 1.2), (TEXT, by_momentum(0.15, 0.6, np.hypot(0.15, 0.6) / np.sqrt(3), 0.7))
    lowest = [block.thresholds("sine", period=0.5, restitution=one).lowest for one in texts]
    assert lowest[0] == pytest.approx(lowest[1], rel=1e-9)
    record = rocking.Record(5 * np.sin(7 * 0.01 * np.arange(300)), 0.01, "m/s2")
    found = [rocking.fragility([record], block, intensity=[3.0, 6.0, 9.0], restitution=one) for one in texts]
    np.testing.assert_allclose(*(one["peak_rotation"] for one in found), rtol=1e-9)


def test_command_takes_the_text():
    given = ["--pulse=sine", "--width=0.3m", "--height=1.2m", "--peak-acceleration=4m/s2", "--period=0.5s"]
    printed = CliRunner().invoke(app, ["response", *given, "--restitution", TEXT, "--format=json"]).stdout
    found = json.loads(printed)
    expected = rocking.Block(0.3, 1.2).response(**MOTION, restitution=TEXT)
    assert found["restitution"] == pytest.approx(by_momentum(0.15, 0.6, np.hypot(0.15, 0.6) / np.sqrt(3), 0.7))
    assert found["overturned"] == bool(expected.overturned)


@pytest.mark.parametrize("wrong", ["kalliontzis", "kalliontzis(0.8)", "kalliontzis(k=0)", "kalliontzis(k=1.1)", "x"])
def test_other_texts_are_refused(wrong):
    with pytest.raises(rocking.InvalidArgumentError, match="restitution"):
        rocking.Block(0.3, 1.2).response(**MOTION, restitution=wrong)


def test_bodies_with_two_different_edges_need_another():
    for edges in ({"left": 0.1, "right": 0.2}, {"left": 0.1, "right": 0.1, "sides": "right"}):
        with pytest.raises(rocking.InvalidArgumentError, match="different edges"):
            rocking.RigidBody(**edges, height=0.6).response(**MOTION, restitution=TEXT)
