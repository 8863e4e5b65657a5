"""Lists every product with its size, sha256, rule and the digests of the code and the settings behind it."""

import hashlib
import json
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rocking._base.output_file import PARTIAL, write_output
from rocking._datasets.checksum import sha256_of_file
from rocking._datasets.netcdf import open_netcdf
from workflow.scripts.job import run

TIMESTAMP = ".snakemake_timestamp"  # file that Snakemake adds to a folder which is a product


def main(
    *, products: Sequence[Path], sources: Mapping[str, Mapping[str, str]], title: str, manifest: Path, code: str
) -> None:
    """Write the manifest; paths in it are relative to the folder that holds it, so that it can be moved.

    `sources` for the path of each product: its `rule`, `code_sha256` and `settings_sha256`. `code`: digest of this
    script. What killed jobs left unfinished is deleted.
    """
    for unfinished in manifest.parent.rglob(f".*{PARTIAL}"):
        unfinished.unlink(missing_ok=True)
    listed = {
        path.relative_to(manifest.parent).as_posix(): digest_of(path) | _of_data_set(path) | dict(sources[str(path)])
        for path in sorted(products)
    }
    content = {"title": title, "manifest_code_sha256": code, **commit_of(Path(__file__).parents[2]), "products": listed}
    write_output(manifest, json.dumps(content, indent=1) + "\n")


def digest_of(product: Path) -> dict[str, Any]:
    """Size [bytes] and sha256 of a file; of a folder those of all its files, with their names."""
    if not product.is_dir():
        return {"sha256": sha256_of_file(product), "size": product.stat().st_size}
    files = sorted(path for path in product.rglob("*") if path.is_file() and path.name != TIMESTAMP)
    lines = [f"{sha256_of_file(path)}  {path.relative_to(product).as_posix()}\n" for path in files]
    size = sum(path.stat().st_size for path in files)
    return {"sha256": hashlib.sha256("".join(lines).encode()).hexdigest(), "size": size}


def _of_data_set(product: Path) -> dict[str, str]:
    """The digest of its values and the processor, which a data set states; nothing for other products."""
    if product.suffix != ".nc":
        return {}
    with open_netcdf(product, cache=False) as opened:
        return {name: opened.attrs[name] for name in ("content_sha256", "processor")}


def commit_of(project: Path) -> dict[str, str]:
    """The commit of the project, if git knows it and no file in version control differs from it."""
    git = ["git", "-C", str(project)]
    try:
        changed, commit = (
            subprocess.run([*git, *command], capture_output=True, text=True, check=True).stdout.strip()
            for command in (("status", "--porcelain", "--untracked-files=no"), ("rev-parse", "HEAD"))
        )
    except (OSError, subprocess.CalledProcessError):
        return {}
    return {} if changed else {"commit": commit}


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
