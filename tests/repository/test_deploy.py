"""The files of deploy/ agree with the tree, the settings and the command of the service."""

import configparser
import ctypes.util
import http.client
import itertools
import json
import re
import shlex
import shutil
import socket
import ssl
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import httpx2
import pytest
import typer
from rocking_api.command import HEALTHCHECK_SECONDS
from rocking_api.settings import Settings

from rocking._cli.app import app
from tests.api.servers import proxy, serving
from tests.sampling import number

ROOT = Path(__file__).parents[2]
DEPLOY = ROOT / "deploy"
CONTAINER = (DEPLOY / "Containerfile").read_text()
PROXY = (DEPLOY / "nginx.conf").read_text()
SYSTEMD = pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="no systemd-analyze")
VARIABLES = {f"ROCKING_{name.upper()}" for name in Settings.model_fields}


@pytest.fixture(scope="module")
def unit():
    found = {}
    for line in (DEPLOY / "rocking.service").read_text().splitlines():
        if "=" in line and not line.startswith("#"):
            key, _, value = line.partition("=")
            found.setdefault(key, []).append(value)
    return found


def serve_arguments(command):
    """The options of a command line `.../rocking serve ...`, as the command itself reads them."""
    assert command[0] == "/opt/rocking/bin/rocking"
    assert command[1] == "serve"
    serve = typer.main.get_command(app).get_command(None, "serve")
    return serve.make_context("serve", command[2:], resilient_parsing=False).params


def instructions(name):
    return re.findall(rf"^{name} (.*)$", CONTAINER, re.MULTILINE)


def test_container_copies_what_exists():
    sources = [part for line in instructions("COPY") if "--from" not in line for part in line.split()[:-1]]
    assert {"environment.lock", "deploy/service.lock", "rocking", "api", "assessment"} <= set(sources)
    assert [name for name in sources if not (ROOT / name).exists()] == []


def test_container_installs_what_has_the_hashes_of_the_lock(tmp_path):
    shutil.copy(ROOT / "environment.lock", tmp_path)
    shutil.copy(DEPLOY / "service.lock", tmp_path)
    (select,) = [line for line in instructions("RUN") if line.startswith("sed")]
    subprocess.run(["sh", "-c", select], cwd=tmp_path, check=True)
    first, second = [shlex.split(line) for line in instructions("RUN") if "pip install" in line]
    assert {"--require-hashes", "--no-deps", "--only-binary"} <= set(first)
    files = [value for key, value in itertools.pairwise(first) if key == "--requirement"]
    pinned = [
        name for file in files for name in re.findall(r"^([\w.-]+)==", (tmp_path / file).read_text(), re.MULTILINE)
    ]
    assert {"setuptools", "uvicorn", "numba"} <= set(pinned)
    assert second[-3:] == ["--no-deps", "--no-build-isolation", "."]  # of the project itself there is no hash


def test_container_has_a_base_with_a_digest_and_code_that_its_user_cannot_change():
    (base,) = re.findall(r"^ARG BASE=(.*)$", CONTAINER, re.MULTILINE)
    assert re.fullmatch(r"[\w./-]+@sha256:[0-9a-f]{64}", base)
    assert {line.split()[0] for line in instructions("FROM")} == {"${BASE}"}
    assert "--chown" not in CONTAINER
    assert [line.split()[-1] for line in instructions("RUN") if "--owner rocking" in line] == ["/kernels"]


def test_context_of_the_container_has_no_history_and_nothing_that_was_made():
    ignored = (ROOT / ".containerignore").read_text().splitlines()
    assert (ROOT / ".dockerignore").read_text().splitlines() == ignored
    made = [line.strip("/").removesuffix("/*") for line in (ROOT / ".gitignore").read_text().splitlines()]
    caches = {".pytest_cache", ".mypy_cache", ".ruff_cache"}  # **/.*_cache
    names = {name if "*" in name or "__" not in name else f"**/{name}" for name in made if not name.startswith("!")}
    assert {".git", ".venv", *names} - caches - {"*.egg-info"} <= {*ignored}


def test_container_starts_the_service():
    (command,) = instructions("CMD")
    options = serve_arguments(json.loads(command))
    assert options["host"] == "0.0.0.0"
    assert instructions("EXPOSE") == [str(options["port"])]
    assert f"127.0.0.1:{options['port']}/health" in instructions("HEALTHCHECK")[0]
    variables = dict(part.split("=") for part in instructions("ENV")[0].split())
    assert set(variables) - {"NUMBA_CACHE_DIR"} <= VARIABLES
    assert instructions("USER") == ["rocking"]


def test_unit_starts_the_service_and_stops_it_in_time(unit):
    options = serve_arguments(shlex.split(unit["ExecStart"][0]))
    assert options["host"] == "127.0.0.1"
    variables = dict(line.split("=") for line in unit["Environment"])
    assert set(variables) - {"NUMBA_CACHE_DIR"} <= VARIABLES
    # uvicorn waits for a worker that dies before it answers, then for the requests that run
    assert int(unit["TimeoutStopSec"][0]) > int(variables["ROCKING_STOP_SECONDS"]) + HEALTHCHECK_SECONDS
    assert unit["SocketBindAllow"] == [f"tcp:{options['port']}"]
    assert variables["NUMBA_CACHE_DIR"] == f"%C/{unit['CacheDirectory'][0]}"
    configparser.ConfigParser(strict=False, interpolation=None).read(DEPLOY / "rocking.service")


@SYSTEMD
def test_exposure_that_systemd_finds_is_low():
    command = ["systemd-analyze", "security", "--offline=true", "--no-pager", str(DEPLOY / "rocking.service")]
    printed = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    assert float(re.search(r"exposure level for rocking.service: ([\d.]+)", printed)[1]) <= 1.0


def system_calls(name):
    """Names of the system calls of a group, and of the groups in it; of a call its own."""
    if not name.startswith("@"):
        return {name}
    command = ["systemd-analyze", "syscall-filter", "--no-pager", name]
    lines = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()[1:]
    names = [line.strip() for line in lines if line.startswith("    ") and not line.strip().startswith("#")]
    return {call for inner in names for call in system_calls(inner)}


FILTERED = """
import ctypes, os, sys
allow, refuse = 0x7FFF0000, 0x00050000 + 1  # SCMP_ACT_ALLOW, SCMP_ACT_ERRNO(EPERM) of seccomp.h
library = ctypes.CDLL("libseccomp.so.2")
library.seccomp_init.restype = ctypes.c_void_p
calls = ctypes.c_void_p(library.seccomp_init(refuse))
names, *command = sys.argv[1:]
for number in map(library.seccomp_syscall_resolve_name, names.encode().split()):
    if number >= 0:  # known to the processor
        assert library.seccomp_rule_add(calls, allow, number, 0) == 0
assert library.seccomp_load(calls) == 0
os.execv(command[0], command)
"""
"""Runs a command that may make some system calls only: their names, the command and its arguments."""


@SYSTEMD
@pytest.mark.skipif(ctypes.util.find_library("seccomp") is None, reason="no libseccomp")
def test_service_works_with_the_system_calls_of_the_unit(unit, tmp_path):
    allowed = set()
    for line in unit["SystemCallFilter"]:
        calls = {call for name in line.removeprefix("~").split() for call in system_calls(name)}
        allowed = allowed - calls if line.startswith("~") else allowed | calls
    assert "execve" in allowed
    assert not {"chroot", "mount", "ptrace", "setuid", "sched_setaffinity"} & allowed
    assert unit["SystemCallErrorNumber"] == ["EPERM"]
    filtered = (sys.executable, "-c", FILTERED, " ".join(sorted(allowed)), sys.executable)
    chroot = "import os\ntry: os.chroot('/')\nexcept PermissionError: print('refused')"
    done = subprocess.run([*filtered, "-c", chroot], stdout=subprocess.PIPE, text=True, check=True)
    assert done.stdout == "refused\n"
    question = "slenderness=0.4&frequency_ratio=5&restitution=0.85"
    with serving(tmp_path, tmp_path / "log", command=(*filtered, "-m", "rocking._cli"), workers=number(1, 2)) as server:
        response = httpx2.get(f"{server.address}/v1/response?pulse=sine&{question}", timeout=120)
        assert response.json()["outcome"] == "RECOVERS"
        assert "process_open_fds" in httpx2.get(server.address + "/metrics", timeout=120).text
        assert server.stop() in (0, -15)
    assert " ERROR " not in server.log.read_text()


@SYSTEMD
def test_unit_is_understood_by_systemd():
    command = ["systemd-analyze", "verify", "--man=no", str(DEPLOY / "rocking.service")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    # the program is not installed where the tests run
    lines = [line for line in done.stderr.splitlines() if "rocking.service" in line and "is not executable" not in line]
    assert lines == []


def test_proxy_has_the_limits_of_the_service(unit):
    settings = Settings()

    def directive(name):
        return re.findall(rf"^ *{name} (.*);$", PROXY, re.MULTILINE)

    assert directive("client_max_body_size") == [f"{settings.max_body_bytes // 2**20}m"]
    assert int(directive("proxy_read_timeout")[0].rstrip("s")) > settings.max_seconds
    assert directive("client_body_timeout") == [f"{settings.arrival_seconds:g}s"]
    assert directive("proxy_buffering") == directive("proxy_request_buffering") == ["on"]
    port = serve_arguments(shlex.split(unit["ExecStart"][0]))["port"]
    assert set(directive("proxy_pass")) == {f"http://127.0.0.1:{port}"}
    assert PROXY.count("{") == PROXY.count("}")


@pytest.mark.skipif(None in map(shutil.which, ("nginx", "openssl")), reason="no nginx and openssl")
def test_proxy_works_in_front_of_the_service(tmp_path):
    trust = ssl.create_default_context()
    trust.check_hostname, trust.verify_mode = False, ssl.CERT_NONE
    trust.set_alpn_protocols(["h2"])
    with serving(tmp_path, tmp_path / "log") as server, proxy(server.port, tmp_path) as (port, log):
        with socket.create_connection(("127.0.0.1", port)) as plain, trust.wrap_socket(plain) as encrypted:
            assert encrypted.selected_alpn_protocol() == "h2"
        trust.set_alpn_protocols(["http/1.1"])
        with httpx2.Client(base_url=f"https://127.0.0.1:{port}", verify=trust, timeout=120) as client:
            question = "slenderness=0.4&frequency_ratio=5&restitution=0.85"
            assert client.get(f"/v1/response?pulse=sine&{question}").json()["outcome"] == "RECOVERS"
            assert client.get("/v1/response?pulse=none").headers["content-type"] == "application/problem+json"
            assert client.get("/metrics").status_code == 200  # from this machine
            body = b"slenderness\n" + b"0.4\n" * 250_000
            batch = "/v1/response?pulse=sine&frequency_ratio=5&restitution=0.85"
            rows = client.post(batch, content=body, headers={"content-type": "text/csv"})
            assert rows.text.count("RECOVERS") == 250_000
            with closing(http.client.HTTPSConnection("127.0.0.1", port, context=trust, timeout=120)) as large:
                large.request("POST", "/v1/response", headers={"content-length": str(2**26 + 1)})
                assert large.getresponse().status == 413
            statuses = [client.get("/v1/pulses").status_code for _ in range(600)]
            assert statuses.count(200) >= 200
            assert set(statuses) <= {200, 429}
    assert not re.search(r"\[(warn|emerg|alert|crit)\]", log.read_text())
