"""A SIMD vector type for kernels: `LANES` doubles, one per cell, and masks of `LANES` truth values.

Arithmetic, comparisons, `load`, `store`, `pick`, `select` and the like take vectors of `FLOAT_LANES` single-precision
numbers, too, which arrays of float32 give.

Kernels write expressions such as `load(series, n) * x + y` as for one cell; comparisons give masks, which `&`, `|`, `~`
combine. numba has no such type, and automatic vectorisation does not recognise the series of a Taylor step.
"""

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.extending import intrinsic, lower_builtin, lower_cast, models, register_model, type_callable

LANES = 16
"""Doubles of a vector. Processors have units of two, four or eight and process the parts at the same time: with 16 the
latencies of two units of eight overlap, which saves a tenth to a fifth of the time against 8."""

VECTOR_BYTES = 8 * LANES
"""Size of a vector and alignment of the rows of an array: a row that crosses a cache line takes two accesses."""

FLOAT_LANES = 2 * LANES  # single-precision numbers of a vector, which is as long

_LLVM_VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_LLVM_FLOATS = ir.VectorType(ir.FloatType(), FLOAT_LANES)
_LLVM_BITS = ir.VectorType(ir.IntType(64), LANES)
_LLVM_MASK = ir.VectorType(ir.IntType(1), LANES)


class _VectorType(types.Type):
    """The numba type of a vector of numbers, or of one truth value for each lane."""

    def __init__(self, name: str, vector: Any) -> None:
        super().__init__(name)
        self.vector = vector


_VECTOR_TYPE, _MASK_TYPE = _VectorType("Lanes", _LLVM_VECTOR), _VectorType("LanesMask", _LLVM_MASK)
_FLOATS_TYPE = _VectorType("FloatLanes", _LLVM_FLOATS)
_FLOATS_MASK_TYPE = _VectorType("FloatLanesMask", ir.VectorType(ir.IntType(1), FLOAT_LANES))


@register_model(_VectorType)
class _VectorModel(models.PrimitiveModel):
    def __init__(self, manager: Any, fe_type: Any) -> None:
        super().__init__(manager, fe_type, fe_type.vector)


def _constant(value: float) -> Any:
    return ir.Constant(_LLVM_VECTOR, [value] * LANES)


def _bits(value: int) -> Any:
    return ir.Constant(_LLVM_BITS, [value] * LANES)


def _splat(builder: Any, value: Any, vector: Any = _LLVM_VECTOR) -> Any:
    undefined, number = ir.Constant(vector, ir.Undefined), ir.IntType(32)
    value = builder.fptrunc(value, vector.element) if value.type != vector.element else value
    single = builder.insert_element(undefined, value, ir.Constant(number, 0))
    return builder.shuffle_vector(
        single, undefined, ir.Constant(ir.VectorType(number, vector.count), [0] * vector.count)
    )


@lower_cast(types.Float, _VectorType)  # type: ignore[untyped-decorator]
def _(_: Any, builder: Any, __: Any, vector: Any, value: Any) -> Any:
    return _splat(builder, value, vector.vector)


def _row_address(builder: Any, array: Any, row: Any) -> Any:
    offset = builder.mul(row, ir.Constant(row.type, VECTOR_BYTES))
    address = builder.gep(builder.bitcast(array, ir.IntType(8).as_pointer()), [offset])
    vector = _LLVM_FLOATS if array.type.pointee == ir.FloatType() else _LLVM_VECTOR
    return builder.bitcast(address, vector.as_pointer())


def _absolute(builder: Any, x: Any) -> Any:
    without_sign = builder.and_(builder.bitcast(x, _LLVM_BITS), _bits(2**63 - 1))
    return builder.bitcast(without_sign, _LLVM_VECTOR)


def _approx_log2(builder: Any, x: Any) -> Any:
    whole = builder.sitofp(builder.bitcast(x, _LLVM_BITS), _LLVM_VECTOR)
    return builder.fsub(builder.fmul(whole, _constant(2.0**-52)), _constant(1023.0))


def _approx_exp2(builder: Any, x: Any) -> Any:
    whole = builder.fmul(builder.fadd(x, _constant(1023.0)), _constant(2.0**52))
    return builder.bitcast(builder.fptosi(whole, _LLVM_BITS), _LLVM_VECTOR)


def _power_of_two(builder: Any, x: Any) -> Any:
    # in the sum the last bits of the mantissa hold the biased exponent
    whole = builder.bitcast(builder.fadd(x, _constant(1.5 * 2.0**52 + 1023.0)), _LLVM_BITS)
    return builder.bitcast(builder.shl(whole, _bits(52)), _LLVM_VECTOR)


def _of_quadrant(builder: Any, turns: Any, even: Any, odd: Any, offset: int) -> Any:
    # in the sum the last bits of the mantissa hold the integer; bit 0 chooses, bit 1 of it plus `offset`, moved to the
    # sign, negates
    bits = builder.bitcast(builder.fadd(turns, _constant(1.5 * 2.0**52)), _LLVM_BITS)
    is_odd = builder.icmp_unsigned("!=", builder.and_(bits, _bits(1)), _bits(0))
    sign = builder.shl(builder.and_(builder.add(bits, _bits(offset)), _bits(2)), _bits(62))
    value = builder.bitcast(builder.select(is_odd, odd, even), _LLVM_BITS)
    return builder.bitcast(builder.xor(value, sign), _LLVM_VECTOR)


def _square_root(builder: Any, x: Any) -> Any:
    name = {ir.DoubleType(): "f64", _LLVM_VECTOR: f"v{LANES}f64", _LLVM_FLOATS: f"v{FLOAT_LANES}f32"}[x.type]
    return builder.call(
        builder.module.declare_intrinsic("llvm.sqrt." + name, fnty=ir.FunctionType(x.type, [x.type])), [x]
    )


def transpose(builder: Any, rows: list[Any]) -> list[Any]:
    """Transpose each square of vectors side by side: exchange the off-diagonal blocks of size 1, 2, 4 and so on.

    Number by number the exchange of rows and columns takes a tenth of the time of slender blocks.
    """
    positions, size = range(LANES), 1
    while size < len(rows):
        upper = [lane if not lane & size else LANES + lane - size for lane in positions]
        lower = [lane + size if not lane & size else LANES + lane for lane in positions]
        mask = ir.VectorType(ir.IntType(32), LANES)
        rows = [
            builder.shuffle_vector(rows[i & ~size], rows[i | size], ir.Constant(mask, lower if i & size else upper))
            for i in range(len(rows))
        ]
        size *= 2
    return rows


def place_of(builder: Any, places: Any, lane: int) -> Any:
    return builder.load(builder.gep(places, [ir.Constant(ir.IntType(64), lane)]))


def _element_address(builder: Any, array: Any, index: Any) -> Any:
    return builder.gep(builder.bitcast(array, ir.DoubleType().as_pointer()), [index])


def _gather(builder: Any, array: Any, places: Any) -> Any:
    vector = ir.Constant(_LLVM_VECTOR, ir.Undefined)
    for i in range(LANES):
        element = builder.load(_element_address(builder, array, place_of(builder, places, i)))
        vector = builder.insert_element(vector, element, ir.Constant(ir.IntType(32), i))
    return vector


def _pick(builder: Any, array: Any, places: Any) -> Any:
    number, vector = ir.IntType(32), ir.Constant(places.type, ir.Undefined)
    whole = builder.fptosi(places, ir.VectorType(number, places.type.count))
    for i in range(places.type.count):
        place = builder.gep(array, [builder.extract_element(whole, ir.Constant(number, i))])
        vector = builder.insert_element(vector, builder.load(place), ir.Constant(number, i))
    return vector


def _gather_rows(builder: Any, source: Any, places: Any, target: Any) -> Any:
    rows = [builder.load(_row_address(builder, source, place_of(builder, places, i)), align=8) for i in range(LANES)]
    for i, column in enumerate(transpose(builder, rows)):
        builder.store(column, _row_address(builder, target, ir.Constant(ir.IntType(64), i)), align=8)


def _scatter_rows(builder: Any, source: Any, places: Any, target: Any) -> Any:
    columns = [
        builder.load(_row_address(builder, source, ir.Constant(ir.IntType(64), i)), align=8) for i in range(LANES)
    ]
    for i, row in enumerate(transpose(builder, columns)):
        builder.store(row, _row_address(builder, target, place_of(builder, places, i)), align=8)


def _store_where(builder: Any, address: Any, mask: Any, x: Any) -> Any:
    return builder.store(builder.select(mask, x, builder.load(address, align=8)), address, align=8)


def instruction(generate: Callable[..., Any], result: Any, *parameters: Any) -> Any:
    """An intrinsic compiled by `generate`; a parameter None is an array, which is passed as its address.

    `select`, `maximum`, `minimum` and `square_root` take numbers, too, in place of all vectors and masks: rules that
    hold for one cell and for `LANES` are stated once by them. A number beside a vector is in every lane.
    """

    def typed(*given: Any) -> Any:
        kinds = [kind or one for kind, one in zip(parameters, given, strict=True)]
        other: dict[Any, Any] = {}
        if all(isinstance(one, types.Number | types.Boolean) for one in given) and _VECTOR_TYPE in kinds:
            other = {_MASK_TYPE: types.boolean, _VECTOR_TYPE: types.float64}
        elif any(getattr(one, "dtype", one) in (types.float32, _FLOATS_TYPE, _FLOATS_MASK_TYPE) for one in given):
            other = {_MASK_TYPE: _FLOATS_MASK_TYPE, _VECTOR_TYPE: _FLOATS_TYPE}
        return other.get(result, result)(*(other.get(kind, kind) for kind in kinds)), lower

    def lower(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        operands = [
            context.make_array(kind)(context, builder, value).data if isinstance(kind, types.Array) else value
            for kind, value in zip(signature.args, values, strict=True)
        ]
        made = generate(builder, *operands)
        return context.get_dummy_value() if result is types.void else made

    # numba inspects the number of parameters
    forms: dict[int, Callable[..., Any]] = {
        1: lambda _, x: typed(x),
        2: lambda _, x, y: typed(x, y),
        3: lambda _, x, y, z: typed(x, y, z),
        4: lambda _, w, x, y, z: typed(w, x, y, z),
    }
    return intrinsic(forms[len(parameters)])


load = instruction(
    lambda builder, *place: builder.load(_row_address(builder, *place), align=8), _VECTOR_TYPE, None, types.intp
)
"""load(array, row): a row of an array (rows, LANES); row 0 of an array (LANES,)."""

gather = instruction(_gather, _VECTOR_TYPE, None, None)
"""gather(array, places): element `places[i]` of an array (cells,) in lane i."""

pick = instruction(_pick, _VECTOR_TYPE, None, _VECTOR_TYPE)
"""pick(array, places): element `places[i]`, a whole number, of an array (cells,) in lane i."""

store = instruction(
    lambda builder, array, row, x: builder.store(x, _row_address(builder, array, row), align=8),
    *(types.void, None, types.intp, _VECTOR_TYPE),
)
"""store(array, row, x): set a row."""

store_where = instruction(
    lambda builder, array, row, mask, x: _store_where(builder, _row_address(builder, array, row), mask, x),
    *(types.void, None, types.intp, _MASK_TYPE, _VECTOR_TYPE),
)
"""store_where(array, row, mask, x): set the lanes of a row in which the mask is true."""

splat = instruction(_splat, _VECTOR_TYPE, types.float64)  # splat(number): the number in every lane
absolute = instruction(_absolute, _VECTOR_TYPE, _VECTOR_TYPE)  # absolute(x), lane by lane

maximum = instruction(lambda builder, x, y: builder.select(builder.fcmp_ordered(">", x, y), x, y), *[_VECTOR_TYPE] * 3)
"""maximum(x, y), lane by lane."""

minimum = instruction(lambda builder, x, y: builder.select(builder.fcmp_ordered("<", x, y), x, y), *[_VECTOR_TYPE] * 3)
"""minimum(x, y), lane by lane."""

approx_log2 = instruction(_approx_log2, _VECTOR_TYPE, _VECTOR_TYPE)
"""log2 of positive numbers from the bits of the doubles read as integers: at most 0.09 too small; -1023 for 0."""

approx_exp2 = instruction(_approx_exp2, _VECTOR_TYPE, _VECTOR_TYPE)
"""2**x for |x| < 1000, up to 6 % too large: the inverse of `approx_log2`."""


square_root = instruction(_square_root, _VECTOR_TYPE, _VECTOR_TYPE)  # square_root(x), lane by lane, correctly rounded
power_of_two = instruction(_power_of_two, _VECTOR_TYPE, _VECTOR_TYPE)  # 2**x of integers x from -1022 to 1023

sine_of_quadrant = instruction(lambda builder, n, s, c: _of_quadrant(builder, n, s, c, 0), *[_VECTOR_TYPE] * 4)
"""sine_of_quadrant(n, s, c): sin(r + n pi/2) of integers n from s = sin(r) and c = cos(r)."""

cosine_of_quadrant = instruction(lambda builder, n, s, c: _of_quadrant(builder, n, c, s, 1), *[_VECTOR_TYPE] * 4)
"""cosine_of_quadrant(n, s, c): cos(r + n pi/2), as `sine_of_quadrant`."""

select = instruction(
    lambda builder, mask, x, y: builder.select(mask, x, y), _VECTOR_TYPE, _MASK_TYPE, _VECTOR_TYPE, _VECTOR_TYPE
)
"""select(mask, x, y): x where the mask is true, else y."""

lane_bits = instruction(
    lambda builder, mask: builder.zext(builder.bitcast(mask, ir.IntType(mask.type.count)), ir.IntType(64)),
    *(types.int64, _MASK_TYPE),
)
"""lane_bits(mask): an integer with bit i set where lane i is true."""

any_lane = instruction(
    lambda builder, mask: builder.icmp_unsigned(
        "!=", builder.bitcast(mask, number := ir.IntType(mask.type.count)), ir.Constant(number, 0)
    ),
    *(types.boolean, _MASK_TYPE),
)
"""any_lane(mask): whether it is true in some lane."""

fill_mask = instruction(
    lambda builder, value: builder.select(
        value, ir.Constant(_LLVM_MASK, [True] * LANES), ir.Constant(_LLVM_MASK, [False] * LANES)
    ),
    *(_MASK_TYPE, types.boolean),
)
"""fill_mask(value): the truth value in every lane."""

gather_rows = instruction(_gather_rows, types.void, None, None, None)
"""gather_rows(source, places, target): row `places[i]` of `source` becomes column i of `target` (LANES, LANES)."""

scatter_rows = instruction(_scatter_rows, types.void, None, None, None)
"""scatter_rows(source, places, target): the inverse, column i of `source` becomes row `places[i]` of `target`."""


def _operation(operation: Any, generate: Callable[..., Any], vector: Any, result: Any) -> None:
    """Define `operation` for two vectors, or a vector and a number."""

    @type_callable(operation)
    def typing(_: Any) -> Any:
        def typed(x: Any, y: Any) -> Any:
            if vector not in (x, y) or not all(one == vector or isinstance(one, types.Number) for one in (x, y)):
                return None
            return result(*(one if one == vector else types.float64 for one in (x, y)))

        return typed

    def lower(_: Any, builder: Any, sig: Any, args: Any) -> Any:
        kinds = zip(sig.args, args, strict=True)
        return generate(builder, *(x if kind == vector else _splat(builder, x, vector.vector) for kind, x in kinds))

    for left, right in ((vector, vector), (vector, types.float64), (types.float64, vector)):
        lower_builtin(operation, left, right)(lower)


def _mask_operation(operation: Any, generate: Callable[..., Any], mask: Any) -> None:
    """Define `operation` for two masks."""

    @type_callable(operation)
    def typing(_: Any) -> Any:
        return lambda x, y: mask if x == y == mask else None

    lower_builtin(operation, mask, mask)(lambda _, builder, __, masks: generate(builder, *masks))


_ARITHMETIC = {
    "fadd": (operator.add, operator.iadd),
    "fsub": (operator.sub, operator.isub),
    "fmul": (operator.mul, operator.imul),
    "fdiv": (operator.truediv,),
}
_COMPARISONS = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge, "==": operator.eq}
_OF_MASKS = {"and_": (operator.and_, operator.iand), "or_": (operator.or_, operator.ior)}
for _vector, _mask in ((_VECTOR_TYPE, _MASK_TYPE), (_FLOATS_TYPE, _FLOATS_MASK_TYPE)):
    for _name, _operators in _ARITHMETIC.items():
        for _operator in _operators:
            _operation(_operator, lambda builder, x, y, name=_name: getattr(builder, name)(x, y), _vector, _vector)
    for _name, _operator in _COMPARISONS.items():
        _operation(_operator, lambda builder, x, y, name=_name: builder.fcmp_ordered(name, x, y), _vector, _mask)
    for _name, _operators in _OF_MASKS.items():
        for _operator in _operators:
            _mask_operation(_operator, lambda builder, x, y, name=_name: getattr(builder, name)(x, y), _mask)
    lower_builtin(operator.invert, _mask)(lambda _, builder, __, masks: builder.not_(*masks))


@type_callable(operator.invert)
def _(_: Any) -> Any:
    return lambda x: x if x in (_MASK_TYPE, _FLOATS_MASK_TYPE) else None
