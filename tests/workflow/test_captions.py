"""What the captions of figures 1, 3, 5 to 7, 11 and 12 state, computed from the data of the figures."""

from typing import Any

import numpy as np
import pytest
import yaml

from tests.workflow_fixtures import PROJECT
from workflow.figures import figure_01, figure_03, figure_05, figure_07, similar_histories

CAPTIONS = (PROJECT / "docs/figures.md").read_text(encoding="utf-8")
FIGURES = yaml.safe_load((PROJECT / "workflow/config/paper.yaml").read_text(encoding="utf-8"))["figures"]


def caption(title: str) -> str:
    return " ".join(CAPTIONS.split(f"## {title}\n")[1].split("## ")[0].split())


def settings(name: str) -> dict[str, Any]:
    return {**FIGURES[name].get("paper", {}), **FIGURES[name]["ours"]}


def test_figure_1_states_the_time_of_uplift() -> None:
    data = figure_01.data(**settings("figure-01"))
    rising = slice(0, int(data.ground_acceleration.values.argmax()) + 1)
    time = np.interp(np.tan(data.attrs["alpha"]), data.ground_acceleration[rising], data.time[rising])
    assert f"here at {time:.2f} s" in caption("Figure 1")


def test_figure_3_states_the_differences_of_the_smallest_solutions() -> None:
    data = figure_03.data(**settings("figure-03"))
    difference, omega = data.difference.values, data.frequency_ratio.values
    large = np.abs(np.nan_to_num(difference)) > 0.01
    slow = omega[(large & (omega < 3)).any(axis=0)].max()
    assert f"below 1 % from omega = {np.ceil(10 * slow) / 10:.1f} to near the end" in caption("Figure 3")
    for row, one in zip(large, difference, strict=True):  # near the end: the last twentieth of the curve
        assert omega[row & (omega > 3)].min(initial=np.inf) > 0.95 * omega[np.isfinite(one)].max()
    assert f"{100 * np.nanmin(difference):.0f} % at small omega" in caption("Figure 3")


def test_solutions_of_figure_3_beyond_the_pulse_continue_the_curves() -> None:
    data = figure_03.data(**settings("figure-03"))
    for eta in data.restitution.values:
        one = data.sel(restitution=eta)
        end = float(one.frequency_ratio[np.isfinite(one.lower)].max())
        after = one.lower_beyond[(one.frequency_ratio > end) & (one.frequency_ratio < end + 0.1)]
        assert np.isfinite(after).all()
        assert abs(float(after[0]) / float(one.lower.dropna("frequency_ratio")[-1]) - 1) < 0.05


def test_figures_5_and_6_end_at_rest_with_the_stated_groups() -> None:
    given = settings("figure-05")
    data = figure_05.data(**given)
    assert np.all(np.abs(data.rotation.values[:, -1]) == 0)
    stated = f"1/a = {given['slenderness']:g}, omega = {given['frequency_ratio']:g} and eta = {given['restitution']:g}"
    assert stated in caption("Figures 5 and 6")


def test_figure_7_states_which_peaks_fall_with_restitution() -> None:
    given = settings("figure-07")
    text, data = caption("Figure 7"), figure_07.data(**given)
    assert f"1/a = {given['slenderness']:g} and omega = {given['frequency_ratio']:g}" in text
    rotation, velocity = (np.abs(data[name]).max("tau").values for name in ("rotation", "angular_velocity"))
    assert np.all(np.diff(rotation, axis=1) > 0)
    assert np.all(np.diff(velocity[1]) > 0)  # cosine
    equal = data.restitution.values[velocity[0] < velocity[0, 0] * (1 + 1e-6)]
    assert f"the same, for eta up to {equal.max():.2f}" in text
    assert np.all(np.diff(velocity[0][equal.size - 1 :]) > 0)


@pytest.mark.parametrize("number", [11, 12])
def test_figures_11_and_12_state_their_frequency_ratio(number: int) -> None:
    given = settings(f"figure-{number}")
    assert f"{given['frequency_ratio']:g} in figure {number}" in caption("Figures 11 and 12")
    data = similar_histories.data(**given)
    assert np.all(data.spread.values[:, 1] < 0.25 * data.spread.values[:, 0])
