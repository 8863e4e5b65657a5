"""Names, units and numbers in the cells of tables."""

from __future__ import annotations

from rocking._base.errors import InvalidArgumentError
from rocking._base.quantity import Quantity
from rocking._base.units import MAX_LENGTH, UNITS, USUAL, split_quantity, unit_name

Cell = str | float
"""A cell: its text, or the number in a cell of a workbook."""

EMPTY = {"", "-", "n/a", "nan"}
"""Cells without a value, in small letters."""

_OPENING = {"]": "[", ")": "("}


def plain_name(text: str) -> str:
    """Return a name in small letters, without blanks and underscores."""
    return "".join(text.replace("_", " ").split()).lower()


def name_and_unit(text: str) -> tuple[str, str | None]:
    """Return the name in a header such as "width [cm]", and the text in the brackets at its end, None without."""
    text = " ".join(text.split())
    opening = _OPENING.get(text[-1:])
    start = text.rfind(opening) if opening else -1
    if start < 0:
        return text, None
    return text[:start].strip(), text[start + 1 : -1].strip()


def is_empty(cell: Cell) -> bool:
    """True for a cell without a value."""
    return str(cell).strip().lower() in EMPTY


def text_of_cell(cell: Cell) -> str:
    """Return the text of a cell; a number of a workbook has 15 digits and a point."""
    return cell if isinstance(cell, str) else f"{cell:.15g}"


def read_cell(quantity: Quantity, cell: Cell, unit: str, decimal: str) -> float | str:
    """Return the value of a cell in SI units, or one of the words of the quantity.

    Parameters
    ----------
    quantity : Quantity
        What the column holds, a number.
    cell : str or float
        One number, with or without a unit.
    unit : str
        Unit in the header, as `unit_name` gives it; "" if it states none.
    decimal : {".", ","}
        Decimal sign of texts.

    Raises
    ------
    InvalidArgumentError
        If the cell is not one number in the range of the quantity, states no unit or another one than the header.
    """
    text = text_of_cell(cell).strip()
    if text.partition("(")[0].strip() in quantity.words:
        return text
    plain = text.replace(".", "?").replace(",", ".") if isinstance(cell, str) and decimal == "," else text
    parts = split_quantity(plain)
    suffix = text[len(text) - len(parts[1]) :] if parts else text
    cell_unit = unit_name(suffix, quantity.unit) if suffix else unit
    if parts is None or cell_unit is None or suffix[:1].isdigit():
        allowed = f"one number with the decimal sign {decimal!r} and no other text but its unit"
        if "," in suffix and decimal == ".":
            allowed += "; state `decimal` where the comma is the decimal sign"
        elif parts is not None and suffix[:1].isalpha():
            allowed = f"a unit: {', '.join(UNITS[quantity.unit])}"
        raise InvalidArgumentError(quantity.name, text[:MAX_LENGTH], allowed)
    if unit and cell_unit != unit:
        raise InvalidArgumentError(quantity.name, text, f"the unit of its header, {unit}")
    if not cell_unit and quantity.unit in USUAL:
        units = ", ".join(f"[{name}]" for name in UNITS[quantity.unit])
        allowed = f"a unit: one of {units} behind {quantity.name} in the header, or a unit in each cell"
        raise InvalidArgumentError(quantity.name, text, allowed)
    try:
        return quantity.number(parts[0] * UNITS[quantity.unit].get(cell_unit, 1.0))
    except InvalidArgumentError as error:
        raise InvalidArgumentError(quantity.name, text, error.allowed) from None
