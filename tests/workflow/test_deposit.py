"""The archive for a data repository: complete, described, and verified without this package."""

import json
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
import yaml

from tests.workflow_fixtures import PROJECT
from workflow.deposit.__main__ import deposit

pytestmark = pytest.mark.slow  # with the shared run of the workflow


@pytest.fixture(scope="module")
def archive(smoke_run: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("deposit") / "rocking-data.zip"
    deposit(smoke_run, path)
    return path


@pytest.fixture
def folder(archive: Path, tmp_path: Path) -> Path:
    zipfile.ZipFile(archive).extractall(tmp_path)
    return tmp_path / "rocking-data"


def verified(folder: Path) -> subprocess.CompletedProcess[str]:
    """Run the script as someone who has Python only: isolated from the environment and its packages."""
    command = [sys.executable, "-I", "-S", "verify.py"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def test_archive_holds_every_product_and_verifies_itself(folder: Path, smoke_results: Path) -> None:
    products = json.loads((smoke_results / "manifest.json").read_bytes())["products"]
    products = [name for name in products if name != "stac" and not name.startswith("zarr/")]
    held = {path.relative_to(folder / "data").as_posix() for path in (folder / "data").rglob("*") if path.is_file()}
    assert held == {*products, "manifest.json"}
    done = verified(folder)
    problems = {path.name for path in (PROJECT / "reference" / "problems").iterdir()}
    assert {path.name for path in (folder / "reference-problems").iterdir()} == problems
    assert (done.returncode, done.stdout) == (0, f"all {len(products) + len(problems) + 5} files are as listed\n")
    if shutil.which("sha256sum"):
        subprocess.run(["sha256sum", "--check", "--quiet", "SHA256SUMS"], cwd=folder, check=True)


def test_files_that_differ_are_named(folder: Path) -> None:
    (folder / "data/claims.md").unlink()
    (folder / "extra.txt").write_text("")
    cube = folder / "data/spectra/sine/eta-0.85.nc"
    spoiled = bytearray(cube.read_bytes())
    spoiled[len(spoiled) // 2] ^= 1
    cube.write_bytes(spoiled)
    done = verified(folder)
    assert done.returncode == 1
    assert done.stderr.splitlines() == [
        "data/claims.md: missing",
        "data/spectra/sine/eta-0.85.nc: differs from its checksum",
        "extra.txt: not listed",
    ]


def test_description_has_what_datacite_requires(folder: Path) -> None:
    about = json.loads((folder / "datacite.json").read_bytes())
    citation = yaml.safe_load((PROJECT / "CITATION.cff").read_text())
    required = ("creators", "titles", "publisher", "publicationYear", "types", "schemaVersion")
    assert [field for field in required if not about[field]] == []
    assert about["types"]["resourceTypeGeneral"] == "Dataset"
    assert about["rightsList"][0]["rightsIdentifier"] == "CC-BY-4.0"
    assert [one["relatedIdentifier"] for one in about["relatedIdentifiers"]] == [citation["references"][0]["doi"]]
    assert "$" not in (folder / "README.md").read_text()


def test_equal_products_give_equal_bytes(archive: Path, smoke_run: Path, tmp_path: Path) -> None:
    deposit(smoke_run, tmp_path / "rocking-data.zip")
    assert (tmp_path / "rocking-data.zip").read_bytes() == archive.read_bytes()


def test_a_damaged_folder_is_not_archived(smoke_run: Path, tmp_path: Path) -> None:
    run = Path(shutil.copytree(smoke_run / "results", tmp_path / "results")).parent
    (run / "results/claims.md").write_text("other")
    with pytest.raises(SystemExit, match=r"results/claims\.md"):
        deposit(run, tmp_path / "archive.zip")
    assert not (tmp_path / "archive.zip").exists()
