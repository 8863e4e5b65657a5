"""Metrics, request ids, log lines and cache headers."""

import logging

import httpx2
import pytest
from fastapi.testclient import TestClient
from prometheus_client.parser import text_string_to_metric_families
from rocking_api.app import create_app
from rocking_api.settings import Settings

from tests.api.conftest import assert_problem, client_of
from tests.api.servers import serving

POINT = {"pulse": "sine", "slenderness": 0.6, "frequency_ratio": 6.0, "restitution": 0.85}


def metrics_of(client):
    """Samples by name and labels."""
    text = client.get("/metrics").text
    return {
        (sample.name, *sorted(sample.labels.values())): sample.value
        for family in text_string_to_metric_families(text)
        for sample in family.samples
    }


def test_metrics_count_requests_and_points_by_source(results):
    with client_of(results) as client:
        client.get("/v1/response", params=POINT)
        client.get("/v1/response", params=POINT | {"method": "solver"})
        client.post("/v1/response", json=POINT | {"slenderness": [0.6, 0.6, 1.5]})
        client.get("/v1/response")
        client.get("/v1/datasets/no/such")
        client.get("/no/such/route")
        found = metrics_of(client)
    assert found["rocking_requests_total", "/v1/response", "200", "GET"] == 2
    assert found["rocking_requests_total", "/v1/response", "200", "POST"] == 1
    assert found["rocking_requests_total", "/v1/response", "422", "GET"] == 1
    assert found["rocking_requests_total", "/v1/datasets/{name:path}", "404", "GET"] == 1
    assert found["rocking_requests_total", "404", "GET", "none"] == 1
    assert found["rocking_points_total", "cube"] == 3
    assert found["rocking_points_total", "solver"] == 2
    assert found["rocking_request_seconds_count", "/v1/response"] == 4
    assert found["rocking_heavy_running",] == found["rocking_heavy_waiting",] == 0


@pytest.mark.parametrize("sane", ["a", "7f3c-1.B_", "x" * 64])
def test_a_valid_request_id_is_sent_back(client, sane):
    assert client.get("/health", headers={"X-Request-ID": sane}).headers["x-request-id"] == sane


@pytest.mark.parametrize("odd", ["", "x" * 65, "a b", '"', "a;b"])
def test_an_invalid_request_id_is_replaced(client, odd):
    made = [client.get("/health", headers={"X-Request-ID": odd}).headers["x-request-id"] for _ in range(2)]
    assert made[0] != made[1]
    assert odd not in made
    assert client.get("/nowhere").headers["x-request-id"]


def test_several_workers_are_one_service(results, tmp_path):
    with serving(results, tmp_path / "log", workers=2) as server:
        found = httpx2.get(f"{server.address}/v1/response", params=POINT, timeout=120)
        assert found.json()["outcome"]
        metrics = httpx2.get(f"{server.address}/metrics", timeout=120).text
        assert server.stop(120) == 0
    assert 'rocking_points_total{source="cube"} 1.0' in metrics
    assert " ERROR " not in server.log.read_text()


def test_an_error_leaves_its_traceback_and_its_id_in_the_log(results, caplog):
    app = create_app(Settings(results=results))

    @app.get("/broken")
    async def broken():
        raise ZeroDivisionError

    with TestClient(app) as client, caplog.at_level(logging.ERROR, "rocking.service"):
        assert_problem(client.get("/broken", headers={"X-Request-ID": "mine"}), 500)
    assert "request mine, path /broken" in caplog.text
    assert "ZeroDivisionError" in caplog.text


def test_responses_may_be_stored_for_a_minute_and_are_revalidated(client):
    response = client.get("/v1/response", params=POINT)
    assert response.headers["cache-control"] == "max-age=60"
    again = client.get("/v1/response", params=POINT, headers={"If-None-Match": response.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")
    other = client.get("/v1/response", params=POINT | {"slenderness": 0.61})
    assert other.headers["etag"] != response.headers["etag"]
    assert "etag" not in client.get("/v1/response").headers


def test_a_version_of_a_data_set_is_immutable(client):
    entry = client.get("/v1/datasets").json()["datasets"][0]
    kept = client.get(entry["version_url"])
    assert "immutable" in kept.headers["cache-control"]
    assert kept.headers["etag"] == f'"{entry["sha256"]}"'
    assert client.get(entry["netcdf"]).headers["cache-control"] == "no-cache"
    gone = entry["version_url"].replace(entry["sha256"], "0" * 64)
    assert entry["sha256"] in assert_problem(client.get(gone), 404)["detail"]
