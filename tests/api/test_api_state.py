"""Health, pages, and what the service does when data sets are missing or damaged."""

import logging
import re
import time

import pytest
import typer
from fastapi.testclient import TestClient
from rocking_api.app import create_app
from rocking_api.command import main
from rocking_api.settings import EXAMPLE, Settings

from tests.api.conftest import NAMES, assert_problem, client_of

QUERY = {"pulse": "sine", "slenderness": 0.6, "frequency_ratio": 6.0, "restitution": 0.85}


def health_of(client):
    """The response of /health once every data set was checked."""
    deadline = time.monotonic() + 30
    while (health := client.get("/health").json())["unchecked"] and time.monotonic() < deadline:
        time.sleep(0.01)
    return health


def test_healthy(client):
    assert {name: health_of(client)[name] for name in ("status", "datasets", "unchecked", "problems")} == {
        "status": "ok",
        "datasets": len(NAMES),
        "unchecked": 0,
        "problems": {},
    }


def test_an_installation_serves_an_example_where_no_data_are(monkeypatch, tmp_path, capsys):
    given = []
    monkeypatch.setattr("uvicorn.run", lambda *_, **__: given.append(Settings().results))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ROCKING_RESULTS", "set for its removal afterwards")
    monkeypatch.delenv("ROCKING_RESULTS")
    main(None, "127.0.0.1", 0)
    assert given == [EXAMPLE]
    assert "those of an example are served" in capsys.readouterr().err
    with client_of(EXAMPLE) as client:
        health = health_of(client)
        assert (health["status"], health["problems"]) == ("ok", {})
        assert client.get("/v1/suites/example").json()["title"].startswith("Example: ")
        query = {"pulse": "cosine", "slenderness": 0.6, "frequency_ratio": 6.0, "restitution": 0.9}
        found = client.get("/v1/response", params=query).json()
        solved = client.get("/v1/response", params=query | {"method": "solver"}).json()
        assert abs(found["peak_rotation"] - solved["peak_rotation"]) <= found["error_bound"] + solved["error_bound"]


def test_a_menu_leads_only_where_something_is(client, tmp_path):
    def menu(of):
        return re.findall(r'<a href="(/\w*/?)"', of.get("/nowhere", headers={"accept": "text/html"}).text)[:8]

    assert {"/suites", "/datasets"} <= set(menu(client))
    with client_of(tmp_path) as empty:
        assert not {"/suites", "/datasets", "/guide/"} & set(menu(empty))
        assert "make reproduce" in empty.get("/static/explorer/suites.js").text


def test_without_results_the_solver_is_used_and_health_reports_it(tmp_path):
    with client_of(tmp_path / "none") as client:
        health = health_of(client)
        assert health["status"] == "degraded"
        assert "make reproduce" in health["problems"]["spectra"]
        assert client.get("/v1/response", params=QUERY).json()["source"] == "solver"
        assert client.get("/v1/datasets").json()["datasets"] == []
        assert_problem(client.get("/v1/response", params=QUERY | {"method": "cube"}), 422, "pulse")


def test_with_a_damaged_cube_the_solver_is_used_and_health_reports_it(client, own_results):
    path = own_results / "spectra" / "sine" / "eta-0.85.nc"
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    with client_of(own_results) as damaged:
        result = damaged.get("/v1/response", params=QUERY).json()
        assert result["source"] == "solver"
        assert (
            result["peak_rotation"]
            == client.get("/v1/response", params=QUERY | {"method": "solver"}).json()["peak_rotation"]
        )
        health = health_of(damaged)
        assert health["status"] == "degraded"
        assert "damaged" in health["problems"]["spectra/sine/eta-0.85"]
        assert_problem(damaged.get("/v1/response", params=QUERY | {"method": "cube"}), 503)
        path.write_bytes(whole)  # repaired: detected without a restart
        assert damaged.get("/v1/response", params=QUERY).json()["source"] == "cube"
        assert health_of(damaged)["status"] == "ok"


def ready_of(client):
    """The response of /ready once every data set was checked."""
    health_of(client)
    return client.get("/ready")


def test_ready_without_data_sets_and_with_intact_ones(client, tmp_path):
    response = ready_of(client)
    assert response.status_code == 200
    assert response.headers["cache-control"] == "no-store"
    assert response.json() == client.get("/health").json() | {"url": "/ready"}
    with client_of(tmp_path / "none") as empty:
        empty.get("/v1/response", params=QUERY | {"method": "solver"})  # waits for the solver
        deadline = time.monotonic() + 60
        while (response := ready_of(empty)).status_code == 503 and time.monotonic() < deadline:
            time.sleep(0.05)  # loading the kernels
        assert response.status_code == 200
        assert response.json()["status"] == "degraded"


def test_damaged_data_sets_make_it_alive_but_not_ready(own_results, caplog):
    names = ["overturning/sine/eta-0.85", "spectra/sine/eta-0.85"]
    paths = [own_results / f"{name}.nc" for name in names]
    whole = [path.read_bytes() for path in paths]
    for path, content in zip(paths, whole, strict=True):
        path.write_bytes(content[:1000])
    with caplog.at_level(logging.INFO, "rocking.service"), client_of(own_results) as client:
        for _ in range(3):
            problem = assert_problem(ready_of(client), 503)
        assert [error["name"] for error in problem["errors"]] == names
        assert all("damaged" in error["value"] for error in problem["errors"])
        assert all(name in problem["detail"] for name in names)
        assert client.get("/health").status_code == 200
        assert damaged_of(client) == dict.fromkeys(names, 1.0)
        lines = [record.args for record in caplog.records if record.msg.startswith("a data set is damaged")]
        assert sorted(name for name, _ in lines) == names
        paths[0].write_bytes(whole[0])
        paths[1].unlink()
        assert ready_of(client).status_code == 200
        assert damaged_of(client) == dict.fromkeys(names, 0.0)
        repaired = [record for record in caplog.records if record.msg.startswith("a data set is no longer damaged")]
        assert len(repaired) == 2


def damaged_of(client):
    """The gauges of damaged data sets."""
    text = client.get("/metrics").text
    return {
        name: float(value)
        for name, value in re.findall(r'^rocking_dataset_damaged\{dataset="(.*)"\} (.*)$', text, re.M)
    }


def test_metrics_report_a_damaged_data_set_that_nobody_asked_for(own_results):
    name = "spectra/cosine/eta-0.90"
    (own_results / f"{name}.nc").write_bytes(b"damaged")
    with client_of(own_results) as client:
        deadline = time.monotonic() + 20
        while not (found := damaged_of(client)) and time.monotonic() < deadline:
            time.sleep(0.02)
    assert found == {name: 1.0}


def test_not_ready_while_the_solver_is_loaded(client, monkeypatch):
    monkeypatch.setattr(client.app.state.service.kernels, "is_loaded", False)
    response = client.get("/ready")
    assert "solver" in assert_problem(response, 503)["detail"]
    assert response.headers["retry-after"] == "30"
    assert client.get("/health").status_code == 200


def test_a_cube_under_another_name_is_refused(own_results):
    own = own_results / "spectra"
    (own / "sine" / "eta-0.85.nc").write_bytes((own / "cosine" / "eta-0.90.nc").read_bytes())
    with client_of(own_results) as client:
        assert client.get("/v1/response", params=QUERY).json()["source"] == "solver"
        assert "holds cosine" in health_of(client)["problems"]["spectra/sine/eta-0.85"]


def test_the_start_warns_of_what_is_missing(tmp_path, caplog):
    with caplog.at_level(logging.WARNING, "rocking.service"), client_of(tmp_path):
        deadline = time.monotonic() + 20
        while "no spectrum cubes" not in caplog.text and time.monotonic() < deadline:
            time.sleep(0.02)
    assert "no spectrum cubes" in caplog.text


@pytest.mark.parametrize("page", ["/", "/docs"])
def test_pages_load_nothing_from_outside(client, page):
    response = client.get(page)
    assert response.headers["content-type"].startswith("text/html")
    assert "default-src 'self'" in response.headers["content-security-policy"]
    for link in re.findall(r'(?:src|href|action)="([^"]+)"', response.text):
        assert link.startswith("/")
        if link != "/guide/":  # built apart: tests/api/test_guide.py
            assert client.get(link).status_code in (200, 422)  # 422: the form's action, without its parameters
    assert "http" not in response.text


@pytest.mark.parametrize(
    "path",
    ["/", "/docs", "/openapi.json", "/health", "/ready", "/metrics", "/v1/datasets", "/v1/response?pulse=sine",
     "/v1/datasets/spectra/sine/eta-0.85.nc", "/v1/datasets/spectra/sine/eta-0.85.zarr/.zmetadata", "/nowhere",
     "/static/explorer/main.js", "/v1/map?pulse=sine&restitution=0.85&columns=2&rows=2"],
)  # fmt: skip
def test_every_response_has_nosniff(client, path):
    for result in (client.get(path), client.head(path), client.get(path, headers={"if-none-match": "*"})):
        assert result.headers.get_list("x-content-type-options") == ["nosniff"]


def test_an_empty_name_of_the_results_is_refused(monkeypatch):
    """An empty path would be the current folder."""
    with pytest.raises(ValueError, match="name of a folder"):
        Settings(results="")
    monkeypatch.setenv("ROCKING_RESULTS", "")
    with pytest.raises(ValueError, match="name of a folder"):
        Settings()


@pytest.mark.parametrize("value", ["https://a.org", "[1]", '"https://a.org"', ""])
def test_origins_that_are_no_list_are_refused_in_one_line(monkeypatch, capsys, value):
    monkeypatch.setenv("ROCKING_CORS_ORIGINS", value)
    with pytest.raises(typer.Exit) as caught:
        main(None, "127.0.0.1", 0)
    assert caught.value.exit_code == 2
    allowed = 'a JSON list of origins, such as ["https://example.org"]'
    assert capsys.readouterr().err == f"Error: ROCKING_CORS_ORIGINS = {value!r} is not allowed; allowed: {allowed}\n"


@pytest.mark.parametrize("path", ["/health", "/ready"])
def test_probes_may_ask_for_the_head_only(client, path):
    head, whole = client.head(path), client.get(path)
    assert (head.status_code, head.headers["cache-control"]) == (whole.status_code, "no-store")


def test_an_internal_error_shows_no_details(results):
    app = create_app(Settings(results=results))

    @app.get("/broken")
    async def broken():
        raise ZeroDivisionError("inside")

    with TestClient(app, raise_server_exceptions=False) as client:
        problem = assert_problem(client.get("/broken"), 500)
        assert "inside." not in problem["detail"]
        assert "ZeroDivision" not in problem["detail"]


def test_only_text_is_compressed(client):
    accept = {"accept-encoding": "gzip"}
    query = {"pulse": "sine", "slenderness": 0.6, "restitution": 0.85}
    assert client.get("/v1/spectrum", params=query, headers=accept).headers["content-encoding"] == "gzip"
    netcdf = client.get("/v1/spectrum", params=query | {"format": "nc"}, headers=accept)
    assert "content-encoding" not in netcdf.headers


def test_settings_come_from_the_environment(monkeypatch, tmp_path):
    monkeypatch.setenv("ROCKING_RESULTS", str(tmp_path))
    monkeypatch.setenv("ROCKING_MAX_POINTS", "7")
    monkeypatch.setenv("ROCKING_CORS_ORIGINS", '["https://a.org"]')
    found = Settings()
    assert (found.results, found.max_points, found.cors_origins) == (tmp_path, 7, ("https://a.org",))


def test_the_type_of_an_error_is_explained(client):
    page = client.get("/problems").text
    found = {
        client.get("/v1/response?pulse=sine").json()["type"],
        client.post("/v1/response", content="{").json()["type"],
        client.post("/v1/response", content="a", headers={"content-type": "text/html"}).json()["type"],
        client.get("/v1/datasets/no/such").json()["type"],
        client.get("/nowhere").json()["type"],
        client.delete("/v1/response").json()["type"],
        client.get("/v1/datasets/spectra/sine/eta-0.85.nc", headers={"range": "bytes=999999999-"}).json()["type"],
    }
    assert len(found) == 7
    for one in found:
        address, _, anchor = one.partition("#")
        assert address == "/problems"
        assert f'id="{anchor}"' in page
    assert_problem(client.get("/v1/datasets?page=2"), 422, "page")
    assert_problem(client.get("/v1/datasets.zip?page=2"), 422, "page")
    assert_problem(client.get("/v1/datasets/spectra/sine/eta-0.85?page=2"), 422, "page")
