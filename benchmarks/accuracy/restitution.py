"""What the choice of the restitution changes: `python -m benchmarks.accuracy.restitution [--files FILE ...]`.

600 blocks, b/h 0.08 to 0.4 and R 0.25 to 4 m, under each record scaled to several PGA, from both sides: how many of
the cases that uplift overturn, and how many outcomes differ from those of "momentum"; for `docs/restitution.md`.
"""

from __future__ import annotations

import numpy as np

import rocking
from benchmarks.accuracy.record_sampling import FILES
from benchmarks.measure import arguments

CHOICES = ("momentum", "kalliontzis(k=0.9)", "kalliontzis(k=0.7)", "kalliontzis(k=0.5)", 0.95, 0.9, 0.83, 0.74)
SLENDERNESS = np.linspace(0.08, 0.4, 30)
RADII = np.geomspace(0.25, 4.0, 20)
LEVELS = [0.2, 0.4, 0.8]
"""PGA [g]."""


if __name__ == "__main__":
    given = arguments(__doc__, files=FILES, levels=LEVELS)
    alpha, radius = np.arctan(SLENDERNESS)[:, None], RADII
    blocks = rocking.Block(2 * radius * np.sin(alpha), 2 * radius * np.cos(alpha))
    records = [rocking.read_record(path) for path in given.files]
    motions = [rocking.Record(sign * one.acceleration, one.time_step, "m/s2") for one in records for sign in (1, -1)]
    outcomes, rotations = {}, {}
    for choice in CHOICES:
        found = [
            blocks.response(one, scale=level * 9.80665 / one.peak_acceleration, restitution=choice, thresholds=False)
            for one in motions
            for level in given.levels
        ]
        outcomes[choice] = np.array([one.overturned for one in found])
        rotations[choice] = np.array([one.rotation for one in found])
    # a PGA of exactly g b/h, which rounding decides, does not count as uplift
    above = [level > SLENDERNESS * (1.0 + 1e-9) for _ in motions for level in given.levels]
    uplifts = np.broadcast_to(np.array(above)[..., None], outcomes["momentum"].shape)
    print(f"{uplifts.size} cases, {uplifts.sum()} uplift")
    print(f"{'restitution':20}{'overturn':>10}{'differ':>8}{'only here':>11}{'median rotation':>17}")
    for choice, fell in outcomes.items():
        own, common = fell[uplifts], outcomes["momentum"][uplifts]
        both = uplifts & ~fell & ~outcomes["momentum"]
        ratio = np.median(rotations[choice][both] / rotations["momentum"][both])
        print(
            f"{choice!s:20}{own.mean():10.1%}{(own != common).mean():8.1%}{(own & ~common).mean():11.1%}{ratio:17.3f}"
        )
