"""Assignment of all fields of records at once: kernels do not list fields that are declared elsewhere."""

from collections.abc import Mapping
from typing import Any

from numba import types
from numba.extending import intrinsic


def _assign(context: Any, builder: Any, target: Any, address: Any, name: str, value: Any) -> None:
    assign = context.get_setattr(name, types.none(target, target.typeof(name)))
    assign(builder, (address, value))


def _copy_fields(_: Any, source: Any, target: Any) -> Any:
    shared = [name for name in target.fields if name in source.fields]

    def lower(context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        for name in shared:
            value = context.get_getattr(source, name)(context, builder, source, values[0], name)
            converted = context.cast(builder, value, source.typeof(name), target.typeof(name))
            _assign(context, builder, target, values[1], name, converted)
        return context.get_dummy_value()

    return types.void(source, target), lower


copy_fields: Any = intrinsic(_copy_fields)
"""copy_fields(source, target): set the fields of a record that another one has too, converted to their types."""


def constant_fields(numbers: Mapping[str, float]) -> Any:
    """An intrinsic that sets fields of a record to constants; names that it does not have are passed over."""

    @intrinsic
    def set_constants(_: Any, target: Any) -> Any:
        def lower(context: Any, builder: Any, _signature: Any, values: Any) -> Any:
            for name, number in numbers.items():
                if name in target.fields:
                    kind = target.typeof(name)
                    value = float(number) if isinstance(kind, types.Float) else int(number)
                    _assign(context, builder, target, values[0], name, context.get_constant(kind, value))
            return context.get_dummy_value()

        return types.void(target), lower

    return set_constants
