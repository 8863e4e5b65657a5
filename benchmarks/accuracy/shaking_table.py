"""The planar block against tests on a shaking table: `python -m benchmarks.accuracy.shaking_table FOLDER`.

The folder is `data/Shake_Table_Response` of the virtual shake robot study, the repository
ZhiangChen/virtual_shake_robot_pybullet (GPL-3): `TestNNN.txt` with the measured motion of the table, 800 samples a
second, and `Results_Granite.xlsx` with the outcomes of two specimens and of discrete-element runs. The sheet is read by
the extra `sheets`; a sheet saved as CSV under the same name serves as well. docs/shaking-table.md has the results.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import rocking_assessment
import xarray as xr
from numpy.typing import NDArray
from scipy.signal import butter, sosfiltfilt
from scipy.stats import binomtest

import rocking
from benchmarks.figures.outcomes import draw_tests
from benchmarks.measure import arguments

Flags = NDArray[np.bool_]

ACCELERATION = 1
"""Column of the acceleration of the table in the direction of shaking, in g; the first one holds the times."""

BAND = 0.2, 25.0
"""Frequencies that are kept [Hz]: below, noise of the sensor gives a false velocity; above, that of the table."""

STEP = 0.005
"""Time step of the motions [s]."""

RANGES: dict[str, Any] = {"alpha": (0.03, 0.3), "half_diagonal": (0.05, 1.0), "restitution": (0.3, 0.95)}

SPECIMENS = 1, 2

GROUPS = 8  # of tests by PGV, whose shares that overturn are compared [-]

COLUMNS = "specimen", "peak_acceleration", "peak_velocity", "overturned", "predicted"


def read_test(path: Path) -> rocking.Record:
    """The motion of the table in one test, band-pass filtered without a shift of phase."""
    columns = pd.read_csv(path, sep=r"\s+", header=None, skiprows=1, usecols=[0, ACCELERATION]).to_numpy()
    time, acceleration = columns.T
    rate = (time.size - 1) / (time[-1] - time[0])
    kept = sosfiltfilt(butter(4, BAND, "bandpass", fs=rate, output="sos"), acceleration - acceleration.mean())
    return rocking.Record(kept[:: round(STEP * rate)], STEP, "g", name=path.stem)


def read_outcomes(folder: Path) -> pd.DataFrame:
    """Outcomes by number of the test, true where the specimen overturned; `measured` and names of runs by specimen."""
    sheet = folder / "Results_Granite.csv"
    table = pd.read_csv(sheet) if sheet.exists() else pd.read_excel(sheet.with_suffix(".xlsx"), engine="calamine")
    table = table.set_index("Test Number").astype(bool)
    names = [re.search(r"Specimen (\d)(?:-Numerical (.+))?", name) for name in table.columns]
    table.columns = pd.MultiIndex.from_tuples([(int(one[1]), one[2] or "measured") for one in names if one])
    return table


def read_tests(folder: Path) -> tuple[list[rocking.Record], pd.DataFrame]:
    """Motions of the tests whose files and outcomes are there, and these outcomes."""
    paths = {int(path.stem.removeprefix("Test")): path for path in folder.glob("Test*.txt")}
    outcomes = read_outcomes(folder)
    outcomes = outcomes.loc[sorted(paths.keys() & set(outcomes.index))]
    return [read_test(paths[number]) for number in outcomes.index], outcomes


def predicted(found: xr.Dataset, motions: list[rocking.Record]) -> Flags:
    """Whether the block that was found overturns under each motion."""
    block = rocking.Block.from_slenderness_angle(found["alpha"].item(), found["half_diagonal"].item())
    eta = found["restitution"].item()
    return np.array([bool(block.response(one, restitution=eta).overturned) for one in motions])


def main(command_line: list[str] | None = None) -> None:
    """Command line."""
    given = arguments(__doc__, command_line, folder=Path, points=12, figure=Path("shaking-table.png"))
    motions, outcomes = read_tests(given.folder)
    print(f"{len(motions)} tests")
    rows = []
    for specimen in SPECIMENS:
        fell = outcomes[specimen, "measured"].to_numpy()
        found = rocking_assessment.calibrate(motions, fell, **RANGES, points=given.points)
        model = predicted(found, motions)
        measures = ([getattr(one, f"peak_{name}") for one in motions] for name in ("acceleration", "velocity"))
        columns: list[Any] = [*measures, fell, model]
        rows += [(specimen, *row) for row in zip(*columns, strict=True)]
        print(f"\nspecimen {specimen}: {fell.sum()} overturn")
        for name in RANGES:
            print(f"  {name:14} {found[name]:.3f} ({found[f'{name}_lower']:.3f} to {found[f'{name}_upper']:.3f})")
        for name in ("right", "validated", "validated_pgv", "validated_pga"):
            print(f"  {name:14} {found[name]:.1%}")
        for part in np.array_split(np.argsort(columns[1]), GROUPS):
            low, high = binomtest(int(fell[part].sum()), part.size).proportion_ci(0.95, "exact")
            ends = np.asarray(columns[1])[part[[0, -1]]]
            measured = f"{fell[part].mean():.2f} ({low:.2f} to {high:.2f})"
            print(f"  {ends[0]:.2f} to {ends[1]:.2f} m/s: measured {measured}, computed {model[part].mean():.2f}")
        for run, fallen in outcomes[specimen].drop(columns="measured").items():
            print(f"  {run!s:14} {(fallen == fell).mean():.1%}")
    draw_tests(pd.DataFrame(rows, columns=COLUMNS), given.figure)


if __name__ == "__main__":
    main()
