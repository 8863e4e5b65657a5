"""Siano's group, (4.4) to (4.9), table 1, and tests of proposed groups."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking.errors import InvalidArgumentError
from rocking.orientation import (
    VARIABLES,
    Orientation,
    admissible_exponents,
    is_group,
    is_homogeneous,
    multiplication_table,
    orientation_of_function,
    quantity_of,
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


def test_admissible_exponents_without_oriented_factors():
    assert admissible_exponents(L0, {"eta": L0}) == [{}]
    assert admissible_exponents(LZ, {"eta": L0}) == []


@pytest.mark.parametrize(
    "group",
    [
        "theta/alpha",
        "theta*g/a_g",
        "a_g/(alpha*g)",
        "g*alpha/a_g",
        "p*t",
        "omega_g/p",
        "g*tan(alpha)/a_g",
        "cos(alpha)",
        "theta*g/(a_g*cos(alpha))",
        "sin(alpha)*alpha",
        "theta**2",
        "eta",
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
    ["", "theta+alpha", "mass*g", "exp(theta)", "theta**eta", "sin(g)", "theta(", "sin(theta, alpha)", "'theta'"],
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
