"""Traces the overturning boundaries of one pulse at one slenderness angle, for the sine beside the closed forms.

They are a part of the files that `workflow/scripts/overturning.py` writes.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from rocking._boundary.curves import join_curves
from rocking._boundary.tracing import overturning_boundaries
from rocking._datasets.cube import MODEL_RESULT, write_dataset
from rocking._excitation.sampled import SampledPulse
from rocking._model.response import Outcome
from workflow.pulses import pulse_of_job
from workflow.scripts.job import run

ACCURACY = (
    "chord_error", "uncounted_chord_error", "thinnest_region", "thinnest_uncounted_region",
    "end_distance", "node_distance", "unmeasured_chords", "open_ends",
)  # fmt: skip
"""Attributes of `overturning_boundary` that state how accurate the curves are."""

SIZES = {"curves": "curve", "points": "point"}
"""Variables of a part with the sizes of these dimensions at each restitution."""


def main(
    *,
    pulse: str,
    samples: Path | list[Path],
    restitution: Sequence[float],
    alpha_deg: float,
    nodes: int,
    slenderness: Mapping[str, float],
    frequency_ratio: Mapping[str, float],
    part: Path,
) -> None:
    """Trace the curves of all restitutions [-] at one angle [deg], inside the configured window, into one file."""
    window = {"slenderness": _ends(slenderness), "frequency_ratio": _ends(frequency_ratio)}
    curves = stacked([*curves_of(pulse_of_job(pulse, samples), restitution, alpha_deg, nodes=nodes, **window)])
    write_dataset(curves, part)
    print(f"{part}: {curves.sizes['curve']} curves, {curves.sizes['point']} points")


def curves_of(
    pulse: str | SampledPulse, restitution: Sequence[float], alpha_deg: float, **window: Any
) -> Iterator[xr.Dataset]:
    """The boundary curves at one slenderness angle, by restitution: ragged polylines, `row_size` points each."""
    alpha = math.radians(alpha_deg)
    for traced in overturning_boundaries(pulse, restitution=restitution, alpha=alpha or None, **window):
        closed = _closed_forms(traced, traced.restitution, slender=alpha == 0.0) if pulse == "sine" else {}
        angle = ("curve", np.full(traced.sizes["curve"], alpha))
        yield traced.assign(closed).assign(alpha=angle)


def stacked(traced: Sequence[xr.Dataset]) -> xr.Dataset:
    """The curves of all restitutions one after the other; over `slice`, number and accuracy of those of each."""
    sizes = {name: ("slice", [one.sizes[dimension] for one in traced]) for name, dimension in SIZES.items()}
    accuracy = {name: ("slice", [one.attrs[name] for one in traced]) for name in ACCURACY}
    return join_curves([one.drop_attrs(deep=False) for one in traced]).assign(sizes | accuracy)


def unstacked(part: xr.Dataset) -> Iterator[xr.Dataset]:
    """The curves of each restitution in turn, with their accuracy as attributes."""
    ends = {name: np.cumsum(part[name].values) for name in SIZES}
    curves = part.drop_vars([*SIZES, *ACCURACY])
    for k in range(part.sizes["slice"]):
        own = {dimension: slice(ends[name][k] - int(part[name][k]), ends[name][k]) for name, dimension in SIZES.items()}
        yield curves.isel(own).assign_attrs({name: part[name].values[k].item() for name in ACCURACY})


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
        once = [1 / closed.falls_from, 1 / closed.safe_again]  # one impact: a curve of two branches, the nearer one
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
