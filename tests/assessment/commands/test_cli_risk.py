"""`rocking risk`: annual rates of a suite, and its fragility for loss programs."""

import json
from pathlib import Path

import pytest
import rocking_assessment
import yaml

import rocking
from rocking.suites.configuration import suite_configuration
from tests.cli.test_cli import read_csv, refused, run

ROOT = Path(__file__).parents[3]
INTENSITY, RATE = [1.0, 5.0, 20.0], [1e-2, 1e-3, 1e-5]


@pytest.fixture(scope="module")
def suite(tmp_path_factory):
    """A configuration of two records and few levels."""
    settings = yaml.safe_load((ROOT / "workflow/config/suite.yaml").read_text())["suite"]
    settings |= {"map": None, "sensitivity": None, "intensity": {"low": 1.0, "high": 30.0, "points": 8}}
    settings["records"] |= {"folder": str(ROOT / "workflow/motions"), "pattern": "napa_HN*.csv"}
    path = tmp_path_factory.mktemp("suite") / "suite.json"
    path.write_text(json.dumps(settings))
    return path


@pytest.fixture
def hazard(tmp_path):
    path = tmp_path / "hazard.csv"
    rows = "".join(f"{x / 9.80665:.17g},{rate}\n" for x, rate in zip(INTENSITY, RATE, strict=True))
    path.write_text(f"pga [g],annual rate [1/year]\n{rows}")
    return path


def test_rates_are_those_of_python(suite, hazard):
    configuration = suite_configuration(json.loads(suite.read_text()), suite.parent)
    fragility = rocking.fragility(
        configuration.motions(),
        configuration.blocks,
        intensity=configuration.intensity,
        measure=configuration.measure,
        demand=configuration.demand,
    )
    expected = rocking_assessment.annual_rate(fragility, (INTENSITY, RATE))["annual_rate"]
    curves = json.loads(run("risk", str(suite), "--hazard", str(hazard), "--format=json"))["curves"]
    rates = [rate for rate in curves["annual_rate"] if rate is not None]
    values = expected.transpose("demand", "block", "model").values.ravel()
    assert rates == pytest.approx(values[values == values].tolist(), rel=1e-9)
    rows = list(read_csv(run("risk", str(suite), "--hazard", str(hazard), "--format=csv")))
    assert len(rows) == len(curves["annual_rate"])


@pytest.mark.parametrize(("ending", "start"), [(".xml", "<?xml"), (".pelicun.csv", "ID,")])
def test_files_for_loss_programs(suite, tmp_path, ending, start):
    path = tmp_path / f"model{ending}"
    assert run("risk", str(suite), "--output", str(path)) == ""
    assert path.read_text().startswith(start)


def test_refusals_name_the_option(suite, hazard, tmp_path):
    assert "--hazard" in refused("risk", str(suite))
    assert "--output" in refused("risk", str(suite), "--output", str(tmp_path / "model.txt"))
    hazard.write_text("")
    assert "--hazard" in refused("risk", str(suite), "--hazard", str(hazard))
