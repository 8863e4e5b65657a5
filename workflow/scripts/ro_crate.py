"""Describes a run as a RO-Crate: its products with their digests, the workflow and the configuration that made them."""

import datetime as dt
import json
from pathlib import Path
from typing import Any

import yaml
from rocrate.model.contextentity import ContextEntity
from rocrate.rocrate import ROCrate

from rocking._base.installation import __version__
from rocking._base.output_file import write_output
from workflow.scripts.job import run

CITATION = Path(__file__).parents[2] / "CITATION.cff"

OLDEST = dt.datetime(1980, 1, 1, tzinfo=dt.UTC)
"""Date of the crate, as of the files in the archive of `workflow.deposit`: a run states no time, so that equal runs
have equal bytes. Whoever publishes the crate puts the date of publication in its place."""

FORMATS = {
    ".nc": "application/netcdf",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".json": "application/json",
    ".md": "text/markdown",
    ".html": "text/html",
    ".zarr": "application/vnd+zarr",
}


def main(*, manifest: Path, configuration: dict[str, Any], crate: Path) -> None:
    """Write `crate`, the file ro-crate-metadata.json beside the manifest that it describes.

    `configuration`: the settings of the run.
    """
    listed = json.loads(manifest.read_bytes())
    about = yaml.safe_load(CITATION.read_text(encoding="utf-8"))
    description = ROCrate()
    description.name = listed["title"]
    description.description = " ".join(about["abstract"].split())
    description.license = "https://creativecommons.org/licenses/by/4.0/"
    description.datePublished = OLDEST
    products = [add_product(description, name, entry) for name, entry in listed["products"].items()]
    products.append(description.add_file(dest_path=manifest.name, properties={"encodingFormat": FORMATS[".json"]}))
    workflow = add(description, "#workflow", "SoftwareSourceCode", name=about["title"], version=__version__)
    settings = add(description, "#configuration", "PropertyValue", name="configuration", value=text_of(configuration))
    description.add_action(
        workflow, "#run", object=[settings], result=products, properties={"name": "run of the workflow"}
    )
    content = json.dumps(description.metadata.generate(), indent=1, sort_keys=True)
    write_output(crate, content + "\n")


def add(crate: ROCrate, identifier: str, kind: str, **properties: str) -> ContextEntity:
    """Add an entity that is no file."""
    return crate.add(ContextEntity(crate, identifier, properties={"@type": kind, **properties}))


def add_product(crate: ROCrate, name: str, entry: dict[str, Any]) -> Any:
    """Add a product of the manifest: a file, or a folder such as a zarr store."""
    properties = {"sha256": entry["sha256"], "contentSize": str(entry["size"]), "description": f"rule {entry['rule']}"}
    suffix = Path(name).suffix
    if suffix in FORMATS:
        properties["encodingFormat"] = FORMATS[suffix]
    if suffix in ("", ".zarr"):
        return crate.add_dataset(dest_path=name, properties=properties)
    return crate.add_file(dest_path=name, properties=properties)


def text_of(configuration: dict[str, Any]) -> str:
    """Settings as JSON text."""
    return json.dumps(configuration, sort_keys=True)


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
