"""The benchmark's peer is a fair one, and the command still runs; no time is asserted."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import rocking
from benchmarks.scipy_peer import peak_rotation


def test_the_script_with_scipy_finds_the_same_peaks() -> None:
    """A dozen cells, from no uplift over impacts to chatter and renewed uplift."""
    random = np.random.default_rng(3)
    slenderness = np.r_[random.uniform(0.1, 0.97, 10), 0.97, 1.2]
    frequency_ratio = np.r_[random.uniform(0.5, 12.0, 10), 4.0, 2.0]
    found = [peak_rotation(s, w, 0.6) for s, w in zip(slenderness, frequency_ratio, strict=True)]
    response = rocking.peak_response("sine", slenderness=slenderness, frequency_ratio=frequency_ratio, restitution=0.6)
    assert response.chatter.any()
    np.testing.assert_allclose(found, response.peak_rotation, rtol=1e-6, atol=1e-10)


@pytest.mark.slow
def test_the_benchmark_runs_and_finds_both_right(tmp_path: Path) -> None:
    out = tmp_path / "slender-cell.json"
    command = [sys.executable, "-m", "benchmarks.slender_cell", "--count", "40", "--sample", "30", "--rounds", "2"]
    root = Path(__file__).parents[1]
    done = subprocess.run([*command, "--out", str(out)], check=False, cwd=root, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    record = json.loads(out.read_text())
    assert record["accuracy"]["ours"]["wrong_fates"] == record["accuracy"]["scipy"]["wrong_fates"] == 0
    assert record["accuracy"]["ours"]["largest_error"] < 1e-12
    assert record["accuracy"]["scipy"]["largest_error"] < 1e-6
    assert "scipy over ours" in done.stdout
