"""Figures 8 and 13: curves that end at the boundary of overturning, every branch of them, and their captions."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import yaml

from rocking._boundary.frequency import critical_frequency_ratio
from rocking._datasets.cube import read_spectrum
from rocking._solver.peak_response import peak_response
from tests.workflow_fixtures import PROJECT
from workflow.figures import figure_08, figure_13
from workflow.figures.spectrum_curves import STRAIGHT, SpectrumBlock, branches, peaks, rows_of

FIGURES = yaml.safe_load((PROJECT / "workflow/config/paper.yaml").read_text(encoding="utf-8"))["figures"]
WINDOW = (1.5, 8.0)


@pytest.fixture(scope="module")
def figure_8() -> xr.Dataset:
    return figure_08.data(**FIGURES["figure-08"]["paper"], **FIGURES["figure-08"]["ours"])


@pytest.fixture(scope="module")
def figure_13_data() -> xr.Dataset:
    return figure_13.data(**FIGURES["figure-13"]["paper"], **FIGURES["figure-13"]["ours"])


def points(data: xr.Dataset, name: str) -> np.ndarray:
    return np.repeat(data[f"curve_{name}"].values, data.row_size.values)


def test_every_curve_ends_at_the_boundary_or_at_the_edge(figure_8: xr.Dataset, figure_13_data: xr.Dataset) -> None:
    for data in (figure_8, figure_13_data):
        ends = np.cumsum(data.row_size.values)
        lower, upper = (ends - data.row_size.values, data.overturns_below, -1), (ends - 1, data.overturns_above, 1)
        for point, overturns, outward in (lower, upper):
            omega, beyond = data.frequency_ratio.values[point], overturns.values == 1
            edge = data.attrs["window"][0 if outward < 0 else 1]
            np.testing.assert_allclose(omega[~beyond], edge, rtol=1e-15)
            groups = {
                "slenderness": data.curve_slenderness.values,
                "restitution": data.curve_restitution.values,
                "alpha": data.curve_alpha.values,
            }
            for k, pulse in enumerate(data.attrs["pulse_names"].split()):
                here = beyond & (data.curve_pulse.values == k)
                of_pulse = {name: value[here] for name, value in groups.items()}
                at, past = (
                    peak_response(pulse, frequency_ratio=omega[here] * (1 + outward * step), **of_pulse)
                    for step in (0.0, 1e-10)
                )
                assert not at.overturned.any()
                assert past.overturned.all()


def test_main_branches_rise_to_alpha(figure_8: xr.Dataset, figure_13_data: xr.Dataset) -> None:
    for data in (figure_8, figure_13_data):
        start = np.cumsum(data.row_size.values) - data.row_size.values
        main = (data.overturns_below.values == 1) & (data.overturns_above.values == 0)
        alpha, s = data.curve_alpha.values, data.curve_slenderness.values
        distance = np.abs(data.spectrum.values[start] / (s * figure_13.scale_of(alpha)) - 1)
        assert main.sum() >= 54
        up_to_alpha = main & (data.curve_slenderness.values < 0.7)
        assert distance[up_to_alpha].max() < 3e-6  # the square root of the distance to the boundary


@pytest.mark.parametrize(("slenderness", "degrees", "inside"), [(0.3, 30, (2.72, 2.80)), (0.45, 10, (1.885, 1.925))])
def test_narrow_branches_are_found(slenderness: float, degrees: int, inside: tuple[float, float]) -> None:
    found = branches(SpectrumBlock("sine", slenderness, 0.85, float(np.radians(degrees))), WINDOW)
    narrow = found[0]
    assert len(found) == 2
    assert narrow.overturns_beyond == (True, True)
    assert narrow.frequency_ratio[0] < inside[0] < inside[1] < narrow.frequency_ratio[-1]
    assert np.all(narrow.peak > 1)  # it passes alpha and is brought back


def test_branches_agree_with_the_thresholds_of_outcome() -> None:
    block = {"slenderness": 0.45, "restitution": 0.85, "alpha": 0.3}
    found = branches(SpectrumBlock("cosine", 0.45, 0.85, 0.3), (0.5, 8.0))
    edges = critical_frequency_ratio("cosine", window=(0.5, 8.0), **block).frequency_ratio
    ends = [
        end for one in found for end, at in zip(one.frequency_ratio[[0, -1]], one.overturns_beyond, strict=True) if at
    ]
    np.testing.assert_allclose(ends, edges, rtol=1e-9)


def test_curves_are_straight_between_their_points() -> None:
    block = SpectrumBlock("sine", 0.6, 0.9)
    (curve,) = branches(block, (2.0, 12.0))
    share = np.array([0.21, 0.5, 0.83])[:, None]
    omega = curve.frequency_ratio[:-1] ** (1 - share) * curve.frequency_ratio[1:] ** share
    line = curve.peak[:-1] * (1 - share) + curve.peak[1:] * share
    assert np.abs(peaks(block, omega) - line).max() < 2 * STRAIGHT


def test_curves_agree_with_the_cubes(smoke_results: Path) -> None:
    data = xr.open_dataset(smoke_results / "figures/figure-13.nc")
    for k, pulse in enumerate(("sine", "cosine")):
        cube = read_spectrum(smoke_results / f"spectra/{pulse}/eta-0.85.nc").sel(slenderness=0.6, method="nearest")
        for alpha in cube.alpha.values:
            (curve,) = rows_of(data, pulse=k, slenderness=0.6, alpha=alpha)
            known = cube.peak_rotation.sel(alpha=alpha).dropna("frequency_ratio")
            known = known[(known.frequency_ratio > curve.frequency_ratio[0].item()) & (known.frequency_ratio < 8)]
            at = np.interp(known.frequency_ratio, curve.frequency_ratio, curve.spectrum)
            assert known.size > 20
            np.testing.assert_allclose(at, known * 0.6 * figure_13.scale_of(np.array(alpha)), atol=0.6 * 2 * STRAIGHT)


def test_closed_form_is_drawn_exactly_where_it_holds(figure_8: xr.Dataset) -> None:
    s, omega, eta = points(figure_8, "slenderness"), figure_8.frequency_ratio.values, points(figure_8, "restitution")
    sine = points(figure_8, "pulse") == 0
    found = peak_response("sine", slenderness=s[sine], frequency_ratio=omega[sine], restitution=eta[sine])
    after_impact = found.peak_mode == 3  # the largest rotation is that of free rocking after an impact
    after_pulse = figure_8.first_impact_follows_pulse.values[sine] == 1
    holds = figure_8.closed_form_holds.values == 1
    np.testing.assert_array_equal(holds[sine], after_impact & after_pulse)
    assert not holds[~sine].any()
    assert set(s[holds]) == {0.3}  # panel (a)
    assert omega[holds].min() > 4
    # below (3.31) it is an approximation, better in (c) than in (e)
    error = np.abs(figure_8.closed_form.values / figure_8.spectrum.values - 1)
    fast = sine & (omega > 6)
    assert np.nanmax(error[fast & (s == 0.45)]) < 0.06 < np.nanmin(error[fast & (s == 0.6)])
