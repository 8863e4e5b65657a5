"""An archive of a results folder for a data repository: `python -m workflow.deposit [FOLDER]`, or `make deposit`.

FOLDER contains `results`, which must be as its manifest states. The zip file holds the products but for the zarr
stores, which repeat the cubes, and the STAC catalogue, which describes them. Beside them it holds checksums, a
description of DataCite, the licence of the data, a page for readers, and a script that verifies the files without this
package. Equal products give equal bytes of the archive in the same year.
"""

import argparse
import datetime as dt
import hashlib
import json
import shutil
import string
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

from rocking._base.installation import __version__
from workflow.verify import MANIFEST, problems

ROOT = Path(__file__).parents[2]
TEXTS = Path(__file__).parent
PROBLEMS = ROOT / "reference" / "problems"
OLDEST = 1980, 1, 1, 0, 0, 0  # time stamp of all files in the archive, the first that zip knows


def datacite(manifest: dict[str, Any], citation: dict[str, Any], year: int) -> dict[str, Any]:
    """Return the metadata after the DataCite schema 4.5; its `doi` is given by who publishes the archive."""
    size = sum(entry["size"] for entry in manifest["products"].values())
    return {
        "schemaVersion": "http://datacite.org/schema/kernel-4",
        "types": {"resourceTypeGeneral": "Dataset", "resourceType": "model results"},
        "titles": [{"title": f"Response spectra and overturning boundaries of the rocking block: {manifest['title']}"}],
        "creators": [{"name": author["name"], "nameType": "Organizational"} for author in citation["authors"]],
        "publisher": {"name": "to be completed by who publishes"},
        "publicationYear": str(year),
        "version": __version__,
        "language": "en",
        "subjects": [{"subject": word} for word in citation["keywords"]],
        "descriptions": [{"descriptionType": "Abstract", "description": citation["abstract"]}],
        "formats": ["application/zip", "application/x-netcdf"],
        "sizes": [f"{size} bytes", f"{len(manifest['products'])} files"],
        "rightsList": [
            {
                "rights": "Creative Commons Attribution 4.0 International",
                "rightsUri": "https://creativecommons.org/licenses/by/4.0/legalcode",
                "rightsIdentifier": "CC-BY-4.0",
                "rightsIdentifierScheme": "SPDX",
            }
        ],
        "relatedIdentifiers": [
            {"relatedIdentifier": paper["doi"], "relatedIdentifierType": "DOI", "relationType": "References"}
            for paper in citation["references"]
        ],
    }


def files(folder: Path) -> Iterator[tuple[str, bytes | Path]]:
    """Yield name in the archive and content, or path, of each file; the checksums come last."""
    manifest = json.loads((folder / MANIFEST).read_bytes())
    products = [name for name in sorted(manifest["products"]) if (folder / "results" / name).is_file()]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    about = datacite(manifest, citation, dt.datetime.now(dt.UTC).year)
    readme = string.Template((TEXTS / "README.md").read_text(encoding="utf-8")).substitute(
        title=about["titles"][0]["title"],
        description=" ".join(citation["abstract"].split()),
        count=len(products),
        size=f"{sum(entry['size'] for entry in manifest['products'].values()) / 1e6:.1f}",
        version=__version__,
        papers="\n".join(
            f"- {paper['title']}. {paper['journal']}, {paper['year']}. https://doi.org/{paper['doi']}"
            for paper in citation["references"]
        ),
    )
    contents: dict[str, bytes | Path] = {
        "README.md": readme.encode(),
        "LICENSE.txt": TEXTS / "LICENSE.txt",
        "verify.py": TEXTS / "verify.py",
        "datacite.json": (json.dumps(about, indent=2) + "\n").encode(),
        **{f"reference-problems/{path.name}": path for path in sorted(PROBLEMS.iterdir())},
        "data/manifest.json": folder / MANIFEST,
        **{f"data/{name}": folder / "results" / name for name in products},
    }
    yield from contents.items()
    yield "SHA256SUMS", "".join(f"{_digest(content)}  {name}\n" for name, content in contents.items()).encode()


def _digest(content: bytes | Path) -> str:
    if isinstance(content, bytes):
        return hashlib.sha256(content).hexdigest()
    with content.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def deposit(folder: Path, archive: Path) -> None:
    """Write the archive of `folder`, or end with the list of the products that are not as the manifest states."""
    if found := [*problems(folder)]:
        sys.exit("\n".join([*found, f"{len(found)} found; nothing is archived"]))
    archive.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(archive, "w") as target:
        for name, content in files(folder):
            entry = zipfile.ZipInfo(f"{archive.stem}/{name}", OLDEST)
            with target.open(entry, "w", force_zip64=True) as file:  # stored: netCDF files are compressed already
                if isinstance(content, bytes):
                    file.write(content)
                else:
                    with content.open("rb") as source:
                        shutil.copyfileobj(source, file)
    print(f"{archive}: {archive.stat().st_size / 1e6:.1f} MB, sha256 {_digest(archive)}")


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=Path(), help="folder with the folder `results`")
    parser.add_argument("--archive", type=Path, default=Path("build/rocking-data.zip"))
    options = parser.parse_args()
    deposit(options.folder, options.archive)


if __name__ == "__main__":
    main()
