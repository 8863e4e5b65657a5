"""A real server on the loopback: xarray opens the data sets over HTTP and reads the same bits as from the file."""

import socket
import subprocess
import sys
import time
from pathlib import Path

import httpx2
import numpy as np
import pytest
import xarray as xr

ROOT = Path(__file__).parents[2]
NAME = "spectra/sine/eta-0.85"
CORNER = {"slenderness": slice(3, 9), "frequency_ratio": slice(40, 60)}


@pytest.fixture(scope="module")
def address(results, tmp_path_factory):
    """`rocking serve` in a process of its own (the netCDF library holds the interpreter while it reads from a URL)."""
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    address = f"http://127.0.0.1:{port}"
    log = tmp_path_factory.mktemp("serve") / "log"
    command = [sys.executable, "-m", "rocking.cli", "serve", "--port", str(port), "--results", str(results)]
    with log.open("w") as output, subprocess.Popen(command, cwd=ROOT, stdout=output, stderr=output) as server:
        try:
            _wait(f"{address}/health", server, log)
            yield address
        finally:
            server.terminate()
            assert server.wait(timeout=30) in (0, -15), log.read_text()


def _wait(url, server, log):
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline and server.poll() is None:
        try:
            assert httpx2.get(url, timeout=30).status_code == 200
        except httpx2.TransportError:
            time.sleep(0.05)
        else:
            return
    raise AssertionError(log.read_text())


@pytest.mark.parametrize(("suffix", "engine"), [(".nc#mode=bytes", "netcdf4"), (".nc", "h5netcdf"), (".zarr", "zarr")])
def test_xarray_opens_a_data_set_over_http(address, results, suffix, engine):
    stored = xr.load_dataset(results / f"{NAME}.nc", engine="netcdf4")
    with xr.open_dataset(f"{address}/v1/datasets/{NAME}{suffix}", engine=engine) as remote:
        assert remote.attrs == stored.attrs or set(remote.attrs) == set(stored.attrs)
        part = remote.isel(CORNER).load()
        for name in stored.variables:
            ours = stored.isel(CORNER)[name].values
            assert part[name].dtype == ours.dtype
            assert part[name].values.tobytes() == ours.tobytes(), name
        whole = remote["peak_rotation"].values
    np.testing.assert_array_equal(whole, stored["peak_rotation"].values)
