"""What checks by standards are worth: `python -m benchmarks.accuracy.standards [--files FILE ...] [--figure FILE]`.

Each record acts, scaled to several PGA, on 120 blocks. A check is unsafe where it passes a block that overturns, from
one side or the other, and conservative where it fails one that does not. `docs/assessment/checks.md` has the numbers.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import rocking_assessment
from numpy.typing import NDArray
from rocking_assessment._objects.columns import CLAUSES
from rocking_assessment._objects.objects import Bodies
from rocking_assessment._objects.search import responses_of
from rocking_assessment._objects.standards import demand_over_capacity

import rocking
from benchmarks.accuracy.record_sampling import FILES
from benchmarks.figures.outcomes import draw_checks
from benchmarks.measure import arguments, progress

SLENDERNESS = np.linspace(0.06, 0.4, 15)
"""b/h [-]."""

RADII = np.geomspace(0.25, 4.0, 8)
"""R [m]."""

LEVELS = [0.1, 0.2, 0.35, 0.6, 1.0]
"""PGA [g]."""


def measured(paths: list[Path], levels: list[float]) -> pd.DataFrame:
    """One row for each record, level and block: `overturned`, `uplifts` and demand over capacity by each clause."""
    blocks = [rocking.Block.from_slenderness_angle(np.arctan(a), R) for R in RADII for a in SLENDERNESS]
    body = Bodies.of(
        [rocking_assessment.Object(str(k), width=x.width, height=x.height) for k, x in enumerate(blocks)]
    ).scaled()
    tables = []
    for path in paths:
        record = rocking.read_record(path)
        for level in levels:
            motions = rocking_assessment.Site(pga=f"{level} g", records=record).motions
            overturned, rotation, _ = responses_of(body, motions, None)
            ratios = demand_over_capacity(body, motions, list(CLAUSES))
            own = {name: value[:, 0] for name, value in ratios.items()}
            moves = overturned[:, 0] | (np.nan_to_num(rotation[:, 0]) > 0.0)
            about = {"record": path.stem, "pga": level, "overturned": overturned[:, 0], "uplifts": moves}
            tables.append(pd.DataFrame(about | own))
        progress(f"{path.stem}: {sum(len(one) for one in tables)} cases")
    return pd.concat(tables, ignore_index=True)


def counts(table: pd.DataFrame) -> pd.DataFrame:
    """How often each check passes, is unsafe and is conservative, with shares of the cases that it can get so wrong."""
    overturned = table["overturned"].to_numpy()
    rows = {}
    for name in CLAUSES:
        passes: NDArray[np.bool_] = table[name].to_numpy() < 1.0
        unsafe, conservative = (passes & overturned).sum(), (~passes & ~overturned).sum()
        rows[name] = {
            "passes": passes.sum(),
            "unsafe": unsafe,
            "of overturned": unsafe / max(overturned.sum(), 1),
            "conservative": conservative,
            "of others": conservative / max((~overturned).sum(), 1),
        }
    return pd.DataFrame(rows).T


def main(command_line: list[str] | None = None) -> None:
    """Command line."""
    given = arguments(__doc__, command_line, files=FILES, levels=LEVELS, figure=Path("assessment/checks.png"))
    table = measured(given.files, given.levels)
    print(f"{len(table)} cases, {table['uplifts'].sum()} uplift, {table['overturned'].sum()} overturn")
    shares = {"of overturned": "{:.1%}".format, "of others": "{:.1%}".format}
    print(counts(table).to_string(float_format="{:.0f}".format, formatters=shares))
    draw_checks(table, CLAUSES, given.figure)


if __name__ == "__main__":
    main()
