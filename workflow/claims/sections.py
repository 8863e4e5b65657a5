"""The claims of each section of the paper, in its order."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from rocking._boundary.curves import curves_at
from rocking._datasets.cube import read_dataset
from rocking.paper.overturning import limit_amplitude
from workflow.claims import boundaries as curves
from workflow.claims import earlier_work, impact_times, similarity, small_rotations, spectra
from workflow.claims import excitations as excitations_claims
from workflow.claims.claim import Claim


def section_3(boundaries: Sequence[Path], cubes: Sequence[xr.Dataset], restitution: Sequence[float]) -> Iterator[Claim]:
    """Overturning of the slender block."""
    yield from curves.exact_curves([curves_at(read_dataset(path), 0.0) for path in boundaries])
    yield from curves.completeness(cubes)
    yield from curves.limit_separates(*curves.sides_of_limit())
    omega = np.linspace(2.0, 12.0, 201)
    yield from curves.limit_value(omega, 1 / limit_amplitude(omega))
    yield from curves.overturning_in_free_rocking(curves.time_near_equilibrium(restitution))
    yield from impact_times.exact_impact(impact_times.impacts_after_pulse())
    yield from impact_times.other_root(impact_times.other_roots())
    on_curve = impact_times.case_1_1_curve(restitution)
    yield from impact_times.impact_about_one(on_curve)
    yield from impact_times.ad_hoc_function(impact_times.expansion_errors())
    yield from impact_times.approximate_time(on_curve)
    yield from impact_times.smallest_solutions(on_curve)
    yield from impact_times.end_of_case_1_1(*impact_times.ends_of_case_1_1())
    yield from earlier_work.earlier_forms(earlier_work.hyperbolic_residuals())
    yield from excitations_claims.more_cycles(excitations_claims.sequences())


def section_4(cubes: Sequence[xr.Dataset], collapse: Path) -> Iterator[Claim]:
    """Orientation, self-similarity and the spectra of the slender block."""
    yield from similarity.table(similarity.computed_table())
    yield from similarity.count_of_products(*similarity.independent_products())
    yield from similarity.homogeneous_equations(similarity.equation_tests())
    yield from similarity.odd_exponents(similarity.homogeneous_pairs())
    yield from similarity.exponents_give_groups(similarity.scalings())
    yield from similarity.groups(similarity.group_tests())
    yield from similarity.collapse(read_dataset(collapse))
    yield from similarity.any_excitation(similarity.histories_of_pulses())
    of_sine = spectra.spectra_of(cubes)
    for judge in (
        spectra.closed_form,
        spectra.time_of_peak,
        spectra.peak_after_pulse,
        spectra.approximation_near_limit,
        spectra.no_real_root,
        spectra.scale_law,
        spectra.damping,
    ):
        yield from judge(of_sine)
    yield from spectra.leading_term(spectra.slow_impacts())
    yield from spectra.period(spectra.swings())


def section_6(pulses: Sequence[str], restitution: float, histories: Sequence[Path]) -> Iterator[Claim]:
    """The groups of (6.1)."""
    spreads = small_rotations.spreads(pulses, restitution)
    yield from small_rotations.practical_similarity(spreads)
    yield from small_rotations.larger_slenderness(spreads)
    yield from small_rotations.histories([read_dataset(path) for path in histories])
    yield from small_rotations.pure_rocking(small_rotations.contacts(pulses, restitution))
