"""GET /v1/critical_amplitude: every amplitude at which the outcome changes."""

import pytest

from rocking.boundary.amplitude import critical_amplitude
from tests.api.conftest import assert_problem

URL = "/v1/critical_amplitude"
QUESTION = {"pulse": "sine", "frequency_ratio": 5.0, "restitution": 0.85}


def test_golden_thresholds(client):
    answer = client.get(URL, params=QUESTION).json()
    assert [one["amplitude"] for one in answer["thresholds"]] == pytest.approx([3.980175, 5.356347, 7.168129], abs=1e-6)
    assert [one["overturns_above"] for one in answer["thresholds"]] == [True, False, True]
    assert answer["thresholds"][-1]["outcome"] == "OVERTURNED_DIRECTLY"
    assert answer["largest_safe_amplitude"] == answer["thresholds"][0]["amplitude"]


@pytest.mark.parametrize("alpha_deg", [None, 0, 20])
def test_thresholds_equal_those_of_the_package(client, alpha_deg):
    asked = QUESTION | ({} if alpha_deg is None else {"alpha_deg": alpha_deg})
    answer = client.get(URL, params=asked).json()
    alpha = 0.3490658503988659 if alpha_deg else None
    truth = critical_amplitude("sine", frequency_ratio=5.0, restitution=0.85, alpha=alpha)
    assert [one["amplitude"] for one in answer["thresholds"]] == truth.amplitude.tolist()
    assert [one["impacts"] for one in answer["thresholds"]] == truth.impacts.tolist()
    assert all(one["slenderness"] == 1 / one["amplitude"] for one in answer["thresholds"])


def test_thresholds_above_the_highest_amplitude_are_not_listed(client):
    answer = client.get(URL, params=QUESTION | {"highest_amplitude": 2.0}).json()
    assert answer["thresholds"] == []
    assert answer["largest_safe_amplitude"] is None


@pytest.mark.parametrize(
    ("changes", "parameter"),
    [
        ({"pulse": "sinus"}, "pulse"),
        ({"frequency_ratio": 0}, "frequency_ratio"),
        ({"frequency_ratio": "nan"}, "frequency_ratio"),
        ({"restitution": 2}, "restitution"),
        ({"alpha_deg": 91}, "alpha_deg"),
        ({"highest_amplitude": 1.0}, "highest_amplitude"),
        ({"highest_amplitude": 1e7}, "highest_amplitude"),
        ({"slenderness": 0.5}, "slenderness"),
    ],
)
def test_bad_input(client, changes, parameter):
    assert_problem(client.get(URL, params=QUESTION | changes), 422, parameter)
