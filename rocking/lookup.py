"""Answers from a cube, each with an error bound; the solver answers where interpolation cannot keep the promise.

A cube answers a point only in a cell whose 16 nodes share fate, count of impacts and lobe of the peak, and whose
error, measured against the solver when the cube was made, is small enough: `SAFETY` times that error must not exceed
the tolerance. Where all 16 nodes overturn in the same way, it answers the fate.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.bounded_response import SOLVER_ERROR, BoundedResponse, solve_with_bound
from rocking.cube import read_spectrum
from rocking.errors import DatasetError, OutsideCubeError, in_range, one_of
from rocking.interpolation import (
    cell_index,
    lagrange4,
    log_index,
    smooth_cells,
    uniform_cells,
    uniform_index,
)
from rocking.response import Outcome

Method = Literal["auto", "cube", "solver"]
METHODS: tuple[str, ...] = get_args(Method)

SAFETY = 4.0
"""Factor from the largest error measured in a cell to its error bound [-]: the probes are nine points, not all."""

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class _Slice:
    """What interpolation needs of one slenderness angle."""

    peak_rotation: Array
    outcome: NDArray[np.int8]
    impacts: NDArray[np.int32]
    bound: Array
    """Per cell: error bound of the peak [-]; 0 where all overturn alike; inf where the cell cannot answer."""


@dataclass(frozen=True)
class Cube:
    """A spectrum cube in memory: one pulse, one restitution, all slenderness angles of the file.

    Attributes
    ----------
    pulse : str
        Name of the pulse.
    restitution : float
        eta [-].
    slenderness, frequency_ratio : float arrays
        The axes [-].
    sha256 : str
        Of the file: the version of the data.
    """

    pulse: str
    restitution: float
    slenderness: Array
    frequency_ratio: Array
    sha256: str
    slices: dict[float, _Slice]

    def response(
        self,
        *,
        slenderness: ArrayLike,
        frequency_ratio: ArrayLike,
        alpha: float | None = None,
        tolerance: float = 1e-4,
        method: str = "auto",
    ) -> BoundedResponse:
        """Peak rotation and fate with an error bound not above `tolerance`.

        Parameters
        ----------
        slenderness, frequency_ratio : array_like, broadcasting
            1/a > 0 and omega > 0 [-]; from 1/a = 1 on there is no uplift, whatever the cube holds.
        alpha : float, optional
            Slenderness angle [rad]; None or 0 for the slender limit.
        tolerance : float
            Largest error of an interpolated peak_rotation [-], >= 0.
        method : {"auto", "cube", "solver"}
            "auto" asks the solver where the cube cannot keep the tolerance, "cube" raises there.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range.
        OutsideCubeError
            With `method="cube"`: outside the axes, in a mixed cell, or in one too coarse for the tolerance.
        """
        one_of("method", method, METHODS)
        limit = float(in_range("tolerance", tolerance, 0.0, np.inf, closed="left"))
        s, w = np.broadcast_arrays(
            np.atleast_1d(in_range("slenderness", slenderness, 0.0, np.inf, closed="neither")),
            np.atleast_1d(in_range("frequency_ratio", frequency_ratio, 0.0, np.inf, closed="neither")),
        )
        shape = np.broadcast_shapes(np.shape(slenderness), np.shape(frequency_ratio))
        answer = BoundedResponse.empty(s.shape)
        rocks = s < 1.0
        if method == "cube":
            answer.source[...] = "cube"
        known = self._promised(s, w, alpha, limit, answer) if method != "solver" else np.zeros_like(rocks)
        asked = rocks & ~known
        if asked.any():
            if method == "cube":
                self._refuse(float(s[asked][0]), float(w[asked][0]), alpha, limit)
            part = solve_with_bound(
                self.pulse,
                slenderness=s[asked],
                frequency_ratio=w[asked],
                restitution=self.restitution,
                alpha=alpha,
            )
            answer.put(asked, part)
        return answer.reshape(shape)

    def _promised(self, s: Array, w: Array, alpha: float | None, limit: float, answer: BoundedResponse) -> Flags:
        """Fill in what the cube can promise; True where it did."""
        layer = self.slices.get(alpha or 0.0)
        row, column = uniform_index(self.slenderness, s), log_index(self.frequency_ratio, w)
        known: Flags = (s < 1.0) & np.isfinite(row) & np.isfinite(column) & (layer is not None)
        if layer is None or not known.any():
            return known
        row, column = row[known], column[known]
        cell = cell_index(row, self.slenderness.size), cell_index(column, self.frequency_ratio.size)
        bound, outcome = layer.bound[cell], layer.outcome[cell]
        peak = lagrange4(layer.peak_rotation, row, column)
        safe = outcome == Outcome.SAFE
        # a safe block passes alpha exactly if its peak does; a peak within its bound of alpha leaves that open
        kept = (bound <= limit) & ~(safe & (np.abs(peak - 1.0) <= bound))
        known[known] = kept
        part = BoundedResponse(
            np.where(safe, np.maximum(peak, 0.0), np.nan)[kept],
            outcome[kept],
            layer.impacts[cell][kept],
            (~safe | (peak > 1.0))[kept],
            np.where(safe, bound, np.nan)[kept],
            np.full(int(kept.sum()), "cube"),
        )
        answer.put(known, part)
        return known

    def _refuse(self, s: float, w: float, alpha: float | None, limit: float) -> None:
        """Say why the cube cannot answer a point."""
        for name, value, axis in (
            ("slenderness", s, self.slenderness),
            ("frequency_ratio", w, self.frequency_ratio),
        ):
            if not axis[0] <= value <= axis[-1]:
                raise OutsideCubeError(name, value, f"[{axis[0]:g}, {axis[-1]:g}] [-] in this cube, or method auto")
        if (alpha or 0.0) not in self.slices:
            levels = ", ".join(f"{level:g}" for level in self.slices)
            raise OutsideCubeError("alpha", alpha, f"one of {levels} [rad] in this cube, or method auto")
        row = cell_index(uniform_index(self.slenderness, s), self.slenderness.size)
        column = cell_index(log_index(self.frequency_ratio, w), self.frequency_ratio.size)
        bound = float(self.slices[alpha or 0.0].bound[row, column])
        where = f"at slenderness {s:g}, frequency_ratio {w:g}"
        if np.isfinite(bound) and bound > limit:
            raise OutsideCubeError("tolerance", limit, f"at least {bound:.3g} {where} in this cube, or method auto")
        raise OutsideCubeError("method", "cube", f"auto or solver {where}, where fates or modes of response meet")


def open_cube(path: Path | str) -> Cube:
    """Read a spectrum cube into memory.

    Raises
    ------
    DatasetError
        If the file is missing, damaged, or not a spectrum cube.
    """
    cube = read_spectrum(path)
    rows, columns = cube["slenderness"].values, cube["frequency_ratio"].values
    for name, steps in (("slenderness", np.diff(rows)), ("frequency_ratio", np.diff(np.log(columns)))):
        if steps.size < 3 or not np.allclose(steps, steps.mean(), rtol=1e-6, atol=0.0):
            raise DatasetError(f"{path}: axis `{name}` is not evenly spaced over 4 nodes or more; build it again")
    slices = {}
    for k, alpha in enumerate(cube["alpha"].values):
        peak, outcome, impacts, mode, error = (
            cube[name].values[k] for name in ("peak_rotation", "outcome", "impacts", "peak_mode", "interpolation_error")
        )
        bound = np.where(smooth_cells(outcome, impacts, mode), SAFETY * error[:-1, :-1] + SOLVER_ERROR, np.inf)
        overturned = uniform_cells(outcome, impacts, mode) & (outcome[:-1, :-1] >= Outcome.OVERTURNED_DIRECTLY)
        bound = np.where(overturned, 0.0, np.where(np.isnan(bound), np.inf, bound))
        slices[float(alpha)] = _Slice(peak, outcome, impacts, bound)
    digest = hashlib.sha256(Path(path).read_bytes()).hexdigest()
    return Cube(str(cube["pulse"].attrs["pulse_name"]), float(cube["restitution"]), rows, columns, digest, slices)
