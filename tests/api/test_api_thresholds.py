"""GET /v1/thresholds: every amplitude at which the outcome changes."""

import pytest

from rocking._boundary.amplitude import thresholds

URL = "/v1/thresholds"
QUERY = {"pulse": "sine", "frequency_ratio": 5.0, "restitution": 0.85}


def test_golden_thresholds(client):
    response = client.get(URL, params=QUERY).json()
    assert [one["amplitude"] for one in response["thresholds"]] == pytest.approx(
        [3.980175, 5.356347, 7.168129], abs=1e-6
    )
    assert [one["overturns_above"] for one in response["thresholds"]] == [True, False, True]
    assert response["thresholds"][-1]["outcome"] == "OVERTURNED_DIRECTLY"
    assert response["largest_surviving_amplitude"] == response["thresholds"][0]["amplitude"]


@pytest.mark.parametrize("alpha_deg", [None, 0, 20])
def test_thresholds_equal_those_of_the_package(client, alpha_deg):
    query = QUERY | ({} if alpha_deg is None else {"alpha_deg": alpha_deg})
    response = client.get(URL, params=query).json()
    alpha = 0.3490658503988659 if alpha_deg else None
    expected = thresholds("sine", frequency_ratio=5.0, restitution=0.85, alpha=alpha)
    assert [one["amplitude"] for one in response["thresholds"]] == expected.amplitude.tolist()
    assert [one["impacts"] for one in response["thresholds"]] == expected.impacts.tolist()
    assert all(one["slenderness"] == 1 / one["amplitude"] for one in response["thresholds"])


def test_thresholds_above_the_highest_are_not_listed(client):
    response = client.get(URL, params=QUERY | {"highest": 2.0}).json()
    assert response["thresholds"] == []
    assert response["largest_surviving_amplitude"] is None
