"""Traces the overturning boundaries of one pulse and restitution, for the sine beside the closed forms."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from rocking._boundary.curves import join_curves
from rocking._boundary.search import RESOLUTION
from rocking._boundary.tracing import boundaries_at_angles
from rocking._datasets.cube import AXES, MODEL_RESULT, VARIABLES, describe, scalar_coordinates, write_dataset
from rocking._excitation.pulses import as_pulse
from rocking._excitation.sampled import SampledPulse
from rocking._model.response import Outcome
from workflow.pulses import configured_pulse
from workflow.scripts.job import attributes_of, run

ACCURACY = (
    "chord_error", "uncounted_chord_error", "thinnest_region", "thinnest_uncounted_region",
    "end_distance", "node_distance", "unmeasured_chords", "open_ends",
)  # fmt: skip
"""Attributes of `overturning_boundary` that state how accurate the curves are."""

COUNTS = ("unmeasured_chords", "open_ends")
"""Attributes of which a file states the sum over the angles; of the others it states the largest."""


def main(
    *,
    pulse: Any,
    restitution: float,
    alpha_deg: Sequence[float],
    nodes: int,
    nodes_rigid: int,
    slenderness: Mapping[str, float],
    frequency_ratio: Mapping[str, float],
    boundaries: Path,
    provenance: dict[str, str],
    threads: int,
) -> None:
    """Trace the curves of a restitution [-] at all angles [deg], inside the configured window.

    `pulse`: entry of the configuration. The first grid has `nodes` in each direction for the slender limit,
    `nodes_rigid` for other angles.
    """
    shape = configured_pulse(pulse)
    window = {"slenderness": _ends(slenderness), "frequency_ratio": _ends(frequency_ratio)}
    traced = curves_of(shape, restitution, alpha_deg, nodes, nodes_rigid, threads=threads, **window)
    joined = join_curves([one.drop_attrs(deep=False) for one in traced])
    curves = described(joined, shape, restitution).assign_attrs(accuracy_of(traced))
    write_dataset(describe(curves, **attributes_of(curves.attrs["id"], provenance)), boundaries)
    print(f"{boundaries}: {curves.sizes['curve']} curves, {curves.sizes['point']} points")


def curves_of(
    pulse: str | SampledPulse,
    restitution: float,
    alpha_deg: Sequence[float],
    nodes: int,
    nodes_rigid: int,
    **options: Any,
) -> list[xr.Dataset]:
    """The boundary curves at each slenderness angle: ragged polylines, `row_size` points each."""
    blocks = [(restitution, math.radians(angle), nodes_rigid if angle else nodes) for angle in alpha_deg]
    return [
        traced.assign(
            _closed_forms(traced, restitution, slender=traced.alpha == 0.0) if pulse == "sine" else {}
        ).assign(alpha=("curve", np.full(traced.sizes["curve"], traced.alpha)))
        for traced in boundaries_at_angles(pulse, blocks, **options)
    ]


def accuracy_of(traced: Sequence[xr.Dataset]) -> dict[str, Any]:
    """What the tracing states of its accuracy, over all angles: see `overturning_boundary`."""
    values = {name: [one.attrs[name] for one in traced] for name in ACCURACY}
    return {name: sum(found) if name in COUNTS else max(found) for name, found in values.items()}


def described(curves: xr.Dataset, pulse: str | SampledPulse, restitution: float) -> xr.Dataset:
    """The curves of all angles with our attributes."""
    name = as_pulse(pulse).name
    for key, side in (("outcome", "overturning"), ("neighbour_outcome", "other")):
        curves[key].attrs |= VARIABLES["outcome"][1] | {"long_name": f"outcome on the {side} side"}
    curves["alpha"].attrs |= AXES["alpha"]
    for variable in curves.data_vars.values():
        variable.attrs = MODEL_RESULT | variable.attrs
    return describe(
        curves.assign_coords(scalar_coordinates(pulse, restitution)),
        title=f"Overturning boundaries of the rigid block under the {name} pulse, restitution {restitution:.2f}",
        summary="Curves on the plane of frequency ratio and dimensionless slenderness that separate blocks which "
        f"overturn from blocks which survive, each point found with the solver to {RESOLUTION:g}. Largest distance of "
        "a chord from its curve: chord_error, and uncounted_chord_error where blocks overturn after many impacts; "
        "width in 1/a below which regions are not resolved: thinnest_region, and thinnest_uncounted_region where "
        "blocks overturn after many impacts; distance in log omega within which the ends of the latter are known: "
        "end_distance; largest distance of the nodes in 1/a, below which a region can be missed: node_distance; ends "
        "of regions that are known to a step of the grid only: open_ends.",
        id=f"overturning/{name}/eta-{restitution:.2f}",
    )


def _ends(window: Mapping[str, float]) -> tuple[float, float]:
    return window["low"], window["high"]


def _closed_forms(traced: xr.Dataset, restitution: float, *, slender: bool) -> dict[str, xr.Variable]:
    """Slenderness by (3.10), (3.18), (3.20) with (3.21) at the frequency ratio of each traced point of that mode.

    They hold for slender blocks under the sine; for any other block they are missing.
    """
    rows = traced.row_size.values
    outcome, impacts = (np.repeat(traced[name].values, rows) for name in ("outcome", "impacts"))
    s, omega = traced.slenderness.values, traced.frequency_ratio.values
    expected = np.full(s.size, np.nan)
    if slender:
        from rocking.paper.overturning import overturning_amplitudes  # noqa: PLC0415  # 0.3 s, only for this block

        closed = overturning_amplitudes(omega, restitution)
        once = [
            1 / closed.overturns_from,
            1 / closed.survives_again,
        ]  # one impact: a curve of two branches, the nearer one
        nearer = np.where(np.abs(once[0] - s) <= np.abs(once[1] - s), once[0], once[1])
        nearer = np.where(np.isnan(once[0]), np.nan, nearer)
        directly = outcome == Outcome.OVERTURNED_DIRECTLY
        expected = np.where(directly, 1 / closed.direct, np.where(impacts == 1, nearer, np.nan))
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
