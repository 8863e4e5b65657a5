"""A SIMD vector type for kernels: `LANES` doubles, one per cell.

Kernels write expressions such as `load(series, n) * x + y` as for one cell. numba has no such type, and automatic
vectorisation does not recognise the series of a Taylor step.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba.core import cgutils, types
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, models, register_model

LANES = 8
"""Doubles of a vector: 512 bits. Processors with narrower units process it in two or four parts."""

VECTOR_BYTES = 8 * LANES
"""Size of a vector and alignment of the rows of an array: a row that crosses a cache line takes two accesses."""

_LLVM_VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_LLVM_BITS = ir.VectorType(ir.IntType(64), LANES)


class _VectorType(types.Type):
    """The numba type of a vector."""

    def __init__(self) -> None:
        super().__init__("Lanes")


_VECTOR_TYPE = _VectorType()


@register_model(_VectorType)
class _VectorModel(models.PrimitiveModel):
    def __init__(self, manager: Any, fe_type: Any) -> None:
        super().__init__(manager, fe_type, _LLVM_VECTOR)


def _constant(value: float) -> Any:
    return ir.Constant(_LLVM_VECTOR, [value] * LANES)


def _splat(builder: Any, value: Any) -> Any:
    undefined = ir.Constant(_LLVM_VECTOR, ir.Undefined)
    single = builder.insert_element(undefined, value, ir.Constant(ir.IntType(32), 0))
    return builder.shuffle_vector(single, undefined, ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES))


def _row_address(builder: Any, array: Any, row: Any) -> Any:
    offset = builder.mul(row, ir.Constant(row.type, VECTOR_BYTES))
    return builder.bitcast(cgutils.pointer_add(builder, array, offset), _LLVM_VECTOR.as_pointer())


def _absolute(builder: Any, x: Any) -> Any:
    without_sign = ir.Constant(_LLVM_BITS, [2**63 - 1] * LANES)
    return builder.bitcast(builder.and_(builder.bitcast(x, _LLVM_BITS), without_sign), _LLVM_VECTOR)


def _approx_log2(builder: Any, x: Any) -> Any:
    whole = builder.sitofp(builder.bitcast(x, _LLVM_BITS), _LLVM_VECTOR)
    return builder.fsub(builder.fmul(whole, _constant(2.0**-52)), _constant(1023.0))


def _approx_exp2(builder: Any, x: Any) -> Any:
    whole = builder.fmul(builder.fadd(x, _constant(1023.0)), _constant(2.0**52))
    return builder.bitcast(builder.fptosi(whole, _LLVM_BITS), _LLVM_VECTOR)


def _instruction(generate: Callable[..., Any], result: Any, *parameters: Any) -> Any:
    """An intrinsic compiled by `generate`; a parameter None is an array, which is passed as its address."""

    def typed(*given: Any) -> Any:
        kinds = [kind or one for kind, one in zip(parameters, given, strict=True)]

        def lower(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            operands = [
                context.make_array(kind)(context, builder, value).data if isinstance(kind, types.Array) else value
                for kind, value in zip(signature.args, values, strict=True)
            ]
            made = generate(builder, *operands)
            return context.get_dummy_value() if result is types.void else made

        return result(*kinds), lower

    # numba inspects the number of parameters
    forms: dict[int, Callable[..., Any]] = {
        1: lambda _, x: typed(x),
        2: lambda _, x, y: typed(x, y),
        3: lambda _, x, y, z: typed(x, y, z),
    }
    return intrinsic(forms[len(parameters)])


load = _instruction(
    lambda builder, *place: builder.load(_row_address(builder, *place), align=8), _VECTOR_TYPE, None, types.intp
)
"""load(array, row): a row of an array (rows, LANES); row 0 of an array (LANES,)."""

store = _instruction(
    lambda builder, array, row, x: builder.store(x, _row_address(builder, array, row), align=8),
    *(types.void, None, types.intp, _VECTOR_TYPE),
)
"""store(array, row, x): set a row."""

splat = _instruction(_splat, _VECTOR_TYPE, types.float64)
"""splat(number): the number in every lane."""

absolute = _instruction(_absolute, _VECTOR_TYPE, _VECTOR_TYPE)
"""absolute(x), lane by lane."""

maximum = _instruction(
    lambda builder, x, y: builder.select(builder.fcmp_ordered(">", x, y), x, y),
    _VECTOR_TYPE,
    _VECTOR_TYPE,
    _VECTOR_TYPE,
)
"""maximum(x, y), lane by lane."""

minimum = _instruction(
    lambda builder, x, y: builder.select(builder.fcmp_ordered("<", x, y), x, y),
    _VECTOR_TYPE,
    _VECTOR_TYPE,
    _VECTOR_TYPE,
)
"""minimum(x, y), lane by lane."""

approx_log2 = _instruction(_approx_log2, _VECTOR_TYPE, _VECTOR_TYPE)
"""log2 of positive numbers from the bits of the doubles read as integers: at most 0.09 too small; -1023 for 0."""

approx_exp2 = _instruction(_approx_exp2, _VECTOR_TYPE, _VECTOR_TYPE)
"""2**x for |x| < 1000, up to 6 % too large: the inverse of `approx_log2`."""


def _arithmetic(operation: Any, instruction: str) -> None:
    """Define `operation` for two vectors, or a vector and a number."""

    @infer_global(operation)
    class Typing(AbstractTemplate):
        def generic(self, args: Any, _: Any) -> Any:
            if _VECTOR_TYPE not in args or not all(isinstance(one, (_VectorType, types.Number)) for one in args):
                return None
            return signature(_VECTOR_TYPE, *(one if one is _VECTOR_TYPE else types.float64 for one in args))

    def lower(_: Any, builder: Any, sig: Any, args: Any) -> Any:
        operands = [x if kind is _VECTOR_TYPE else _splat(builder, x) for kind, x in zip(sig.args, args, strict=True)]
        return getattr(builder, instruction)(*operands)

    for left, right in ((_VECTOR_TYPE, _VECTOR_TYPE), (_VECTOR_TYPE, types.float64), (types.float64, _VECTOR_TYPE)):
        lower_builtin(operation, left, right)(lower)


for _operation, _name in (
    (operator.add, "fadd"),
    (operator.iadd, "fadd"),
    (operator.sub, "fsub"),
    (operator.isub, "fsub"),
    (operator.mul, "fmul"),
    (operator.truediv, "fdiv"),
):
    _arithmetic(_operation, _name)
