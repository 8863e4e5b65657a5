"""Claims of section 4 on orientation and self-similarity."""

from __future__ import annotations

import numpy as np
import xarray as xr

from rocking.orientation import Orientation, admissible_exponents, is_group, multiplication_table
from workflow.claims.claim import Claim, verdict

PRINTED_TABLE_1 = ("0xyz", "x0zy", "yz0x", "zyx0")


def orientation() -> list[Claim]:
    """Table 1, the condition (4.9), and the groups of (4.10) and (4.11)."""
    table = tuple("".join(product.symbol[1] for product in row) for row in multiplication_table())
    factors = {"a_g/g": Orientation.LZ, "alpha": Orientation.LZ}
    pairs = admissible_exponents(Orientation.LZ, factors, largest=4)
    odd = [sum(exponents.values()) % 2 == 1 for exponents in pairs]
    all_pairs = 9 * 9
    free = {group: is_group(group) for group in ("theta/alpha", "theta*g/a_g", "a_g/(alpha*g)", "omega_g/p", "p*t")}
    chosen = [{"a_g/g": 1, "alpha": -2}, {"a_g/g": -2, "alpha": 1}]
    return [
        Claim(
            key="table-1",
            place="section 4, table 1",
            printed="products of the unit orientations",
            found="all 16 computed from the rules (4.4) and (4.5) as printed",
            verdict=verdict(table == PRINTED_TABLE_1, somewhere=False),
            numbers={"equal_entries": sum(a == b for x, y in zip(table, PRINTED_TABLE_1, strict=True)
                                          for a, b in zip(x, y, strict=True))},
        ),
        Claim(
            key="odd-exponents",
            place="section 4, (4.9)",
            printed="homogeneity requires epsilon_2 + epsilon_3 to be odd",
            found=f"of {all_pairs} pairs of exponents up to 4 in size, {len(pairs)} are homogeneous, exactly those "
            "with an odd sum; the two choices of the paper are among them",
            verdict=verdict(all(odd) and 2 * len(pairs) == all_pairs - 1 and all(c in pairs for c in chosen), False),
            numbers={"pairs": all_pairs, "homogeneous": len(pairs)},
        ),
        Claim(
            key="groups",
            place="section 4, (4.10), (4.11)",
            printed="the groups of (4.10) and (4.11) are dimensionless and orientationless",
            found=", ".join(f"{group}: {'yes' if good else 'no'}" for group, good in free.items()),
            verdict=verdict(all(free.values()), somewhere=False),
            numbers={"groups": len(free)},
        ),
    ]  # fmt: skip


def collapse(figure: xr.Dataset) -> list[Claim]:
    """Figure 5 collapses to figure 6: two blocks, each integrated in SI units."""
    rotation = figure.rotation.values
    peak = float(np.abs(rotation).max())
    between = float(np.abs(rotation[0] - rotation[1]).max()) / peak
    master = np.interp(figure.tau[0], figure.tau_master, figure.master_rotation)  # all of these times are samples of it
    solver = float(np.abs(rotation - master).max()) / peak
    return [
        Claim(
            key="collapse",
            place="section 4, figures 5 and 6",
            printed="two blocks of different size and shape with equal groups follow one master curve",
            found="two independent integrations with dimensions (rtol 1e-11) differ by at most "
            f"{between:.1e} of the peak once scaled, and by {solver:.1e} from the solution by the groups alone",
            verdict=verdict(max(between, solver) < 1e-6, somewhere=False),
            numbers={"between_blocks": between, "from_groups": solver},
        )
    ]
