"""Objects at a site: parameters and response, from the declared columns of an assessment."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, Field, SerializeAsAny, create_model

from rocking._assessment.columns import OUTPUTS
from rocking._assessment.site import LENGTH, STRENGTHS, Site
from rocking._base.errors import number
from rocking._dimensional.table_reader import Column
from rocking._excitation.pulses import as_pulse
from rocking_api.models.metadata import METADATA_URL_FIELD
from rocking_api.models.params import Params, TableFormat
from rocking_api.models.responses import BY_SOLVER, ECHO, QUERY, VERSION_FIELD

_STRENGTH: dict[str, Any] = {"minimum": STRENGTHS[0], "maximum": STRENGTHS[1]}
_LENGTH: dict[str, Any] = {"minimum": LENGTH[0], "maximum": LENGTH[1]}


class AssessParams(Params):
    """A site, by PGA and PGV or by PGA and a range of periods."""

    pga: float = Field(description="peak ground acceleration [m/s2]", examples=[3.0], json_schema_extra=_STRENGTH)
    pgv: float | None = Field(
        None,
        description="peak ground velocity, from which each pulse has its period [m/s]; either this or periods",
        examples=[0.3],
        json_schema_extra=_STRENGTH,
    )
    period_min: float | None = Field(
        None, description="shortest period of the pulses, with `period_max` [s]", json_schema_extra=_LENGTH
    )
    period_max: float | None = Field(
        None, description="longest period of the pulses, with `period_min` [s]", json_schema_extra=_LENGTH
    )
    shapes: str | None = Field(
        None,
        description="pulses by name, separated by commas; absent: all that leave the ground at rest",
        examples=["sine,ricker"],
    )
    moving_ground: bool = Field(False, description="also half sine and rectangular, which leave the ground moving")
    sensitivity: bool = Field(True, description="find the factors of changed objects, and sizes not overturned")
    format: TableFormat = None

    @classmethod
    def check_field(cls, name: str, value: Any) -> None:
        ranges = {"pga": STRENGTHS, "pgv": STRENGTHS, "period_min": LENGTH, "period_max": LENGTH}
        if name in ranges and value is not None:
            number(name, value, *ranges[name], unit={"pga": "m/s2", "pgv": "m/s"}.get(name, "s"))
        elif name == "shapes" and value is not None:
            for shape in value.split(","):
                as_pulse(shape)

    @property
    def site(self) -> Site:
        """The site.

        Raises
        ------
        InvalidArgumentError
            If the parameters do not go together.
        """
        periods: Any = (
            None if self.period_min is None and self.period_max is None else (self.period_min, self.period_max)
        )
        shapes = None if self.shapes is None else self.shapes.split(",")
        return Site(self.pga, self.pgv, periods, shapes=shapes, moving_ground=self.moving_ground)


def _field(column: Column) -> Any:
    kinds: dict[str, Any] = {"": str, "bool": bool}
    unit = f" [{column.unit}]" if column.unit not in ("", "bool") else ""
    optional = column.name != "uplifts" and column.unit != ""
    kind = kinds.get(column.unit, float)
    return (kind | None if optional else kind), Field(description=f"{column.meaning}{unit}")


AssessedRow: type[BaseModel] = create_model(
    "AssessedRow",
    __doc__="One object in one direction; null: not known, of a factor: none up to `highest_factor`.",
    **{column.name: _field(column) for column in OUTPUTS},
)


class UnreadRow(BaseModel):
    """A row of the table that was not read."""

    row: int = Field(description="number in the table, from 1")
    column: str = Field(description="name of the column; empty: the whole row")
    reason: str = Field(description="what was found and what is allowed")


class AssessResponse(BaseModel):
    """Objects at a site, the worst first."""

    query: Annotated[SerializeAsAny[AssessParams], ECHO] = QUERY
    rows: list[AssessedRow] = Field(description="one for each object and direction, the worst first")  # type: ignore[valid-type]
    motions: list[str] = Field(description="motions of the site; from both sides each")
    highest_factor: float = Field(description="highest factor on the motions that was searched [-]")
    bad_rows: list[UnreadRow] = Field(description="rows that were not read; the others are assessed")
    skipped: list[str] = Field(description="columns of the table that are not used")
    source: str = BY_SOLVER
    version: str = VERSION_FIELD
    metadata_url: str = METADATA_URL_FIELD
