"""STAC catalogue and RO-Crate of a run: read by the libraries of these formats, with the bytes of another run."""

import json
from pathlib import Path

import pystac
import xarray as xr
import yaml
from pystac.extensions.datacube import DatacubeExtension
from rocrate.rocrate import ROCrate

from rocking._datasets.cube import DIMENSIONS
from tests.workflow_fixtures import SMOKE
from workflow.scripts import ro_crate, stac


def test_catalogue_leads_to_every_data_set(smoke_results: Path) -> None:
    catalogue = pystac.Catalog.from_file(str(smoke_results / "stac/catalog.json"))
    items = list(catalogue.get_items(recursive=True))
    configuration = yaml.safe_load(SMOKE.read_text())
    assert {child.id for child in catalogue.get_children()} == set(configuration["pulses"])
    assert len(items) == len(configuration["pulses"]) * len(configuration["restitution"])
    for item in items:
        paths = {name: Path(asset.get_absolute_href()) for name, asset in item.assets.items()}
        assert all(path.is_file() for path in paths.values())
        with xr.open_dataset(paths["spectrum"]) as cube:
            described = DatacubeExtension.ext(item)
            assert set(described.dimensions) == set(DIMENSIONS) == set(cube.dims)
            assert set(described.variables or {}) == set(cube.data_vars)
            assert item.properties["rocking:restitution"] == float(cube.restitution)
    for collection in catalogue.get_children():
        store = Path(collection.assets["zarr"].get_absolute_href())
        with xr.open_zarr(store) as opened:
            dimensions = DatacubeExtension.ext(collection).dimensions
            assert {name: len(dimension.values) for name, dimension in dimensions.items()} == dict(opened.sizes)


def test_catalogue_made_twice_has_equal_bytes(smoke_results: Path, tmp_path: Path) -> None:
    """And names no folder of the machine that made it."""
    contents = []
    for place in ("first", "second"):
        results = tmp_path / place / "results"
        results.mkdir(parents=True)
        for part in ("spectra", "overturning", "zarr"):
            (results / part).symlink_to(smoke_results / part)
        cubes = sorted(results.glob("spectra/*/eta-*.nc"))
        boundaries = [results / "overturning" / path.relative_to(results / "spectra") for path in cubes]
        stores = sorted(results.glob("zarr/*.zarr"))
        stac.main(cubes=cubes, boundaries=boundaries, stores=stores, folder=results / "stac")
        files = sorted(path for path in (results / "stac").rglob("*") if path.is_file())
        contents.append({path.relative_to(results): path.read_bytes() for path in files})
    assert contents[0] == contents[1]
    assert not any(str(tmp_path).encode() in content for content in contents[0].values())


def test_crate_lists_the_products_of_the_manifest(smoke_results: Path, tmp_path: Path) -> None:
    manifest = json.loads((smoke_results / "manifest.json").read_text())
    crate = ROCrate(smoke_results)
    run = crate.dereference("#run")
    identifiers = {entity.id.rstrip("/") for entity in run["result"]}
    assert identifiers == {*manifest["products"], "manifest.json"}
    for name, entry in manifest["products"].items():
        entity = crate.dereference(name) or crate.dereference(f"{name}/")
        assert entity["sha256"] == entry["sha256"]
    written = smoke_results / "ro-crate-metadata.json"
    configuration = json.loads(crate.dereference("#configuration")["value"])
    ro_crate.main(manifest=smoke_results / "manifest.json", configuration=configuration, crate=tmp_path / written.name)
    assert (tmp_path / written.name).read_bytes() == written.read_bytes()
