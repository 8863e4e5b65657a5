"""Messages to the service manager: as long as event loops run; workers whose loop stops are killed."""

import math
import os
import re
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import httpx2
import pytest
from rocking_api.metrics import FOLDER
from rocking_api.service_manager import tell_that_it_answers, watchdog_seconds

from tests.api.servers import Server, processes_below, serving

SECONDS = 60
"""Longest time that a test waits for something."""

SILENCE = 4
"""Time without a message after which none is expected: they come once a second."""

WATCHDOG_SECONDS = 8
"""Longer than a worker waits for a processor on a busy machine."""

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the service manager is that of Linux")


@contextmanager
def service_manager(address, monkeypatch):
    """The socket of a service manager, which the environment names."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as receiver:
        receiver.bind(address.replace("@", "\0"))
        monkeypatch.setenv("NOTIFY_SOCKET", address)
        monkeypatch.setenv("WATCHDOG_USEC", str(WATCHDOG_SECONDS * 1_000_000))
        yield receiver


@pytest.fixture
def messages(tmp_path, monkeypatch):
    with service_manager(str(tmp_path / "notify"), monkeypatch) as receiver:
        yield receiver


def next_message(receiver, seconds=SECONDS):
    """Lines of the next message."""
    receiver.settimeout(seconds)
    return receiver.recv(4096).decode().split("\n")


def cease(receiver):
    """Whether messages cease, apart from those that wait."""
    deadline = time.monotonic() + SECONDS
    while time.monotonic() < deadline:
        try:
            next_message(receiver, SILENCE)
        except TimeoutError:
            return True
    return False


def test_without_a_service_manager_nothing_is_sent_and_no_time_is_set(monkeypatch):
    for name in ("NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"):
        monkeypatch.delenv(name, raising=False)
    tell_that_it_answers()
    assert watchdog_seconds() == math.inf


def test_the_watchdog_of_another_process_is_none_of_this_one(monkeypatch):
    monkeypatch.setenv("WATCHDOG_USEC", "2500000")
    assert watchdog_seconds() == 2.5
    monkeypatch.setenv("WATCHDOG_PID", str(os.getpid()))
    assert watchdog_seconds() == 2.5
    monkeypatch.setenv("WATCHDOG_PID", str(os.getppid()))
    assert watchdog_seconds() == math.inf


def test_the_address_of_a_service_manager_may_be_a_name_that_is_no_file(monkeypatch):
    with service_manager(f"@rocking-{os.getpid()}", monkeypatch) as receiver:
        tell_that_it_answers()
        assert next_message(receiver) == ["READY=1", "WATCHDOG=1"]


def test_a_service_manager_that_is_not_reached_is_logged_and_does_no_harm(tmp_path, monkeypatch, caplog):
    monkeypatch.setenv("NOTIFY_SOCKET", str(tmp_path / "missing"))
    tell_that_it_answers()
    assert "the service manager was not reached" in caplog.text


@pytest.mark.usefixtures("messages")
def test_a_service_manager_that_does_not_read_is_not_waited_for(caplog):
    for _ in range(10_000):  # more than a socket holds
        tell_that_it_answers()
        if caplog.text:
            return
    raise AssertionError


@pytest.mark.parametrize("workers", [1, 2])
def test_the_service_says_that_it_answers_until_it_stops(messages, results, tmp_path, workers):
    with serving(results, tmp_path / "log", workers=workers) as server:
        assert next_message(messages) == ["READY=1", "WATCHDOG=1"]
        assert httpx2.get(server.address + "/health", timeout=SECONDS).json()["status"] == "ok"
        assert next_message(messages) == ["READY=1", "WATCHDOG=1"]
        server.process.send_signal(signal.SIGSTOP)
        assert cease(messages)
        server.process.send_signal(signal.SIGCONT)
        assert "WATCHDOG=1" in next_message(messages)
        assert server.stop(SECONDS) == -signal.SIGTERM


PROGRAM = """
import sys, time
import rocking_api.server as server
from rocking_api.settings import Settings

async def app(scope, receive, send):
    if scope["type"] == "http":
        time.sleep(1000)  # in the event loop

server.create_app = lambda *_, **__: app
server._load_kernels = lambda: None
server.serve(Settings(), "127.0.0.1", 0, int(sys.argv[1]))
"""


@contextmanager
def blocked(workers, log, messages):
    """A service that has sent a message, with its event loop, or that of one of its workers, blocked by a request."""
    command = [sys.executable, "-c", PROGRAM, str(workers)]
    environment = os.environ | {FOLDER: str(log.parent), "PYTHONFAULTHANDLER": "1"}
    with log.open("w") as output, subprocess.Popen(command, stderr=output, env=environment) as it:
        try:
            server = Server(it, log)
            next_message(messages)
            with socket.create_connection(("127.0.0.1", server.port)) as connection:
                connection.sendall(b"GET / HTTP/1.1\r\nHost: here\r\n\r\n")
                yield server
        finally:
            if it.poll() is None:
                for process in (*processes_below(it.pid), it.pid):
                    os.kill(process, signal.SIGKILL)


def test_a_blocked_event_loop_is_silent(messages, tmp_path):
    with blocked(1, tmp_path / "log", messages) as server:
        assert cease(messages)
        server.process.send_signal(signal.SIGABRT)  # as systemd does
        server.process.wait(SECONDS)
        assert "in app" in server.log.read_text()  # where the loop was


def test_a_worker_with_a_blocked_event_loop_is_replaced(messages, tmp_path):
    with blocked(2, tmp_path / "log", messages) as server:
        before, deadline = set(processes_below(server.process.pid)), time.monotonic() + SECONDS
        killing = re.compile(r'"a worker does not answer, it is killed".*"worker": ?(\d+)')
        while not (killed := killing.search(server.log.read_text())):
            assert time.monotonic() < deadline
            next_message(messages)
        while len(after := set(processes_below(server.process.pid))) < 2 or after == before:
            assert time.monotonic() < deadline
            time.sleep(0.1)
        assert before - after == {int(killed[1])}  # the other one serves
        assert "WATCHDOG=1" in next_message(messages)
        assert not Path(f"/proc/{killed[1]}").exists()
