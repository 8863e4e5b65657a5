"""Invalid configurations are refused before the first job, in one line with key, value and allowed values."""

from __future__ import annotations

import math
import tracemalloc
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.workflow_fixtures import PROJECT, SMOKE, snakemake
from workflow.configuration import SCHEMA, ConfigurationError, check

CONFIGURATIONS = sorted({*(PROJECT / "workflow/config").glob("*.yaml")} - {SCHEMA})
MISSING = object()
GIVEN = yaml.safe_load(SMOKE.read_text())


def smoke(place: str = "", value: Any = None) -> dict[str, Any]:
    """The smallest configuration, with another value at a place such as `grid/alpha_deg`."""
    configuration = deepcopy(GIVEN)
    *sections, key = place.split("/")
    part = configuration
    for name in sections:
        part = part[name]
    if value is MISSING:
        del part[key]
    elif key:
        part[key] = value
    return configuration


@pytest.mark.parametrize("path", CONFIGURATIONS, ids=lambda path: path.stem)
def test_configurations_of_the_repository_are_accepted(path: Path) -> None:
    check(yaml.safe_load(path.read_text()), path.parent)


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        ("colour", 1, "configuration: unknown key colour; the keys are title, pulses"),
        ("grid/spacing", 1, "grid: unknown key spacing; the keys are alpha_deg, slenderness, frequency_ratio"),
        ("figures/figure-08/ours/restitutoin", 1, "figures.figure-08.ours: unknown key restitutoin"),
        ("claims", MISSING, "configuration: missing key claims"),
        ("figures/figure-04", MISSING, "figures: missing key figure-04"),
        ("grid/frequency_ratio", 3, "grid.frequency_ratio = 3: missing key"),
        ("grid/frequency_ratio/low", 50.0, "grid.frequency_ratio: low = 50, high = 12; allowed: low < high"),
        ("grid/frequency_ratio/low", math.nan, "grid.frequency_ratio.low = nan: allowed: a finite number"),
        ("grid/frequency_ratio/high", math.inf, "grid.frequency_ratio.high = inf: allowed: a number"),
        ("grid/frequency_ratio/low", True, "grid.frequency_ratio.low = True: allowed: a number"),
        ("grid/frequency_ratio/points", 161.5, "grid.frequency_ratio.points = 161.5: allowed: a whole number"),
        ("grid/frequency_ratio/points", 10**9, "points = 1000000000: allowed: a whole number from 4 to 200000000"),
        ("grid/frequency_ratio/points", 10**7, "1,460,000,000 nodes, 139 GB"),
        ("grid/frequency_ratio/points", 10**7, "allowed: 200,000,000, 19 GB"),
        ("grid/slenderness/steps", [1e-9], "grid.slenderness.steps.0 = 1e-09: allowed: a number from 1e-06"),
        ("grid/slenderness/steps", [1.25e-6], "720001 slenderness x 161 frequency_ratio"),
        ("grid/slenderness/steps", [0.4], "no multiple of the step 0.4"),
        ("grid/slenderness/steps", [0.1, 0.1], "2 steps for 1 stretch"),
        ("grid/alpha_deg", [20], "grid.alpha_deg = [20]: allowed: a list with 0, the slender limit"),
        ("grid/alpha_deg", [20, 0], "grid.alpha_deg = [20, 0]: allowed: 1 to 200 ascending values"),
        ("grid/alpha_deg", [0, 90], "grid.alpha_deg.1 = 90: allowed: a number from 0.01 to 89, or 0"),
        ("grid/alpha_deg", [0, 10], "figures.figure-09: alpha_deg = 20; allowed: [0, 10]"),
        ("restitution", [0.85, 0.905], "restitution = [0.85, 0.905]: 0.905; allowed: two decimals"),
        ("restitution", [0.85], "figures.figure-04: restitution = 0.9; allowed: [0.85]"),
        ("pulses", ["cosine"], "pulses = ['cosine']: figure-04 needs sine"),
        ("pulses", ["sine", "triangle"], "pulses.1 = 'triangle': allowed: one of sine, cosine"),
        ("pulses", ["sine", "cosine", "sine"], "allowed: 1 to 200 different values"),
        ("pulses", [], "pulses = []: allowed: 1 to 200 different values"),
        ("boundary/slenderness/low", 2.0, "boundary.slenderness.low = 2.0: allowed: a number from 0.0001 to 1"),
        ("figures/figure-05/ours/duration", 1e300, "figures.figure-05.ours.duration = 1e+300: allowed: a number"),
        ("figures/figure-05/ours/half_diagonal", [1.0], "allowed: one of each for every block"),
        ("figures/figure-scale-law/ours/reference", 0.8, "reference = 0.8; allowed: one of its [0.85, 0.9]"),
    ],
)  # fmt: skip
def test_invalid_value_is_refused_in_one_line(place: str, value: Any, message: str) -> None:
    configuration, peak = smoke(place, value), 0
    if place.endswith(("points", "steps")):  # tracing takes five times the time
        tracemalloc.start()
    with pytest.raises(ConfigurationError) as refused:
        check(configuration)
    if tracemalloc.is_tracing():
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)
    assert len(str(refused.value)) < 300
    assert peak < 20e6  # no axis is made of what is refused


def test_workflow_ends_with_the_error_before_any_job(tmp_path: Path) -> None:
    written = tmp_path / "wrong.yaml"
    written.write_text(yaml.safe_dump(smoke("grid/frequency_ratio/low", 50.0)))
    refused = snakemake(tmp_path, configuration=written, module="workflow.run")
    assert refused.returncode == 1
    *_, last = refused.stdout.splitlines()
    assert last == "Configuration refused: grid.frequency_ratio: low = 50, high = 12; allowed: low < high"
    assert len(refused.stdout.splitlines()) == 2  # the other one tells the profile
    absent = snakemake(tmp_path, configuration=tmp_path / "absent.yaml", module="workflow.run")
    assert absent.stdout == f"--configfile {tmp_path / 'absent.yaml'}: no such file\n"
    assert not (tmp_path / "results").exists()
