"""Siano's group, (4.4) to (4.9), table 1, and tests of proposed groups."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking._base.errors import InvalidArgumentError
from rocking.paper import (
    VARIABLES,
    Orientation,
    admissible_exponents,
    is_group,
    is_homogeneous,
    is_homogeneous_equation,
    multiplication_table,
    orientation_of_function,
    quantity_of,
    scaling_of_exponents,
    terms_of_equation,
)

L0, LX, LY, LZ = Orientation
orientations = st.sampled_from(Orientation)


def test_table_1_as_printed():
    printed = """
        l0 lx ly lz
        lx l0 lz ly
        ly lz l0 lx
        lz ly lx l0"""
    assert [[o.symbol for o in row] for row in multiplication_table()] == [
        line.split() for line in printed.strip().splitlines()
    ]


@given(orientations, orientations, orientations)
def test_orientations_are_a_commutative_group(a, b, c):
    assert (a * b) * c is a * (b * c)
    assert a * b is b * a
    assert a * L0 is a
    assert a * a.inverse() is L0


@given(orientations, st.integers(-9, 9))
def test_powers(a, n):
    assert a.inverse() is a  # (4.4)
    assert a**2 is L0  # (4.4)
    assert a ** (2 * n + 1) is a  # (4.5)
    assert a ** (2 * n) is L0  # (4.5)
    assert a / a is L0


def test_functions_of_an_angle():
    assert orientation_of_function(math.cos, LZ) is L0  # (4.6)
    assert orientation_of_function(math.sin, LZ) is LZ
    assert orientation_of_function(math.tan, LZ) is LZ  # (4.6): tan = sin/cos = l_z/l_0
    assert orientation_of_function(math.exp, L0) is L0
    with pytest.raises(InvalidArgumentError, match="'exp'"):
        orientation_of_function(math.exp, LZ)


def test_variables_of_the_rocking_block():
    assert quantity_of("theta").orientation is LZ  # (4.7)
    assert quantity_of("omega_g/p").is_free  # (4.7)
    assert quantity_of("a_g/g").orientation is LZ  # (4.7): l_x/l_y
    assert quantity_of("a_g/g").length == quantity_of("a_g/g").time == 0
    assert quantity_of("alpha").orientation is LZ  # (4.7)
    assert quantity_of("eta").is_free  # (4.7)


def test_admissible_exponents_have_an_odd_sum():
    arguments = {name: quantity_of(name).orientation for name in ("omega_g/p", "a_g/g", "alpha", "eta")}
    found = admissible_exponents(LZ, arguments)  # (4.8)
    assert found
    assert all((e["a_g/g"] + e["alpha"]) % 2 == 1 for e in found)  # (4.9)
    assert len(found) == 12  # of 25 pairs in -2..2
    assert {"a_g/g": 1, "alpha": -2} in found  # the groups of (4.10)
    assert {"a_g/g": -2, "alpha": 1} in found  # the groups of (4.11)
    assert all(is_homogeneous(LZ, {k: arguments[k] for k in e}, e) for e in found)
    assert not is_homogeneous(LZ, {"a_g/g": LZ, "alpha": LZ}, {"a_g/g": 1, "alpha": 1})


@pytest.mark.parametrize(
    "group",
    [
        "theta/alpha",
        "theta*g/a_g",
        "p*t",
        "g*tan(alpha)/a_g",
        "cos(alpha)",
        "theta*g/(a_g*cos(alpha))",
        "theta**2",
        "theta*alpha**-1",
        "2*theta*(alpha)**-1",
    ],
)
def test_proposed_groups_that_hold(group):
    assert is_group(group)


@pytest.mark.parametrize(
    "group", ["theta", "alpha", "a_g/g", "g*a_g", "theta*p", "sin(alpha)", "theta*g/a_g**2", "omega_g", "a_g/alpha"]
)
def test_proposed_groups_that_fail(group):
    assert not is_group(group)


@pytest.mark.parametrize(
    "expression",
    [
        "",
        "theta+eta",
        "mass*g",
        "exp(theta)",
        "theta**eta",
        "sin(g)",
        "theta(",
        "'theta'",
    ],
)
def test_expressions_that_are_no_product_are_rejected(expression):
    with pytest.raises(InvalidArgumentError, match="`expression`"):
        quantity_of(expression)


def test_dimensional_analysis_alone_cannot_combine_the_groups():
    # theta, alpha and a_g/g are dimensionless one by one: only their orientation forbids them as groups, below (4.3)
    for name in ("theta", "alpha", "a_g/g"):
        found = quantity_of(name)
        assert (found.length, found.time) == (0, 0)
        assert not found.is_free
    involved = ("theta", "alpha", "p", "a_g/g", "omega_g", "eta")  # (4.2)
    assert len(involved) == 6
    assert {quantity_of(name).length for name in involved} == {0}  # only time is left, [T]
    assert set(VARIABLES) >= {"theta", "alpha", "p", "a_g", "g", "omega_g", "eta"}


@pytest.mark.parametrize(
    ("equation", "count"),
    [
        ("I*theta/t**2 + m*g*R*sin(alpha - theta) = -m*a_g*R*cos(alpha - theta)", 3),  # (2.1), theta > 0
        ("I*theta/t**2 + m*g*R*sin(-alpha - theta) = -m*a_g*R*cos(-alpha - theta)", 3),  # (2.1), theta < 0
        ("theta/t**2/p**2 = -sin(alpha*sgn(theta) - theta) - a_g/g*cos(alpha*sgn(theta) - theta)", 3),  # (2.2)
        ("theta/t**2 - p**2*theta + p**2*alpha*sgn(theta) = -p**2*a_g/g", 4),  # (3.1)
        (
            "theta/t**2/p**2 + cos(alpha)*((a_g/g*tan(alpha) - 1)*sin(theta) + (tan(alpha) + a_g/g)*cos(theta)) = 0",
            2,
        ),  # (5.1), theta > 0
        (
            "theta/t**2/p**2 - cos(alpha)*((a_g/g*tan(alpha) + 1)*sin(theta) + (tan(alpha) - a_g/g)*cos(theta)) = 0",
            2,
        ),  # (5.1), theta < 0, corrected
    ],
    ids=["(2.1) +", "(2.1) -", "(2.2)", "(3.1)", "(5.1) +", "(5.1) -"],
)
def test_terms_of_the_equations_of_motion_have_one_orientation(equation, count):
    terms = terms_of_equation(equation)
    assert len(terms) == count
    assert is_homogeneous_equation(equation)
    assert {quantity.orientation for quantity in terms.values()} == {LZ}


@pytest.mark.parametrize(
    "equation",
    [
        "theta/t**2/p**2 = -sin(alpha) - a_g/g*sin(alpha)",  # sin for cos: l_0
        "theta/t**2 - p**2*theta = -p**2*a_g",  # without g: another dimension and orientation
        "I*theta/t**2 = -m*g*b*sin(alpha)",  # b for R
        "theta/t**2 = -p*a_g/g",  # p for p squared
    ],
)
def test_wrong_equations_are_not_homogeneous(equation):
    assert not is_homogeneous_equation(equation)


def test_even_powers_pass_the_test_of_a_group_although_no_group_of_rocking():
    # the limit of the method that the module docstring states: (4.5) removes the orientation of even powers
    for group in ("alpha**2", "theta*alpha**2*g/a_g", "theta*alpha"):
        assert is_group(group)
    # the equation of motion tells them apart: scaled with alpha**2 its terms differ
    assert is_homogeneous_equation("theta/t**2/p**2 = alpha*sgn(theta)")
    assert not is_homogeneous_equation("theta/t**2/p**2 = alpha**2*sgn(theta)")


def test_exponents_of_the_paper_give_its_groups():
    by_block = scaling_of_exponents({"a_g/g": 1, "alpha": -2})
    assert (by_block.scale, by_block.group) == (
        "alpha",
        {"a_g/g": 1, "alpha": -1},
    )  # (4.10): theta/alpha, a_g/(g alpha)
    by_pulse = scaling_of_exponents({"a_g/g": -2, "alpha": 1})
    assert (by_pulse.scale, by_pulse.group) == ("a_g/g", {"a_g/g": -1, "alpha": 1})  # (4.11): theta g/a_g, g alpha/a_g
    for scaling in (by_block, by_pulse):
        assert is_group(f"theta/({scaling.scale})")
        assert is_group("*".join(f"({name})**{exponent}" for name, exponent in scaling.group.items()))
    with pytest.raises(InvalidArgumentError, match="sum is 1 or -1"):
        scaling_of_exponents({"a_g/g": 3, "alpha": 0})
