"""The workflow as a whole, run by Snakemake itself on the smallest configuration."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import tomllib
import zipfile
from pathlib import Path

import llvmlite.binding
import numpy as np
import pytest
import xarray as xr
import yaml

import rocking
from rocking._datasets.cube import read_dataset, read_spectrum
from rocking._datasets.provenance import settings_digest
from tests.workflow.test_sampled_pulses import configuration as data_sets_alone
from tests.workflow_fixtures import AFTERWARDS, PROJECT, SMOKE, rules_to_run, snakemake
from workflow.scripts.manifest import commit_of


@pytest.fixture
def copy_of_run(smoke_run: Path, tmp_path: Path) -> Path:
    """A finished run that a test may spoil; times of files are kept, or Snakemake would build all of them again."""
    return Path(shutil.copytree(smoke_run, tmp_path / "run"))


def test_every_product_is_made_and_listed(smoke_results: Path) -> None:
    manifest = json.loads((smoke_results / "manifest.json").read_text())
    figures = [
        *(f"figure-0{k}" for k in range(1, 10)),
        *(f"figure-{k}" for k in range(10, 14)),
        "figure-S1",
        "figure-scale-law",
        "figure-scale-law-excitations",
        "figure-master-spectra",
        "figure-master-housner",
        "table-1",
    ]
    expected = {f"figures/{name}.{kind}" for name in figures for kind in ("svg", "png", "nc")}
    expected |= {"claims.json", "claims.md", "claims.html"}
    for pulse in ("sine", "cosine"):
        for kind in ("spectra", "overturning"):
            expected |= {f"{kind}/{pulse}/eta-{eta}.nc" for eta in ("0.85", "0.90")}
        expected |= {f"spectra/{pulse}/restitution-errors.nc", f"zarr/{pulse}.zarr"}
    expected |= {"stac"}
    assert set(manifest["products"]) == expected
    files = {path.relative_to(smoke_results).as_posix() for path in smoke_results.rglob("*") if path.is_file()}
    beside = {name for name in files - expected if not name.startswith(("zarr/", "stac/"))}
    # and nothing else lies about
    checks = {"checks.txt", "checks/sine.txt", "checks/cosine.txt"}
    assert beside == checks | {"manifest.json", "ro-crate-metadata.json"}


def test_products_carry_the_digests_of_the_manifest(smoke_results: Path) -> None:
    entry = json.loads((smoke_results / "manifest.json").read_text())["products"]["spectra/sine/eta-0.85.nc"]
    cube = read_spectrum(smoke_results / "spectra/sine/eta-0.85.nc")
    assert cube.attrs["code_sha256"] == entry["code_sha256"]
    assert cube.attrs["settings_sha256"] == entry["settings_sha256"]


@pytest.mark.parametrize("name", ["spectra/sine/eta-0.85", "overturning/cosine/eta-0.90", "figures/figure-07"])
def test_a_data_set_states_version_command_and_configuration(smoke_results: Path, name: str) -> None:
    about = read_dataset(smoke_results / f"{name}.nc").attrs
    assert about["product_version"] == rocking.__version__
    assert about["history"] == f"snakemake results/{name}.nc"
    assert about["processor"] == (os.environ.get("NUMBA_CPU_NAME") or llvmlite.binding.get_host_cpu_name())
    assert settings_digest(json.loads(about["configuration"])) == about["settings_sha256"]
    (author,) = tomllib.loads((PROJECT / "pyproject.toml").read_text())["project"]["authors"]
    names = {about[f"{role}_{kind}"] for role in ("creator", "publisher") for kind in ("name", "institution")}
    assert names == {about["institution"]} == {author["name"]}


def test_the_manifest_states_the_commit_only_of_an_unchanged_checkout(tmp_path: Path) -> None:
    assert commit_of(tmp_path) == {}
    git = ["git", "-C", str(tmp_path), "-c", "user.name=a", "-c", "user.email=a@b.c"]
    (tmp_path / "a").write_text("1")
    for command in (["init", "-q"], ["add", "a"], ["commit", "-q", "-m", "a"]):
        subprocess.run([*git, *command], check=True)
    assert len(commit_of(tmp_path)["commit"]) == 40
    (tmp_path / "a").write_text("2")
    assert commit_of(tmp_path) == {}


def test_products_were_tested(smoke_results: Path) -> None:
    lines = (smoke_results / "checks.txt").read_text().splitlines()
    assert len(lines) > 60
    assert all(line.startswith("passed test_") for line in lines)


def test_store_of_a_pulse_holds_its_cubes(smoke_results: Path) -> None:
    store = xr.open_zarr(smoke_results / "zarr/sine.zarr", consolidated=True)
    for eta in (0.85, 0.90):
        cube = read_spectrum(smoke_results / f"spectra/sine/eta-{eta:.2f}.nc")
        np.testing.assert_array_equal(store.peak_rotation.sel(restitution=eta), cube.peak_rotation)


def state(folder: Path) -> dict[str, tuple[int, int]]:
    """Size and time of each file and folder; `.snakemake`, the notes of Snakemake itself, is left out."""
    found = {}
    for path in [folder, *folder.rglob("*")]:
        name = path.relative_to(folder)
        if name.parts[:1] != (".snakemake",):
            found[name.as_posix()] = path.stat().st_size, path.stat().st_mtime_ns
    return found


def test_reading_the_workflow_and_dry_runs_change_nothing(copy_of_run: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.yaml"
    configuration = yaml.safe_load(SMOKE.read_text())
    configuration["figures"]["figure-07"]["ours"]["slenderness"] = 0.46
    configuration["boundary"]["nodes"] = 103
    other.write_text(yaml.safe_dump(configuration))
    before = state(copy_of_run)
    planned = snakemake(copy_of_run, "--dry-run", configuration=other)
    assert planned.returncode == 0, planned.stdout
    assert {"overturning", "spectra", "figures_histories"} <= rules_to_run(planned.stdout)
    assert snakemake(copy_of_run, "--summary", configuration=other).returncode == 0
    assert state(copy_of_run) == before
    assert "Nothing to be done" in snakemake(copy_of_run, "--dry-run").stdout
    assert state(copy_of_run) == before


def test_second_run_does_nothing_also_if_files_are_newer(copy_of_run: Path) -> None:
    for path in (copy_of_run / "results").rglob("*.nc"):
        path.touch()
    again = snakemake(copy_of_run)
    assert again.returncode == 0
    assert "Nothing to be done" in again.stdout


def test_changed_module_reruns_only_dependent_jobs(copy_of_run: Path, tmp_path: Path) -> None:
    """In a project that has moved."""
    project = tmp_path / "project"
    for folder in ("rocking", "workflow", "profiles", "benchmarks"):
        shutil.copytree(PROJECT / folder, project / folder, ignore=shutil.ignore_patterns("__pycache__"))
    (project / "docs").mkdir()
    for name in ("Snakefile", "environment.lock", "CITATION.cff", "docs/equations.md"):
        shutil.copy2(PROJECT / name, project / name)
    modules = {
        "rocking/paper/orientation.py": {"figures_closed_forms", "claims"},
        "workflow/figures/figure_08.py": {"figures_spectrum_curves"},
        "workflow/scripts/spectra.py": {
            "spectra", "restitution_errors", "zarr_store", "check_data_sets", "figures_scale_law", "claims",
        },
    }  # fmt: skip
    for module in modules:
        with (project / module).open("a") as source:
            source.write("\n# a change\n")
    changed = snakemake(copy_of_run, "--dry-run", project=project)
    assert rules_to_run(changed.stdout) == set.union(*modules.values()) | {"stac", *AFTERWARDS}


@pytest.mark.long
def test_another_restitution_repeats_what_depends_on_it_alone(tmp_path: Path) -> None:
    """Of the data sets of one pulse; files without content stand for the products."""
    run, before, changed, added = (tmp_path / name for name in ("run", "before.yaml", "changed.yaml", "added.yaml"))
    for path, last in ((before, [0.98]), (changed, [0.97]), (added, [0.98, 0.99])):
        restitution = [0.92, 0.94, 0.96, *last, 1.00]
        path.write_text(yaml.safe_dump(data_sets_alone(["sine"]) | {"restitution": restitution}))
    summary = snakemake(run, "--summary", configuration=before).stdout
    for name in re.findall(r"^(results/\S+)\t", summary, flags=re.MULTILINE):
        (run / name).parent.mkdir(parents=True, exist_ok=True)
        (run / name).mkdir() if name.endswith((".zarr", "stac")) else (run / name).touch()
    assert snakemake(run, "--touch", "--forceall", configuration=before).returncode == 0
    for other, eta in ((added, "0.99"), (changed, "0.97")):
        planned = snakemake(run, "--dry-run", configuration=other).stdout
        once = {"overturning", "spectra", "restitution_errors", "zarr_store", "check_data_sets"}
        assert rules_to_run(planned) == once | {"stac", *AFTERWARDS}, planned
        for text in ("boundaries", "Spectrum cube"):
            assert re.findall(rf"{text} of the \w+ pulse at restitution (\S+)", planned) == [eta]


@pytest.mark.long
def test_lint_finds_nothing(tmp_path: Path) -> None:
    linted = snakemake(tmp_path, "--lint")
    assert linted.returncode == 0, linted.stdout


@pytest.mark.long
def test_report_holds_figures_with_captions(copy_of_run: Path) -> None:
    report = snakemake(copy_of_run, "--report", "report.zip")
    assert report.returncode == 0, report.stdout
    with zipfile.ZipFile(copy_of_run / "report.zip") as archive:
        names = archive.namelist()
        page = b"".join(archive.read(name) for name in names if name.endswith((".html", ".js")))
    assert len([name for name in names if name.endswith(".png")]) >= 19
    caption = (PROJECT / "workflow/report/figure-07.rst").read_text().split(",")[0]
    assert caption.encode() in page


def test_environment_of_the_jobs_has_the_versions_of_the_project() -> None:
    """Names of conda-forge are those of PyPI but for a few."""
    text = (PROJECT / "pyproject.toml").read_text()
    for package in yaml.safe_load((PROJECT / "workflow/envs/rocking.yaml").read_text())["dependencies"]:
        renamed = package.replace("lazy_", "lazy-").replace("-base", "").replace("pystac", "pystac-core")
        name, _, version = renamed.partition(" ")
        assert name == "python" or f'"{name}{version}"'.lower() in text.lower(), package


@pytest.mark.long
@pytest.mark.parametrize("name", ["atlas", "atlas-small"])
def test_other_configurations_are_valid(name: str, tmp_path: Path) -> None:
    planned = snakemake(tmp_path, "--dry-run", "--quiet", configuration=PROJECT / f"workflow/config/{name}.yaml")
    assert planned.returncode == 0, planned.stdout


@pytest.mark.parametrize("path", sorted((PROJECT / "workflow/manifests").glob("*.json")), ids=lambda path: path.stem)
def test_stored_manifests_are_those_of_their_configurations(path: Path) -> None:
    configuration = yaml.safe_load((PROJECT / "workflow/config" / path.name.replace(".json", ".yaml")).read_text())
    listed = json.loads(path.read_text())["products"]
    expected = {
        f"{kind}/{pulse}/eta-{eta:.2f}.nc"
        for kind in ("spectra", "overturning")
        for pulse in configuration["pulses"]
        for eta in configuration["restitution"]
    }
    figures = {f"figures/{name}.{kind}" for name in configuration.get("figures", ()) for kind in ("svg", "png", "nc")}
    claims = {"claims.json", "claims.md", "claims.html"} if "claims" in configuration else set()
    # manifests from before these products have the others
    later = {name for name in listed if name == "stac" or name.endswith((".zarr", "/restitution-errors.nc"))}
    assert set(listed) - later == expected | figures | claims
    assert all("content_sha256" in entry for name, entry in listed.items() if name.endswith(".nc"))
    assert len({entry["processor"] for name, entry in listed.items() if name.endswith(".nc")}) == 1
