"""What is known of the cells of a cube, in one record of 16 bytes for each.

The records of all angles of a cell follow each other: those between which a point lies are in one or two cache lines.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rocking._interpolation.stencils import NO_STENCIL, OVERTURNS
from rocking._model.outcome_code import overturning_code

CELL_RECORD = np.dtype(
    [
        ("code", np.int32),
        ("interpolation_error", np.float32),
        ("restitution_error", np.float32),
        ("alpha_error", np.float32),
    ],
    align=True,
)
"""What is known of a cell.

`code` is -1 where nothing is interpolated, else 4 v + `stencil`. Where all blocks of the cell overturn in the same way,
v is their overturning code (`rocking._model.outcome_code`), else 1 + the impacts of the four corners, 0 where these
differ. The errors are the variables of the cube [-].
"""

CELL_BYTES = CELL_RECORD.itemsize
INTERPOLATION_ERROR, RESTITUTION_ERROR, ALPHA_ERROR = 4, 8, 12
"""Size of a cell's record and offsets of its errors [bytes]."""

FORM_BITS = 2
"""Bits of a code that state the stencil: `PEAK`, `SQUARED` or `OVERTURNS`."""


def pack_cells(
    stencil: NDArray[np.int8],
    outcome: NDArray[np.int8],
    impacts: NDArray[np.int32],
    interpolation_error: NDArray[np.float32],
    restitution_error: NDArray[np.float32],
    alpha_error: NDArray[np.float32],
) -> NDArray[np.void]:
    """The records (n - 1, m - 1, angles) of the cells of a cube, or of some rows, from its variables (angles, n, m)."""
    lower = np.s_[:, :-1, :-1]
    corner = impacts[lower]
    equal = np.logical_and.reduce(
        [corner == impacts[:, i : i - 1 or None, j : j - 1 or None] for i in (0, 1) for j in (0, 1)]
    )
    form = stencil[lower].astype(np.int32)
    value = np.where(form == OVERTURNS, overturning_code(outcome[lower], corner), np.where(equal, corner + 1, 0))
    angles, rows, columns = form.shape
    cells = np.empty((rows, columns, angles), CELL_RECORD)
    fields = {
        "code": np.where(form == NO_STENCIL, -1, (value << FORM_BITS) + form),
        "interpolation_error": interpolation_error[lower],
        "restitution_error": restitution_error[lower],
        "alpha_error": alpha_error[lower],
    }
    for name, values in fields.items():
        cells[name] = np.moveaxis(values, 0, -1)
    return cells
