"""Invalid configurations are refused before the first job, with key and what is allowed."""

from __future__ import annotations

import math
import tracemalloc
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
import yaml
from snakemake.exceptions import WorkflowError
from snakemake.utils import validate

from tests.workflow_fixtures import PROJECT, SMOKE, snakemake
from workflow.configuration import ConfigurationError, check

SCHEMA = PROJECT / "workflow/config/schema.yaml"
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
    configuration = yaml.safe_load(path.read_text())
    validate(configuration, str(SCHEMA))
    check(configuration, path.parent)


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        ("colour", 1, "'colour' was unexpected"),
        ("grid/spacing", 1, "'spacing' was unexpected"),
        ("figures/figure-08/ours/restitutoin", 1, "'restitutoin' was unexpected"),
        ("claims", MISSING, "'claims' is a dependency of 'figures'"),
        ("figures/figure-04", MISSING, "'figure-04' is a required property"),
        ("grid/frequency_ratio", 3, "3 is not of type 'object'"),
        ("grid/frequency_ratio/high", math.inf, "inf is greater than the maximum of 1000.0"),
        ("grid/frequency_ratio/low", True, "True is not of type 'number'"),
        ("grid/frequency_ratio/points", 161.5, "161.5 is not of type 'integer'"),
        ("grid/frequency_ratio/points", 10**9, "1000000000 is greater than the maximum of 200000000"),
        ("grid/slenderness/steps", [1e-9], "1e-09 is less than the minimum of 1e-06"),
        ("grid/alpha_deg", [20], "[20] does not contain items matching the given schema"),
        ("grid/alpha_deg", [0, 90], "90 is not valid under any of the given schemas"),
        ("pulses", ["sine", "cosine", "sine"], "has non-unique elements"),
        ("pulses", [], "[] should be non-empty"),
        ("boundary/slenderness/low", 2.0, "2.0 is greater than the maximum of 1"),
        ("figures/figure-05/ours/duration", 1e300, "1e+300 is greater than the maximum of 100"),
        ("figures/figure-05/paper/pulse", "saw", "'saw' is not one of ['sine', 'cosine'"),
    ],
)
def test_invalid_value_is_refused_by_the_schema(place: str, value: Any, message: str) -> None:
    with pytest.raises(WorkflowError) as refused:
        validate(smoke(place, value), str(SCHEMA))
    assert message in str(refused.value)


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        ("grid/frequency_ratio/low", 50.0, "grid.frequency_ratio: low = 50, high = 12; allowed: low < high"),
        ("grid/frequency_ratio/low", math.nan, "grid.frequency_ratio: low = nan, high = 12; allowed: low < high"),
        ("grid/frequency_ratio/points", 10**7, "1,460,000,000 nodes, 139 GB; allowed: 200,000,000, 19 GB"),
        ("grid/slenderness/steps", [1.25e-6], "nodes, 22 GB"),
        ("grid/slenderness/steps", [0.4], "no multiple of the step 0.4"),
        ("grid/slenderness/steps", [0.1, 0.1], "2 steps for 1 stretch"),
        ("grid/alpha_deg", [20, 0], "grid.alpha_deg = [20, 0]: allowed: ascending values"),
        ("grid/alpha_deg", [0, 10], "figures.figure-09: alpha_deg = 20; allowed: [0, 10]"),
        ("restitution", [0.85, 0.905], "restitution = [0.85, 0.905]: 0.905; allowed: two decimals"),
        ("pulses", ["sine", "triangle"], "pulses.1: `pulse` = 'triangle'"),
        ("figures/figure-scale-law/ours/reference", 0.8, "reference = 0.8; allowed: one of its [0.85, 0.9]"),
    ],
)
def test_values_that_do_not_go_together_are_refused_in_one_line(place: str, value: Any, message: str) -> None:
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


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        ("grid/frequency_ratio/low", 50.0, "Configuration refused: grid.frequency_ratio: low = 50, high = 12; allowed"),
        ("pulses", ["sine"], "results/overturning/cosine/eta-0.85.nc"),
    ],
)
def test_workflow_ends_with_the_error_before_any_job(place: str, value: Any, message: str, tmp_path: Path) -> None:
    written = tmp_path / "wrong.yaml"
    written.write_text(yaml.safe_dump(smoke(place, value)))
    refused = snakemake(tmp_path, configuration=written)
    assert refused.returncode == 1
    assert message in refused.stdout
    assert not (tmp_path / "results").exists()
