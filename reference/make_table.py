"""Write a table of random cells with their multi-precision responses: `python -m reference.make_table --help`.

The tables in tests/data/multiprecision are made by
    python -m reference.make_table tests/data/multiprecision/slender.csv
    python -m reference.make_table tests/data/multiprecision/rigid.csv --cells 300 --seed 2 --alpha 1e-8 1.5
"""

from __future__ import annotations

import argparse
import csv
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from flint import arb

from reference.conditioning import integrate_with_conditioning
from reference.exact_pulses import PULSES

ONSET = (1e-9, 0.2)  # 1 - slenderness of the cells near the onset of uplift, where blocks chatter


def random_cells(
    count: int,
    seed: int,
    alpha: tuple[float, float] | None,
    frequency_ratio: tuple[float, float],
    slenderness: tuple[float, float],
    onset_share: float,
) -> Iterator[dict[str, Any]]:
    """Yield cells [-; alpha in rad] with every pulse in turn.

    frequency_ratio and slenderness are uniform in the logarithm, restitution is uniform in [0, 1]; a share of the cells
    has 1 - slenderness uniform in the logarithm instead; alpha is uniform in the logarithm and uniform in turns.
    """
    random = np.random.default_rng(seed)

    def log_uniform(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    for k in range(count):
        onset = random.uniform() < onset_share
        cell: dict[str, Any] = {
            "pulse": PULSES[k % len(PULSES)],
            "slenderness": 1.0 - log_uniform(*ONSET) if onset else log_uniform(*slenderness),
            "frequency_ratio": log_uniform(*frequency_ratio),
            "restitution": float(random.uniform()),
        }
        if alpha is not None:
            cell["alpha"] = log_uniform(*alpha) if k // len(PULSES) % 2 else float(random.uniform(*alpha))
        yield cell


def solved_row(cell: dict[str, Any]) -> dict[str, str]:
    """Return the cell with its response: inputs with all digits, results with 20 digits, empty where there is none."""
    response, condition = integrate_with_conditioning(**cell)
    row = {name: value if isinstance(value, str) else repr(value) for name, value in cell.items()}
    row |= {
        "outcome": str(response.outcome),
        "overturned": str(int(response.overturned)),
        "impacts": str(response.impacts),
        "chatter": str(int(response.chatter)),
        "exceeded_alpha": str(int(response.exceeded_alpha)),
    }
    for name in ("peak_rotation", "uplift_time", "first_impact_time", "first_impact_velocity", "margin"):
        row[name] = _digits(getattr(response, name))
    row |= {f"{name}_per_ulp": f"{value:.3e}" for name, value in condition._asdict().items()}
    return row


def _digits(value: arb | None) -> str:
    return "" if value is None else value.str(20, radius=False)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("path", type=Path)
    parser.add_argument("--cells", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--alpha", type=float, nargs=2, metavar=("LOW", "HIGH"), help="rad; without it: slender")
    parser.add_argument("--frequency-ratio", type=float, nargs=2, default=(0.05, 50.0), metavar=("LOW", "HIGH"))
    parser.add_argument("--slenderness", type=float, nargs=2, default=(1e-3, 1 - 1e-9), metavar=("LOW", "HIGH"))
    parser.add_argument("--onset-share", type=float, default=0.2, help="share of cells close to slenderness 1")
    options = parser.parse_args()
    started = time.perf_counter()
    rows: list[dict[str, str]] = []
    for cell in random_cells(
        options.cells,
        options.seed,
        options.alpha and tuple(options.alpha),
        tuple(options.frequency_ratio),
        tuple(options.slenderness),
        options.onset_share,
    ):
        rows.append(solved_row(cell))
        if len(rows) % 50 == 0:
            sys.stderr.write(f"{len(rows)} of {options.cells} cells, {time.perf_counter() - started:.0f} s\n")
    unfinished = options.path.with_suffix(".tmp")
    with unfinished.open("w", newline="") as stream:
        writer = csv.DictWriter(stream, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    unfinished.replace(options.path)


if __name__ == "__main__":
    main()
