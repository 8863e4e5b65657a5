"""GET /v1/blocks/response: SI units in, degrees and metres out."""

import math

import pytest

from rocking.block import Block
from rocking.solve import peak_response
from tests.service.conftest import assert_problem

QUESTION = {
    "half_width": 0.2,
    "half_height": 0.8,
    "pulse": "sine",
    "peak_acceleration": 4.0,
    "pulse_period": 0.5,
}


def ask(client, **changes):
    return client.get("/v1/blocks/response", params=QUESTION | changes)


def test_the_answer_is_the_solver_s_in_si_units(client):
    answer = ask(client).json()
    block = Block(0.2, 0.8)
    truth = peak_response(
        "sine",
        slenderness=block.uplift_acceleration / 4.0,
        frequency_ratio=2 * math.pi / 0.5 / block.frequency_parameter,
        restitution=block.housner_restitution,
        alpha=block.alpha,
    )
    rotation = truth.peak_rotation * block.alpha
    assert answer["peak_rotation_deg"] == pytest.approx(math.degrees(rotation), rel=1e-9)
    assert answer["top_displacement"] == pytest.approx(1.6 * math.sin(rotation), rel=1e-9)
    assert answer["restitution"] == block.housner_restitution
    assert answer["response"]["query"]["alpha_deg"] == pytest.approx(14.036, abs=1e-3)
    assert not answer["overturned"]


def test_golden_thresholds_of_the_rigid_block(client):
    block = Block.from_slenderness_angle(0.2, 0.5)
    answer = ask(client, half_width=block.half_width, half_height=block.half_height).json()
    found = [threshold["peak_acceleration"] / block.uplift_acceleration for threshold in answer["thresholds"]]
    assert found == pytest.approx([1.45844, 3.97129, 4.07192], abs=1e-5)
    assert [threshold["overturns_above"] for threshold in answer["thresholds"]] == [True, False, True]
    assert answer["largest_safe_acceleration"] == answer["thresholds"][0]["peak_acceleration"]


def test_a_block_that_falls(client):
    answer = ask(client, peak_acceleration=8.0).json()
    assert answer["overturned"]
    assert answer["peak_rotation_deg"] is answer["top_displacement"] is None


def test_a_weak_pulse_moves_nothing(client):
    answer = ask(client, peak_acceleration=2.0, restitution=0.9).json()
    assert answer["response"]["outcome"] == "NO_UPLIFT"
    assert answer["peak_rotation_deg"] == 0.0
    assert answer["restitution"] == 0.9


@pytest.mark.parametrize(
    ("changes", "parameter"),
    [
        ({"half_width": 0}, "half_width"),
        ({"half_height": "nan"}, "half_height"),
        ({"peak_acceleration": -1}, "peak_acceleration"),
        ({"pulse_period": 0}, "pulse_period"),
        ({"pulse_period": "inf"}, "pulse_period"),
        ({"gravity": 0}, "gravity"),
        ({"half_width": 1e5}, "half_width"),
        ({"pulse": "sinus"}, "pulse"),
        ({"restitution": 1.5}, "restitution"),
        ({"restitution": "bouncy"}, "restitution"),
        ({"half_width": 2.0}, "restitution"),
        ({"half_depth": 1.0}, "half_depth"),
        ({"method": "cube"}, "restitution"),
    ],
)
def test_bad_input(client, changes, parameter):
    assert_problem(ask(client, **changes), 422, parameter)
