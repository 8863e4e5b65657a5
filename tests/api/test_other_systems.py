"""What the service does where functions of Linux are missing: taken away here, the other systems were not at hand."""

import ctypes
import multiprocessing
import os
import runpy
import subprocess
import sys
from contextlib import ExitStack

import httpx2
import pytest
import rocking_api.server
import uvicorn
from typer.testing import CliRunner

import workflow.run
from rocking._cli.app import app
from rocking._solver import chunks
from tests.api.servers import ROOT, serving

LIMITED = """
import os, runpy, socket, sys
import netCDF4, numba, pandas, scipy, typer, xarray  # as they are for the system where this test runs
sys.platform = "freebsd14"  # of darwin and win32 Python itself has modules that are missing here
sys.modules["uvloop"] = sys.modules["httptools"] = None
os.process_cpu_count = os.cpu_count  # from Python 3.13 on it calls the function that goes
del os.sched_getaffinity, socket.TCP_NOTSENT_LOWAT
runpy.run_module("rocking._cli", run_name="__main__")
"""


def test_a_service_answers_without_the_packages_and_functions_of_linux(results, tmp_path):
    with serving(results, tmp_path / "log", (sys.executable, "-c", LIMITED)) as server:
        question = "pulse=sine&slenderness=0.6&frequency_ratio=6&restitution=0.85"
        answer = httpx2.get(f"{server.address}/v1/response?{question}", timeout=120)
        assert answer.status_code == 200
        assert server.stop() in (0, -15)


def test_workers_of_other_systems_share_one_socket(monkeypatch):
    config = uvicorn.Config("", port=0)
    for system, count in (("linux", 3), ("darwin", 1)):
        monkeypatch.setattr(sys, "platform", system)
        with ExitStack() as stack:
            sockets = [stack.enter_context(one) for one in rocking_api.server._listen(config, 3)]
            assert len({one.fileno() for one in sockets}) == count
            assert len({one.getsockname() for one in sockets}) == 1


def test_several_workers_are_refused_where_processes_cannot_be_forked(monkeypatch, tmp_path):
    monkeypatch.setattr(multiprocessing, "get_all_start_methods", lambda: ["spawn"])
    refused = CliRunner().invoke(app, ["serve", "--workers", "2", "--results", str(tmp_path)])
    assert refused.exit_code == 2
    assert refused.output == "Error: --workers = 2 is not allowed; allowed: 1 on a system that cannot fork\n"


@pytest.mark.parametrize("error", [OSError, AttributeError, TypeError])
def test_another_c_library_is_left_as_it_is(monkeypatch, error):
    def refuse(name):
        assert name is None
        raise error

    monkeypatch.setattr(ctypes, "CDLL", refuse)
    rocking_api.server._return_freed_memory()


def test_cores_are_those_of_the_machine_where_a_process_has_none_of_its_own(monkeypatch):
    assert len(os.sched_getaffinity(0)) == chunks.AVAILABLE_CORES
    monkeypatch.delattr(os, "sched_getaffinity")
    monkeypatch.setattr(os, "cpu_count", lambda: 7)
    assert runpy.run_path(chunks.__file__)["AVAILABLE_CORES"] == 7
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert runpy.run_path(chunks.__file__)["AVAILABLE_CORES"] == 1


def test_the_memory_of_a_run_is_limited_where_the_system_tells_it(monkeypatch):
    (limit,) = workflow.run._memory_limit([])
    assert 0 < float(limit.removeprefix("--resources=mem_mb=")) < 1e9
    monkeypatch.setattr(os, "sysconf_names", {})
    assert workflow.run._memory_limit([]) == []


def test_the_library_is_imported_without_modules_of_posix():
    code = """
import os, sys
import netCDF4, numba, pandas, scipy, typer, xarray  # as they are for the system where this test runs
sys.platform = "win32"
for name in ("fcntl", "pwd", "grp", "resource", "termios"):
    sys.modules[name] = None
del os.fork, os.sysconf, os.sched_getaffinity
import rocking
print([getattr(rocking, name) is not None for name in rocking.__all__].count(False))
"""
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.stdout == "0\n", done.stderr
