"""Compilation of all kernels in advance, by a small call of each: `python -m rocking.precompile`.

`make environment` and the start of the service run it, so that no request waits for the compiler.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from rocking._boundary.matching import load_entries
from rocking._excitation.records.record import Record
from rocking._history.time_history import time_history
from rocking._lookup.cube import Cube
from rocking._lookup.cube_slice import slice_of
from rocking._numba.kernel_cache import COMPLETE, NOT_KEPT, cache_folder
from rocking._solver.peak_response import peak_response
from rocking._solver.records.estimate import estimate_outcomes
from rocking._solver.records.record_response import record_cells, record_response
from rocking._solver.records.samples import motion_samples
from rocking._spectra.cubes import spectra


def is_missing() -> bool:
    """Whether there is a cache folder and it is not complete."""
    folder = cache_folder()
    return folder is not None and not (Path(folder) / COMPLETE).exists()


def load_kernels() -> None:
    """Load all kernels into this process from the cache; compile those that are missing."""
    block: dict[str, Any] = {"slenderness": 0.8, "frequency_ratio": 3.0, "restitution": 0.85}
    peak_response("sine", **block)
    peak_response("sine", **block, alpha=0.3)
    peak_response("cosine", slenderness=0.999, frequency_ratio=0.05, restitution=1.0)  # has many impacts
    motion = Record([0.0, 1.0, -1.0, 0.0], 0.1, unit="m/s2")
    record_response(motion, frequency_parameter=3.0, slenderness=0.8, restitution=0.85, alpha=[0.0, 0.3])
    groups: dict[str, Any] = {"frequency_parameter": 3.0, "slenderness": np.array([0.8]), "restitution": 0.85}
    estimate_outcomes(motion_samples(motion), record_cells(motion, **groups, alpha=0.3, vertical_scale=None))
    time_history(motion, frequency_parameter=3.0, slenderness=0.8, restitution=0.85)
    time_history("sine", **block, samples=2)
    time_history("sine", **block, alpha=0.3, samples=2)
    axes: dict[str, Any] = {"slenderness": np.linspace(0.75, 0.85, 5), "frequency_ratio": np.linspace(2.5, 3.5, 5)}
    slices = [slice_of(cube) for cube in spectra("sine", restitution=[0.84, 0.86], **axes, threads=1)]
    load_entries()
    cube = Cube("sine", np.array([one.restitution for one in slices]), slices.__getitem__)
    cube.response(**block)


def main() -> None:
    """Compile the kernels that are not in the cache."""
    folder = cache_folder()
    if folder is not None and is_missing():
        load_kernels()
        if not NOT_KEPT.is_set():
            (Path(folder) / COMPLETE).touch()


if __name__ == "__main__":
    main()
