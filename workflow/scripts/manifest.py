"""Lists every product with its size, sha256, rule and the digests of the code and the settings behind it."""

import json
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from workflow.records import read_record
from workflow.scripts.job import run


def main(
    *,
    products: Sequence[Path],
    records: Sequence[Path],
    sources: Mapping[str, Mapping[str, str]],
    title: str,
    manifest: Path,
    code: str,
) -> None:
    """Write the manifest; paths in it are relative to the folder that holds it, so that it can be moved.

    `records` of the jobs hold the digests of the products; `sources` for the path of each product its `rule`,
    `code_sha256` and `settings_sha256`. `code` is the digest of this script, so that Snakemake runs it again when it
    changes.
    """
    recorded = {name: entry for record in records for name, entry in read_record(record).items()}
    listed = {
        path.relative_to(manifest.parent).as_posix(): {**recorded[str(path)], **sources[str(path)]}
        for path in sorted(products)
    }
    content = {"title": title, "manifest_code_sha256": code, **commit_of(Path(__file__).parents[2]), "products": listed}
    manifest.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


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
