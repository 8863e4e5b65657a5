"""Prefetching, for kernels that write large tables."""

from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.extending import intrinsic


def _prefetch_for_write(_: Any, address: Any) -> Any:
    """Let the processor fetch the cache line at an address, an integer, that will be written, without waiting."""

    def lower(context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        byte, number = ir.IntType(8).as_pointer(), ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [byte, number, number, number])
        function = builder.module.declare_intrinsic("llvm.prefetch", [byte], kind)
        for_write, all_levels, data = (ir.Constant(number, value) for value in (1, 3, 1))
        builder.call(function, [builder.inttoptr(values[0], byte), for_write, all_levels, data])
        return context.get_dummy_value()

    return types.void(address), lower


prefetch_for_write: Any = intrinsic(_prefetch_for_write)  # called without its first parameter
