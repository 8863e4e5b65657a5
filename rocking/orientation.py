"""Orientational analysis (Siano 1985): similarity groups must be dimensionless and without orientation.

A vector along x carries the orientation l_x, an angle in the x-y plane l_z, a scalar l_0. Orientations multiply as
Klein's four-group, (4.4) and (4.5), and both sides of a physical equation must carry the same one, (4.8). Figure 1
lies in the x-y plane: the ground moves along x, gravity acts along y, rotations are about z.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from itertools import product

from rocking.errors import InvalidArgumentError, one_of


class Orientation(Enum):
    """Unit orientations, represented by pairs of parities. A product adds them modulo 2."""

    L0 = (0, 0)
    LX = (1, 0)
    LY = (0, 1)
    LZ = (1, 1)

    def __mul__(self, other: Orientation) -> Orientation:
        return Orientation(((self.value[0] + other.value[0]) % 2, (self.value[1] + other.value[1]) % 2))  # table 1

    def inverse(self) -> Orientation:
        """The inverse orientation, which is the orientation itself, (4.4)."""
        return self**-1

    def __truediv__(self, other: Orientation) -> Orientation:
        return self * other.inverse()

    def __pow__(self, exponent: int) -> Orientation:
        """l^(2n) = l_0 and l^(2n+1) = l for any integer n, (4.5)."""
        return self if exponent % 2 else Orientation.L0  # (4.5), and with exponent -1 (4.4)

    @property
    def symbol(self) -> str:
        """`l0`, `lx`, `ly` or `lz`, as in the paper."""
        return self.name.lower()


def multiplication_table() -> tuple[tuple[Orientation, ...], ...]:
    """Table 1 of the paper, computed: row times column, both in the order l_0, l_x, l_y, l_z."""
    return tuple(tuple(row * column for column in Orientation) for row in Orientation)


def orientation_of_function(function: Callable[[float], float], argument: Orientation) -> Orientation:
    """Orientation of function(x) for an argument of given orientation, (4.6).

    Parameters
    ----------
    function : callable
        Real function of a real variable, analytic at 0 (`math.cos`, `math.tan`, ...), evaluated up to |x| = 1.2.
    argument : Orientation
        Orientation of x.

    Returns
    -------
    Orientation
        l_0 for an even function (all powers of its series even), that of the argument for an odd one.

    Raises
    ------
    InvalidArgumentError
        For a function of an oriented argument that is neither even nor odd, such as exp: the terms of its series have
        different orientations.
    """
    if argument is Orientation.L0:
        return argument
    pairs = [(function(x), function(-x)) for x in (0.1, 0.3, 0.7, 1.2)]
    if all(math.isclose(right, left, rel_tol=1e-12) for right, left in pairs):
        return argument**2  # (4.6): every term is an even power
    if all(math.isclose(right, -left, rel_tol=1e-12) for right, left in pairs):
        return argument
    name = getattr(function, "__name__", repr(function))
    raise InvalidArgumentError("function", name, f"an even or odd function of an argument oriented {argument.symbol}")


@dataclass(frozen=True)
class Quantity:
    """Orientation and dimension of a physical quantity: `length` and `time` are exponents of [L] and [T]."""

    orientation: Orientation
    length: int = 0
    time: int = 0

    def __mul__(self, other: Quantity) -> Quantity:
        return Quantity(self.orientation * other.orientation, self.length + other.length, self.time + other.time)

    def __truediv__(self, other: Quantity) -> Quantity:
        return self * other**-1

    def __pow__(self, exponent: int) -> Quantity:
        return Quantity(self.orientation**exponent, exponent * self.length, exponent * self.time)

    @property
    def is_free(self) -> bool:
        """Whether the quantity is dimensionless and without orientation, as a similarity group must be."""
        return self == Quantity(Orientation.L0)


VARIABLES: Mapping[str, Quantity] = {
    "theta": Quantity(Orientation.LZ),  # an angle in the x-y plane
    "alpha": Quantity(Orientation.LZ),
    "a_g": Quantity(Orientation.LX, 1, -2),  # the ground moves along x
    "g": Quantity(Orientation.LY, 1, -2),  # gravity acts along y
    "omega_g": Quantity(Orientation.L0, 0, -1),  # angular frequencies carry none (Siano 1985)
    "p": Quantity(Orientation.L0, 0, -1),
    "t": Quantity(Orientation.L0, 0, 1),
    "eta": Quantity(Orientation.L0),
}
"""The characteristic variables of the rocking block, (4.7)."""

_FUNCTIONS: Mapping[str, Callable[[float], float]] = {"sin": math.sin, "cos": math.cos, "tan": math.tan}


def quantity_of(expression: str) -> Quantity:
    """Orientation and dimension of a proposed group.

    Parameters
    ----------
    expression : str
        Product of powers of the names in `VARIABLES`, with `*`, `/`, `**` (integer), brackets, numbers and sin, cos,
        tan: `"theta*g/a_g"`, `"g*tan(alpha)/a_g"`.

    Raises
    ------
    InvalidArgumentError
        For any other expression; the message quotes the part.
    """
    try:
        tree = ast.parse(expression, mode="eval").body
    except SyntaxError:
        raise InvalidArgumentError("expression", expression, "a product such as theta*g/a_g") from None
    return _evaluate(tree)


def _evaluate(node: ast.expr) -> Quantity:
    match node:
        case ast.Name(id=name):
            return VARIABLES[one_of("expression", name, VARIABLES)]
        case ast.Constant(value=int() | float()):
            return Quantity(Orientation.L0)
        case ast.BinOp(left=left, op=ast.Mult(), right=right):
            return _evaluate(left) * _evaluate(right)
        case ast.BinOp(left=left, op=ast.Div(), right=right):
            return _evaluate(left) / _evaluate(right)
        case ast.BinOp(left=left, op=ast.Pow(), right=ast.Constant(value=int(exponent))):
            return _evaluate(left) ** exponent
        case ast.BinOp(
            left=left, op=ast.Pow(), right=ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int(exponent)))
        ):
            return _evaluate(left) ** -exponent
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]):
            inner = _evaluate(argument)
            if inner.length or inner.time:
                raise InvalidArgumentError("expression", ast.unparse(node), "a function of a dimensionless argument")
            function = _FUNCTIONS[one_of("expression", name, _FUNCTIONS)]
            return Quantity(orientation_of_function(function, inner.orientation))
        case _:
            raise InvalidArgumentError(
                "expression", ast.unparse(node), "names, *, /, ** with an integer, sin, cos, tan"
            )


def is_group(expression: str) -> bool:
    """True if the proposed group, as in `quantity_of`, is dimensionless and orientationless."""
    return quantity_of(expression).is_free


def is_homogeneous(target: Orientation, factors: Mapping[str, Orientation], exponents: Mapping[str, int]) -> bool:
    """Orientational homogeneity of target = product of factor^exponent, (4.8).

    Parameters
    ----------
    target : Orientation
        Orientation of the left side.
    factors : mapping of str to Orientation
        The arguments of the response function.
    exponents : mapping of str to int
        An exponent for each of them.
    """
    total = Orientation.L0
    for name, orientation in factors.items():
        total = total * orientation ** exponents[name]
    return total is target


def admissible_exponents(
    target: Orientation, factors: Mapping[str, Orientation], largest: int = 2
) -> list[dict[str, int]]:
    """All exponents up to a size for which (4.8) is homogeneous.

    Parameters
    ----------
    target : Orientation
        Orientation of the left side.
    factors : mapping of str to Orientation
        The arguments of the response function; those without orientation are free and left out of the answer.
    largest : int
        Largest absolute value of an exponent, >= 0.

    Returns
    -------
    list of dict
        For theta_max = phi(omega, a_g/g, alpha, eta) all pairs whose sum is odd, (4.9).

    Notes
    -----
    The paper prints a_g/a for a_g/g in (4.8); (4.3) and (4.7) have a_g/g.
    """
    oriented = {name: orientation for name, orientation in factors.items() if orientation is not Orientation.L0}
    choices = product(range(-largest, largest + 1), repeat=len(oriented))
    candidates = (dict(zip(oriented, choice, strict=True)) for choice in choices)
    return [exponents for exponents in candidates if is_homogeneous(target, oriented, exponents)]  # (4.8), (4.9)
