"""The spectrum cubes of a pulse as one zarr store."""

import hashlib

import numpy as np
import pytest
import xarray as xr

from rocking._base.errors import DatasetError, InvalidArgumentError
from rocking._datasets.cube import read_spectrum, write_dataset
from rocking._datasets.zarr_store import write_pulse_store
from rocking._spectra.cubes import spectrum


@pytest.fixture(scope="module")
def cubes(tmp_path_factory):
    """Cubes of two restitutions, the larger one first."""
    folder = tmp_path_factory.mktemp("spectra")
    return [_cube(folder / f"eta-{restitution:.2f}.nc", restitution) for restitution in (0.9, 0.85)]


def _cube(path, restitution, nodes=12):
    axes = {"slenderness": np.linspace(0.2, 0.9, nodes), "frequency_ratio": np.geomspace(2.0, 9.0, nodes)}
    write_dataset(spectrum("sine", restitution=restitution, alpha=[0.0, 0.2], **axes), path)
    return path


def _digest(folder):
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return hashlib.sha256(b"".join(path.name.encode() + path.read_bytes() for path in files)).hexdigest()


def test_the_store_holds_the_cubes_in_the_order_of_their_restitutions(cubes, tmp_path):
    store = tmp_path / "zarr" / "sine.zarr"
    write_pulse_store(cubes, store)
    with xr.open_zarr(store, consolidated=True, chunks=None) as joined:
        assert joined["restitution"].values.tolist() == [0.85, 0.9]
        assert joined["peak_rotation"].encoding["chunks"] == (1, 1, 12, 12)
        for path in cubes:
            cube = read_spectrum(path)
            part = joined.sel(restitution=float(cube["restitution"]))
            for name, variable in cube.data_vars.items():
                np.testing.assert_array_equal(part[name].values, variable.values)
                assert part[name].attrs["long_name"] == variable.attrs["long_name"]
        assert joined.attrs["license"] == "CC-BY-4.0"
        assert "content_sha256" not in joined.attrs


def test_equal_cubes_give_equal_bytes_and_replace_an_older_store(cubes, tmp_path):
    write_pulse_store(cubes[:1], tmp_path / "first.zarr")
    write_pulse_store(cubes, tmp_path / "first.zarr")
    write_pulse_store(cubes[::-1], tmp_path / "second.zarr")
    assert _digest(tmp_path / "first.zarr") == _digest(tmp_path / "second.zarr")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["first.zarr", "second.zarr"]


def test_cubes_of_other_axes_are_refused_and_leave_nothing(cubes, tmp_path):
    other = _cube(tmp_path / "eta-0.80.nc", 0.8, nodes=13)
    with pytest.raises(DatasetError, match=r"eta-0\.\d+\.nc: its pulse, axes or variables differ"):
        write_pulse_store([*cubes, other], tmp_path / "sine.zarr")
    with pytest.raises(InvalidArgumentError, match="at least one"):
        write_pulse_store([], tmp_path / "sine.zarr")
    assert [path.name for path in tmp_path.iterdir()] == ["eta-0.80.nc"]
