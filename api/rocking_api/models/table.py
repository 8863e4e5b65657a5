"""How a table in a body is laid out."""

from __future__ import annotations

from typing import Any
from urllib.parse import quote

from rocking._base.errors import TableFileError
from rocking._dimensional.table_reader import TableLayout, stated_columns
from rocking_api.http.errors import refusal
from rocking_api.models.params import Params
from rocking_api.models.quantity import Decimal, Delimiter, Skip, said

MAX_STATED = 200  # most columns that a request states [-]


class TableParams(Params):
    """The layout of a table: `TableLayout` has the same names."""

    columns: list[str] = said(
        "canonical header of a column, such as Breite (cm)=width [cm], or unused; may be repeated",
        [],
        max_length=MAX_STATED,
    )
    decimal: Decimal = "."
    delimiter: Delimiter = None
    skip: Skip = 0
    sheet: str | None = said("sheet of a workbook, where several hold cells", None)
    allow_unusual: bool = said("read objects below 1 cm or above 50 m", False)

    @property
    def layout(self) -> TableLayout:
        """What is stated about the table."""
        return TableLayout(
            columns=stated_columns(self.columns),
            decimal=self.decimal,
            delimiter=self.delimiter,
            skip=self.skip,
            sheet=self.sheet,
            allow_unusual=self.allow_unusual,
        )


def table_refusal(error: TableFileError) -> Exception:
    """The error of a table with parameters of the query in its text."""
    return refusal(error.message(_as_parameter, "?", "&"), error.parameter, error.value, error.expected)


def _as_parameter(name: str, value: Any) -> str:
    return f"`{name}`" if value is None else f"{name}={quote(str(value))}"
