"""What archives and package indexes are told of the project agrees, and is stated in one place each."""

import runpy
import tomllib
from pathlib import Path

import pytest
import yaml
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
CITATION = yaml.safe_load((ROOT / "CITATION.cff").read_text())


@pytest.mark.parametrize("name", ["codemeta.json", ".zenodo.json"])
def test_files_of_archives_repeat_the_citation(name: str) -> None:
    expected = runpy.run_path(str(ROOT / "docs" / "metadata.py"))["files"]()
    assert (ROOT / name).read_text() == expected[name], "written anew by: python docs/metadata.py"


def test_project_and_citation_agree() -> None:
    assert PROJECT["keywords"] == CITATION["keywords"]
    assert PROJECT["license"] == CITATION["license"]
    assert [author["name"] for author in PROJECT["authors"]] == [author["name"] for author in CITATION["authors"]]


CONDA_NAMES = {"matplotlib": "matplotlib-base", "prometheus-client": "prometheus_client"}
"""Names of packages in conda-forge that are not those of the Python package index."""


def conda(lines: list[str]) -> list[str]:
    found = [Requirement(line) for line in lines]
    return [f"{CONDA_NAMES.get(one.name, one.name.lower())} {one.specifier}" for one in found]


def test_recipe_of_conda_states_what_the_project_states() -> None:
    text = (ROOT / "deploy" / "conda" / "recipe.yaml").read_text()
    recipe = yaml.safe_load(text.replace("${{ python_min }}", PROJECT["requires-python"].removeprefix(">=")))
    assert recipe["context"]["version"] == PROJECT["version"]
    assert recipe["about"] | {"license_file": PROJECT["license-files"][0]} == recipe["about"]
    assert (recipe["about"]["summary"], recipe["about"]["license"]) == (PROJECT["description"], PROJECT["license"])
    python = f"python {PROJECT['requires-python']}"
    assert recipe["requirements"]["run"] == [python, *conda(PROJECT["dependencies"])]
    extras = PROJECT["optional-dependencies"]
    own = [line for line in extras["service"] if not line.startswith("rocking[")]
    constraints = conda([*extras["plot"], *extras["sheets"], *own])
    assert recipe["requirements"]["run_constraints"] == constraints
    commands = [f"{name} = {target}" for name, target in PROJECT["scripts"].items()]
    assert recipe["build"]["python"]["entry_points"] == commands
    assert recipe["requirements"]["host"][2:] == ["setuptools >=77"]
    (command,) = recipe["tests"][1]["script"]
    assert command in (ROOT / "README.md").read_text()
