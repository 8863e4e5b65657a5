"""Orientational analysis (Siano 1985): similarity groups must be dimensionless and without orientation.

A vector along x carries the orientation l_x, an angle in the x-y plane l_z, a scalar l_0. Orientations multiply as
Klein's four-group, (4.4) and (4.5), and both sides of a physical equation must carry the same one, (4.8). Figure 1
lies in the x-y plane: the ground moves along x, gravity acts along y, rotations are about z.

Limit of the method: by (4.5) every even power is without orientation. `alpha**2` and `theta*alpha**2*g/a_g` therefore
pass the test of a group, although no equation of rocking contains them alone. The test is necessary, not sufficient;
which of the admissible exponents are right follows from the equation of motion, the terms of which
`is_homogeneous_equation` compares one by one.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from itertools import product

from rocking._base.errors import InvalidArgumentError, integer, one_of


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
    """Orientation and dimension of a physical quantity: `length`, `time`, `mass` are exponents of [L], [T], [M]."""

    orientation: Orientation
    length: int = 0
    time: int = 0
    mass: int = 0

    def __mul__(self, other: Quantity) -> Quantity:
        return Quantity(
            self.orientation * other.orientation,
            self.length + other.length,
            self.time + other.time,
            self.mass + other.mass,
        )

    def __truediv__(self, other: Quantity) -> Quantity:
        return self * other**-1

    def __pow__(self, exponent: int) -> Quantity:
        powers = (exponent * self.length, exponent * self.time, exponent * self.mass)
        return Quantity(self.orientation**exponent, *powers)

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
    "m": Quantity(Orientation.L0, mass=1),
    "R": Quantity(Orientation.LY, 1),  # so that b = R sin(alpha) is along x and h = R cos(alpha) along y
    "b": Quantity(Orientation.LX, 1),
    "h": Quantity(Orientation.LY, 1),
    "I": Quantity(Orientation.L0, 2, mass=1),  # m times squares of lengths
}
"""The characteristic variables of the rocking block, (4.7), and those of its equation of motion (2.1)."""

_FUNCTIONS: Mapping[str, Callable[[float], float]] = {"sin": math.sin, "cos": math.cos, "tan": math.tan}

_SIGN = "sgn"
"""The sign of an angle, theta/|theta|: angle and magnitude have the same orientation, their quotient has none."""

MAX_COMBINATIONS = 1_000_000  # most combinations of exponents that are tried [-]


def quantity_of(expression: str) -> Quantity:
    """Orientation and dimension of a proposed group, or of a sum whose terms agree in both.

    Parameters
    ----------
    expression : str
        Names in `VARIABLES`, with `+`, `-`, `*`, `/`, `**` (integer), brackets, numbers and sin, cos, tan, sgn:
        `"theta*g/a_g"`, `"g*tan(alpha)/a_g"`, `"sin(alpha - theta)"`.

    Raises
    ------
    InvalidArgumentError
        For any other expression, and for a sum of terms that differ in orientation or dimension; the message quotes
        the part.
    """
    return _evaluate(_parsed(expression))


def _parsed(expression: str) -> ast.expr:
    try:
        return ast.parse(expression.strip(), mode="eval").body
    except SyntaxError:
        raise InvalidArgumentError("expression", expression, "a product such as theta*g/a_g") from None


def _terms(node: ast.expr) -> list[ast.expr]:
    """The terms of a sum, without their signs; zero, which has any orientation, is no term."""
    match node:
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub(), right=right):
            return _terms(left) + _terms(right)
        case ast.UnaryOp(op=ast.UAdd() | ast.USub(), operand=operand):
            return _terms(operand)
        case ast.Constant(value=0):
            return []
        case _:
            return [node]


def terms_of_equation(equation: str) -> dict[str, Quantity]:
    """Orientation and dimension of each term of an equation.

    Parameters
    ----------
    equation : str
        Two sides, each as in `quantity_of`, joined by `=`. A time derivative is written as a quotient: theta/t**2.

    Returns
    -------
    dict
        Each term, without its sign, with its quantity.

    Raises
    ------
    InvalidArgumentError
        For anything else; for a sum inside a product or function whose terms differ.

    Examples
    --------
    >>> [quantity.orientation.symbol for quantity in terms_of_equation("I*theta/t**2 = -m*g*R*sin(alpha)").values()]
    ['lz', 'lz']
    """
    sides = equation.split("=")
    if len(sides) != 2:
        raise InvalidArgumentError("equation", equation, "two sides joined by =")
    terms = [term for side in sides for term in _terms(_parsed(side))]
    return {ast.unparse(term): _evaluate(term) for term in terms}


def is_homogeneous_equation(equation: str) -> bool:
    """True if all terms of an equation, as in `terms_of_equation`, have one orientation and one dimension."""
    return len(set(terms_of_equation(equation).values())) <= 1


def _evaluate(node: ast.expr) -> Quantity:
    match node:
        case ast.BinOp(op=ast.Add() | ast.Sub()) | ast.UnaryOp(op=ast.UAdd() | ast.USub()):
            found = {_evaluate(term) for term in _terms(node)}
            if len(found) > 1:
                raise InvalidArgumentError(
                    "expression", ast.unparse(node), "a sum of terms of one orientation and dimension"
                )
            return found.pop() if found else Quantity(Orientation.L0)
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
            if inner.length or inner.time or inner.mass:
                raise InvalidArgumentError("expression", ast.unparse(node), "a function of a dimensionless argument")
            if name == _SIGN:
                return Quantity(Orientation.L0)
            function = _FUNCTIONS[one_of("expression", name, (*_FUNCTIONS, _SIGN))]
            return Quantity(orientation_of_function(function, inner.orientation))
        case _:
            raise InvalidArgumentError(
                "expression", ast.unparse(node), "names, +, -, *, /, ** with an integer, sin, cos, tan, sgn"
            )


def is_group(expression: str) -> bool:
    """True if the proposed group, as in `quantity_of`, is dimensionless and orientationless.

    This is necessary for a similarity group, not sufficient: `alpha**2` passes, since (4.5) takes the orientation from
    every even power.
    """
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
    target, factors
        As for `is_homogeneous`; factors without orientation are free and left out of the answer.
    largest : int
        Largest absolute value of an exponent, >= 0; at most 1,000,000 combinations are tried.

    Returns
    -------
    list of dict
        For theta_max = phi(omega, a_g/g, alpha, eta) all pairs whose sum is odd, (4.9).

    Notes
    -----
    The paper prints a_g/a for a_g/g in (4.8); (4.3) and (4.7) have a_g/g.
    """
    oriented = {name: orientation for name, orientation in factors.items() if orientation is not Orientation.L0}
    highest = int(0.5 * (MAX_COMBINATIONS ** (1.0 / max(len(oriented), 1)) - 1.0))
    most = integer("largest", largest, 0, highest)
    choices = product(range(-most, most + 1), repeat=len(oriented))
    candidates = (dict(zip(oriented, choice, strict=True)) for choice in choices)
    return [exponents for exponents in candidates if is_homogeneous(target, oriented, exponents)]  # (4.8), (4.9)


@dataclass(frozen=True)
class Scaling:
    """What the exponents of (4.8) say about a response: response/scale = phi(group)."""

    scale: str
    group: dict[str, int]


def scaling_of_exponents(exponents: Mapping[str, int]) -> Scaling:
    """Split the product of (4.8) into one oriented factor, the scale of the response, and a group without orientation.

    By (4.4) the scale may have exponent -1 as well as 1; the exponents of the group sum to zero. Of the splits that
    exist this is the one with the smallest exponents in the group.

    Parameters
    ----------
    exponents : mapping of str to int
        Exponents of dimensionless factors that all carry the orientation of the response; their sum is 1 or -1.

    Raises
    ------
    InvalidArgumentError
        For another sum: such a product has no single factor as its scale.

    Examples
    --------
    >>> scaling_of_exponents({"a_g/g": 1, "alpha": -2})  # (4.10)
    Scaling(scale='alpha', group={'a_g/g': 1, 'alpha': -1})
    >>> scaling_of_exponents({"a_g/g": -2, "alpha": 1})  # (4.11)
    Scaling(scale='a_g/g', group={'a_g/g': -1, 'alpha': 1})
    """
    total = sum(exponents.values())
    if abs(total) != 1:
        raise InvalidArgumentError("exponents", dict(exponents), "exponents whose sum is 1 or -1")
    splits = [
        Scaling(scale, {name: exponent - total * (name == scale) for name, exponent in exponents.items()})
        for scale in exponents
    ]
    return min(splits, key=lambda split: max(map(abs, split.group.values())))
