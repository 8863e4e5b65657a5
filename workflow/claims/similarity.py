"""Claims of section 4 on orientation and self-similarity."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import xarray as xr

from rocking._excitation.pulses import PULSE_NAMES
from rocking._history.time_history import time_history
from rocking._model.block import RectangularBlock
from rocking.paper.orientation import (
    Orientation,
    Scaling,
    admissible_exponents,
    is_group,
    is_homogeneous_equation,
    multiplication_table,
    quantity_of,
    scaling_of_exponents,
)
from workflow.claims.area import Floats
from workflow.claims.claim import SAME, Claim
from workflow.figures.dimensional import DimensionalProblem

PRINTED_TABLE_1 = ("0xyz", "x0zy", "yz0x", "zyx0")

PRINTED_EXPONENTS = {"(4.10)": {"a_g/g": 1, "alpha": -2}, "(4.11)": {"a_g/g": -2, "alpha": 1}}

PRINTED_GROUPS = {
    "(4.10)": Scaling("alpha", {"a_g/g": 1, "alpha": -1}),  # theta/alpha over a_g/(alpha g)
    "(4.11)": Scaling("a_g/g", {"a_g/g": -1, "alpha": 1}),  # theta g/a_g over alpha g/a_g
}

EQUATIONS = {
    "(2.2)": "theta/t**2/p**2 = -sin(alpha*sgn(theta) - theta) - a_g/g*cos(alpha*sgn(theta) - theta)",
    "(3.1)": "theta/t**2 - p**2*theta + p**2*alpha*sgn(theta) = -p**2*a_g/g",
    "(5.1)": "theta/t**2/p**2 + cos(alpha)*((a_g/g*tan(alpha) - 1)*sin(theta) + (tan(alpha) + a_g/g)*cos(theta)) = 0",
}


def computed_table() -> tuple[str, ...]:
    """Table 1 computed from the rules, a letter for each product."""
    return tuple("".join(product.symbol[1] for product in row) for row in multiplication_table())


def table(found: Sequence[str]) -> Iterator[Claim]:
    """Table 1 against a computed one."""
    equal = [a == b for x, y in zip(found, PRINTED_TABLE_1, strict=True) for a, b in zip(x, y, strict=True)]
    yield Claim(
        key="table-1",
        fails_if="only by a misprint: the products follow from the rules",
        identity=True,
        place="section 4, table 1",
        printed="products of the unit orientations",
        criterion="all 16 follow from the rules (4.4) and (4.5)",
        found=f"{sum(equal)} do",
        share=float(np.mean(equal)),
        numbers={"equal_entries": sum(equal)},
    )


def independent_products() -> tuple[int, int]:
    """The number of variables of (4.2), and how many of their dimensions are independent."""
    variables = [quantity_of(name) for name in ("theta", "alpha", "p", "a_g/g", "omega_g", "eta")]
    return len(variables), int(np.linalg.matrix_rank([[one.length, one.time, one.mass] for one in variables]))


def count_of_products(variables: int, dimensions: int) -> Iterator[Claim]:
    """The number of dimensionless products of (4.2)."""
    yield Claim(
        key="five-products",
        fails_if="only by a slip in the list of variables or their dimensions",
        place="section 4, above (4.3)",
        printed="six variables that involve one dimension have five independent dimensionless products",
        criterion="the variables of (4.2), less the rank of the matrix of their dimensional exponents",
        found=f"{variables} - {dimensions} = {variables - dimensions}",
        share=variables - dimensions == 5,
        identity=True,
        numbers={"variables": variables, "dimensions": dimensions},
    )


def homogeneous_pairs() -> list[tuple[int, int]]:
    """The exponents (epsilon_2, epsilon_3) up to 4 in size for which (4.8) is homogeneous."""
    factors = {"a_g/g": Orientation.LZ, "alpha": Orientation.LZ}
    return [(found["a_g/g"], found["alpha"]) for found in admissible_exponents(Orientation.LZ, factors, largest=4)]


def odd_exponents(pairs: Sequence[tuple[int, int]]) -> Iterator[Claim]:
    """(4.9): homogeneity of (4.8) is the same as an odd sum of exponents."""
    every = [(m, n) for m in range(-4, 5) for n in range(-4, 5)]
    agree = [((m + n) % 2 == 1) == ((m, n) in pairs) for m, n in every]
    yield Claim(
        key="odd-exponents",
        fails_if="only by a slip: parities add in a product",
        identity=True,
        place="section 4, (4.9)",
        printed="homogeneity of (4.8) requires epsilon_2 + epsilon_3 to be odd",
        criterion=f"of the {len(every)} pairs of exponents from -4 to 4 those with an odd sum, and no others, give "
        "both sides one orientation",
        found=f"so for {sum(agree)} pairs; {len(pairs)} are homogeneous",
        share=float(np.mean(agree)),
        numbers={"pairs": len(every), "agree": sum(agree), "homogeneous": len(pairs)},
    )


def scalings() -> dict[str, Scaling]:
    """The scale and the group to which the exponents of the paper lead."""
    return {equation: scaling_of_exponents(exponents) for equation, exponents in PRINTED_EXPONENTS.items()}


def exponents_give_groups(found: Mapping[str, Scaling]) -> Iterator[Claim]:
    """Whether the exponents that the paper chooses lead to the groups that it states."""
    equal = [found[equation] == printed for equation, printed in PRINTED_GROUPS.items()]
    yield Claim(
        key="exponents-give-groups",
        fails_if="only by a slip in the exponents or the groups",
        identity=True,
        place="section 4, (4.10), (4.11)",
        printed="epsilon = (1, -2) retrieves the groups of (3.4), epsilon = (-2, 1) those of (4.1)",
        criterion="the product of (4.8) with these exponents is one oriented factor, by (4.4) the scale of the "
        "rotation, times the group that is printed",
        found="; ".join(
            f"{equation}: scale {one.scale}, group " + " ".join(f"({name})^{n}" for name, n in one.group.items())
            for equation, one in found.items()
        ),
        share=float(np.mean(equal)),
        numbers={"equal": sum(equal)},
    )


def group_tests() -> dict[str, bool]:
    """Whether each group of (4.10) and (4.11) is dimensionless and without orientation."""
    return {
        group: is_group(group) for group in ("theta/alpha", "theta*g/a_g", "a_g/(alpha*g)", "omega_g/p", "p*t", "eta")
    }


def groups(free: Mapping[str, bool]) -> Iterator[Claim]:
    """The groups of (4.10) and (4.11)."""
    failing = [group for group, good in free.items() if not good]
    yield Claim(
        key="groups",
        fails_if="only by a slip in a group",
        identity=True,
        place="section 4, (4.10), (4.11)",
        printed="the groups are dimensionless and orientationless",
        criterion=f"each of {', '.join(free)} has no dimension and, by (4.4) and (4.5), no orientation",
        found=f"{len(free) - len(failing)} of {len(free)}"
        + (f", not {', '.join(failing)}" if failing else "")
        + "; a necessary test only: alpha^2 and theta alpha^2 g/a_g pass it too",
        share=float(np.mean(list(free.values()))),
        numbers={"groups": len(free), "free": len(free) - len(failing)},
    )


def equation_tests() -> dict[str, bool]:
    """Whether the terms of each equation of motion have one dimension and one orientation."""
    return {number: is_homogeneous_equation(equation) for number, equation in EQUATIONS.items()}


def homogeneous_equations(homogeneous: Mapping[str, bool]) -> Iterator[Claim]:
    """The demand that physical equations be orientationally homogeneous, tested on those of the paper."""
    failing = [number for number, good in homogeneous.items() if not good]
    yield Claim(
        key="homogeneous-equations",
        fails_if="only by a slip in an equation: each follows from a balance of moments",
        identity=True,
        place="section 4, below (4.3)",
        printed="physical equations are both dimensionally and orientationally homogeneous",
        criterion=f"all terms of {', '.join(homogeneous)} have one dimension and one orientation",
        found="so in all" if not failing else f"not in {', '.join(failing)}",
        share=float(np.mean(list(homogeneous.values()))),
        numbers={"equations": len(homogeneous), "homogeneous": len(homogeneous) - len(failing)},
    )


def collapse(figure: xr.Dataset) -> Iterator[Claim]:
    """Figure 5 collapses to figure 6: two blocks, each integrated in SI units."""
    rotation = figure.rotation.values
    peak = float(np.abs(rotation).max())
    between = float(np.abs(rotation[0] - rotation[1]).max()) / peak
    master = np.interp(figure.tau[0], figure.tau_master, figure.master_rotation)  # all of these times are samples of it
    solver = float(np.abs(rotation - master).max()) / peak
    yield Claim(
        key="collapse",
        fails_if="only by an error of an integration: the groups are a change of variables in (3.2)",
        identity=True,
        place="section 4, figures 5 and 6",
        printed="two blocks of different size and shape with equal groups follow one master curve",
        criterion="two integrations in SI units, scaled, and the solution from the groups alone differ by less than "
        f"{SAME:.0e} of the peak",
        found=f"by {between:.0e} between the blocks and {solver:.0e} from the solution by groups",
        share=max(between, solver) < SAME,
        numbers={"between_blocks": between, "from_groups": solver},
    )


GROUPS = {"slenderness": 0.55, "frequency_ratio": 3.5, "restitution": 0.85}
"""Groups at which self-similarity is tested for each pulse."""


def histories_of_pulses() -> dict[str, Floats]:
    """For each pulse g theta/a_g of two blocks integrated in SI units and of the solver, (3, sample)."""
    blocks = [RectangularBlock.from_slenderness_angle(alpha, R) for alpha, R in ((0.12, 1.0), (0.24, 3.0))]
    return {pulse: _histories(pulse, blocks) for pulse in PULSE_NAMES}


def _histories(pulse: str, blocks: Sequence[RectangularBlock]) -> Floats:
    problems = [DimensionalProblem.with_groups(pulse, block, *GROUPS.values()) for block in blocks]
    p = [block.frequency_parameter for block in blocks]
    duration = problems[0].pulse_end * p[0] + 1.0
    solved = time_history(pulse, **GROUPS, duration=duration, samples=201)
    rows = [
        problem.history(solved.tau.values / one)[0] / block.alpha
        for problem, one, block in zip(problems, p, blocks, strict=True)
    ]
    return np.array([*rows, solved.rotation.values])


def any_excitation(histories: Mapping[str, Floats]) -> Iterator[Claim]:
    """Self-similarity for every pulse of the catalogue."""
    spreads = {pulse: float(np.ptp(rows, axis=0).max() / np.abs(rows).max()) for pulse, rows in histories.items()}
    equal = [spread < 1e-7 for spread in spreads.values()]
    yield Claim(
        key="any-excitation",
        fails_if="only by an error of an integration: the groups are a change of variables in (3.2)",
        identity=True,
        place="section 4, below (4.11)",
        printed="the response is self-similar for any excitation that can be described by a_g and omega_g",
        criterion="two blocks of different size and shape with equal groups, integrated in SI units, and the solution "
        f"from the groups differ by less than 1e-07 of the peak; {len(spreads)} pulses",
        found=f"so for {sum(equal)} of them; largest difference {max(spreads.values()):.0e}",
        share=float(np.mean(equal)),
        numbers=spreads,
    )
