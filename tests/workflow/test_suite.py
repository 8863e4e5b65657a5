"""The workflow on the suite of records of the repository, run by Snakemake."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from snakemake.exceptions import WorkflowError
from snakemake.utils import validate

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking._datasets.cube import read_dataset
from rocking.suites.configuration import SuiteConfiguration, suite_configuration
from tests.workflow_fixtures import PROJECT, snakemake
from workflow.configuration import ConfigurationError, check
from workflow.verify import problems

CONFIGURATION = PROJECT / "workflow/config/suite.yaml"
RECORDS = ("napa_HNE", "napa_HNN")


@pytest.fixture(scope="module")
def configuration(tmp_path_factory: pytest.TempPathFactory) -> Path:
    given = yaml.safe_load(CONFIGURATION.read_text())
    given["suite"]["records"] |= {"folder": str(PROJECT / "workflow/motions"), "pattern": "napa_*.csv"}
    path = tmp_path_factory.mktemp("configuration") / "suite.yaml"
    path.write_text(yaml.safe_dump(given))
    return path


@pytest.fixture(scope="module")
def suite(configuration: Path) -> SuiteConfiguration:
    return suite_configuration(yaml.safe_load(configuration.read_text())["suite"], configuration.parent)


@pytest.fixture(scope="module")
def suite_run(configuration: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder in which the workflow ran with that file; tests must not change it."""
    directory = tmp_path_factory.mktemp("suite")
    finished = snakemake(directory, configuration=configuration)
    assert finished.returncode == 0, finished.stdout
    return directory


@pytest.fixture(scope="module")
def products(suite_run: Path) -> Path:
    return suite_run / "results/suites/demonstration"


def test_every_product_is_made_and_listed(products: Path) -> None:
    listed = json.loads((products / "manifest.json").read_text())["products"]
    expected = {f"records/{name}.csv.nc" for name in RECORDS} | {"outcomes.nc", "fragility.nc", "fragility.csv"}
    expected |= {f"sensitivity/{name}.csv.nc" for name in RECORDS} | {"sensitivity.nc", "sensitivity.csv"}
    expected |= {f"figures/{name}.{kind}" for name in ("curves", "outcomes", "map") for kind in ("svg", "png", "nc")}
    assert set(listed) == expected
    for name, entry in listed.items():
        assert hashlib.sha256((products / name).read_bytes()).hexdigest() == entry["sha256"]
    found = {path.relative_to(products).as_posix() for path in products.rglob("*") if path.is_file()}
    assert found - expected == {"manifest.json", "ro-crate-metadata.json"}


def test_the_shorter_configuration_of_the_guide_is_enough(tmp_path: Path) -> None:
    page = (PROJECT / "docs/fragility.md").read_text()
    (text,) = re.findall(r"```yaml\n(.*?)```", page, re.S)
    given = yaml.safe_load(text)["suite"]
    with pytest.raises(rocking.InvalidArgumentError, match="relative to the file of the configuration"):
        suite_configuration(given, tmp_path).motions()
    (tmp_path / "motions").symlink_to(PROJECT / "workflow/motions")
    suite = suite_configuration(given, tmp_path)
    assert len(suite.motions()) == 5
    assert (suite.restitution, suite.demand, suite.confidence) == ("momentum", ("overturning",), 0.95)
    assert (suite.map, suite.sensitivity) == (None, None)
    described = set(re.findall(r"`suite\.([\w.]+)`", page))
    sections = {name.partition(".")[0] for name in described}
    assert sections == {*SuiteConfiguration.__annotations__}


def test_products_are_those_of_the_library(products: Path, suite: SuiteConfiguration) -> None:
    direct = rocking.fragility(
        suite.motions(), suite.blocks, intensity=suite.intensity, measure=suite.measure, demand=suite.demand
    )
    outcomes, fragility = (read_dataset(products / f"{name}.nc") for name in ("outcomes", "fragility"))
    for name in ("peak_rotation", "outcome", "scale"):
        np.testing.assert_array_equal(outcomes[name], direct[name])
    for name in ("exceedances", "median_intensity", "dispersion_upper", "records_surviving_above_first"):
        np.testing.assert_array_equal(fragility[name], direct[name])
    assert outcomes.record.values.tolist() == list(RECORDS)
    assert outcomes.digest.values.tolist() == [motion.digest for motion in suite.motions()]


def test_friction_restitution_and_sampling_are_those_of_the_library(products: Path, suite: SuiteConfiguration) -> None:
    asked = suite.sensitivity
    assert asked is not None
    found = read_dataset(products / "sensitivity.nc")
    direct = rocking.suites.suite_sensitivity(
        suite.motions(), suite.blocks[1], intensity=asked.intensity, restitution_step=asked.restitution_step
    )
    for name in (
        "friction_demand",
        "overturned_low_restitution",
        "overturned_high_restitution",
        "overturned_resampled",
    ):
        np.testing.assert_array_equal(found[name][1], direct[name])
        assert found[name].attrs["units"] == "1"
    np.testing.assert_array_equal(found.fraction_resampled, found.overturned_resampled.mean("record"))
    np.testing.assert_array_equal(found.friction_demand_largest, found.friction_demand.max("record"))
    assert found.attrs["confidence"] == suite.confidence
    rows = (products / "sensitivity.csv").read_text().splitlines()
    assert len(rows) == 1 + len(suite.blocks) * asked.intensity.size
    assert rows[0].startswith("width,height,intensity,restitution,restitution_low")


def test_map_is_that_of_single_blocks(products: Path, suite: SuiteConfiguration) -> None:
    outcomes = read_dataset(products / "outcomes.nc")
    data = read_dataset(products / "figures/map.nc")
    np.testing.assert_array_equal(data.probability, outcomes.map_overturned.mean("record"))
    for i, j in ((0, 0), (4, 7), (18, 3)):
        block = rocking.Block.from_slenderness_angle(float(outcomes.map_alpha[j]), float(outcomes.map_half_diagonal[i]))
        direct = rocking.fragility(suite.motions(), block, intensity=[6.0])
        np.testing.assert_array_equal(outcomes.map_overturned[i, j], direct.overturned[0])


@pytest.mark.long  # as for data sets, test_workflow_recovery.py
def test_second_run_does_nothing_and_a_lost_record_is_made_again(
    suite_run: Path, configuration: Path, tmp_path: Path
) -> None:
    # beside it: paths of records are relative to the folder of the run
    copy = Path(shutil.copytree(suite_run, tmp_path, dirs_exist_ok=True))
    again = snakemake(copy, configuration=configuration)
    assert "Nothing to be done" in again.stdout
    place = "results/suites/demonstration/records/napa_HNE.csv.nc"
    before = (copy / place).read_bytes()
    (copy / place).unlink()
    assert [name for name in problems(copy) if "napa_HNE" in name]
    planned = snakemake(copy, "--dry-run", configuration=configuration)
    jobs = dict(re.findall(r"^(\w+) +(\d+)$", planned.stdout.partition("total")[0], flags=re.MULTILINE))
    once = ("suite_record", "suite_fragility", "suite_figures", "manifest", "ro_crate", "all")
    assert jobs == dict.fromkeys(once, "1"), planned.stdout
    remade = snakemake(copy, place, configuration=configuration)
    assert remade.returncode == 0, remade.stdout
    assert (copy / place).read_bytes() == before
    assert [*problems(copy)] == []


def test_sizes_of_blocks_are_in_metres_or_with_units() -> None:
    configuration = yaml.safe_load(CONFIGURATION.read_text())["suite"]
    same = [
        {"width": 0.5, "height": 2.0},
        {"width": "50cm", "height": 2.0},
        {"width": 0.5, "height": "2 m"},
        "rectangle(width=50cm, height=2m)",
    ]
    kinds = [{"width": 0.5, "height": 2.0, "wall": "3 cm"}, "frame(width=50cm, height=4m, mass_ratio=2)"]
    found = suite_configuration(configuration | {"blocks": same + kinds}, CONFIGURATION.parent).blocks
    assert len(found) == 6
    assert len(set(found)) == 3
    others = [same[0] | {"offset": "5 cm"}, same[0]]
    with pytest.raises(ConfigurationError, match="equal edges"):
        check({"title": "", "suite": configuration | {"blocks": others, "sensitivity": None}}, CONFIGURATION.parent)
    with pytest.raises(InvalidArgumentError, match="about the same one"):
        suite_configuration(configuration | {"blocks": [*others, same[0] | {"sides": "left"}]}, CONFIGURATION.parent)


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        ("colour", 1, "'colour' was unexpected"),
        ("name", "a/b", "'a/b' does not match"),
        ("records/pattern", "../*.csv", "'../*.csv' does not match"),
        ("blocks", [], "[] should be non-empty"),
        ("restitution", "plastic", "'plastic' is not valid"),
        ("intensity/points", 1, "is not valid"),
        ("confidence", 1.0, "1.0 is greater than or equal to the maximum of 1"),
        ("sensitivity/intensity", [-1.0], "[-1.0] is not valid"),
        ("sensitivity", {"intensity": [1.0]}, "'restitution_step' is a required property"),
        ("records/folder", "nowhere", "suite.records = "),
        ("records/unit", "feet", "suite.records.unit = 'feet': allowed: one of m/s2"),
        ("blocks", [{"width": 0.4}], "suite.blocks[0].height = None: allowed: required for rectangle"),
        ("measure", "sa", "suite.measure = 'sa': allowed: one of pga, pgv"),
        ("intensity", [3.0, 2.0], "suite.intensity = [3.0, 2.0]: allowed: 1 to 10000 ascending values"),
        ("demand", ["sliding"], "suite.demand = 'sliding': allowed: overturning, alpha"),
        ("map/alpha_deg", [95.0], "suite.map.alpha_deg = 95.0: allowed: (0, 89] [deg]"),
    ],
)
def test_invalid_configuration_is_refused(place: str, value: Any, message: str) -> None:
    """By the schema, or by what makes the suite from it."""
    configuration = yaml.safe_load(CONFIGURATION.read_text())
    *sections, key = place.split("/")
    part = configuration["suite"]
    for name in sections:
        part = part[name]
    part[key] = value
    with pytest.raises((ConfigurationError, WorkflowError)) as error:
        refuse(configuration)
    assert message in str(error.value)


def refuse(configuration: dict[str, Any]) -> None:
    validate(configuration, str(PROJECT / "workflow/config/schema.yaml"))
    check(configuration, CONFIGURATION.parent)
