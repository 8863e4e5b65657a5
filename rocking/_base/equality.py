"""Equality of dataclasses that hold arrays, which `dataclass` compares element by element."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, ClassVar

import numpy as np


class EqualByValue:
    """Base of dataclasses, declared with `eq=False`, that are equal if all their fields are: arrays by value.

    A nan equals a nan. Such objects have no hash, as arrays have none.
    """

    __hash__: ClassVar[None]  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(
            equal_values(getattr(self, one.name), getattr(other, one.name))
            for one in fields(self)  # type: ignore[arg-type]
            if one.compare
        )


def equal_values(one: Any, other: Any) -> bool:
    """Whether two values are equal; arrays by their values, nan being equal to nan."""
    if one is other:
        return True
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        one, other = np.asarray(one), np.asarray(other)
        if one.dtype.names and one.dtype == other.dtype:
            return all(equal_values(one[name], other[name]) for name in one.dtype.names)
        floats = one.dtype.kind in "fc" and other.dtype.kind in "fc"
        return np.array_equal(one, other, equal_nan=floats)
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(equal_values(one[key], other[key]) for key in one)
    if isinstance(one, list | tuple) and type(one) is type(other):
        return len(one) == len(other) and all(map(equal_values, one, other))
    return bool(one == other or (one != one and other != other))
