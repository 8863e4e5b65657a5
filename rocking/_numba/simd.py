"""Several cells side by side: a value of `LANES` doubles, one per cell, on which the vector units work at once.

Kernels write `load(series, n) * x + y` and so on as if for one cell. numba has no such type of its own, and its
automatic vectorisation does not see through the series of a Taylor step, so the type is declared here.
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
"""Cells side by side: 512 bits, which processors with narrower units take in two or four parts."""

VECTOR_BYTES = 8 * LANES
"""Size of a value and the alignment of rows in memory: a row that straddles two cache lines costs twice."""

_LLVM_VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_LLVM_BITS = ir.VectorType(ir.IntType(64), LANES)


class _VectorType(types.Type):
    """numba's name for the value."""

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
    """What kernels call and `generate` compiles; a parameter None is an array, which it gets as its address."""

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

    # numba wants to see how many parameters there are
    forms: dict[int, Callable[..., Any]] = {
        1: lambda _, x: typed(x),
        2: lambda _, x, y: typed(x, y),
        3: lambda _, x, y, z: typed(x, y, z),
    }
    return intrinsic(forms[len(parameters)])


load = _instruction(
    lambda builder, *place: builder.load(_row_address(builder, *place), align=8), _VECTOR_TYPE, None, types.intp
)
"""load(array, row): a row of an array (rows, LANES), or the only one of an array (LANES,) as row 0."""

store = _instruction(
    lambda builder, array, row, x: builder.store(x, _row_address(builder, array, row), align=8),
    *(types.void, None, types.intp, _VECTOR_TYPE),
)
"""store(array, row, x): set that row."""

splat = _instruction(_splat, _VECTOR_TYPE, types.float64)
"""everywhere(number): the same number in every lane."""

absolute = _instruction(_absolute, _VECTOR_TYPE, _VECTOR_TYPE)
"""|x|."""

maximum = _instruction(
    lambda builder, x, y: builder.select(builder.fcmp_ordered(">", x, y), x, y),
    _VECTOR_TYPE,
    _VECTOR_TYPE,
    _VECTOR_TYPE,
)
"""The larger of two."""

minimum = _instruction(
    lambda builder, x, y: builder.select(builder.fcmp_ordered("<", x, y), x, y),
    _VECTOR_TYPE,
    _VECTOR_TYPE,
    _VECTOR_TYPE,
)
"""The smaller of two."""

approx_log2 = _instruction(_approx_log2, _VECTOR_TYPE, _VECTOR_TYPE)
"""log2 of positive numbers, at most 0.09 too small: the bits of a double read as a whole number. -1023 for 0."""

approx_exp2 = _instruction(_approx_exp2, _VECTOR_TYPE, _VECTOR_TYPE)
"""2**x for |x| < 1000, up to 6 % too large: the inverse of `approx_log2`."""


def _arithmetic(operation: Any, instruction: str) -> None:
    """Let `operation` take two values, or a value and a number."""

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
