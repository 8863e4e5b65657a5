"""Size of a spectrum cube in other encodings, and time to read it: `python -m benchmarks.cost.encodings FILE`.

Prints bytes a node; the times to write the file, to read it whole, and to open it and read the peak at one node (the
shortest of three); and what each variable takes of the file as it is.
"""

from __future__ import annotations

import argparse
import math
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from rocking._datasets.cube import DIMENSIONS

Encoding = dict[str, dict[str, Any]]

PEAK = "peak_rotation"
LEVELS, DIGITS, TILES, ERROR_BITS = (1, 9), (12, 9, 6), (64, 64), (8, 4)
"""Levels of zlib, digits of the peaks, nodes of a smaller chunk, and bits kept of the measured errors."""

REPEATS = 3


def rounded_up(errors: np.ndarray[Any, np.dtype[np.float32]], bits: int) -> np.ndarray[Any, np.dtype[np.float32]]:
    """Round positive float32 numbers up to `bits` bits after the leading one."""
    dropped = np.uint32(23 - bits)
    whole = errors.view(np.uint32) + np.uint32((1 << int(dropped)) - 1)
    return np.where(np.isfinite(errors), ((whole >> dropped) << dropped).view(np.float32), errors)


def variants(cube: xr.Dataset, present: Encoding) -> Iterator[tuple[str, xr.Dataset, Encoding]]:
    """Yield name, data and encoding of each variant."""

    def everywhere(**options: Any) -> Encoding:
        return {name: encoding | options for name, encoding in present.items()}

    def of_peaks(**options: Any) -> Encoding:
        return present | {PEAK: present[PEAK] | options}

    yield "as it is", cube, present
    for level in LEVELS:
        yield f"zlib {level}", cube, everywhere(complevel=level)
    yield "zstd 4, without shuffle", cube, everywhere(zlib=False, compression="zstd", shuffle=False)
    yield "not compressed", cube, everywhere(zlib=False)
    yield f"chunks of {TILES[0]} x {TILES[1]} nodes", cube, everywhere(chunksizes=(1, *TILES))
    yield "peaks in float32", cube, of_peaks(dtype="float32")
    for digits in DIGITS:
        yield f"peaks with {digits} digits", cube, of_peaks(significant_digits=digits, quantize_mode="BitGroom")
    for bits in ERROR_BITS:
        errors = {
            name: cube[name].copy(data=rounded_up(cube[name].values, bits)) for name in present if "_error" in name
        }
        yield f"errors rounded up to {bits} bits", cube.assign(errors), present


def shortest(call: Callable[[], object]) -> float:
    """Return the shortest time of some calls [s]."""
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return min(times)


def read_node(path: Path) -> float:
    """Open a file and read the peak at one node."""
    with xr.open_dataset(path, engine="netcdf4") as cube:
        return float(cube[PEAK][tuple(size // 2 for size in cube[PEAK].shape)])


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    source = parser.parse_args().file
    with xr.open_dataset(source, engine="netcdf4") as opened:
        cube = opened.load()
    nodes = math.prod(cube.sizes[name] for name in DIMENSIONS)
    kept = ("zlib", "complevel", "shuffle", "chunksizes")
    present: Encoding = {
        str(name): {option: variable.encoding[option] for option in kept}
        for name, variable in cube.data_vars.items()
        if variable.dims == DIMENSIONS
    }
    for variable in cube.variables.values():
        variable.encoding = {}
    print(f"{source}: {nodes} nodes, {source.stat().st_size / nodes:.2f} bytes a node")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.nc"

        def write(data: xr.Dataset, encoding: Encoding) -> float:
            start = time.perf_counter()
            data.to_netcdf(path, engine="netcdf4", encoding=encoding)
            return time.perf_counter() - start

        for name, data, encoding in variants(cube, present):
            written = write(data, encoding)
            read = shortest(lambda: xr.load_dataset(path, engine="netcdf4"))
            one = shortest(lambda: read_node(path))
            print(
                f"{name:55} {path.stat().st_size / nodes:6.2f} bytes a node; "
                f"written in {written:.2f} s, read in {read:.2f} s, one node in {1e3 * one:.0f} ms"
            )
        for name in present:
            write(cube[[name]], {name: present[name]})
            print(f"{name:55} {path.stat().st_size / nodes:6.2f} bytes a node")


if __name__ == "__main__":
    main()
