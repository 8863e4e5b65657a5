"""Attributes of responses for the fields that are derived from others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rocking._model.fields import DERIVED_FIELDS, ResponseField


class DerivedFields:
    """Base of responses: each of `DERIVED_FIELDS` is a property, which type checkers find listed here."""

    if TYPE_CHECKING:

        @property
        def residual_energy(self) -> NDArray[np.float64]:
            """Energy at the end of the pulse over that of the unstable equilibrium at alpha [-]."""

    def _derived(self, field: ResponseField) -> NDArray[Any]:
        """The values of a derived field."""
        raise NotImplementedError


def _property(field: ResponseField) -> property:
    def read(self: DerivedFields) -> NDArray[Any]:
        return self._derived(field)

    return property(read, doc=field.description("nan"))


for _field in DERIVED_FIELDS:
    setattr(DerivedFields, _field.name, _property(_field))
