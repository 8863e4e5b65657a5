"""The service on one core, asked from another: `python -m benchmarks.service.performance [--results FOLDER]`.

One worker is bound to the first core, the load to the second. Measured are the start, questions about one block over
1, 16 and 64 connections, batches of a thousand to a million blocks in binary and to a hundred thousand in JSON, and the
memory of the worker. The blocks are random: 1/a 0.05 to 0.95, omega 0.5 to 12, restitution 0.85, alpha as asked; how
many of them a data set answers, and how many the solver, is told. wrk asks if it is installed (apt-get install wrk).
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from benchmarks.measure import progress, save, spread, versions
from benchmarks.service.load import load

NETCDF = "application/x-netcdf"
SERVER = "import os; os.sched_setaffinity(0, {%d}); from rocking._cli.app import app; app()"


class Worker:
    """A running server."""

    def __init__(self, process: subprocess.Popen[bytes], port: int) -> None:
        self.process = process
        self.port = port

    def ask(self, path: str, body: bytes | None = None, media_type: str = "application/json") -> bytes:
        """GET, or POST with a body."""
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{path}", body, {"Content-Type": media_type})
        with urllib.request.urlopen(request, timeout=300) as answer:
            content: bytes = answer.read()
        return content

    def memory(self) -> dict[str, float]:
        """Resident memory now and at most [MB]."""
        status = Path(f"/proc/{self.process.pid}/status").read_text(encoding="utf-8")
        names = {"now_MB": "VmRSS", "most_MB": "VmHWM"}
        return {name: int(re.findall(rf"{key}:\s+(\d+) kB", status)[0]) / 1e3 for name, key in names.items()}


@contextmanager
def worker(results: Path, core: int, pulse: str) -> Iterator[tuple[Worker, dict[str, float]]]:
    """A server bound to a core, and how long it took to listen and to give a first answer [s]."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "log"
        began = time.perf_counter()
        command = [sys.executable, "-c", SERVER % core, "serve", "--port", "0", "--results", str(results)]
        with log.open("wb") as output, subprocess.Popen(command, stdout=output, stderr=output) as process:
            try:
                while not (listening := re.search(rb"running on http://127\.0\.0\.1:(\d+)", log.read_bytes())):
                    if process.poll() is not None:
                        raise SystemExit(log.read_text())
                    time.sleep(0.005)
                one = Worker(process, int(listening[1]))
                started = time.perf_counter() - began
                one.ask(_question(pulse, 0.0) % (0.6, 6.0))
                yield one, {"listens_s": started, "first_answer_s": time.perf_counter() - began}
            finally:
                process.terminate()
                process.wait(60)


def _question(pulse: str, alpha_deg: float) -> str:
    path = f"/v1/response?pulse={pulse}&restitution=0.85&slenderness=%.9f&frequency_ratio=%.9f"
    return path + (f"&alpha_deg={alpha_deg:g}" if alpha_deg else "")


def _blocks(points: int) -> dict[str, np.ndarray]:
    random = np.random.default_rng(points)
    return {
        "slenderness": random.uniform(0.05, 0.95, points),
        "frequency_ratio": np.exp(random.uniform(np.log(0.5), np.log(12.0), points)),
    }


def batches(
    one: Worker, pulse: str, alpha_deg: float, sizes: dict[str, list[int]], rounds: int
) -> list[dict[str, Any]]:
    """Time of batches of several sizes [points], from the first byte sent to the last received [s]."""
    options = f"?pulse={pulse}&restitution=0.85&alpha_deg={alpha_deg:g}"
    asked = {
        (form, points): (options, _as_netcdf(points), NETCDF)
        if form == "netcdf"
        else ("", _as_json(points, pulse=pulse, restitution=0.85, alpha_deg=alpha_deg), "application/json")
        for form in sizes
        for points in sizes[form]
    }
    times: dict[tuple[str, int], list[float]] = {key: [] for key in asked}
    for _ in range(rounds):
        for key, (query, body, media_type) in asked.items():
            began = time.perf_counter()
            one.ask("/v1/response" + query, body, media_type)
            times[key].append(time.perf_counter() - began)
    return [{"form": form, "points": points, "seconds": spread(times[form, points])} for form, points in asked]


def share_by_data_sets(one: Worker, pulse: str, alpha_deg: float, points: int) -> float:
    """Of random blocks [-]; the solver answers the others."""
    answer = one.ask("/v1/response", _as_json(points, pulse=pulse, restitution=0.85, alpha_deg=alpha_deg))
    sources = json.loads(answer)["source"]
    return float(sources.count("cube") / max(1, len(sources)))


def _as_netcdf(points: int) -> bytes:
    return bytes(
        xr.Dataset({name: ("point", values) for name, values in _blocks(points).items()}).to_netcdf(engine="scipy")
    )


def _as_json(points: int, **common: Any) -> bytes:
    return json.dumps({**common, **{name: values.tolist() for name, values in _blocks(points).items()}}).encode()


def main(arguments: list[str] | None = None) -> None:
    """Measure, print, write the record."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", type=Path, default=Path("results"), help="folder of the data sets")
    parser.add_argument("--pulse", default="sine")
    parser.add_argument("--alpha-deg", type=float, default=0.0)
    parser.add_argument("--seconds", type=float, default=5.0, help="of each load")
    parser.add_argument("--connections", type=int, nargs="+", default=[1, 16, 64])
    parser.add_argument("--points", type=int, nargs="+", default=[1_000, 10_000, 100_000, 1_000_000], help="of batches")
    parser.add_argument("--json-points", type=int, nargs="+", default=[1_000, 10_000], help="of those in JSON")
    parser.add_argument("--rounds", type=int, default=3, help="of the batches")
    parser.add_argument("--out", type=Path, default=Path("results/benchmarks/service.json"))
    asked = parser.parse_args(arguments)
    cores = sorted(os.sched_getaffinity(0))
    record: dict[str, Any] = {
        "versions": versions("rocking", "fastapi", "uvicorn", "uvloop", "httptools", "numpy"),
        "cores": {"worker": cores[0], "load": cores[-1]},
        "results": sorted(path.relative_to(asked.results).as_posix() for path in asked.results.glob("spectra/*/*.nc")),
    }
    with worker(asked.results, cores[0], asked.pulse) as (one, start):
        record["start"] = start
        record["memory_at_first"] = one.memory()
        record["points"] = []
        for connections in asked.connections:
            progress(f"{connections} connections")
            path = _question(asked.pulse, asked.alpha_deg)
            record["points"].append(load(one.port, path, connections, asked.seconds, cores[-1]))
        record["memory_after_points"] = one.memory()
        progress("batches")
        sizes = {"netcdf": asked.points, "json": asked.json_points}
        record["batches"] = batches(one, asked.pulse, asked.alpha_deg, sizes, asked.rounds)
        record["share_by_data_sets"] = share_by_data_sets(one, asked.pulse, asked.alpha_deg, max(asked.json_points))
        record["memory_after_batches"] = one.memory()
    save(record, asked.out)
    print(table(record))


def table(record: dict[str, Any]) -> str:
    """All of it in lines."""
    start = record["start"]
    lines = [f"start       listens after {start['listens_s']:.2f} s, first answer {start['first_answer_s']:.2f} s"]
    lines += [
        f"{row['connections']:>3} connections ({row['client']})  {row['per_second']:8.0f} questions/s   "
        f"median {row['median_ms']:7.2f} ms   p99 {row['p99_ms']:7.2f} ms   errors {row['errors']}"
        for row in record["points"]
    ]
    lines += [
        f"{row['form']:<7}{row['points']:>9} blocks  {row['seconds']['median']:8.4f} s "
        f"({row['seconds']['smallest']:.4f} to {row['seconds']['largest']:.4f})"
        for row in record["batches"]
    ]
    lines.append(f"by data sets {100 * record['share_by_data_sets']:.1f} %, the rest by the solver")
    memory = [record[f"memory_{when}"] for when in ("at_first", "after_points", "after_batches")]
    lines.append("memory      " + ", ".join(f"{m['now_MB']:.0f} MB" for m in memory) + " (first, points, batches)")
    lines.append(f"at most     {memory[-1]['most_MB']:.0f} MB")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
