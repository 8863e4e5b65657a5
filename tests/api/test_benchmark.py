"""`python -m benchmarks.cost.service` runs and records what it should; no time is asserted."""

import json
import subprocess
import sys

import pytest

from tests.api.servers import ROOT


@pytest.mark.long
def test_the_benchmark_measures_a_worker(results, tmp_path):
    out = tmp_path / "service.json"
    few = ["--seconds", "1", "--points", "2000", "--rounds", "1"]
    command = [sys.executable, "-m", "benchmarks.cost.service", "--results", str(results), *few, "--out", str(out)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    record = json.loads(out.read_text())
    assert record["points"]["questions"] > 50
    assert 0 < record["points"]["median_ms"] <= record["points"]["p99_ms"]
    assert [one["points"] for one in record["batches"]] == [2000]
    assert 0 < record["share_by_data_sets"] < 1
    assert record["memory"]["after batches"]["now_MB"] > 50
    assert "the rest by the solver" in done.stdout
