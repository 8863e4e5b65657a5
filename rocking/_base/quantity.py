"""The declaration of a quantity, and of kinds of bodies and pulses, whose parameters are quantities.

Python, tables, options, HTTP and the pages derive from a `Quantity`. It imports nothing heavy: the layer of an
interface makes its own object from the declaration, an option of typer in `rocking/_cli/parameters.py`, a field of
pydantic in `api/rocking_api/models/quantity.py`.

A `Kind` is a function with annotated parameters. A text describes a body or
pulse of a kind with the units of its parameters, `name(parameter=value, ...)`, in the same way in all interfaces.
"""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import KW_ONLY, dataclass, replace
from functools import cached_property, lru_cache
from numbers import Real
from typing import TYPE_CHECKING, Any, Generic, TypeVar

if TYPE_CHECKING:  # they load numpy, which help does without
    import numpy as np
    from numpy.typing import NDArray

    from rocking._base.units import Values

MAX_LABEL = 25  # characters of a label that xarray writes in one line, with a unit [-]


@dataclass(frozen=True)
class Quantity:
    """A quantity that users state or that is computed.

    Attributes
    ----------
    name : str
        In Python, in JSON and in tables that are written; the option has dashes.
    unit : str
        SI unit, a key of `rocking._base.units.UNITS`, "-" of a number; "" of a text, "bool" of yes or no.
    meaning : str
        In one sentence, without a capital or a full stop.
    symbol : str
        As in the paper.
    lower, upper : float
        Ends of the range; they may be infinite.
    closed : {"both", "left", "right", "neither"}
        Which ends belong to the range.
    default : object
        Value where none is stated; None: it is needed, or the meaning says what applies.
    example : str
        As people write it, with its unit.
    words : tuple of str
        Texts that are values.
    """

    name: str
    unit: str
    meaning: str
    _: KW_ONLY
    symbol: str = ""
    lower: float = -math.inf
    upper: float = math.inf
    closed: str = "neither"
    default: Any = None
    example: str = ""
    words: tuple[str, ...] = ()

    def convert(self, value: Values) -> NDArray[np.float64]:
        """Convert a value to the SI unit, a float64 array, shape kept; checked as `rocking._base.errors` says."""
        from rocking._base.errors import in_range  # noqa: PLC0415

        return in_range(self.name, value, self.lower, self.upper, closed=self.closed, unit=self.unit)

    def number(self, value: Values, name: str = "") -> float:
        """Convert one number, as `convert`; `name`: in the error message, where it is another."""
        if type(value) is float and self.lower < value < self.upper:  # all that is left to do for most
            return value
        from rocking._base.errors import number  # noqa: PLC0415

        return number(name or self.name, value, self.lower, self.upper, closed=self.closed, unit=self.unit)

    def read(self, value: Any, *, si: bool = False) -> Any:
        """Read an option, a cell of JSON or a parameter of a query: one of the words, a text, or a number.

        `value` is a text such as "40 cm" or "momentum", or a number in the SI unit. `si`: whether a text without a unit
        is in the SI unit, as in a query; otherwise it needs one. Raises `InvalidArgumentError` as `convert`.
        """
        from rocking._base.errors import InvalidArgumentError  # noqa: PLC0415
        from rocking._base.units import USUAL  # noqa: PLC0415

        if not self.unit or (isinstance(value, str) and value.partition("(")[0].strip() in self.words):
            return value
        try:
            # a number, or a percentage; Python also takes digits of other scripts, and underscores
            if isinstance(value, str) and (si or self.unit not in USUAL) and value.isascii() and "_" not in value:
                with suppress(ValueError):
                    value = float(value)
            return self.number(value)
        except InvalidArgumentError as error:
            if not self.words:
                raise
            allowed = f"{' or '.join(self.words)}, or {error.allowed}"
            raise InvalidArgumentError(self.name, error.value, allowed) from None

    @property
    def interval(self) -> str:
        """The range, such as `[0, 1]`."""
        left = "[" if self.closed in ("both", "left") and math.isfinite(self.lower) else "("
        right = "]" if self.closed in ("both", "right") and math.isfinite(self.upper) else ")"
        return f"{left}{self.lower:g}, {self.upper:g}{right}"

    @property
    def limits(self) -> dict[str, float]:
        """The range as keywords of JSON schema."""
        lower = "minimum" if self.closed in ("both", "left") else "exclusiveMinimum"
        upper = "maximum" if self.closed in ("both", "right") else "exclusiveMaximum"
        ends = {lower: self.lower, upper: self.upper}
        return {name: end for name, end in ends.items() if math.isfinite(end)}

    @property
    def named(self) -> str:
        """The meaning, with the symbol after its first clause."""
        if not self.symbol:
            return self.meaning
        clause, semicolon, remark = self.meaning.partition(";")
        return f"{clause}, {self.symbol}{semicolon}{remark}"

    @property
    def help(self) -> str:
        """Meaning, symbol and unit in one line."""
        return self.named + (f" [{self.unit}]" if self.unit not in ("", "bool") else "")

    @property
    def sentence(self) -> str:
        """Meaning, symbol, range of a number, words and example, for the help of an option."""
        parts = [self.named[0].upper() + self.named[1:]]
        if self.unit == "-" and (self.lower > 0.0 or math.isfinite(self.upper)):
            parts.append(self.interval)
        parts += [f"or {word}" for word in self.words]
        if self.example:
            example = repr(self.example) if " " in self.example else self.example
            parts.append(f"such as {example}")
        return f"{', '.join(parts)}."

    @property
    def label(self) -> str:
        """Meaning and symbol for the axis of a picture; the symbol alone if both are longer than a label may be."""
        symbol = self.symbol.partition(" = ")[0]
        text = f"{self.meaning} {symbol}"
        return text if len(text) <= MAX_LABEL else symbol

    @property
    def header(self) -> str:
        """The name with its unit, in the header of a table that is written."""
        return self.name if self.unit in ("", "-", "bool") else f"{self.name} [{self.unit}]"

    @property
    def option(self) -> str:
        """The name of the option of the command line."""
        return "--" + self.name.replace("_", "-")

    def restricted(self, lower: float, upper: float) -> Quantity:
        """Return the quantity on a part of its range, closed at finite ends; `ValueError` for any other range."""
        if not self.lower <= lower < upper <= self.upper:
            raise ValueError(f"[{lower:g}, {upper:g}] is not a part of {self.interval}, the range of {self.name}")
        return replace(self, lower=lower, upper=upper, closed="both" if math.isfinite(upper) else "left")

    def in_degrees(self) -> Quantity:
        """Return the angle in degrees, with the ending `_deg` of its name."""
        lower, upper = math.degrees(self.lower), math.degrees(self.upper)
        return replace(self, name=f"{self.name}_deg", unit="deg", lower=lower, upper=upper)


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
        hints = {}
        for name, parameter in inspect.signature(self.make).parameters.items():
            hint = parameter.annotation
            hints[name] = eval(hint, self.make.__globals__) if isinstance(hint, str) else hint
        return hints

    @cached_property
    def fields(self) -> Mapping[str, Quantity]:
        """Its parameters by name, with the defaults of the signature."""
        fields = {}
        for name, parameter in inspect.signature(self.make).parameters.items():
            default = None if parameter.default is inspect.Parameter.empty else parameter.default
            fields[name] = replace(self.hints[name].__metadata__[0], name=name, default=default)
        return fields

    @cached_property
    def needed(self) -> frozenset[str]:
        """The parameters without a default."""
        parameters = inspect.signature(self.make).parameters.items()
        return frozenset(name for name, parameter in parameters if parameter.default is inspect.Parameter.empty)

    def read(self, arguments: Mapping[str, Any], *, numbers: bool = False) -> dict[str, Any]:
        """Convert parameters to SI units, `numbers` or arrays; texts have units, labelled arrays stay as they are.

        Raises `InvalidArgumentError` if one is missing, unknown or out of range.
        """
        from rocking._base.errors import InvalidArgumentError  # noqa: PLC0415

        for name, value in arguments.items():
            if name not in self.fields:
                allowed = " and ".join(self.fields) or "no parameters"
                raise InvalidArgumentError(name, value, f"for {self.name}: {allowed}")
        for name in self.fields:
            if name in self.needed and arguments.get(name) is None:
                raise InvalidArgumentError(name, None, f"required for {self.name}({', '.join(self.fields)})")
        read = Quantity.read if numbers else _read
        values = {}
        for name, value in arguments.items():
            if numbers or value is not None:
                values[name] = read(self.fields[name], value)
        return values

    def __call__(self, /, **arguments: Any) -> Made:
        """Make an object from what `read` reads; an error has the argument as it was stated."""
        from rocking._base.errors import InvalidArgumentError  # noqa: PLC0415

        try:
            return self.make(**self.read(arguments))
        except InvalidArgumentError as error:
            if not isinstance(arguments.get(error.parameter), str) or isinstance(error.value, str):
                raise
            raise InvalidArgumentError(error.parameter, arguments[error.parameter], error.allowed) from None


def _read(quantity: Quantity, value: Any) -> Any:
    """Convert the value of a parameter."""
    if not quantity.unit or hasattr(value, "dims"):
        return value
    return quantity.read(value) if isinstance(value, str | Real) else quantity.convert(value)


@lru_cache(maxsize=256)
def split_kind(text: str, argument: str) -> tuple[str, str, Mapping[str, str]] | None:
    """Return the sign, the name and the parameters in a text; None if it has another form.

    Raises `InvalidArgumentError` if a parameter is stated twice, or without a name.
    """
    from rocking._base.errors import InvalidArgumentError  # noqa: PLC0415

    match = _TEXT.fullmatch(text)
    if match is None:
        return None
    parameters: dict[str, str] = {}
    for part in filter(str.strip, (match[3] or "").split(",")):
        key, equals, value = map(str.strip, part.partition("="))
        if not equals or key in parameters:
            raise InvalidArgumentError(argument, text, "each parameter once, as name=value")
        parameters[key] = value
    return match[1], match[2], parameters


def kind_with(kinds: Mapping[str, Kind[Made]], arguments: Mapping[str, Any]) -> Kind[Made] | None:
    """Return the first kind that has all stated parameters, preferably one that needs no others; None without one."""
    names = {name for name, value in arguments.items() if value is not None}
    candidates = [kind for kind in kinds.values() if names and names <= kind.fields.keys()]
    complete = [kind for kind in candidates if kind.needed <= names]
    return next(iter(complete + candidates), None)
