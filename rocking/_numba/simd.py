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

BYTES = 8 * LANES
"""Size of a value and the alignment of rows in memory: a row that straddles two cache lines costs twice."""

_VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_BITS = ir.VectorType(ir.IntType(64), LANES)


class _Lanes(types.Type):
    """numba's name for the value."""

    def __init__(self) -> None:
        super().__init__("Lanes")


_LANES = _Lanes()


@register_model(_Lanes)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, fe_type: Any) -> None:
        super().__init__(manager, fe_type, _VECTOR)


def _constant(value: float) -> Any:
    return ir.Constant(_VECTOR, [value] * LANES)


def _spread(builder: Any, value: Any) -> Any:
    undefined = ir.Constant(_VECTOR, ir.Undefined)
    single = builder.insert_element(undefined, value, ir.Constant(ir.IntType(32), 0))
    return builder.shuffle_vector(single, undefined, ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES))


def _row(builder: Any, array: Any, row: Any) -> Any:
    offset = builder.mul(row, ir.Constant(row.type, BYTES))
    return builder.bitcast(cgutils.pointer_add(builder, array, offset), _VECTOR.as_pointer())


def _magnitude(builder: Any, x: Any) -> Any:
    without_sign = ir.Constant(_BITS, [2**63 - 1] * LANES)
    return builder.bitcast(builder.and_(builder.bitcast(x, _BITS), without_sign), _VECTOR)


def _rough_log2(builder: Any, x: Any) -> Any:
    whole = builder.sitofp(builder.bitcast(x, _BITS), _VECTOR)
    return builder.fsub(builder.fmul(whole, _constant(2.0**-52)), _constant(1023.0))


def _rough_exp2(builder: Any, x: Any) -> Any:
    whole = builder.fmul(builder.fadd(x, _constant(1023.0)), _constant(2.0**52))
    return builder.bitcast(builder.fptosi(whole, _BITS), _VECTOR)


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


load = _instruction(lambda builder, *place: builder.load(_row(builder, *place), align=8), _LANES, None, types.intp)
"""load(array, row): a row of an array (rows, LANES), or the only one of an array (LANES,) as row 0."""

store = _instruction(
    lambda builder, array, row, x: builder.store(x, _row(builder, array, row), align=8),
    *(types.void, None, types.intp, _LANES),
)
"""store(array, row, x): set that row."""

everywhere = _instruction(_spread, _LANES, types.float64)
"""everywhere(number): the same number in every lane."""

magnitude = _instruction(_magnitude, _LANES, _LANES)
"""|x|."""

larger = _instruction(
    lambda builder, x, y: builder.select(builder.fcmp_ordered(">", x, y), x, y), _LANES, _LANES, _LANES
)
"""The larger of two."""

smaller = _instruction(
    lambda builder, x, y: builder.select(builder.fcmp_ordered("<", x, y), x, y), _LANES, _LANES, _LANES
)
"""The smaller of two."""

rough_log2 = _instruction(_rough_log2, _LANES, _LANES)
"""log2 of positive numbers, at most 0.09 too small: the bits of a double read as a whole number. -1023 for 0."""

rough_exp2 = _instruction(_rough_exp2, _LANES, _LANES)
"""2**x for |x| < 1000, up to 6 % too large: the inverse of `rough_log2`."""


def _arithmetic(operation: Any, instruction: str) -> None:
    """Let `operation` take two values, or a value and a number."""

    @infer_global(operation)
    class Typing(AbstractTemplate):
        def generic(self, args: Any, _: Any) -> Any:
            if _LANES not in args or not all(isinstance(one, (_Lanes, types.Number)) for one in args):
                return None
            return signature(_LANES, *(one if one is _LANES else types.float64 for one in args))

    def lower(_: Any, builder: Any, sig: Any, args: Any) -> Any:
        operands = [x if kind is _LANES else _spread(builder, x) for kind, x in zip(sig.args, args, strict=True)]
        return getattr(builder, instruction)(*operands)

    for left, right in ((_LANES, _LANES), (_LANES, types.float64), (types.float64, _LANES)):
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
