"""Writes a STAC catalogue of the data sets: a collection for each pulse, an item for each of its restitutions."""

import datetime as dt
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pystac
import xarray as xr
from pystac.extensions.datacube import AdditionalDimension, DatacubeExtension, Variable

from rocking._datasets.netcdf import open_netcdf
from workflow.scripts.job import run

DATE = dt.datetime(2012, 4, 4, tzinfo=dt.UTC)
"""Time of all items: the data have none, STAC asks for one. That of the paper keeps the bytes the same in each run."""

NOWHERE = (
    "The data are results of a model in dimensionless groups: they have no place and no time. Their extent in STAC "
)
NOWHERE += "is the whole globe at the date of the paper, as STAC asks for one."

CUBE = {
    "media_type": "application/netcdf",
    "roles": ["data"],
    "title": "peak rotation, outcome and impacts over angle, slenderness and frequency ratio",
}
BOUNDARY = {"media_type": "application/netcdf", "roles": ["data"], "title": "overturning boundaries of each angle"}
STORE = {"media_type": "application/vnd+zarr", "roles": ["data"], "title": "cubes of all restitutions as a zarr store"}


def main(*, cubes: Sequence[Path], boundaries: Sequence[Path], stores: Sequence[Path], folder: Path) -> None:
    """Write the catalogue into `folder`, with links relative to it.

    `cubes`: spectrum cubes; `boundaries`: the overturning boundaries of the same pulses and restitutions, in the same
    order; `stores`: the zarr store of each pulse, PULSE.zarr.
    """
    catalogue = pystac.Catalog("rocking", f"Rocking spectra and overturning boundaries. {NOWHERE}", title="rocking")
    collections = {store.stem: collection_of(store) for store in stores}
    catalogue.add_children(collections.values())
    for cube, boundary in zip(cubes, boundaries, strict=True):
        collections[cube.parent.name].add_item(item_of(cube, boundary))
    for store in stores:
        add_restitution(collections[store.stem])
    catalogue.normalize_hrefs(str(folder.absolute()))
    catalogue.make_all_asset_hrefs_relative()
    catalogue.save(pystac.CatalogType.SELF_CONTAINED)
    print(f"{folder}: {len(collections)} collections, {len(cubes)} items")


def collection_of(store: Path) -> pystac.Collection:
    """Collection of a pulse, with its zarr store."""
    extent = pystac.Extent(pystac.SpatialExtent([[-180.0, -90.0, 180.0, 90.0]]), pystac.TemporalExtent([[DATE, DATE]]))
    text = f"Response of rocking blocks under the {store.stem} pulse. {NOWHERE}"
    collection = pystac.Collection(store.stem, text, extent, title=f"{store.stem} pulse", license="CC-BY-4.0")
    collection.add_asset("zarr", pystac.Asset(str(store.absolute()), **STORE))
    return collection


def item_of(cube: Path, boundary: Path) -> pystac.Item:
    """Item of one restitution of a pulse, with the dimensions and variables of its cube."""
    with open_netcdf(cube) as dataset:
        properties = {"title": dataset.attrs["title"], "rocking:restitution": float(dataset.restitution)}
        identifier = f"{cube.parent.name}-{cube.stem}"
        item = pystac.Item(identifier, geometry=None, bbox=None, datetime=DATE, properties=properties)
        item.add_asset("spectrum", pystac.Asset(str(cube.absolute()), **CUBE))
        item.add_asset("boundaries", pystac.Asset(str(boundary.absolute()), **BOUNDARY))
        dimensions = {str(name): dimension_of(dataset[name]) for name in dataset.dims}
        variables = {str(name): variable_of(array) for name, array in dataset.data_vars.items()}
    DatacubeExtension.ext(item, add_if_missing=True).apply(dimensions, variables)
    return item


def add_restitution(collection: pystac.Collection) -> None:
    """Give a collection the dimensions of its items, and restitution as a further one."""
    items = list(collection.get_items())
    cubes = [DatacubeExtension.ext(item) for item in items]
    values = sorted(item.properties["rocking:restitution"] for item in items)
    restitution = {"type": "restitution", "description": "coefficient of restitution", "values": values}
    dimensions = {"restitution": AdditionalDimension(restitution), **cubes[0].dimensions}
    variables = dict(cubes[0].variables or {})
    DatacubeExtension.ext(collection, add_if_missing=True).apply(dimensions, variables)


def dimension_of(axis: xr.DataArray) -> AdditionalDimension:
    """Dimension of a data cube from the axis of a file; its type is its name."""
    fields = {**description_of(axis), "type": str(axis.name), "values": axis.values.tolist()}
    return AdditionalDimension(fields)


def variable_of(array: xr.DataArray) -> Variable:
    """Variable of a data cube."""
    return Variable({**description_of(array), "type": "data", "dimensions": [str(name) for name in array.dims]})


def description_of(array: xr.DataArray) -> Mapping[str, Any]:
    """Meaning and unit of a variable of a file."""
    attributes = array.attrs
    fields = {"description": attributes.get("long_name", ""), "unit": attributes.get("units")}
    return {name: value for name, value in fields.items() if value is not None}


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
