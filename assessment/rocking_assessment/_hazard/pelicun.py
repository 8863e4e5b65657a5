"""Fragility curves for pelicun: the CSV of components that it reads for FEMA P-58.

Columns and units are those of the files of pelicun 3.10: an identity, the demand with its unit, floor offset and
a flag for one along a direction, and for each limit state the family, median and dispersion of its curve.
"""

from __future__ import annotations

from os import PathLike
from typing import Any

import xarray as xr

from rocking.extension import STANDARD_GRAVITY, csv_text, write_output
from rocking_assessment._hazard.nrml import checked_measure, lognormal_of, reached_states

DEMANDS = {"pga": ("Peak Floor Acceleration", "g", STANDARD_GRAVITY), "pgv": ("Peak Floor Velocity", "mps", 1.0)}
"""Types of demand of pelicun for those of this package, with their units and these in SI."""


def write_pelicun(fragility: xr.Dataset, path: str | PathLike[str]) -> None:
    """Write the fragility of blocks as components of pelicun (FEMA P-58), limit states rocks (LS1) and overturns (LS2).

    The curves are the lognormal fits; uplift over the PGA is a step, written with a dispersion of 0.001. The demand is
    that of the floor on which the block stands (offset 0), along the direction in which it rocks (directional).

    Parameters
    ----------
    fragility : xarray.Dataset
        Result of `rocking.fragility`, with the measure pga or pgv; one component for each block, `block.1` and so on
        (pelicun divides identities at a hyphen).
    path : path
        The file, written anew.

    Raises
    ------
    InvalidArgumentError
        If the measure has no counterpart, there is one level only, or a fit does not exist.
    """
    demand, unit, in_si = DEMANDS[checked_measure(fragility, DEMANDS)]
    levels, reached_by = reached_states(fragility)
    blocks = [f"block.{k + 1}" for k in range(reached_by["rocks"].shape[0])]
    columns: dict[str, list[Any]] = {
        "ID": blocks,
        "Incomplete": [0] * len(blocks),
        "Demand-Type": [demand] * len(blocks),
        "Demand-Unit": [unit] * len(blocks),
        "Demand-Offset": [0] * len(blocks),
        "Demand-Directional": [1] * len(blocks),
    }
    argument = "fragility", "levels", "levels between which it changes"
    for k, (state, reached) in enumerate(reached_by.items(), start=1):
        pairs = zip(blocks, reached, strict=True)
        fits = [lognormal_of(of_block, levels, f"{block} {state}", argument) for block, of_block in pairs]
        columns[f"LS{k}-Family"] = ["lognormal"] * len(blocks)
        columns[f"LS{k}-Theta_0"] = [median / in_si for median, _ in fits]
        columns[f"LS{k}-Theta_1"] = [dispersion for _, dispersion in fits]
    write_output(path, csv_text(columns))
