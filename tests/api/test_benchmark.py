"""`python -m benchmarks.service.performance` runs and records what it should; no time is asserted."""

import asyncio
import json
import subprocess
import sys

import pytest

from benchmarks.service.load import _run_client
from tests.api.servers import ROOT, serving


@pytest.mark.slow
def test_the_benchmark_measures_a_worker(results, tmp_path):
    out = tmp_path / "service.json"
    few = ["--seconds", "1", "--connections", "4", "--points", "2000", "--json-points", "500", "--rounds", "1"]
    command = [
        sys.executable,
        "-m",
        "benchmarks.service.performance",
        "--results",
        str(results),
        *few,
        "--out",
        str(out),
    ]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    record = json.loads(out.read_text())
    (points,) = record["points"]
    assert points["errors"] == 0
    assert points["questions"] > 50
    assert 0 < points["median_ms"] <= points["p99_ms"]
    assert [(one["form"], one["points"]) for one in record["batches"]] == [("netcdf", 2000), ("json", 500)]
    assert 0 < record["share_by_data_sets"] < 1
    assert record["memory_after_batches"]["now_MB"] > 50
    assert "questions/s" in done.stdout


def test_the_python_client_counts_responses_and_errors(results, tmp_path):
    good = "/v1/response?pulse=sine&restitution=0.85&slenderness=%.9f&frequency_ratio=%.9f"
    with serving(results, tmp_path / "log") as server:
        asyncio.run(_run_client(server.port, good, 3, 0.1))  # the first responses wait for a cube and the kernels
        found = asyncio.run(_run_client(server.port, good, 3, 0.5))
        wrong = asyncio.run(_run_client(server.port, good.replace("sine", "sinus"), 3, 0.2))
    assert (found["client"], found["connections"], found["errors"]) == ("asyncio", 3, 0)
    assert found["questions"] > 10
    assert 0 < found["median_ms"] <= found["p99_ms"]
    assert wrong["errors"] == wrong["questions"] > 0
