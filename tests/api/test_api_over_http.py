"""A server on the loopback: xarray opens the data sets over HTTP and reads the same bits as from the file."""

import numpy as np
import pytest
import xarray as xr

from rocking._datasets.cube import read_dataset
from tests.api.servers import serving

NAME = "spectra/sine/eta-0.85"
CORNER = {"slenderness": slice(3, 9), "frequency_ratio": slice(40, 60)}


@pytest.fixture(scope="module")
def address(results, tmp_path_factory):
    """A separate process: the netCDF library holds the interpreter while it reads from a URL."""
    with serving(results, tmp_path_factory.mktemp("serve") / "log") as server:
        yield server.address


@pytest.mark.parametrize(("suffix", "engine"), [(".nc#mode=bytes", "netcdf4"), (".nc", "h5netcdf"), (".zarr", "zarr")])
def test_xarray_opens_a_data_set_over_http(address, results, suffix, engine):
    stored = read_dataset(results / f"{NAME}.nc")
    with xr.open_dataset(f"{address}/v1/datasets/{NAME}{suffix}", engine=engine) as remote:
        # JSON, in which zarr keeps attributes, has no nan
        without = {name for name, value in stored.attrs.items() if engine == "zarr" and value != value}
        assert set(remote.attrs) == set(stored.attrs) - without
        part = remote.isel(CORNER).load()
        for name in stored.variables:
            ours = stored.isel(CORNER)[name].values
            assert part[name].dtype == ours.dtype
            assert part[name].values.tobytes() == ours.tobytes(), name
        whole = remote["peak_rotation"].values
    np.testing.assert_array_equal(whole, stored["peak_rotation"].values)
