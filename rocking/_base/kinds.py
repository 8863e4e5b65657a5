"""Kinds of bodies and of pulses: functions whose annotated parameters are quantities, and texts that describe one.

It imports nothing heavy, so that the help of the command line lists kinds.

A text has the name of the kind and its parameters with their units, `name(parameter=value, ...)`, everywhere: in
Python, as an option, over HTTP, in tables and in configurations.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from numbers import Real
from typing import Any, Generic, TypeVar

from rocking._base.quantity import Quantity

Made = TypeVar("Made")

_TEXT = re.compile(r"(-?)([A-Za-z_]\w{0,99})(?:\s*\(([^()]{0,2000})\))?")


@dataclass(frozen=True)
class Kind(Generic[Made]):
    """A kind of body or pulse."""

    # makes one from numbers in SI units and texts; each parameter is annotated `Annotated[float, QUANTITY]`
    make: Callable[..., Made]

    @property
    def name(self) -> str:
        """Its name in texts."""
        return self.make.__name__

    @property
    def meaning(self) -> str:
        """Its first line of documentation."""
        return (self.make.__doc__ or "").partition("\n")[0]

    @cached_property
    def hints(self) -> Mapping[str, Any]:
        """The annotations of its parameters by name: a type with its quantity."""
        hints = {name: one.annotation for name, one in inspect.signature(self.make).parameters.items()}
        known = self.make.__globals__
        return {name: eval(hint, known) if isinstance(hint, str) else hint for name, hint in hints.items()}

    @cached_property
    def fields(self) -> Mapping[str, Quantity]:
        """Its parameters by name, with the defaults of the signature."""
        found = {}
        for name, one in inspect.signature(self.make).parameters.items():
            default = None if one.default is inspect.Parameter.empty else one.default
            found[name] = replace(self.hints[name].__metadata__[0], name=name, default=default)
        return found

    @cached_property
    def needed(self) -> frozenset[str]:
        """The parameters without a default."""
        parameters = inspect.signature(self.make).parameters.items()
        return frozenset(name for name, one in parameters if one.default is inspect.Parameter.empty)

    def read(self, given: Mapping[str, Any], *, numbers: bool = False) -> dict[str, Any]:
        """The parameters in SI units, `numbers` or arrays; texts have their units, labelled arrays stay as they are.

        Raises `InvalidArgumentError` if one is missing, unknown or out of range.
        """
        from rocking._base.errors import InvalidArgumentError  # noqa: PLC0415

        for name, value in given.items():
            if name not in self.fields:
                raise InvalidArgumentError(
                    name, value, f"for {self.name}: {' and '.join(self.fields) or 'no parameters'}"
                )
        for name in self.fields:
            if name in self.needed and given.get(name) is None:
                raise InvalidArgumentError(name, None, f"required for {self.name}({', '.join(self.fields)})")
        read = Quantity.read if numbers else _read
        return {name: read(self.fields[name], value) for name, value in given.items() if numbers or value is not None}

    def __call__(self, **given: Any) -> Made:
        """Make one from what `read` reads; an error has the value that was given."""
        from rocking._base.errors import InvalidArgumentError  # noqa: PLC0415

        try:
            return self.make(**self.read(given))
        except InvalidArgumentError as error:
            if not isinstance(given.get(error.parameter), str) or isinstance(error.value, str):
                raise
            raise InvalidArgumentError(error.parameter, given[error.parameter], error.allowed) from None


def _read(quantity: Quantity, value: Any) -> Any:
    """The value of a parameter."""
    if not quantity.unit or hasattr(value, "dims"):
        return value
    return quantity.read(value) if isinstance(value, str | Real) else quantity.convert(value)


@lru_cache(maxsize=256)
def split_kind(text: str, argument: str) -> tuple[str, str, Mapping[str, str]] | None:
    """The sign, the name and the parameters in a text; None if it has another form.

    Raises `InvalidArgumentError` if a parameter is stated twice, or without a name.
    """
    from rocking._base.errors import InvalidArgumentError  # noqa: PLC0415

    found = _TEXT.fullmatch(text)
    if found is None:
        return None
    parameters: dict[str, str] = {}
    for part in filter(str.strip, (found[3] or "").split(",")):
        key, equals, value = (one.strip() for one in part.partition("="))
        if not equals or key in parameters:
            raise InvalidArgumentError(argument, text, "each parameter once, as name=value")
        parameters[key] = value
    return found[1], found[2], parameters


def kind_with(kinds: Mapping[str, Kind[Made]], given: Mapping[str, Any]) -> Kind[Made] | None:
    """The first kind that has all parameters that are given, one that needs no others if there is one."""
    named = {name for name, value in given.items() if value is not None}
    known = [one for one in kinds.values() if named and named <= one.fields.keys()]
    return next((one for one in known if one.needed <= named), next(iter(known), None))
