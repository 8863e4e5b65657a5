"""The result of an assessment: a table with one row for each object and direction."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rocking.extension import (
    RESOLUTION,
    Array,
    BadRow,
    Cell,
    EqualByValue,
    StopFlag,
    csv_text,
    integer,
    variable,
    write_output,
)
from rocking_assessment._objects.columns import OUTPUTS, VERDICTS, digits_apart
from rocking_assessment._objects.directions import factors_by_direction
from rocking_assessment._objects.motions import bodies_of, first_exceedances, friction_needed, frictions, history_of
from rocking_assessment._objects.objects import Object
from rocking_assessment._objects.site import Motion, Site
from rocking_assessment._objects.xlsx import xlsx_bytes

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


@dataclass(frozen=True, eq=False, repr=False)
class Assessment(EqualByValue):
    """Objects at a site, one row for each direction in which one can rock, the worst first.

    Attributes
    ----------
    columns : mapping of str to array (rows,)
        The columns of `rocking_assessment._objects.columns.OUTPUTS`; a number that is not known is nan.
    motions : tuple of str
        The motions of the site.
    highest_factor : float
        Highest factor on these motions that was searched [-].
    objects : tuple of Object
        The object of each row.
    factors : float array (rows, motions)
        Lowest factor on each motion that overturns the object, nan where none up to `highest_factor` does [-].
    rotations : float array (rows, motions)
        Largest rotation under each motion at the strength of the site, nan where it overturns the object [rad].
    site : Site
        The site.
    resolution : float
        Largest relative distance of the factors on records that were tried [-]; 0 if all motions are pulses.
    """

    columns: Mapping[str, NDArray[Any]]
    motions: tuple[str, ...]
    highest_factor: float
    objects: tuple[Object, ...]
    factors: Array
    rotations: Array
    site: Site
    resolution: float = 0.0

    @property
    def events(self) -> int:
        """Number of motions of the site, a pair of components as one [-]."""
        return len({motion.group for motion in self.site.motions})

    @property
    def rows(self) -> list[dict[str, Any]]:
        """The rows, each by the names of the columns; a number or answer that is not known is None."""
        columns = {name: [_known(value) for value in values.tolist()] for name, values in self.columns.items()}
        return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]

    @property
    def details(self) -> dict[str, list[Cell]]:
        """Cells of the table of objects for the object of each row, by its headers and in their order.

        Of objects that were not read from a table their `details`.
        """
        rows = [obj.cells or obj.details for obj in self.objects]
        names = [obj.name for obj in self.objects]
        outputs = {quantity.name for quantity in OUTPUTS} | {quantity.header for quantity in OUTPUTS}
        details: dict[str, list[Cell]] = {}
        labels: dict[str, None] = {}
        for row in rows:
            labels |= dict.fromkeys(row)
        for label in labels:
            cells = [row.get(label, "") for row in rows]
            is_output = label in outputs and not (label == "object" and cells == names)
            details[f"{label} (given)" if is_output else label] = cells
        return details

    def with_details(self, columns: Mapping[str, Any], added: Sequence[Mapping[str, Cell]] = ()) -> dict[str, Any]:
        """Columns of the table behind the `details` of its rows, and of rows that are added at the end."""
        details = self.details
        for label, cells in details.items():
            cells += [row.get(label, "") for row in added]
        name = next(iter(columns))
        if name not in details and not any(obj.cells for obj in self.objects):
            details = {name: [], **details}  # objects that are not from a table: their names come first
        return {**details, **columns}

    def worst_motion(self, row: int) -> Motion:
        """The motion with the lowest factor that overturns a row, or else the one that rotates it most."""
        row = integer("row", row, 0, len(self.objects) - 1)
        factors, rotations = self.factors[row], np.nan_to_num(self.rotations[row])
        worst = rotations.argmax() if np.isnan(factors).all() else np.nanargmin(factors)
        return self.site.motions[int(worst)]

    def strength(self, row: int) -> float:
        """The factor on its worst motion from which a row overturns, 1 if that is above 1 [-]."""
        return float(np.nanmin([1.0, *self.factors[row]]))

    def history(self, row: int = 0) -> xr.Dataset:
        """The motion of a row under its worst motion, as of `rocking.RigidBody.history`.

        It has the strength of the site, or that from which the row overturns if that is less.
        """
        motion, factor = self.worst_motion(row), self.strength(row)
        weaker = replace(motion, peak_acceleration=factor * motion.peak_acceleration)
        return history_of(self.objects[row], str(self.columns["direction"][row]), weaker)

    def friction(self, row: int = 0) -> xr.Dataset:
        """Friction that a row needs under each motion at the strength of the site, if it does not slide.

        Returns
        -------
        xarray.Dataset
            Over `motion`: `friction_needed`, the largest one [-], infinite where it lifts off; `exceeded_at`, the time
            at which the coefficient of the object is first exceeded [s], nan where it is not, or not given.
        """
        import xarray as xr  # noqa: PLC0415  (takes longer to load than the package)

        row = integer("row", row, 0, len(self.objects) - 1)
        obj, direction = self.objects[row], str(self.columns["direction"][row])
        motions = self.site.motions
        (needed,) = friction_needed([(obj, direction)], motions)
        (exceeded,) = first_exceedances(bodies_of([(obj, direction)]), frictions([obj]), motions)
        variables = {
            "friction_needed": variable("motion", needed, "1", "largest coefficient of friction needed"),
            "exceeded_at": variable("motion", exceeded, "s", "time at which that of the object is exceeded"),
        }
        return xr.Dataset(variables, {"motion": [*self.motions]})

    def directions(self, row: int = 0, *, stop: StopFlag | None = None) -> xr.Dataset:
        """Factors on the motions that overturn the object of a row, over the horizontal direction of the motion.

        The ground accelerates in a direction where a motion is positive: 0 degrees is along the width or the x axis, 90
        along the depth or the y axis. Directions are every 15 degrees, and across the sides of the base; of an outline,
        and of an object without a depth, 0 and 180 degrees. Each motion acts from one side, so that the opposite
        direction is the motion reversed: it has another factor if the centre of mass is not in the middle.

        An object turns about a side of its base, for which the component of the motion across that side suffices. Of a
        mesh the planes in oblique directions count as well, so that no direction is above the rows of the table. A
        planar base of its extent in an oblique direction, which turns about a corner, would overestimate it.

        Parameters
        ----------
        row : int
            Of the table; all rows of one object give the same.
        stop : StopFlag, optional
            Cancels the work.

        Returns
        -------
        xarray.Dataset
            Over `direction` [degrees]: `factor`, nan where none up to `highest_factor` overturns it; `along`, the
            direction across a side along which the component of the motion does [degrees]; `governing`, the motion;
            `at_full_strength`, whether a motion overturns it at a factor of 1.
        """
        row = integer("row", row, 0, len(self.objects) - 1)
        obj = self.objects[row]
        resolution = self.resolution or RESOLUTION
        return factors_by_direction(obj.planes_around, obj.restitution, self.site.motions, stop, resolution)

    def to_pandas(self) -> pd.DataFrame:
        """The table as a data frame."""
        import pandas as pd  # noqa: PLC0415  (takes longer to load than the package)

        return pd.DataFrame(self.with_details(self.columns))

    def to_xarray(self) -> xr.Dataset:
        """The table as a labelled data set over `row`, with units and meanings."""
        import xarray as xr  # noqa: PLC0415  (takes longer to load than the package)

        variables = {}
        for quantity in OUTPUTS:
            values = self.columns[quantity.name]
            if quantity.name == "slides_first":
                values = values.astype(np.float64)
            variables[quantity.name] = variable("row", values, quantity.unit, quantity.meaning)
        return xr.Dataset(variables)

    def to_csv(self, path: str | PathLike[str] | None = None, *, bad_rows: Sequence[BadRow] = ()) -> str:
        """The table as CSV with units in its header, written to a file if a path is given.

        The columns of the table of objects come first, as they stand. Rows of it that were not read follow at the end,
        with the verdict "not read" and the reason among the warnings. Text that a spreadsheet would take for a formula
        has a leading apostrophe.
        """
        text = csv_text(self._columns_with(bad_rows))
        if path is not None:
            write_output(path, text)
        return text

    def to_xlsx(self, path: str | PathLike[str] | None = None, *, bad_rows: Sequence[BadRow] = ()) -> bytes:
        """The table of `to_csv` as an .xlsx workbook; numbers of a workbook with objects are numbers."""
        raw = xlsx_bytes(self._columns_with(bad_rows))
        if path is not None:
            write_output(path, raw)
        return raw

    def _columns_with(self, bad_rows: Sequence[BadRow]) -> dict[str, Any]:
        rows = self.rows
        for bad_row in bad_rows:
            rows.append({"object": f"row {bad_row.row}", "verdict": "not read", "warnings": str(bad_row)})
        columns = {quantity.header: [row.get(quantity.name) for row in rows] for quantity in OUTPUTS}
        return self.with_details(columns, [bad_row.cells for bad_row in bad_rows])

    def __repr__(self) -> str:
        """The number of rows with each verdict, and the worst row."""
        count = Counter(self.columns["verdict"].tolist())
        rows = len(self.objects)
        text = f"<rocking_assessment.Assessment of {rows} objects and directions under {len(self.motions)} motions: "
        if not rows:
            return f"{text}none>"
        worst = self.rows[0]
        text += ", ".join(f"{count[verdict]} {verdict}" for verdict in reversed(VERDICTS) if count[verdict])
        text += f";\nworst: {worst['object']}, {worst['direction']}, "
        factor = worst["factor"]
        if factor is None:
            text += f"not overturned up to {self.highest_factor:g} times these motions"
        else:
            text += f"overturned from {factor:.{digits_apart(factor)}g} times these motions"
        if worst["share"] > worst["share_at_full_strength"] == 0.0:
            text += ", at full strength it comes to rest"
        if self.resolution:
            text += f"; factors at most {100.0 * self.resolution:g} % apart were tried"
        return f"{text}>"


def _known(value: Any) -> Any:
    return None if value != value else value
