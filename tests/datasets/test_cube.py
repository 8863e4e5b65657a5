"""Data set files: metadata conventions, round trip, and detection of damage."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from rocking._base.errors import DatasetError
from rocking._datasets.cube import VARIABLES, read_dataset, read_spectrum, stored_pulse, write_dataset
from rocking._excitation.sampled import SampledPulse
from rocking._interpolation.stencils import NO_STENCIL, OVERTURNS, SQUARED
from rocking._model.response import Outcome
from rocking._solver.peak_response import peak_response
from rocking._spectra.cubes import spectrum
from tests.cf_compliance import complaints

SLENDERNESS = np.linspace(0.1, 0.8, 29)
FREQUENCY_RATIO = np.geomspace(0.8, 10.0, 41)

NOT_APPLICABLE = (
    "geospatial_", "time_coverage_",  # the control space has no place and no time
    "standard_name",  # CF has no standard name for rocking
    "date_",  # equal content gives equal bytes
    "creator_email", "creator_url", "contributor_", "publisher_email", "publisher_url", "naming_authority",
    "metadata_link", "program", "platform", "instrument", "keywords_vocabulary", "comment",  # not applicable
)  # fmt: skip
"""Recommendations of ACDD-1.3 that do not apply here; all others are followed."""


@pytest.fixture(scope="module")
def cube() -> xr.Dataset:
    return spectrum("sine", restitution=0.85, slenderness=SLENDERNESS, frequency_ratio=FREQUENCY_RATIO)


@pytest.fixture
def cube_file(cube: xr.Dataset, tmp_path: Path) -> Path:
    path = tmp_path / "eta-0.85.nc"
    write_dataset(cube, path)
    return path


def test_spectrum_follows_cf(cube_file: Path) -> None:
    assert complaints(cube_file) == []


def test_a_file_holds_the_samples_of_its_pulse_and_follows_cf(tmp_path: Path) -> None:
    pulse = SampledPulse(np.random.default_rng(1).uniform(-1.0, 1.0, 100), period=30.0, name="noise")
    axes = {"slenderness": SLENDERNESS[::4], "frequency_ratio": FREQUENCY_RATIO[::4]}
    write_dataset(spectrum(pulse, restitution=0.85, **axes), tmp_path / "noise.nc")
    assert complaints(tmp_path / "noise.nc") == []
    assert stored_pulse(read_spectrum(tmp_path / "noise.nc")) == pulse


@pytest.mark.parametrize(
    "product", ["spectra/cosine/eta-0.90.nc", "overturning/sine/eta-0.85.nc", "figures/figure-01.nc"]
)
def test_products_follow_cf_and_acdd(smoke_results: Path, product: str) -> None:
    path = smoke_results / product
    assert complaints(path) == []
    remaining = [
        message
        for message in complaints(path, "acdd:1.3")
        if not any(exception in message for exception in NOT_APPLICABLE)
    ]
    assert remaining == []


def test_cube_round_trip(cube: xr.Dataset, cube_file: Path) -> None:
    back = read_spectrum(cube_file)
    xr.testing.assert_equal(back, cube)
    assert back.peak_rotation.dtype == np.float64
    assert {name: back[name].dtype.str[1:] for name in VARIABLES} == {
        name: kind for name, (kind, _) in VARIABLES.items()
    }
    assert back.attrs["title"] == cube.attrs["title"]


def test_equal_content_gives_equal_bytes(cube_file: Path, tmp_path: Path) -> None:
    write_dataset(read_spectrum(cube_file), tmp_path / "again.nc")
    assert (tmp_path / "again.nc").read_bytes() == cube_file.read_bytes()


def test_failed_write_keeps_the_old_file_only(
    cube: xr.Dataset, cube_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = cube_file.read_bytes()

    def fail(_: xr.Dataset, path: Path, **__: object) -> None:
        Path(path).write_bytes(b"half a file")
        raise OSError("disk full")

    monkeypatch.setattr(xr.Dataset, "to_netcdf", fail)
    with pytest.raises(OSError, match="disk full"):
        write_dataset(cube, cube_file)
    assert cube_file.read_bytes() == before
    assert list(cube_file.parent.iterdir()) == [cube_file]


def test_truncated_file(cube_file: Path) -> None:
    content = cube_file.read_bytes()
    cube_file.write_bytes(content[: len(content) // 2])
    with pytest.raises(DatasetError, match="damaged"):
        read_dataset(cube_file)


def test_flipped_bits(cube_file: Path) -> None:
    intact = cube_file.read_bytes()
    rng = np.random.default_rng(20120404)
    for position in rng.choice(len(intact), size=60, replace=False):
        content = bytearray(intact)
        content[position] ^= 0xFF
        cube_file.write_bytes(content)
        with pytest.raises(DatasetError, match="damaged"):
            read_dataset(cube_file)


def test_other_readers_ignore_the_digest_at_the_end(cube_file: Path) -> None:
    ours = read_dataset(cube_file)
    for engine in ("netcdf4", "h5netcdf"):
        with xr.open_dataset(cube_file, engine=engine, decode_times=False) as theirs:
            xr.testing.assert_identical(theirs.load(), ours)


def test_foreign_file(tmp_path: Path) -> None:
    xr.Dataset({"peak_rotation": ("x", [1.0])}).to_netcdf(tmp_path / "foreign.nc")
    with pytest.raises(DatasetError, match="not written by this package"):
        read_dataset(tmp_path / "foreign.nc")


@pytest.mark.parametrize("change", ["variable", "type", "axis", "restitution"])
def test_other_schema(cube: xr.Dataset, tmp_path: Path, change: str) -> None:
    other = {
        "variable": lambda: cube.drop_vars("peak_mode"),
        "type": lambda: cube.assign(impacts=cube.impacts.astype("f8")),
        "axis": lambda: cube.isel(slenderness=slice(None, None, -1)),
        "restitution": lambda: cube.drop_vars("restitution"),
    }[change]()
    write_dataset(other, tmp_path / "other.nc")
    with pytest.raises(DatasetError, match=change if change != "type" else "impacts"):
        read_spectrum(tmp_path / "other.nc")


def test_interpolation_error_marks_smooth_cells_only(cube: xr.Dataset) -> None:
    error = cube.interpolation_error.values[0]
    assert np.isnan(error[-1]).all()
    assert np.isnan(error[:, -1]).all()
    stencil = cube.stencil.values[0]
    assert (error[stencil == OVERTURNS] == 0).all()
    np.testing.assert_array_equal(stencil == NO_STENCIL, np.isnan(error) & ~((stencil >= 0) & np.isnan(error)))
    i, j = np.nonzero(np.isfinite(error) & (stencil != OVERTURNS))
    assert i.size > 200
    for corner in ((0, 0), (0, 1), (1, 0), (1, 1)):
        assert (cube.outcome.values[0][i + corner[0], j + corner[1]] == Outcome.RECOVERS).all()
    # the error at a random point is hardly larger than at the probe points: no lobe lies between them
    rng = np.random.default_rng(3)
    u, v = rng.random((2, i.size))
    s = SLENDERNESS[i] + u * (SLENDERNESS[1] - SLENDERNESS[0])
    omega = FREQUENCY_RATIO[j] * (FREQUENCY_RATIO[1] / FREQUENCY_RATIO[0]) ** v
    squared = cube.stencil.values[0][i, j] == SQUARED
    assert squared.any()
    solved = peak_response("sine", slenderness=s, frequency_ratio=omega, restitution=0.85)
    weights = [lagrange(u), lagrange(v)]
    peak = cube.peak_rotation.values[0]
    nodes = {(m, n): peak[i - 1 + m, j - 1 + n] for m in range(4) for n in range(4)}
    plain, square = (
        sum(weights[0][m] * weights[1][n] * form(z) for (m, n), z in nodes.items())
        for form in (lambda z: z, lambda z: (1 - z) ** 2)
    )
    interpolated = np.where(squared, 1 - np.sqrt(np.maximum(square, 0)), plain)
    ratio = np.abs(interpolated - solved.peak_rotation) / error[i, j]
    assert np.quantile(ratio, 0.99) < 2.5


def lagrange(t: np.ndarray) -> list[np.ndarray]:
    """Weights of the nodes -1, 0, 1, 2 at t in [0, 1], independent of the package."""
    return [
        -t * (t - 1) * (t - 2) / 6,
        (t + 1) * (t - 1) * (t - 2) / 2,
        -(t + 1) * t * (t - 2) / 2,
        (t + 1) * t * (t - 1) / 6,
    ]


def test_threads_read_files_at_the_same_time(cube_file: Path) -> None:
    # In another process: without the lock, the netCDF library ends the process within a second.
    program = (
        "import sys, threading\n"
        "from concurrent.futures import ThreadPoolExecutor\n"
        "from rocking._datasets.cube import decode_dataset, read_content\n"
        "from rocking._datasets.netcdf import open_netcdf\n"
        "path = sys.argv[1]\n"
        "content = read_content(path)\n"
        "def read(number):\n"
        "    if number % 2:\n"
        "        return decode_dataset(content, path)\n"
        "    with open_netcdf(path, cache=False) as opened:\n"
        "        return opened.isel(slenderness=number % 29).load()\n"
        "with ThreadPoolExecutor(8) as pool:\n"
        "    read_by_all = list(pool.map(read, range(80)))\n"
        "print(len(read_by_all))"
    )
    done = subprocess.run([sys.executable, "-c", program, str(cube_file)], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "80\n"), done.stderr
