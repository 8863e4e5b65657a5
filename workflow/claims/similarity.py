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


def printed_entries(computed: Sequence[str]) -> list[bool]:
    """Whether each entry of a table of products is that of table 1."""
    return [a == b for x, y in zip(computed, PRINTED_TABLE_1, strict=True) for a, b in zip(x, y, strict=True)]


def odd_pairs(pairs: Sequence[tuple[int, int]]) -> list[bool]:
    """Whether each pair of exponents from -4 to 4 is among `pairs` as its sum is odd, and is not as it is even."""
    exponents = range(-4, 5)
    return [((m + n) % 2 == 1) == ((m, n) in pairs) for m in exponents for n in exponents]


def orientation_tests() -> dict[str, list[bool]]:
    """Results of the tests of each claim on orientation, with the functions of `rocking.paper.orientation`."""
    computed = ["".join(product.symbol[1] for product in row) for row in multiplication_table()]
    variables = [quantity_of(name) for name in ("theta", "alpha", "p", "a_g/g", "omega_g", "eta")]
    dimensions = np.linalg.matrix_rank([[each.length, each.time, each.mass] for each in variables])
    factors = {"a_g/g": Orientation.LZ, "alpha": Orientation.LZ}
    admissible = admissible_exponents(Orientation.LZ, factors, largest=4)
    scalings = {equation: scaling_of_exponents(exponents) for equation, exponents in PRINTED_EXPONENTS.items()}
    groups = ("theta/alpha", "theta*g/a_g", "a_g/(alpha*g)", "omega_g/p", "p*t", "eta")
    return {
        "table-1": printed_entries(computed),
        "five-products": [len(variables) - int(dimensions) == 5],
        "homogeneous-equations": [is_homogeneous_equation(equation) for equation in EQUATIONS.values()],
        "odd-exponents": odd_pairs([(pair["a_g/g"], pair["alpha"]) for pair in admissible]),
        "exponents-give-groups": [scalings[equation] == printed for equation, printed in PRINTED_GROUPS.items()],
        "groups": [is_group(group) for group in groups],
    }


def orientation(tests: Mapping[str, Sequence[bool]]) -> Iterator[Claim]:
    """The claims on orientation, from the results of their tests."""
    for key, results in tests.items():
        yield Claim(key, float(np.mean(results)), {"tested": len(results), "met": sum(results)}, identity=True)


def collapse(figure: xr.Dataset) -> Claim:
    """Figure 5 collapses to figure 6: two blocks, each integrated in SI units."""
    rotation = figure.rotation.values
    peak = float(np.abs(rotation).max())
    between = float(np.abs(rotation[0] - rotation[1]).max()) / peak
    master = np.interp(figure.tau[0], figure.tau_master, figure.master_rotation)  # all of these times are samples of it
    solver = float(np.abs(rotation - master).max()) / peak
    return Claim(
        "collapse",
        max(between, solver) < SAME,
        {"between the blocks": between, "from the groups": solver},
        identity=True,
    )


GROUPS = {"slenderness": 0.55, "frequency_ratio": 3.5, "restitution": 0.85}
"""Groups at which self-similarity is tested for each pulse."""


def histories_of_pulses() -> dict[str, Floats]:
    """For each pulse g theta/a_g of two blocks integrated in SI units and of the solver, (3, sample)."""
    blocks = [RectangularBlock.from_slenderness_angle(alpha, R) for alpha, R in ((0.12, 1.0), (0.24, 3.0))]
    return {pulse: _histories(pulse, blocks) for pulse in PULSE_NAMES}


def _histories(pulse: str, blocks: Sequence[RectangularBlock]) -> Floats:
    problems = [DimensionalProblem.with_groups(pulse, block, *GROUPS.values()) for block in blocks]
    duration = problems[0].pulse_end * blocks[0].frequency_parameter + 1.0
    solved = time_history(pulse, **GROUPS, duration=duration, samples=201)
    rows = [
        problem.history(solved.tau.values / block.frequency_parameter)[0] / block.alpha
        for problem, block in zip(problems, blocks, strict=True)
    ]
    return np.array([*rows, solved.rotation.values])


def any_excitation(histories: Mapping[str, Floats]) -> Claim:
    """Self-similarity for every pulse of the catalogue."""
    spreads = {pulse: float(np.ptp(rows, axis=0).max() / np.abs(rows).max()) for pulse, rows in histories.items()}
    return Claim(
        "any-excitation", float(np.mean([spread < 1e-7 for spread in spreads.values()])), spreads, identity=True
    )
