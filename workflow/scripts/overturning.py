"""Joins the overturning boundaries of one pulse at all slenderness angles: one file for each restitution."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import xarray as xr

from rocking._boundary.curves import join_curves
from rocking._boundary.search import RESOLUTION
from rocking._datasets.cube import (
    AXES,
    MODEL_RESULT,
    VARIABLES,
    describe,
    read_dataset,
    scalar_coordinates,
    write_dataset,
)
from rocking._excitation.pulses import as_pulse
from rocking._excitation.sampled import SampledPulse
from workflow.parts import delete_former_parts
from workflow.pulses import pulse_of_job
from workflow.scripts.job import run
from workflow.scripts.overturning_part import ACCURACY, unstacked

COUNTS = ("unmeasured_chords", "open_ends")
"""Attributes of which a file states the sum over the angles; of the others it states the largest."""


def main(
    *,
    pulse: str,
    samples: Path | list[Path],
    restitution: Sequence[float],
    parts: Sequence[Path],
    boundaries: Sequence[Path],
    provenance: Mapping[str, str],
) -> None:
    """Write the curves of each restitution [-] at all angles, one part for each angle, to `boundaries`."""
    by_angle = [unstacked(read_dataset(path)) for path in parts]
    shape = pulse_of_job(pulse, samples)
    for eta, path, traced in zip(restitution, boundaries, zip(*by_angle, strict=True), strict=True):
        joined = join_curves([one.drop_attrs(deep=False) for one in traced])
        curves = described(joined, shape, eta).assign_attrs(accuracy_of(traced))
        write_dataset(describe(curves, **provenance), path)
        print(f"{path}: {curves.sizes['curve']} curves, {curves.sizes['point']} points")
    delete_former_parts(parts, pulse)


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
        f"overturn from blocks which survive, each point found with the solver to {RESOLUTION:g}. "
        "Largest distance of a chord from its curve: chord_error, and uncounted_chord_error where blocks overturn "
        "after many impacts; width in 1/a below which regions are not resolved: "
        "thinnest_region, and thinnest_uncounted_region where blocks overturn after many impacts; distance in log "
        "omega within which the ends of the latter are known: end_distance; largest distance of the nodes in 1/a, "
        "below which a region can be missed: node_distance; ends of regions that are known to a step of the grid "
        "only: open_ends.",
        history="rocking._boundary.tracing.overturning_boundaries",
        id=f"overturning/{name}/eta-{restitution:.2f}",
    )


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
