"""Digests of the products, recorded by the job that made them: a product that differs from its record is made again.

The record of a job is one of its outputs: a job without its record is run again, as without any other output. Its name
contains a digest of the code and the settings of the job, so that it is missing after a change of them, whether or not
Snakemake has noted what the products were made from (it has not for a job that went on after its run was killed).
"""

import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from rocking._datasets.netcdf import sha256_of_file
from rocking._datasets.provenance import settings_digest

FOLDER = Path("results/.records")
PARTS = Path("results/.parts")  # files from which products are made, kept so that what does not change is not repeated


def digest(path: Path) -> dict[str, Any]:
    """Size [bytes] and sha256 of a file."""
    return {"sha256": sha256_of_file(path), "size": path.stat().st_size}


def _digest_of_values(path: Path) -> dict[str, str]:
    """The digest of the values of a data set that it states itself; nothing for other files."""
    if path.suffix != ".nc":
        return {}
    from rocking._datasets.netcdf import open_netcdf  # noqa: PLC0415  # half a second, for jobs that have loaded it

    with open_netcdf(path, cache=False) as opened:
        return {"content_sha256": opened.attrs["content_sha256"]}


def processor() -> str:
    """Name by LLVM of the processor that the kernels are compiled for, such as znver4."""
    import llvmlite.binding  # noqa: PLC0415  # for jobs, which have loaded it

    return os.environ.get("NUMBA_CPU_NAME") or str(llvmlite.binding.get_host_cpu_name())


def record_name(job: str, provenance: Mapping[str, Any]) -> str:
    """Name in the folder of the record of a job, with a digest of what its products are made from."""
    return f"{job}.{settings_digest(provenance)[:16]}.json"


def records_of(folder: Path, job: str) -> list[Path]:
    """The records of a job in the folder of a run, by its name such as `spectra/sine`; one, if the run is finished."""
    place = (folder / FOLDER / job).parent
    return sorted(path for path in place.glob("*.json") if path.name.rsplit(".", 2)[0] == Path(job).name)


def write_record(record: Path, products: Iterable[Path]) -> None:
    """Write the digests of the products of a job, and delete its records of former products.

    Beside the bytes of a data set its values have a digest: the attributes name the code that it was made with, the
    values do not. The values depend on the instructions of the processor, whose name is stated.
    """
    job = record.name.rsplit(".", 2)[0]
    for former in record.parent.glob("*.json"):
        if former.name.rsplit(".", 2)[0] == job:
            former.unlink()
    content = {
        path.as_posix(): digest(path) | _digest_of_values(path) | {"processor": processor()} for path in products
    }
    record.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def read_record(record: Path) -> dict[str, Any]:
    """The digests that `write_record` wrote. Raises `ValueError` if the file is not a record."""
    content = json.loads(record.read_bytes())
    if not isinstance(content, dict) or not content:
        raise ValueError(f"{record}: no record of products")
    return content


def differences(folder: Path, recorded: Mapping[str, Any]) -> Iterator[str]:
    """Descriptions of the files that are missing in a folder or differ from their recorded digests."""
    for name, expected in recorded.items():
        path = folder / name
        try:
            found = digest(path)
        except OSError as error:
            yield f"{path}: {error.strerror}"
        else:
            if not isinstance(expected, dict) or not found.items() <= expected.items():
                yield f"{path}: its bytes are not the recorded ones"


def false_records(folder: Path) -> Iterator[tuple[Path, list[str]]]:
    """Each record that is damaged or does not match its products, with the reasons."""
    for record in sorted((folder / FOLDER).rglob("*.json")):
        try:
            found = [*differences(folder, read_record(record))]
        except ValueError:
            found = [f"{record}: damaged"]
        if found:
            yield record, found


def forget_false_records(folder: Path) -> Iterator[str]:
    """Delete these records, so that Snakemake runs their jobs again; yields the reasons."""
    for record, found in false_records(folder):
        _date_back(folder, record)
        record.unlink()
        yield from found


def date_back_outdated(folder: Path, names: Iterable[str]) -> None:
    """Give the oldest time to the products of jobs whose record has another name than in `names`.

    Where a product is asked for by its path, Snakemake looks for that file alone and not for the record beside it. A
    file that is older than the script of its job is made again.
    """
    for name in names:
        job, current, _ = re.sub(r"\{\w+\}", "*", name).rsplit(".", 2)
        for record in (folder / FOLDER).glob(f"{job}.*.json"):
            if record.name.rsplit(".", 2)[1] != current:
                _date_back(folder, record)


def _date_back(folder: Path, record: Path) -> None:
    """Give the products of a record the oldest time."""
    products: Mapping[str, Any] = {}
    with suppress(ValueError):  # a damaged record
        products = read_record(record)
    for name in products:
        with suppress(FileNotFoundError):
            os.utime(folder / name, (0, 0))
