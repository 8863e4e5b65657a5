"""Loads and prefetches from addresses, for kernels that read large tables of several files.

An array taken from a tuple by a variable index costs a count of references, an atomic operation, in each iteration; an
address costs nothing. The caller keeps the arrays alive and the offsets inside of them.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.extending import intrinsic


def _load(kind: Any) -> Any:
    def load(_: Any, address: Any) -> Any:
        def lower(context: Any, builder: Any, _signature: Any, values: Any) -> Any:
            return builder.load(builder.inttoptr(values[0], context.get_value_type(kind).as_pointer()))

        return kind(address), lower

    return intrinsic(load)


load_float64: Any = _load(types.float64)
load_float32: Any = _load(types.float32)
load_int32: Any = _load(types.int32)
"""load(address): the number at an address, an integer."""


def _prefetch(for_write: bool) -> Any:
    def prefetch(_: Any, address: Any) -> Any:
        def lower(context: Any, builder: Any, _signature: Any, values: Any) -> Any:
            byte, number = ir.IntType(8).as_pointer(), ir.IntType(32)
            kind = ir.FunctionType(ir.VoidType(), [byte, number, number, number])
            function = builder.module.declare_intrinsic("llvm.prefetch", [byte], kind)
            all_levels, data = 3, 1
            hints = [ir.Constant(number, value) for value in (int(for_write), all_levels, data)]
            builder.call(function, [builder.inttoptr(values[0], byte), *hints])
            return context.get_dummy_value()

        return types.void(address), lower

    return intrinsic(prefetch)


prefetch: Any = _prefetch(False)
"""prefetch(address): let the processor fetch the cache line at an address, without waiting for it."""

prefetch_for_write: Any = _prefetch(True)
"""prefetch_for_write(address): the same for a cache line that will be written."""
