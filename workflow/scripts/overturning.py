"""Traces the overturning boundaries of one pulse at all slenderness angles, for the sine beside the closed forms."""

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from rocking.boundary.curves import join_curves
from rocking.boundary.search import RESOLUTION
from rocking.boundary.tracing import overturning_boundaries
from rocking.closed_form import overturning_amplitudes
from rocking.datasets.cube import AXES, MODEL_RESULT, VARIABLES, describe, scalar_coordinates, write_dataset
from rocking.model.response import Outcome
from workflow.scripts.job import run

RESOLUTIONS = (
    "chord_error",
    "uncounted_chord_error",
    "thinnest_region",
    "thinnest_uncounted_region",
    "end_distance",
    "node_distance",
)
"""Attributes of `overturning_boundary` of which a file states the largest."""


def main(
    *,
    pulse: str,
    restitution: Sequence[float],
    alpha_deg: Sequence[float],
    boundary: Mapping[str, Any],
    boundaries: Sequence[Path],
    provenance: Mapping[str, str],
) -> None:
    """Trace one file of curves per restitution [-], at all angles [deg], inside the configured window."""
    limits = {name: (boundary[name]["low"], boundary[name]["high"]) for name in ("slenderness", "frequency_ratio")}
    nodes = {angle: boundary["nodes_rigid"] if angle else boundary["nodes"] for angle in alpha_deg}
    by_angle = [curves_of(pulse, restitution, angle, nodes=nodes[angle], **limits) for angle in alpha_deg]
    for eta, path, parts in zip(restitution, boundaries, zip(*by_angle, strict=True), strict=True):
        joined = join_curves([part.drop_attrs(deep=False) for part in parts])
        curves = described(joined, pulse, eta).assign_attrs(accuracy_of(parts))
        write_dataset(describe(curves, **provenance), path)
        print(f"{path}: {curves.sizes['curve']} curves, {curves.sizes['point']} points")


def curves_of(pulse: str, restitution: Sequence[float], alpha_deg: float, **window: Any) -> Iterator[xr.Dataset]:
    """The boundary curves at one slenderness angle, by restitution: ragged polylines, `row_size` points each."""
    alpha = math.radians(alpha_deg)
    for traced in overturning_boundaries(pulse, restitution=restitution, alpha=alpha or None, **window):
        closed = _closed_forms(traced, traced.restitution, slender=alpha == 0.0) if pulse == "sine" else {}
        angle = ("curve", np.full(traced.sizes["curve"], alpha))
        yield traced.assign(closed).assign(alpha=angle)


def accuracy_of(parts: Sequence[xr.Dataset]) -> dict[str, Any]:
    """What the tracing states of its accuracy, over all angles: see `overturning_boundary`."""
    return {
        **{name: max(part.attrs[name] for part in parts) for name in RESOLUTIONS},
        "unmeasured_chords": sum(part.unmeasured_chords for part in parts),
        "open_ends": sum(part.open_ends for part in parts),
    }


def described(curves: xr.Dataset, pulse: str, restitution: float) -> xr.Dataset:
    """The curves of all angles with our attributes."""
    for name, side in (("outcome", "overturning"), ("neighbour_outcome", "other")):
        curves[name].attrs |= VARIABLES["outcome"][1] | {"long_name": f"outcome on the {side} side"}
    curves["alpha"].attrs |= AXES["alpha"]
    for variable in curves.data_vars.values():
        variable.attrs = MODEL_RESULT | variable.attrs
    return describe(
        curves.assign_coords(scalar_coordinates(pulse, restitution)),
        title=f"Overturning boundaries of the rigid block under the {pulse} pulse, restitution {restitution:.2f}",
        summary="Curves on the plane of frequency ratio and dimensionless slenderness that separate blocks which "
        f"overturn from blocks which survive, each point found with the solver to {RESOLUTION:g}. "
        "Largest distance of a chord from its curve: chord_error, and uncounted_chord_error where blocks overturn "
        "after many impacts; width in 1/a below which regions are not resolved: "
        "thinnest_region, and thinnest_uncounted_region where blocks overturn after many impacts; distance in log "
        "omega within which the ends of the latter are known: end_distance; largest distance of the nodes in 1/a, "
        "below which a region can be missed: node_distance; ends of regions that are known to a step of the grid "
        "only: open_ends.",
        history="rocking.boundary.tracing.overturning_boundaries",
        id=f"overturning/{pulse}/eta-{restitution:.2f}",
    )


def _closed_forms(traced: xr.Dataset, restitution: float, *, slender: bool) -> dict[str, xr.Variable]:
    """Slenderness by (3.10), (3.18), (3.20) with (3.21) at the frequency ratio of each traced point of that mode.

    They hold for slender blocks under the sine; for any other block they are missing.
    """
    rows = traced.row_size.values
    outcome, impacts = (np.repeat(traced[name].values, rows) for name in ("outcome", "impacts"))
    s, omega = traced.slenderness.values, traced.frequency_ratio.values
    closed = overturning_amplitudes(omega, restitution)
    once = [1 / closed.falls_from, 1 / closed.safe_again]  # the curve of one impact has two branches: the nearer one
    nearer = np.where(np.abs(once[0] - s) <= np.abs(once[1] - s), once[0], once[1])
    nearer = np.where(np.isnan(once[0]), np.nan, nearer)
    expected = np.where(
        outcome == Outcome.OVERTURNED_DIRECTLY, 1 / closed.direct, np.where(impacts == 1, nearer, np.nan)
    )
    expected = expected if slender else np.full(s.size, np.nan)
    island = np.where(np.isin(traced.impacts.values, (0, 1)), 0, 1).astype(np.int8)
    return {
        "closed_form_slenderness": xr.Variable(
            "point",
            expected,
            {**MODEL_RESULT, "long_name": "slenderness of the boundary in closed form",
             "equation": "3.10, 3.18, 3.20, 3.21",
             "comment": "missing for overturning after three or more impacts, and for alpha > 0: no closed form"},
        ),
        "closed_form_difference": xr.Variable(
            "point", s - expected, {**MODEL_RESULT, "long_name": "traced minus closed form slenderness"}
        ),
        "island": xr.Variable(
            "curve",
            island,
            {"units": "1", "long_name": "overturning after three or more impacts, which no closed form knows",
             "flag_values": np.array([0, 1], dtype=np.int8), "flag_meanings": "no yes"},
        ),
    }  # fmt: skip


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
