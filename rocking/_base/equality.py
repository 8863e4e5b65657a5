"""Equality of dataclasses that hold arrays, which `dataclass` compares element by element."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray


class EqualByValue:
    """Base of dataclasses, declared with `eq=False`, that are equal if all their fields are: arrays by value.

    A nan equals a nan. Such objects have no hash, as arrays have none.
    """

    __hash__: ClassVar[None]  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        for field in fields(self):  # type: ignore[arg-type]
            if field.compare and not equal_values(getattr(self, field.name), getattr(other, field.name)):
                return False
        return True


def equal_values(value: Any, other: Any) -> bool:
    """Return True if two values are equal; arrays by their values, nan being equal to nan."""
    if value is other:
        return True
    if isinstance(value, np.ndarray) or isinstance(other, np.ndarray):
        return _equal_arrays(np.asarray(value), np.asarray(other))
    if isinstance(value, Mapping) and isinstance(other, Mapping):
        return value.keys() == other.keys() and all(equal_values(value[key], other[key]) for key in value)
    if isinstance(value, list | tuple) and type(value) is type(other):
        return len(value) == len(other) and all(map(equal_values, value, other))
    return bool(value == other or (value != value and other != other))


def _equal_arrays(array: NDArray[Any], other: NDArray[Any]) -> bool:
    if array.dtype.names and array.dtype == other.dtype:
        return all(_equal_arrays(array[name], other[name]) for name in array.dtype.names)
    floats = array.dtype.kind in "fc" and other.dtype.kind in "fc"
    return np.array_equal(array, other, equal_nan=floats)
