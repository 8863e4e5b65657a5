"""Health, metrics and log, and what the service does when data sets are missing or damaged."""

import asyncio
import errno
import logging
import re
from pathlib import Path
from threading import Semaphore
from types import SimpleNamespace

import pytest
import typer
from fastapi.testclient import TestClient
from rocking_api.app import create_app
from rocking_api.command import serve
from rocking_api.dataset_checker import DatasetChecker
from rocking_api.settings import EXAMPLE, Settings

from tests.api.conftest import NAMES, POINT, assert_problem, client_of, health_of, metrics_of, until

ROOT = Path(__file__).parents[2]

SINE, CURVES = "spectra/sine/eta-0.85", "overturning/sine/eta-0.85"


def ready_of(client):
    """The response of /ready once every data set was checked."""
    health_of(client)
    return client.get("/ready")


def test_healthy_and_ready(client, monkeypatch):
    health = health_of(client)
    expected = {"status": "ok", "datasets": len(NAMES), "unchecked": 0, "problems": {}}
    assert {name: health[name] for name in expected} == expected
    response = ready_of(client)
    assert (response.status_code, response.headers["cache-control"]) == (200, "no-store")
    assert response.json() == client.get("/health").json() | {"url": "/ready"}
    for path in ("/health", "/ready"):  # probes may ask for the head only
        head, whole = client.head(path), client.get(path)
        assert (head.status_code, head.headers["cache-control"]) == (whole.status_code, "no-store")
    monkeypatch.setattr(client.app.state.service.kernels, "is_loaded", False)
    response = client.get("/ready")
    assert "solver" in assert_problem(response, 503)["detail"]
    assert response.headers["retry-after"] == "30"
    assert client.get("/health").status_code == 200


def test_an_installation_serves_an_example_where_no_data_are(monkeypatch, tmp_path, capsys):
    given = []
    monkeypatch.setattr("uvicorn.run", lambda *_, **__: given.append(Settings().results))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ROCKING_RESULTS", "set for its removal afterwards")
    monkeypatch.delenv("ROCKING_RESULTS")
    serve("127.0.0.1", 0, None)
    assert given == [EXAMPLE]
    assert "those of an example are served" in capsys.readouterr().err
    with client_of(EXAMPLE) as client:
        health = health_of(client)
        assert (health["status"], health["problems"]) == ("ok", {})
        assert client.get("/v1/suites/example").json()["title"].startswith("Example: ")
        query = POINT | {"pulse": "cosine", "restitution": 0.9}
        found = client.get("/v1/response", params=query).json()
        solved = client.get("/v1/response", params=query | {"method": "solver"}).json()
        assert abs(found["peak_rotation"] - solved["peak_rotation"]) <= found["error_bound"] + solved["error_bound"]


def test_without_results_the_solver_is_used_and_all_say_so(client, tmp_path, caplog):
    def menu(of):
        return re.findall(r'<a href="(/\w*/?)"', of.get("/nowhere", headers={"accept": "text/html"}).text)[:8]

    with caplog.at_level(logging.WARNING, "rocking.service"), client_of(tmp_path / "none") as empty:
        health = health_of(empty)
        assert health["status"] == "degraded"
        assert "make reproduce" in health["problems"]["spectra"]
        assert str(tmp_path) not in str(health)
        assert empty.get("/v1/response", params=POINT).json()["source"] == "solver"
        assert empty.get("/v1/datasets").json()["datasets"] == []
        assert_problem(empty.get("/v1/response", params=POINT | {"method": "cube"}), 422, "pulse")
        until(lambda: ready_of(empty).status_code == 200, 60)  # loading the kernels
        assert empty.get("/ready").json()["status"] == "degraded"
        until(lambda: "no spectrum cubes" in caplog.text)
        assert {"/suites", "/datasets"} <= set(menu(client))  # a menu leads only where something is
        assert not {"/suites", "/datasets"} & set(menu(empty))
        assert "make reproduce" in empty.get("/static/explorer/suites.js").text


def test_with_a_damaged_cube_the_solver_is_used_until_it_is_repaired(client, own_results):
    path = own_results / f"{SINE}.nc"
    whole = path.read_bytes()
    other = (own_results / "spectra/cosine/eta-0.90.nc").read_bytes()
    with client_of(own_results) as damaged:
        for content, problem in ((whole[: len(whole) // 2], "damaged"), (other, "holds cosine")):
            path.write_bytes(content)
            result = damaged.get("/v1/response", params=POINT).json()
            solved = client.get("/v1/response", params=POINT | {"method": "solver"}).json()
            assert (result["source"], result["peak_rotation"]) == ("solver", solved["peak_rotation"])
            health = health_of(damaged)
            assert health["status"] == "degraded"
            assert problem in health["problems"][SINE]
            assert str(own_results) not in str(health)
            assert_problem(damaged.get("/v1/response", params=POINT | {"method": "cube"}), 503)
        path.write_bytes(whole)  # detected without a restart
        assert damaged.get("/v1/response", params=POINT).json()["source"] == "cube"
        assert health_of(damaged)["status"] == "ok"


def test_damaged_data_sets_make_it_alive_but_not_ready(own_results, caplog):
    names = [CURVES, SINE]
    paths = [own_results / f"{name}.nc" for name in names]
    whole = [path.read_bytes() for path in paths]
    with caplog.at_level(logging.INFO, "rocking.service"), client_of(own_results) as client:
        assert ready_of(client).status_code == 200
        for path, content in zip(paths, whole, strict=True):
            path.write_bytes(content[:1000])
        until(lambda: len(client.app.state.service.dataset_checker.damaged) == 2)  # of which nobody asked
        for _ in range(3):
            problem = assert_problem(ready_of(client), 503)
        assert [error["name"] for error in problem["errors"]] == names
        assert all("damaged" in error["value"] for error in problem["errors"])
        assert client.get("/health").status_code == 200
        assert caplog.text.count("a data set is damaged") == 2
        paths[0].write_bytes(whole[0])
        paths[1].unlink()
        assert ready_of(client).status_code == 200
        assert caplog.text.count("a data set is no longer damaged") == 2


def test_the_state_follows_a_folder_that_is_replaced_during_a_check_or_without_requests(monkeypatch):
    monkeypatch.setattr("rocking_api.dataset_checker.MAX_WAIT", 0.05)
    monkeypatch.setattr("rocking_api.dataset_checker.WATCH_SECONDS", 0.01)
    names = ["spectra/sine/eta-0.80", "spectra/sine/eta-0.85", "spectra/sine/eta-0.90"]
    present, long = [*names], Semaphore(0)

    def problem(name):
        if name == names[2]:
            long.acquire(timeout=20)  # a large file, which is read when the folder is replaced
        return "damaged" if name == names[1] else None

    catalogue = SimpleNamespace(scan=lambda: ([*present], {}), product=lambda _: None)
    problems = lambda: {names[1]: "damaged"} if names[1] in present else {}  # noqa: E731
    checker = DatasetChecker(SimpleNamespace(catalogue=catalogue, problem=problem, problems=problems))

    async def followed():
        while not checker.damaged:
            await checker.state()
        present[:] = names[:1]
        state = await checker.state()
        assert (state.names, state.unchecked, state.problems, checker.damaged) == (names[:1], 0, {}, {})
        watch = asyncio.create_task(checker.watch())
        present[:] = names[:2]
        while not checker.damaged:
            await asyncio.sleep(0.01)
        watch.cancel()
        long.release()

    asyncio.run(asyncio.wait_for(followed(), 10))


def test_metrics_count_requests_by_route_and_status(results):
    with client_of(results) as client:
        for params in (POINT, POINT | {"method": "solver"}, {}):
            client.get("/v1/response", params=params)
        found = metrics_of(client)
    counts = {key: value for key, value in found.items() if key[0] == "http_requests_total"}
    assert counts["http_requests_total", "/v1/response", "2xx", "GET"] == 2
    assert counts["http_requests_total", "/v1/response", "4xx", "GET"] == 1


def test_an_internal_error_leaves_its_traceback_in_the_log_only(results):
    app = create_app(Settings(results=results))

    @app.get("/broken")
    async def broken():
        raise ZeroDivisionError("inside")

    with TestClient(app, raise_server_exceptions=False) as client:
        problem = assert_problem(client.get("/broken"), 500)
    assert "inside." not in problem["detail"]
    assert "ZeroDivision" not in problem["detail"]
    with TestClient(app) as client, pytest.raises(ZeroDivisionError):  # what the server logs
        client.get("/broken")


def test_a_full_disk_is_503_and_other_errors_of_the_system_are_faults(results):
    app = create_app(Settings(results=results))

    @app.get("/full")
    async def full():
        raise OSError(errno.ENOSPC, "No space left on device", "x")

    with TestClient(app, raise_server_exceptions=False) as client:
        response = client.get("/full")
    assert "/tmp" not in assert_problem(response, 503)["detail"]
    assert response.headers["retry-after"]


def test_settings_come_from_the_environment(monkeypatch, tmp_path):
    monkeypatch.setenv("ROCKING_RESULTS", str(tmp_path))
    monkeypatch.setenv("ROCKING_MAX_POINTS", "7")
    monkeypatch.setenv("ROCKING_CORS_ORIGINS", '["https://a.org"]')
    found = Settings()
    assert (found.results, found.max_points, found.cors_origins) == (tmp_path, 7, ("https://a.org",))
    monkeypatch.setenv("ROCKING_RESULTS", "")
    with pytest.raises(ValueError, match="name of a folder"):  # it would be the current one
        Settings()


def test_origins_that_are_no_list_are_refused_in_one_line(monkeypatch, capsys):
    for value in ("https://a.org", "[1]", ""):
        monkeypatch.setenv("ROCKING_CORS_ORIGINS", value)
        with pytest.raises(typer.Exit) as caught:
            serve("127.0.0.1", 0, None)
        assert caught.value.exit_code == 2
        allowed = 'a JSON list of origins, such as ["https://example.org"]'
        text = f"Error: ROCKING_CORS_ORIGINS = {value!r} is not allowed; allowed: {allowed}\n"
        assert capsys.readouterr().err == text


@pytest.mark.parametrize("name", ["ROCKING_" + "MAX_POINT", "rocking_result", "ROCKING_"])
def test_a_misspelt_variable_is_refused_at_the_start(monkeypatch, capsys, name):
    monkeypatch.setenv(name, "7")
    with pytest.raises(typer.Exit) as caught:
        serve("127.0.0.1", 0, None)
    assert caught.value.exit_code == 2
    assert capsys.readouterr().err.startswith(f"Error: {name} is not allowed; allowed: ROCKING_ACCESS_LOG, ROCKING_")


def test_the_type_of_an_error_is_explained(client):
    page = client.get("/problems").text
    found = {
        client.get("/v1/response?pulse=sine").json()["type"],
        client.post("/v1/response", content="{", headers={"content-type": "application/json"}).json()["type"],
        client.post("/v1/response", content="a", headers={"content-type": "text/html"}).json()["type"],
        client.get("/v1/datasets/no/such").json()["type"],
        client.get("/nowhere").json()["type"],
        client.delete("/v1/response").json()["type"],
    }
    assert len(found) == 6
    for one in found:
        address, _, anchor = one.partition("#")
        assert address == "/problems"
        assert f'id="{anchor}"' in page
