"""Assignment of all fields of records at once: kernels do not list the fields, which are declared elsewhere."""

from collections.abc import Mapping
from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.extending import intrinsic

from rocking._numba.simd import LANES, place_of, transpose

_DOUBLES = ir.VectorType(ir.DoubleType(), LANES)
_WORDS = ir.VectorType(ir.IntType(64), LANES)


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
    """An intrinsic that sets those of the named fields that a record has to constants."""

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


def _scatter_records(_: Any, source: Any, places: Any, target: Any) -> Any:
    def lower(context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        lanes = context.make_array(places)(context, builder, values[1]).data
        records = context.make_array(target)(context, builder, values[2]).data
        words = _words(builder, source, values[0], target.dtype)
        with builder.goto_entry_block():  # once, not in each iteration of a loop
            unused = builder.alloca(ir.ArrayType(ir.DoubleType(), len(words)))
        nowhere = builder.bitcast(unused, records.type)
        addresses = []
        for lane in range(LANES):
            place = place_of(builder, lanes, lane)
            written = builder.icmp_signed(">=", place, ir.Constant(place.type, 0))
            addresses.append(builder.select(written, builder.gep(records, [place]), nowhere))
        for first in range(0, len(words), LANES):
            _write_words(builder, words[first : first + LANES], addresses, first)
        return context.get_dummy_value()

    return types.void(source, places, target), lower


scatter_records: Any = intrinsic(_scatter_records)
"""scatter_records(source, places, target): lane i becomes the record `places[i]` of an array, if not negative.

`source` is a record with a row of `LANES` doubles for each field of the records of `target`, by the same name. The
fields are put together to words of eight bytes, and these written as vectors.
"""


def _words(builder: Any, source: Any, address: Any, record: Any) -> list[Any]:
    """The words of the records of all lanes, each a vector of the lanes."""
    words: list[Any] = [None] * (record.size // 8)
    for name in record.fields:
        kind, (word, byte) = record.typeof(name), divmod(record.offset(name), 8)
        row = builder.gep(
            builder.bitcast(address, ir.IntType(8).as_pointer()), [ir.Constant(ir.IntType(64), source.offset(name))]
        )
        value = builder.load(builder.bitcast(row, _DOUBLES.as_pointer()), align=8)
        if isinstance(kind, types.Float):
            words[word] = value
            continue
        bits = 8 if isinstance(kind, types.Boolean) else kind.bitwidth
        low = ir.Constant(_WORDS, [2**bits - 1] * LANES)
        whole = builder.and_(builder.fptosi(value, _WORDS), low)
        moved = builder.shl(whole, ir.Constant(_WORDS, [8 * byte] * LANES))
        words[word] = moved if words[word] is None else builder.or_(words[word], moved)
    return [builder.bitcast(word, _DOUBLES) for word in words]


def _write_words(builder: Any, words: list[Any], addresses: list[Any], first: int) -> None:
    """Write words, from the number `first` on, of the records at the addresses of all lanes."""
    count = 1 << (len(words) - 1).bit_length()
    undefined = ir.Constant(_DOUBLES, ir.Undefined)
    blocks = transpose(builder, words + [undefined] * (count - len(words)))
    for i, block in enumerate(blocks):
        for start in range(0, LANES, count):
            own = ir.Constant(ir.VectorType(ir.IntType(32), len(words)), list(range(start, start + len(words))))
            record = builder.shuffle_vector(block, undefined, own)
            target = builder.bitcast(addresses[start + i], ir.DoubleType().as_pointer())
            target = builder.gep(target, [ir.Constant(ir.IntType(64), first)])
            builder.store(record, builder.bitcast(target, record.type.as_pointer()), align=8)
