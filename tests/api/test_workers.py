"""Several workers on one port: metrics of all, kernels that they share, a worker that is killed, the end of all."""

import http.client
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import closing, contextmanager, suppress
from pathlib import Path

import httpx2
import pytest
import rocking_api.command
import rocking_api.server
from prometheus_client.parser import text_string_to_metric_families
from rocking_api.metrics import FOLDER
from typer.testing import CliRunner

from rocking._cli.app import app
from rocking._datasets.checksum import sha256_of_file
from rocking._datasets.cube import read_spectrum, write_dataset
from tests.api.servers import processes_below, serving

POINT = "/v1/response?pulse=sine&slenderness=0.6&frequency_ratio=6.0&restitution=0.85"
SECONDS = 30
"""Longest time that a test waits for something."""

pytestmark = pytest.mark.skipif(not Path("/proc/self/smaps_rollup").exists(), reason="reads /proc of Linux")


@pytest.fixture(scope="module")
def folder(results, tmp_path_factory):
    """A folder with a copy of the results, the log and the temporary files of the server."""
    folder = tmp_path_factory.mktemp("workers")
    shutil.copytree(results, folder / "results")
    return folder


@pytest.fixture(scope="module")
def server(folder):
    with serving(folder / "results", folder / "log", workers=2, TMPDIR=str(folder)) as server:
        httpx2.get(server.address + POINT, timeout=SECONDS)  # the workers are started
        yield server


def workers_of(server):
    return processes_below(server.process.pid)


def connect_to(server, worker):
    """A connection that one worker has accepted: each new one goes to any of them."""
    deadline = time.monotonic() + SECONDS
    while time.monotonic() < deadline:
        connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=SECONDS)
        request(connection, "/v1/pulses")
        if _socket_of(server.port, connection.sock.getsockname()[1]) in _descriptors(worker):
            return closing(connection)
        connection.close()
    raise AssertionError("no connection to this worker")


def _socket_of(port, client_port):
    """What the descriptor of a connection is called in the process that has accepted it on a port."""
    rows = [line.split() for line in Path("/proc/net/tcp").read_text().splitlines()[1:]]
    established = (row for row in rows if row[3] == "01")  # former connections of the two ports are listed as well
    # a row may be listed twice while the table changes
    (inode,) = {row[9] for row in established if [int(end[-4:], 16) for end in row[1:3]] == [port, client_port]}
    return f"socket:[{inode}]"


def _descriptors(process):
    """What the open descriptors of a process are called."""
    found = set()
    for link in Path(f"/proc/{process}/fd").iterdir():
        with suppress(FileNotFoundError):  # closed meanwhile
            found.add(str(link.readlink()))
    return found


def request(connection, path):
    """Status, headers and body of a response."""
    connection.request("GET", path)
    response = connection.getresponse()
    return response.status, response.headers, response.read()


def get_from(server, worker, path):
    """The response of one worker."""
    with connect_to(server, worker) as connection:
        return request(connection, path)


def metrics_of(server):
    """Samples of /metrics by name and labels."""
    text = httpx2.get(server.address + "/metrics", timeout=SECONDS).text
    return {
        (sample.name, *sorted(sample.labels.values())): sample.value
        for family in text_string_to_metric_families(text)
        for sample in family.samples
    }


def wait_for(condition):
    deadline = time.monotonic() + SECONDS
    while not (found := condition()):
        assert time.monotonic() < deadline
        time.sleep(0.01)
    return found


def answered(server):
    return metrics_of(server)["rocking_requests_total", "/v1/response", "200", "GET"]


def test_metrics_are_those_of_all_workers(server):
    first, second = workers_of(server)
    before = answered(server)
    ids = {get_from(server, worker, POINT)[1]["x-request-id"] for worker in (first, second, second)}
    assert len(ids) == 3  # workers do not draw the same random numbers
    wait_for(lambda: answered(server) == before + 3)
    found = metrics_of(server)
    assert found["rocking_points_total", "cube"] == before + 3
    assert found["rocking_heavy_running",] == 0
    for worker in (first, second):
        assert found["process_resident_memory_bytes", str(worker)] > 1e7
    assert {key[1] for key in found if key[0] == "process_open_fds"} == {str(first), str(second)}


def test_workers_share_kernels(server):
    for worker in workers_of(server):
        assert json.loads(get_from(server, worker, POINT)[2])["source"] == "cube"
    for worker in workers_of(server):
        memory = Path(f"/proc/{worker}/smaps_rollup").read_text()
        sizes = {key: int(size) for key, size in re.findall(r"^(\w+): +(\d+) kB", memory, re.MULTILINE)}
        assert sizes["Private_Clean"] + sizes["Private_Dirty"] < sizes["Rss"] / 3


def test_all_workers_read_a_replaced_cube(server, folder):
    path = folder / "results" / "spectra" / "sine" / "eta-0.85.nc"
    old, answer = sha256_of_file(path), httpx2.get(server.address + POINT).json()
    assert answer["data_version"] == old
    write_dataset(read_spectrum(path).assign_attrs(comment="another file of the same cube"), path)
    new = sha256_of_file(path)
    assert new != old
    for worker in workers_of(server):
        with connect_to(server, worker) as connection:
            wait_for(lambda: json.loads(request(connection, POINT)[2]) == answer | {"data_version": new})


def test_a_killed_worker_is_replaced(server):
    before, (first, second) = answered(server), workers_of(server)
    os.kill(first, signal.SIGKILL)
    for _ in range(20):
        assert httpx2.get(server.address + POINT, timeout=SECONDS).status_code == 200
    third = wait_for(lambda: set(workers_of(server)) - {first, second}).pop()
    assert get_from(server, third, POINT)[0] == 200
    assert answered(server) >= before + 20  # those of the killed worker are counted
    wait_for(lambda: ("process_open_fds", str(third)) in metrics_of(server))
    assert ("process_open_fds", str(first)) not in metrics_of(server)
    assert "a worker has ended" in server.log.read_text()


def test_running_requests_of_all_workers_are_finished_at_shutdown(server, folder):
    """The last test of this server."""
    assert [*folder.glob("rocking-metrics-*")]
    responses, asking, workers = [], [], workers_of(server)

    def ask(worker, restitution):
        with connect_to(server, worker) as connection:
            # traced on request: some seconds
            responses.append(request(connection, f"/v1/overturning?pulse=ricker&restitution={restitution}")[0])

    for worker in workers:
        asking.append(threading.Thread(target=ask, args=(worker, 0.77 + len(asking) / 100)))
        asking[-1].start()
    wait_for(lambda: metrics_of(server)["rocking_heavy_running",] == 2)
    status = server.stop()
    for thread in asking:
        thread.join()
    assert responses == [200, 200]
    assert status == -signal.SIGTERM
    assert [worker for worker in workers if Path(f"/proc/{worker}").exists()] == []
    assert [*folder.glob("rocking-metrics-*")] == []


def test_the_folder_of_metrics_is_removed_if_it_ends_before_the_workers_run(tmp_path, monkeypatch):
    def serve(*_):
        (folder,) = tmp_path.iterdir()
        assert os.environ[FOLDER] == str(folder)
        signal.raise_signal(signal.SIGTERM)

    monkeypatch.setattr(rocking_api.server, "serve", serve)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv(FOLDER, "")  # restored at the end
    handler = signal.getsignal(signal.SIGTERM)
    try:
        with pytest.raises(SystemExit, match="143"):
            rocking_api.command.main(None, "127.0.0.1", 0, workers=2)
    finally:
        signal.signal(signal.SIGTERM, handler)
    assert [*tmp_path.iterdir()] == []


PROGRAM = """
import os, signal, socket, sys, time
from rocking_api.workers import Workers

def work(*_):
    os.write(1, f"{os.getpid()}\\n".encode())  # at once: both workers write to this pipe
    if sys.argv[1] == "fails":
        sys.exit(3)
    while True:
        time.sleep(1)

listener = socket.create_server(("127.0.0.1", 0))
print(Workers(work, lambda process: print("ended", process, flush=True), 0).run([listener] * 2), listener.fileno())
"""


@contextmanager
def main_process(way):
    """Two workers that do nothing, and end in some way."""
    with subprocess.Popen([sys.executable, "-c", PROGRAM, way], stdout=subprocess.PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.kill()


def test_a_worker_that_cannot_start_ends_all():
    with main_process("fails") as process:
        assert process.wait(SECONDS) == 3


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_all_workers(number):
    with main_process("by a signal") as process:
        workers = [int(process.stdout.readline()) for _ in range(2)]
        process.send_signal(number)
        assert process.wait(SECONDS) == 0
        *ended, result = process.stdout.read().splitlines()
    assert sorted(ended) == sorted(f"ended {worker}" for worker in workers)
    assert result == f"{int(number)} -1"


def test_workers_end_with_a_main_process_that_is_killed():
    with main_process("by a signal") as process:
        workers = [int(process.stdout.readline()) for _ in range(2)]
        process.kill()
        wait_for(lambda: not any(_runs(worker) for worker in workers))


def _runs(process):
    """Whether a process runs; one that has ended may wait for its new parent to notice."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


@pytest.mark.parametrize(("workers", "reason"), [("0", "greater than or equal to 1"), ("two", "a valid integer")])
def test_a_number_of_workers_that_makes_no_sense_is_refused(workers, reason):
    refused = CliRunner().invoke(app, ["serve", "--workers", workers])
    assert refused.exit_code == 2
    assert "Invalid value for '--workers'" in refused.output
    assert reason in refused.output
