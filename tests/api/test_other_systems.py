"""What the service does where functions of Linux are missing: taken away here, the other systems were not at hand."""

import os
import runpy
import sys

import httpx2

from rocking._solver import chunks
from tests.api.servers import serving

LIMITED = """
import os, runpy, sys
import netCDF4, numba, pandas, scipy, typer, xarray  # as they are for the system where this test runs
sys.platform = "freebsd14"  # of darwin and win32 Python itself has modules that are missing here
sys.modules["uvloop"] = sys.modules["httptools"] = None
os.process_cpu_count = os.cpu_count  # from Python 3.13 on it calls the function that goes
del os.sched_getaffinity
runpy.run_module("rocking._cli", run_name="__main__")
"""


def test_a_service_answers_without_the_packages_and_functions_of_linux(results, tmp_path):
    with serving(results, tmp_path / "log", (sys.executable, "-c", LIMITED)) as server:
        question = "pulse=sine&slenderness=0.6&frequency_ratio=6&restitution=0.85"
        answer = httpx2.get(f"{server.address}/v1/response?{question}", timeout=120)
        assert answer.status_code == 200
        assert server.stop() in (0, -15)


def test_cores_are_those_of_the_machine_where_a_process_has_none_of_its_own(monkeypatch):
    assert len(os.sched_getaffinity(0)) == chunks.AVAILABLE_CORES
    monkeypatch.delattr(os, "sched_getaffinity")
    monkeypatch.setattr(os, "cpu_count", lambda: 7)
    assert runpy.run_path(chunks.__file__)["AVAILABLE_CORES"] == 7
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert runpy.run_path(chunks.__file__)["AVAILABLE_CORES"] == 1
