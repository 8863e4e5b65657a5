"""Write reference/problems/restrained-blocks.csv: `python -m reference.make_restrained` (some seconds).

Sixty blocks with a tendon, its prestress and a damper under pulses, half of them slender. docs/reference-problems.md
describes the columns.
"""

import csv
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
from flint import arb

from reference.exact_response import ExactResponse, working_precision
from reference.multiprecision import integrate

TABLE = Path(__file__).with_name("problems") / "restrained-blocks.csv"
COUNT, SEED, BITS = 60, 7, 192
PULSES = ("sine", "cosine", "half_sine", "ricker", "rectangular", "c1")
DIGITS = 12
STEP = 1e-24  # relative change of the slenderness for the conditioning [-]


def cells() -> list[dict[str, Any]]:
    """Groups [-; alpha in rad] of the blocks: a third each without tendon, with kappa < 1 and with kappa up to 8."""
    random = np.random.default_rng(SEED)

    def cell(k: int) -> dict[str, Any]:
        return {
            "pulse": PULSES[k % len(PULSES)],
            "slenderness": round(float(np.exp(random.uniform(np.log(0.06), np.log(0.9)))), 4),
            "frequency_ratio": round(float(np.exp(random.uniform(np.log(0.5), np.log(7.0)))), 4),
            "restitution": round(float(random.uniform(0.5, 1.0)), 3),
            "alpha": None if k % 2 == 0 else round(float(random.uniform(0.05, 0.9)), 3),
            "stiffness": round(float((0.0, 1.0, 8.0)[k // 2 % 3] * random.uniform()), 4),
            "prestress": round(float((0.0, 0.8)[k // 6 % 2] * random.uniform()), 4),
            "damping": round(float((0.0, 0.3, 1.5)[k // 12 % 3] * random.uniform()), 4),
        }

    return [cell(k) for k in range(COUNT)]


def row(cell: dict[str, Any]) -> dict[str, str]:
    """Return the cell with its answer to `DIGITS` + 3 digits, and the digits that another code can be asked for."""
    with working_precision(BITS):
        response = integrate(**cell)
        moved = integrate(**cell | {"slenderness": arb(cell["slenderness"]) * (1 + arb(STEP))})
        factor = _conditioning(response, moved)
        answer = response.peak_rotation if response.outcome == 1 else None
        peak = "" if answer is None else str(answer.str(DIGITS + 3, radius=False))
    digits = max(0, min(DIGITS, math.floor(15.0 - math.log10(max(factor, 1.0)))))
    values = {name: "" if value is None else str(value) for name, value in cell.items()}
    return values | {"outcome": str(response.outcome), "peak_rotation": peak, "digits": str(digits)}


def _conditioning(response: ExactResponse, moved: ExactResponse) -> float:
    """Relative change of the peak over that of the slenderness."""
    if response.outcome != 1 or response.peak_rotation is None or moved.peak_rotation is None:
        return 1.0
    change = (moved.peak_rotation - response.peak_rotation) / response.peak_rotation
    return abs(float(change / arb(STEP)))


def main() -> None:
    """Write the table."""
    rows = [row(cell) for cell in cells()]
    with TABLE.open("w", newline="") as stream:
        writer = csv.DictWriter(stream, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    sys.stderr.write(f"{len(rows)} cases in {TABLE}\n")


if __name__ == "__main__":
    main()
