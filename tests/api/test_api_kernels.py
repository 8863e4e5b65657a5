"""The service responds while the solver is compiled; requests for it wait up to their time limit."""

import asyncio
import os
import shutil
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace
from urllib.parse import urlencode

import pytest
import rocking_api.execution.kernels

from rocking import precompile
from rocking._excitation.pulses import PULSE_NAMES
from rocking._numba.kernel_cache import cache_folder
from rocking._solver.kernels.batch import solve_batch
from tests.api.conftest import assert_problem, client_of, until
from tests.api.servers import Stopwatch, ask, serving

QUERY = {"slenderness": 0.6, "frequency_ratio": 6.0, "restitution": 0.85, "method": "solver"}
FOLDER = f"{solve_batch.__module__}.{solve_batch.__name__}"
"""Of the kernel whose compilation takes longest."""

SPECTRUM = {"pulse": "sine", "slenderness": 0.6, "restitution": 0.85, "points": 3}


def get(port, path):
    """Status of a request."""
    return ask(port, "GET", path)[0]


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
    for granted in (600, 60):
        log, path["ROCKING_MAX_SECONDS"] = tmp_path / f"{granted}.log", str(granted)
        with serving(tmp_path, log, command, cwd=tmp_path, **path) as server, ThreadPoolExecutor() as clients:
            assert str(installed.packages) in log.read_text()
            for page in ("/", "/docs", "/openapi.json", "/metrics", "/static/docs.js"):
                assert get(server.port, page) == 200, page
            if granted == 60:
                get(server.port, "/v1/response?" + urlencode(QUERY | {"pulse": "sine"}))  # waits until they are loaded
            began, waits = time.monotonic(), []
            queries = (urlencode(QUERY | {"pulse": name}) for name in PULSE_NAMES)
            asked = [clients.submit(get, server.port, f"/v1/response?{query}") for query in queries]
            while not all(one.done() for one in asked):
                stopwatch = Stopwatch(os.getpid(), server.process.pid)
                assert get(server.port, "/health") == 200
                waits.append(stopwatch.seconds())
                time.sleep(0.005)
        assert {one.result() for one in asked} == {200}
        assert max(waits) < 0.2
        assert (copied / FOLDER).is_dir()
    assert time.monotonic() - began < 1.5  # of the second, whose kernels are loaded


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
        until(lambda: client.get("/v1/spectrum", params=SPECTRUM).status_code == 200)


def test_kernels_are_compiled_in_another_process_and_loaded_in_a_thread(monkeypatch):
    done = []

    async def run_process(command, **_):
        done.append(command[1:])
        return SimpleNamespace(returncode=0)

    own = rocking_api.execution.kernels
    monkeypatch.setattr(own, "is_missing", lambda: True)
    monkeypatch.setattr(own.anyio, "run_process", run_process)
    monkeypatch.setattr(own, "load_kernels", lambda: done.append(threading.current_thread()))
    asyncio.run(own.Kernels(1.0).load())
    assert done[0] == ["-m", "rocking.precompile"]
    assert done[1] is not threading.main_thread()
