"""Fields of pydantic from the declarations of quantities."""

from __future__ import annotations

from functools import partial
from typing import Any

from pydantic import BeforeValidator, Field

from rocking._base.quantity import Quantity


def described(quantity: Quantity, text: str = "", **more: Any) -> Any:
    """What the declaration says of a field: its meaning, unit and range in the schema; `more` are those of `Field`."""
    return Field(description=text or quantity.help, json_schema_extra=dict(quantity.limits), **more)


def reader(quantity: Quantity) -> BeforeValidator:
    """Reads a number in the SI unit, a text such as "40 cm", or one of the words of the quantity, and checks it."""
    return BeforeValidator(partial(quantity.read, si=True))
