"""The service responds while the solver is compiled; requests for it wait up to their time limit."""

import asyncio
import http.client
import os
import shutil
import threading
import time
from contextlib import closing
from pathlib import Path
from urllib.parse import urlencode

import pytest
import rocking_api.execution.kernels
from rocking_api.execution.kernels import Kernels

from rocking import precompile
from rocking._excitation.pulses import PULSE_NAMES
from rocking._numba.kernel_cache import cache_folder
from rocking._solver.kernels.batch import solve_batch
from rocking._solver.records.batch import solve_slender
from tests.api.conftest import assert_problem, client_of
from tests.api.servers import Stopwatch, serving
from tests.sampling import number

QUERY = {"slenderness": 0.6, "frequency_ratio": 6.0, "restitution": 0.85, "method": "solver"}
MISSING = number(solve_slender, solve_batch)
"""A kernel that is compiled in a second, or the one that takes longest."""

FOLDER = f"{MISSING.__module__}.{MISSING.__name__}"
SPECTRUM = {"pulse": "sine", "slenderness": 0.6, "restitution": 0.85, "points": 3}


def get(connection, path):
    """Status of a request.

    Not through a client that prepares TLS: nine of those hold the interpreter of this process for tenths of a second,
    which would be measured as time of the server.
    """
    connection.request("GET", path)
    response = connection.getresponse()
    response.read()
    return response.status


def connect(server):
    return closing(http.client.HTTPConnection("127.0.0.1", server.port, timeout=600))


def burst(server):
    """Request all pulses at once: status and time of each, and the times of /health meanwhile [s].

    The times of /health are those on a machine that does nothing else.
    """
    responses, waits = {}, []

    def get_response(pulse):
        began = time.perf_counter()
        with connect(server) as connection:
            status = get(connection, "/v1/response?" + urlencode(QUERY | {"pulse": pulse}))
        responses[pulse] = status, time.perf_counter() - began

    threads = [threading.Thread(target=get_response, args=(pulse,)) for pulse in PULSE_NAMES]
    with connect(server) as connection:
        get(connection, "/health")
        for thread in threads:
            thread.start()
        while not waits or any(thread.is_alive() for thread in threads):
            stopwatch = Stopwatch(os.getpid(), server.process.pid)
            assert get(connection, "/health") == 200
            waits.append(stopwatch.seconds())
            time.sleep(0.005)
    return responses, waits


@pytest.mark.long
@pytest.mark.alone
@pytest.mark.skipif(not Path("/proc/self/schedstat").exists(), reason="needs the delays that Linux tells")
def test_health_responds_while_the_kernels_are_compiled_and_loaded(installed, tmp_path):
    """From an installed wheel. On two cores in use by others: 0.09 s at most while they are compiled, 0.02 s while they
    are loaded. One kernel is missing; the others are copied.
    """
    precompile.main()
    compiled = Path(cache_folder())
    missing = shutil.ignore_patterns(precompile.COMPLETE, FOLDER)
    copied = shutil.copytree(compiled, tmp_path / "kernels" / compiled.name, ignore=missing)
    program = "import rocking, sys; print(rocking.__file__); from rocking._cli.app import app; app()"
    command, path = (installed.python, "-c", program), {"PYTHONPATH": "", "NUMBA_CACHE_DIR": str(copied.parent)}
    runs = [(600, "compiled.log"), (60, "loaded.log")]
    for granted, log in number(runs[:1], runs):
        path["ROCKING_MAX_SECONDS"] = str(granted)
        with serving(tmp_path, tmp_path / log, command, cwd=tmp_path, **path) as server, connect(server) as connection:
            assert str(installed.packages) in server.log.read_text()
            for page in ("/", "/docs", "/openapi.json", "/metrics", "/static/docs.js"):
                assert get(connection, page) == 200, page
            if log == "loaded.log":
                get(connection, "/v1/response?" + urlencode(QUERY | {"pulse": "sine"}))  # waits until they are loaded
            responses, waits = burst(server)
        assert {status for status, _ in responses.values()} == {200}
        assert max(waits) < 0.2
        assert (copied / FOLDER).is_dir()
    assert max(seconds for _, seconds in responses.values()) < number(600.0, 1.0)


def test_a_request_waits_for_the_kernels_up_to_its_time_limit(tmp_path, monkeypatch):
    loaded = threading.Event()
    monkeypatch.setattr(rocking_api.execution.kernels, "load_kernels", lambda: loaded.wait(30))
    with client_of(tmp_path, max_seconds=0.1) as client:
        for route in ("response", "spectrum"):
            refused = client.get(f"/v1/{route}", params=QUERY | {"pulse": "sine"} if route == "response" else SPECTRUM)
            assert_problem(refused, 503)
            assert int(refused.headers["retry-after"]) > 0
        assert client.get("/health").status_code == 200
        loaded.set()
        deadline = time.monotonic() + 10
        while client.get("/v1/spectrum", params=SPECTRUM).status_code != 200 and time.monotonic() < deadline:
            time.sleep(0.01)
        assert client.get("/v1/spectrum", params=SPECTRUM).status_code == 200


def test_kernels_are_compiled_in_another_process_and_loaded_in_a_thread(monkeypatch):
    done = []

    async def run_process(command, **_):
        done.append(command[1:])
        return type("Ended", (), {"returncode": 0})

    monkeypatch.setattr(rocking_api.execution.kernels, "is_missing", lambda: True)
    monkeypatch.setattr(rocking_api.execution.kernels.anyio, "run_process", run_process)
    monkeypatch.setattr(rocking_api.execution.kernels, "load_kernels", lambda: done.append(threading.current_thread()))

    async def scenario():
        kernels = Kernels(1.0)
        await kernels.wait()  # nothing loads them: a request loads what it needs
        await kernels.load()
        await kernels.wait()

    asyncio.run(scenario())
    assert done[0] == ["-m", "rocking.precompile"]
    assert done[1] is not threading.main_thread()
