"""Misprints of the paper: what is printed, what is right, and the tests that show it; also in docs/equations.md."""

from dataclasses import asdict, dataclass
from typing import Any

TESTS = "tests/paper/test_errata.py"  # the file of the tests that show the misprints


@dataclass(frozen=True)
class Misprint:
    """One row of the table of misprints; `tests` are functions of `TESTS`."""

    place: str
    printed: str
    right: str
    tests: tuple[str, ...]

    def record(self) -> dict[str, Any]:
        """A mapping for JSON."""
        return asdict(self) | {"tests": [f"{TESTS}::{test}" for test in self.tests]}

    def row(self) -> str:
        """The row of a Markdown table."""
        tests = ", ".join(f"`{TESTS}::{test}`" for test in self.tests)
        return f"| {self.place} | {self.printed} | {self.right} | {tests} |"


MISPRINTS = (
    Misprint("(3.3)", "sin psi = 1/alpha", "sin psi = 1/a", ("test_3_3_uplift_phase",)),
    Misprint(
        "(3.9), second line",
        "D0* = omega/(omega^2+1) (...)",
        "D0* = (omega/(omega^2+1))^2 (...)",
        ("test_3_9_second_line_against_integration",),
    ),
    Misprint(
        "after (3.31)",
        "(3.18) for case 1.1, (3.30) for case 1.2",
        "(3.18) for case 1.2, (3.30) for case 1.1",
        ("test_after_3_31_assignment_of_conditions_to_cases",),
    ),
    Misprint(
        "before (4.3)",
        "equation (3.31) contains six variables",
        "equation (4.2) does",
        ("test_before_4_3_equation_with_six_variables",),
    ),
    Misprint("(4.8)", "a_g/a", "a_g/g", ("test_4_8_argument_of_the_response_function",)),
    Misprint(
        "(4.12), first form",
        "m g R [1 - cos(alpha - theta_m)]",
        "m g R [cos(alpha - theta_m) - cos alpha]",
        ("test_4_12_energy_against_integration",),
    ),
    Misprint(
        "(4.14), (4.15), (4.16)",
        "sqrt(1 - D0*)",
        "1 - D0*",
        ("test_4_14_and_4_15_small_forms_against_integration", "test_4_16_scale_function_against_integration"),
    ),
    Misprint(
        "(5.1), theta < 0",
        "(u/g - tan alpha) cos theta",
        "(tan alpha - u/g) cos theta",
        ("test_5_1_sign_for_negative_rotation",),
    ),
    Misprint(
        "captions of figures 5, 7, 8",
        "histories from equation (3.3)",
        "from equation (3.2)",
        ("test_figure_captions_histories_come_from_3_2",),
    ),
    Misprint(
        "figure 8",
        "caption: eta from 0.82",
        "text and plot: from 0.80, by 0.02 to 0.96",
        ("test_figure_8_restitutions",),
    ),
    Misprint(
        "caption of figure 3",
        "numerical results from (3.20) and (3.28)",
        "from (3.20) and (3.21)",
        ("test_figure_3_caption_numerical_condition",),
    ),
    Misprint(
        "above (4.1)",
        "multiplying (3.5) with g alpha/a_g",
        "multiplying (3.4)",
        ("test_above_4_1_equation_that_is_multiplied",),
    ),
    Misprint(
        "below (3.12)",
        "the time of impact is inserted in (3.18)",
        "in (3.17), which becomes (3.18)",
        ("test_below_3_12_condition_that_takes_the_impact_time",),
    ),
    Misprint(
        "section 6, below figure 12",
        "figure 10 was presented for the slender block formulation",
        "for blocks of several slenderness angles, in the groups of (5.3)",
        ("test_section_6_figure_10_is_not_of_slender_blocks",),
    ),
    Misprint(
        "section 7",
        "exactly self-similar for small rotations and practically for large ones",
        "practically for small rotations, as section 6 says; exactly in the slender limit only",
        ("test_section_7_small_rotations_are_not_exactly_self_similar",),
    ),
    Misprint(
        "below (3.8)",
        "B = 0 is the unstable manifold",
        "the stable manifold of the unstable equilibrium: B multiplies the growing exponential, and without it the "
        "distance from alpha falls as e^-tau",
        ("test_below_3_8_manifold_without_the_growing_exponential",),
    ),
)
