"""Outcomes of bodies with two different edges under the records of a suite and their mirror images.

A record and its mirror image, both signs of its acceleration, overturn such a body at different intensities, and the
side from which the ground moves first is a matter of chance. Both count, each with half the weight of the record.
"""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError
from rocking._base.quantities import RESTITUTION
from rocking._base.units import Scalar
from rocking._dimensional.problem import Problem, spread_restitution
from rocking._dimensional.response import respond
from rocking._dimensional.rigid_body import RigidBody
from rocking._numba.cancellation import StopFlag
from rocking.suites.intensity import measure_of
from rocking.suites.outcomes import FIELDS, check_levels, checked_levels, checked_records, labelled_outcomes

SIGNS = 2  # motions of one record: as recorded and mirrored [-]

BODY_MEASURES = "pga", "pgv", "pga_ratio"
"""Measures that two different edges leave defined; uplift is that of the weaker edge."""


def body_outcomes(
    records: Any,
    body: RigidBody,
    intensity: ArrayLike,
    measure: str,
    restitution: Scalar,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> xr.Dataset:
    """Solve the response of bodies (bodies,) to every record and its mirror image at every level.

    The arguments are those of `rocking.fragility`, without measures that refer to one slenderness angle. The result is
    that of `rocking.suites.outcomes.suite_outcomes`, with the mirror image of each record after it, and with other
    properties of the bodies.
    """
    chosen = measure_of(measure)
    if measure not in BODY_MEASURES:
        raise InvalidArgumentError(
            "measure", measure, f"{', '.join(BODY_MEASURES)} for a body with two different edges"
        )
    motions = []
    for record in checked_records(records):
        motions += [record, record.mirrored()]
    levels = checked_levels(intensity, chosen)
    spread = spread_restitution(body, restitution)
    eta = None if isinstance(spread, str) and spread == "momentum" else np.array(RESTITUTION.number(spread))
    columns = {name: value.reshape(-1, 1) if value.ndim else value for name, value in body.parameters.items()}
    column = body.changed(**columns)
    shape = (*body.shape, levels.size, len(motions))
    fields = {field.name: np.empty(shape, dtype=field.file_dtype) for field in FIELDS} | {"scale": np.empty(shape)}
    for k, motion in enumerate(motions):
        recorded: Scalar | Array
        if measure == "pga":
            recorded = motion.peak_acceleration
        elif measure == "pgv":
            recorded = motion.peak_velocity
        else:
            recorded = motion.peak_acceleration / column.uplift_acceleration
        scale = np.broadcast_to(levels / recorded, shape[:2])
        check_levels(levels, motion, scale, np.broadcast_to(body.gravity, body.shape).tolist())
        problem = Problem(column, motion, scale, np.ones(()), eta)
        response = respond(problem, threads=threads, stop=stop)
        for name, values in fields.items():
            values[:, :, k] = scale if name == "scale" else getattr(response, name)
    return labelled_outcomes(fields, levels, chosen, motions, _properties(body, eta))


def _properties(body: RigidBody, eta: Array | None) -> dict[str, tuple[NDArray[Any], str, str]]:
    """Return the coordinates of the bodies: values (bodies,), unit and meaning."""
    properties: dict[str, tuple[Any, str, str]] = {
        "width": (body.width, "m", "distance of the edges"),
        "height": (body.top_height, "m", "height of the body"),
        "uplift_acceleration": (body.uplift_acceleration, "m s-2", "ground acceleration of uplift, of the weaker edge"),
        "gravity": (body.gravity, "m s-2", "acceleration of gravity"),
    }
    for side, edge in (("right", body.right), ("left", body.left)):
        restitution = np.maximum(edge.restitution, 0.0) if eta is None else eta
        properties |= {
            f"alpha_{side}": (edge.alpha, "rad", f"slenderness angle of the {side} edge"),
            f"frequency_parameter_{side}": (
                edge.frequency_parameter,
                "rad s-1",
                f"frequency parameter p of the {side} edge",
            ),
            f"restitution_{side}": (
                restitution,
                "1",
                f"coefficient of restitution of impacts that leave the {side} edge",
            ),
        }
    return {
        name: (np.broadcast_to(values, body.shape), unit, text) for name, (values, unit, text) in properties.items()
    }
