"""One worker against several: `python -m benchmarks.service.workers [--results FOLDER] [--workers 2]`.

First the memory of all processes of each service, pages that several share counted once (PSS), after batches from every
cube of the pulse, each service alone. Then both services run and are loaded in turns, several rounds each: requests for
one block over many connections, by wrk if it is installed, batches of 20,000 blocks, and downloads by wrk. Last, a
worker is killed under load: which requests fail. The load shares the cores with the workers: on two cores two workers
cannot reach twice the rate of one where that needs a core.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.measure import progress, save, spread, versions
from benchmarks.service.load import load, point_request, send

POINT = "/v1/response?pulse=%s&restitution=0.85&slenderness=%%.9f&frequency_ratio=%%.9f"
BATCH_POINTS = 20_000
"""Blocks of a batch."""


class Service:
    """A running service with some workers."""

    def __init__(self, process: subprocess.Popen[bytes], port: int, workers: int) -> None:
        self.process = process
        self.port = port
        self.workers = workers

    def processes(self) -> list[int]:
        """The main process and its workers."""
        return [self.process.pid, *children(self.process.pid)]

    def memory(self) -> dict[str, float]:
        """Memory of all processes, shared pages counted once, and largest private memory of one process [MB]."""
        sizes = [_memory(process) for process in self.processes()]
        return {
            "all_MB": sum(size["Pss"] for size in sizes),
            "largest_private_MB": max(size["Private_Clean"] + size["Private_Dirty"] for size in sizes),
        }

    def processor_seconds(self) -> float:
        """Processor time of all processes so far [s]."""
        ticks = 0
        for process in self.processes():
            fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
            ticks += int(fields[11]) + int(fields[12])
        return ticks / os.sysconf("SC_CLK_TCK")

    def post(self, body: bytes) -> None:
        """Send a batch and read its response."""
        request = urllib.request.Request(
            f"http://127.0.0.1:{self.port}/v1/response", body, {"Content-Type": "application/json"}
        )
        with urllib.request.urlopen(request, timeout=300) as response:
            response.read()


def batch(pulse: str, restitution: float, points: int) -> bytes:
    """The body of a batch of random blocks."""
    random = np.random.default_rng(points)
    body = {
        "pulse": pulse,
        "restitution": restitution,
        "slenderness": random.uniform(0.05, 0.95, points).tolist(),
        "frequency_ratio": np.exp(random.uniform(np.log(0.5), np.log(12.0), points)).tolist(),
    }
    return json.dumps(body).encode()


def children(process: int) -> list[int]:
    """Process ids of the children of a process."""
    children = Path(f"/proc/{process}/task/{process}/children")
    return [int(child) for child in children.read_text(encoding="utf-8").split()]


def _memory(process: int) -> dict[str, float]:
    rollup = Path(f"/proc/{process}/smaps_rollup").read_text(encoding="utf-8")
    return {key: int(size) / 1e3 for key, size in re.findall(r"^(\w+): +(\d+) kB", rollup, re.MULTILINE)}


@contextmanager
def service(results: Path, workers: int) -> Iterator[Service]:
    """A service on a free port, once its workers respond."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "log"
        command = [sys.executable, "-m", "rocking._cli", "serve", "--port", "0", "--results", str(results)]
        environment = os.environ | {"ROCKING_MAX_SECONDS": "600"}
        with (
            log.open("wb") as output,
            subprocess.Popen(
                [*command, "--workers", str(workers)], stdout=output, stderr=output, env=environment
            ) as process,
        ):
            try:
                while not (listening := re.search(rb"running on http://127\.0\.0\.1:(\d+)", log.read_bytes())):
                    if process.poll() is not None:
                        raise SystemExit(log.read_text())
                    time.sleep(0.005)
                one = Service(process, int(listening[1]), workers)
                one.post(batch("sine", 0.85, 10))
                yield one
            finally:
                process.terminate()
                process.wait(60)


def memory_with_all_cubes(one: Service, pulse: str, restitutions: list[float]) -> dict[str, float]:
    """Memory after batches from every cube; there are so many that each worker has used each cube."""
    at_first = one.memory()["all_MB"]
    for restitution in restitutions:
        for _ in range(1 if one.workers == 1 else 8 * one.workers):
            one.post(batch(pulse, restitution, BATCH_POINTS))
    return {"at_first_MB": at_first, **one.memory()}


def turn(one: Service, pulse: str, connections: int, seconds: float) -> dict[str, float]:
    """Requests per second and processor time for a request under one load."""
    before = one.processor_seconds()
    found = load(one.port, POINT % pulse, connections, seconds, None)
    spent = one.processor_seconds() - before
    return {
        "per_second": found["per_second"],
        "median_ms": found["median_ms"],
        "p99_ms": found["p99_ms"],
        "errors": found["errors"],
        "processor_ms": 1e3 * spent / found["questions"],
    }


def batch_turn(one: Service, pulse: str, seconds: float, clients: int) -> float:
    """Batches per second of some clients that send one after the other."""
    body = batch(pulse, 0.85, BATCH_POINTS)

    async def client(until: float) -> int:
        count = 0
        while time.perf_counter() < until:
            await asyncio.to_thread(one.post, body)
            count += 1
        return count

    async def all_clients() -> float:
        began = time.perf_counter()
        counts = await asyncio.gather(*(client(began + seconds) for _ in range(clients)))
        return sum(counts) / (time.perf_counter() - began)

    return asyncio.run(all_clients())


def file_turn(one: Service, name: str, seconds: float) -> dict[str, float]:
    """Downloads of a data set and revalidations of an unchanged one per second, over 16 connections of wrk."""
    address = f"http://127.0.0.1:{one.port}/v1/datasets/{name}.nc"
    with urllib.request.urlopen(address) as response:
        tag, megabytes = response.headers["ETag"], len(response.read()) / 1e6
    rates = {}
    for kind, header in (("downloads", []), ("revalidations", ["--header", f"If-None-Match: {tag}"])):
        command = ["wrk", "-t1", "-c16", f"-d{max(1, round(seconds))}s", *header, address]
        printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        rates[kind] = float(re.findall(r"Requests/sec: +([\d.]+)", printed)[0])
    return {**rates, "download_MB_per_second": rates["downloads"] * megabytes}


def kill_under_load(one: Service, pulse: str, connections: int, seconds: float) -> dict[str, Any]:
    """Kill a worker after a third of the time; each connection sends one request after the other.

    Returns
    -------
    dict
        requests, failed (by kind), the longest time of a request [s], and after which time the new worker ran [s].
    """
    outcomes: Counter[str] = Counter()
    times: list[float] = []
    random = np.random.default_rng(connections)

    async def connection(until: float) -> None:
        reader, writer = await asyncio.open_connection("127.0.0.1", one.port)
        try:
            while time.perf_counter() < until:
                began = time.perf_counter()
                head = await send(reader, writer, point_request(POINT % pulse, random))
                outcomes[head[9:12].decode()] += 1
                times.append(time.perf_counter() - began)
        finally:
            writer.close()
            with suppress(OSError):
                await writer.wait_closed()

    async def client(until: float) -> None:
        while time.perf_counter() < until:
            try:
                await connection(until)
            except (OSError, asyncio.IncompleteReadError) as error:
                outcomes[type(error).__name__] += 1

    async def killer() -> float:
        await asyncio.sleep(seconds / 3)
        workers = set(children(one.process.pid))
        os.kill(min(workers), signal.SIGKILL)
        began = time.perf_counter()
        while not set(children(one.process.pid)) - workers:
            await asyncio.sleep(0.002)
        return time.perf_counter() - began

    async def everything() -> float:
        until = time.perf_counter() + seconds
        clients = [asyncio.create_task(client(until)) for _ in range(connections)]
        replaced = await killer()
        await asyncio.gather(*clients)
        return replaced

    replaced = asyncio.run(everything())
    failed = {kind: count for kind, count in outcomes.items() if kind != "200"}
    return {
        "requests": outcomes.total(),
        "failed": failed,
        "longest_s": max(times),
        "replaced_after_s": replaced,
        "connections": connections,
    }


def main(arguments: list[str] | None = None) -> None:
    """Measure, print, write the record."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", type=Path, default=Path("results"), help="folder of the data sets")
    parser.add_argument("--workers", type=int, default=2, help="of the second service")
    parser.add_argument("--pulse", default="sine")
    parser.add_argument("--seconds", type=float, default=4.0, help="of each load")
    parser.add_argument("--connections", type=int, nargs="+", default=[16, 64])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--out", type=Path, default=Path("results/benchmarks/workers.json"))
    asked = parser.parse_args(arguments)
    restitutions = sorted(float(path.stem[4:]) for path in asked.results.glob(f"spectra/{asked.pulse}/eta-*.nc"))
    record: dict[str, Any] = {
        "versions": versions("rocking", "fastapi", "uvicorn", "uvloop", "httptools", "numpy"),
        "cores": len(os.sched_getaffinity(0)),
        "cubes": len(restitutions),
    }
    record["memory"] = {}
    for workers in (1, asked.workers):
        progress(f"memory of {workers}")
        with service(asked.results, workers) as one:
            record["memory"][workers] = memory_with_all_cubes(one, asked.pulse, restitutions)
    with ExitStack() as stack:
        services = {workers: stack.enter_context(service(asked.results, workers)) for workers in (1, asked.workers)}
        loads: dict[tuple[int, int], list[dict[str, float]]] = {}
        batches: dict[int, list[float]] = {}
        for number in range(asked.rounds):
            progress(f"round {number + 1}")
            for workers, one in services.items():
                for connections in asked.connections:
                    loads.setdefault((workers, connections), []).append(
                        turn(one, asked.pulse, connections, asked.seconds)
                    )
                batches.setdefault(workers, []).append(batch_turn(one, asked.pulse, asked.seconds, 4))
        record["loads"] = [
            {"workers": workers, "connections": connections}
            | {name: spread([row[name] for row in rows]) for name in rows[0]}
            for (workers, connections), rows in loads.items()
        ]
        if shutil.which("wrk"):
            progress("files")
            name = f"spectra/{asked.pulse}/eta-0.85"
            turns = [
                (workers, file_turn(one, name, asked.seconds)) for _ in range(3) for workers, one in services.items()
            ]
            record["files"] = [
                {"workers": workers}
                | {kind: spread([rates[kind] for one, rates in turns if one == workers]) for kind in turns[0][1]}
                for workers in services
            ]
        record["ratios"] = {  # in one round, so that other load on the machine affects both alike
            connections: spread(
                [
                    several["per_second"] / one["per_second"]
                    for one, several in zip(loads[1, connections], loads[asked.workers, connections], strict=True)
                ]
            )
            for connections in asked.connections
        }
        record["batches"] = [{"workers": workers, "per_second": spread(rates)} for workers, rates in batches.items()]
        progress("a worker is killed")
        record["killed"] = [
            kill_under_load(services[asked.workers], asked.pulse, connections, asked.seconds)
            for connections in asked.connections
        ]
    save(record, asked.out)
    print(table(record))


def table(record: dict[str, Any]) -> str:
    """All of it in lines."""
    lines = [
        f"{row['workers']} workers, {row['connections']:>3} connections  {row['per_second']['median']:7.0f} requests/s "
        f"({row['per_second']['smallest']:.0f} to {row['per_second']['largest']:.0f})   median "
        f"{row['median_ms']['median']:6.2f} ms   p99 {row['p99_ms']['median']:6.2f} ms   "
        f"processor {row['processor_ms']['median']:.3f} ms a request   errors {row['errors']['largest']:.0f}"
        for row in record["loads"]
    ]
    lines += [
        f"{connections:>3} connections: {ratio['median']:.2f} times the rate of one worker "
        f"({ratio['smallest']:.2f} to {ratio['largest']:.2f})"
        for connections, ratio in record["ratios"].items()
    ]
    lines += [
        f"{row['workers']} workers, batches of {BATCH_POINTS:,}  {row['per_second']['median']:.1f} a second "
        f"({row['per_second']['smallest']:.1f} to {row['per_second']['largest']:.1f})"
        for row in record["batches"]
    ]
    lines += [
        f"{row['workers']} workers, 16 connections  {row['downloads']['median']:.0f} downloads/s "
        f"({row['download_MB_per_second']['median']:.0f} MB/s), {row['revalidations']['median']:.0f} revalidations/s"
        for row in record.get("files", [])
    ]
    lines += [
        f"{workers} workers: {memory['at_first_MB']:.0f} MB in all, {memory['all_MB']:.0f} MB after all cubes, "
        f"at most {memory['largest_private_MB']:.0f} MB private in one process"
        for workers, memory in record["memory"].items()
    ]
    lines += [
        f"worker killed, {row['connections']} connections: {sum(row['failed'].values())} of {row['requests']} requests "
        f"failed {row['failed']}, the longest took {row['longest_s']:.3f} s, "
        f"replaced after {row['replaced_after_s']:.3f} s"
        for row in record["killed"]
    ]
    return "\n".join(lines)


if __name__ == "__main__":
    main()
