"""Figures: reproducible files, and data that agree with the captions."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import pytest
import yaml

from rocking._datasets.cube import read_dataset
from rocking._excitation.pulses import PULSE_NAMES
from rocking._solver.peak_response import peak_response
from tests.workflow_fixtures import PROJECT, SMOKE
from workflow.figures import figure_09, figure_scale_law_excitations, similar_histories
from workflow.scripts.figures import draw_figure

PROVENANCE = ("code_sha256", "settings_sha256", "configuration", "product_version")
CONFIGURED = yaml.safe_load(SMOKE.read_text())["figures"]


@pytest.mark.parametrize("name", ["figure-01", "table-1"])
def test_figure_drawn_twice_has_equal_bytes(name: str, smoke_results: Path, tmp_path: Path) -> None:
    paths = {kind: tmp_path / f"{name}.{kind}" for kind in ("svg", "png", "nc")}
    written = read_dataset(smoke_results / f"figures/{name}.nc").attrs
    provenance = {key: written[key] for key in PROVENANCE}
    draw_figure(name, files=paths, inputs={}, **CONFIGURED[name], provenance=provenance)
    for kind, path in paths.items():
        there = smoke_results / f"figures/{name}.{kind}"
        assert hashlib.sha256(path.read_bytes()).digest() == hashlib.sha256(there.read_bytes()).digest(), kind


@pytest.mark.parametrize("name", CONFIGURED)
def test_figure_lists_values_chosen_here_and_has_a_caption(name: str, smoke_results: Path) -> None:
    attributes = read_dataset(smoke_results / f"figures/{name}.nc").attrs
    assert attributes.get("values_chosen_here", "") == ", ".join(CONFIGURED[name].get("ours", {}))
    assert f"[{name}](#" in (PROJECT / "docs/figures.md").read_text()


def test_dimensional_blocks_have_the_given_groups(smoke_results: Path) -> None:
    data = read_dataset(smoke_results / "figures/figure-05.nc")
    gravity = 9.80665
    np.testing.assert_allclose(gravity * data.alpha / data.peak_acceleration, data.attrs["slenderness"], rtol=1e-12)
    omega = 2 * np.pi / data.period / data.frequency_parameter
    np.testing.assert_allclose(omega, data.attrs["frequency_ratio"], rtol=1e-12)
    assert np.ptp(data.half_diagonal.values) > 1
    assert np.ptp(data.alpha.values) > 0.1


def test_upper_surviving_region_of_figure_9_is_bounded_where_the_outcome_changes() -> None:
    omega, alpha = np.array([2.5, 3.5, 5.0]), float(np.radians(20))
    low, high = figure_09.upper_surviving_region("sine", omega, 0.85, alpha)

    def recovers(amplitude: np.ndarray) -> np.ndarray:
        found = peak_response("sine", slenderness=1 / amplitude, frequency_ratio=omega, restitution=0.85, alpha=alpha)
        return found.exceeded_alpha & ~found.overturned

    assert recovers(low * (1 + 1e-9)).all()
    assert recovers(high * (1 - 1e-9)).all()
    assert not recovers(low * (1 - 1e-9)).any()
    assert not recovers(high * (1 + 1e-9)).any()


def test_blocks_of_figure_11_have_equal_groups() -> None:
    pulse, s, omega, eta, alpha = "cosine", 0.6, 4.0, 0.9, np.radians(20)
    data = similar_histories.data(
        pulses=[pulse], restitution=eta, alpha_deg=[20], slenderness=s, frequency_ratio=omega, duration=5.0
    )
    block = {"frequency_ratio": omega, "restitution": eta, "alpha": alpha}
    by_alpha = peak_response(pulse, slenderness=s * np.tan(alpha) / alpha, **block).peak_rotation
    by_tangent = peak_response(pulse, slenderness=s, **block).peak_rotation
    # theta = alpha times the peak; a_g/g = alpha/s and tan(alpha)/s
    expected = [by_alpha * s, by_tangent * alpha * s / np.sin(alpha)]
    np.testing.assert_allclose(np.abs(data.rotation.values[0, :, 0]).max(axis=-1), expected, rtol=1e-4)


def test_scale_law_of_excitations_is_that_of_single_blocks() -> None:
    axis = {"low": 2.0, "high": 8.0, "points": 4}
    data = figure_scale_law_excitations.data(
        records=["napa_HNN.csv"],
        restitution=[0.8, 0.9],
        reference=0.9,
        slenderness={"low": 0.3, "high": 0.9, "points": 4},
        frequency_ratio=axis,
        frequency_parameter=axis,
    )
    low, high = (
        peak_response("cosine", slenderness=0.5, frequency_ratio=8.0, restitution=eta).peak_rotation
        for eta in (0.8, 0.9)
    )
    k = PULSE_NAMES.index("cosine")
    assert float(data.pulse_deviation[k, 1, -1]) == pytest.approx(abs(high * (0.8 / 0.9) ** 2 / low - 1), rel=1e-12)
    assert float(data.pulse_exponent[k, 1, -1]) == pytest.approx(np.log(low / high) / np.log(0.8 / 0.9), rel=1e-12)
    names = data.attrs["excitation_names"].split()
    assert names == [*PULSE_NAMES, "napa_HNN"]
    # one lobe: the largest rotation comes before the impact
    assert float(data.median_exponent[names.index("half_sine")]) == pytest.approx(0.0, abs=1e-12)
    assert np.isfinite(data.record_deviation.values).any()


def test_islands_of_figure_4_are_lines_in_the_expected_region(smoke_results: Path) -> None:
    data = read_dataset(smoke_results / "figures/figure-04.nc")
    a, omega = data.island_amplitude.values, data.island_frequency_ratio.values
    assert np.isfinite(a).sum() > 50
    assert 1 / np.nanmax(a) > 0.89
    assert np.nanmax(omega) < 1.1
    assert set(np.unique(data.island_impacts)) >= {3, 5}
    # on either side of a line between survival and overturning the outcomes differ
    eta = data.island_restitution.values
    here = np.isfinite(a) & (data.island_impacts.values > 0)
    below, above = (
        peak_response(
            "sine", slenderness=1 / a[here] + step, frequency_ratio=omega[here], restitution=eta[here]
        ).overturned
        for step in (-1e-9, 1e-9)
    )
    assert np.mean(below != above) > 0.95  # not where two lines meet
