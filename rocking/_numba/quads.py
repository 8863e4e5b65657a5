"""SIMD vectors of four doubles for kernels: the values of one row of a stencil.

They are written as `load_quad(address) * x + y`, like those of `rocking._numba.simd`.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types

from rocking._numba.simd import VectorType, define_arithmetic, instruction

SIZE = 4
"""Doubles of a vector."""

_QUAD_TYPE = VectorType(SIZE)
_NUMBERS: Any = types.UniTuple  # numba has no annotations


def _lane(number: int) -> Any:
    return ir.Constant(ir.IntType(32), number)


def _load(builder: Any, address: Any) -> Any:
    return builder.load(builder.inttoptr(address, _QUAD_TYPE.llvm.as_pointer()), align=8)


def _combine(builder: Any, *numbers: Any) -> Any:
    vector = ir.Constant(_QUAD_TYPE.llvm, ir.Undefined)
    for k, number in enumerate(numbers):
        vector = builder.insert_element(vector, number, _lane(k))
    return vector


def _separate(builder: Any, vector: Any) -> Any:
    found = ir.Constant(ir.ArrayType(ir.DoubleType(), SIZE), ir.Undefined)
    for k in range(SIZE):
        found = builder.insert_value(found, builder.extract_element(vector, _lane(k)), k)
    return found


load_quad = instruction(_load, _QUAD_TYPE, types.intp)
"""load_quad(address): the four doubles at an address, an integer."""

quad = instruction(_combine, _QUAD_TYPE, *[types.float64] * SIZE)
"""quad(a, b, c, d): the vector of four numbers."""

numbers_of = instruction(_separate, _NUMBERS(types.float64, SIZE), _QUAD_TYPE)
"""numbers_of(x): the four numbers of a vector."""

select_quad = instruction(
    lambda builder, condition, x, y: builder.select(condition, x, y),
    *(_QUAD_TYPE, types.boolean, _QUAD_TYPE, _QUAD_TYPE),
)
"""select_quad(condition, x, y): x if the condition holds, else y."""

define_arithmetic(_QUAD_TYPE)
