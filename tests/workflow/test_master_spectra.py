"""Master spectra: maps of the solver in the groups of (6.1), and what their caption states."""

from collections.abc import Iterator

import numpy as np
import pytest
import xarray as xr
import yaml

from rocking._dimensional.block import Block
from rocking._solver.peak_response import peak_response
from tests.workflow_fixtures import PROJECT
from workflow.figures import master_spectra

FIGURES = yaml.safe_load((PROJECT / "workflow/config/paper.yaml").read_text(encoding="utf-8"))["figures"]


@pytest.fixture(scope="module", params=["figure-master-spectra", "figure-master-housner"])
def maps(request: pytest.FixtureRequest) -> Iterator[tuple[str, xr.Dataset]]:
    """Name and data of a figure of the paper; boundaries, which take longest, of the last angle only."""
    traced = master_spectra._traced
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(master_spectra, "_traced", lambda s, omega, eta, angles: traced(s, omega, eta[-1:], angles[-1:]))
        yield request.param, master_spectra.data(**FIGURES[request.param]["ours"])


def test_maps_are_solutions_of_single_blocks(maps: tuple[str, xr.Dataset]) -> None:
    name, data = maps
    for k, pulse in enumerate(("sine", "cosine")):
        for j, alpha in enumerate(data.alpha.values):
            block = Block.from_slenderness_angle(float(alpha), 1.0) if alpha else None
            eta = 0.85 if "spectra" in name else block.momentum_restitution if block else 1.0
            assert float(data.restitution[j]) == pytest.approx(eta, rel=1e-12)
            s, omega = float(data.slenderness[66]), float(data.frequency_ratio[120])
            found = peak_response(pulse, slenderness=s, frequency_ratio=omega, restitution=eta, alpha=alpha or None)
            theta = float(found.peak_rotation) * (alpha or 1.0)
            a_g = (np.tan(alpha) if alpha else 1.0) / s  # in units of g
            assert float(data.spectrum[k, j, 66, 120]) == pytest.approx(theta / (a_g * np.cos(alpha)), rel=1e-12)


def test_outcome_changes_across_the_boundaries(maps: tuple[str, xr.Dataset]) -> None:
    _, data = maps
    alpha, eta = float(data.alpha[-1]), float(data.restitution[-1])
    for k, pulse in enumerate(("sine", "cosine")):
        here = (data.boundary_pulse.values == k) & (data.boundary_alpha.values == alpha)
        here &= np.isfinite(data.boundary_amplitude.values)
        omega, s = data.boundary_frequency_ratio.values[here], 1 / data.boundary_amplitude.values[here]
        below, above = (
            peak_response(pulse, slenderness=s + step, frequency_ratio=omega, restitution=eta, alpha=alpha).overturned
            for step in (-1e-9, 1e-9)
        )
        assert s.size > 100
        assert np.mean(below != above) > 0.95  # not where two curves meet
