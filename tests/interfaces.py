"""One question to each interface: run by `make oldest` and `make newest` with versions that no lock holds.

The file is not collected by `pytest`, because other tests ask the same of the locked versions. It needs pytest and the
extras service, plot, mesh, dask and workflow.
"""

import json
import subprocess
import sys
from pathlib import Path

import pytest
import xarray as xr

import rocking
from tests.sheets import xlsx_bytes
from tests.workflow_fixtures import snakemake

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="locks of folders, clocks of processes")

HEADER = ("width (m)", "height (m)", "peak acceleration (g)", "period (s)")
BLOCK = (0.4, 1.6, 0.6, 0.5)
SQUARE = ((-0.2, -0.2), (0.2, -0.2), (0.2, 0.2), (-0.2, 0.2))


def command(*arguments: str | Path) -> str:
    """Standard output of the command, which must succeed."""
    line = (sys.executable, "-m", "rocking._cli", *arguments)
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@POSIX
def test_service_answers_a_question(tmp_path: Path) -> None:
    from tests.api.servers import ask, serving  # noqa: PLC0415  (not on every system)

    query = "pulse=sine&slenderness=0.4&frequency_ratio=5&restitution=0.85"
    with serving(tmp_path, tmp_path / "log") as server:
        status, body = ask(server.port, "GET", f"/v1/response?{query}")
    assert status == 200, body
    assert json.loads(body)["outcome"] == "RECOVERS"


@pytest.mark.parametrize("ending", ["csv", "xlsx"])
def test_command_reads_a_table_of_blocks(tmp_path: Path, ending: str) -> None:
    table = tmp_path / f"blocks.{ending}"
    lines = [",".join(map(str, row)) for row in (HEADER, BLOCK)]
    table.write_bytes("\n".join(lines).encode() if ending == "csv" else xlsx_bytes([HEADER, BLOCK]))
    printed = json.loads(command("response", table, "--pulse", "sine", "--format", "json"))
    assert printed["outcome"] == ["OVERTURNED_AFTER_IMPACT"]


def test_a_picture_is_drawn(tmp_path: Path) -> None:
    response = rocking.Block(0.4, 1.6).response("sine", peak_acceleration=4.0, period=0.5)
    rocking.plot.response(response).figure.savefig(tmp_path / "picture.svg")
    assert "<svg" in (tmp_path / "picture.svg").read_text()


def test_command_assesses_a_mesh_and_writes_a_report(tmp_path: Path) -> None:
    corners = [(x, y, z) for z in (0.0, 1.6) for x, y in SQUARE]
    vertices = "\n".join(f"v {x} {y} {z}" for x, y, z in corners)
    sides = "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8"
    (tmp_path / "box.obj").write_text(f"{vertices}\nf 4 3 2 1\nf 5 6 7 8\n{sides}\n")
    site = ("--pga", "0.4g", "--pgv", "50cm/s", "--shapes", "sine", "--no-sensitivity")
    command("assess", "--mesh", tmp_path / "box.obj", "--mesh-unit", "m", *site, "--report", tmp_path / "report.html")
    assert "box" in (tmp_path / "report.html").read_text()


@POSIX
def test_workflow_makes_a_cube(tmp_path: Path) -> None:
    cube = "results/spectra/sine/eta-0.85.nc"
    done = snakemake(tmp_path, "--cores", "1", cube)
    assert done.returncode == 0, done.stdout
    assert (tmp_path / cube).is_file()


def test_labelled_arrays_of_dask_stay_lazy() -> None:
    slenderness = xr.DataArray([0.2, 0.4], dims="slenderness").chunk(1)
    found = rocking.peak_response("sine", slenderness=slenderness, frequency_ratio=5.0, restitution=0.85)
    assert found["peak_rotation"].chunks == ((1, 1),)
    assert found.compute()["outcome"].shape == (2,)
