"""Schema of the spectrum cubes, and functions that write and read data set files.

A spectrum cube (`results/spectra/PULSE/eta-0.85.nc`) has dimensions (alpha, slenderness, frequency_ratio), the
variables `VARIABLES`, which say what they hold, scalar coordinates `pulse` and `restitution`, the attribute
`IMPACTS_BEFORE_REST`, and derived fields of the nodes where they were asked for (`OPTIONAL_VARIABLES`). The errors
between the cubes of a pulse are in a file beside them (`RESTITUTION_ERROR`). alpha = 0 stands for the slender limit.
Values of a cell are stored at its lower corner. A file of a pulse given by samples holds these, `pulse_phase` and
`pulse_shape`. Files follow CF-1.11 and ACDD-1.3. They contain no time of creation, so equal content gives equal
bytes, and a digest of their values.
"""

import hashlib
import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from rocking._base.errors import DatasetError, RockingError
from rocking._base.installation import AUTHORS, __version__
from rocking._base.output_file import replacement_of
from rocking._base.quantities import FREQUENCY_RATIO, SLENDERNESS
from rocking._datasets.checksum import append_checksum, find_damage
from rocking._datasets.netcdf import open_netcdf, write_netcdf
from rocking._excitation.pulses import PULSE_NAMES, as_pulse, pulse_number
from rocking._excitation.sampled import SampledPulse
from rocking._interpolation.stencils import NO_STENCIL, OVERTURNS, PEAK, SQUARED
from rocking._model.fields import CUBE_FIELDS, DERIVED_FIELDS

MAX_FILE_BYTES = 2 * 1024**3
"""Largest file that is read, whole, into memory [bytes]: forty times a cube of `atlas.yaml`. A sparse file can have any
size."""

DIMENSIONS = ("alpha", "slenderness", "frequency_ratio")  # dimensions of a spectrum cube, in order

AXES: dict[str, dict[str, Any]] = {
    "alpha": {
        "units": "rad",
        "long_name": "slenderness angle alpha",
        "equation": "2.1",
        "comment": "0 for the slender limit",
    },
    "slenderness": {"units": "1", "long_name": SLENDERNESS.label, "equation": "4.11"},
    "frequency_ratio": {"units": "1", "long_name": FREQUENCY_RATIO.label, "equation": "3.6"},
}

SAMPLES = {
    "pulse_phase": {"units": "rad", "long_name": "phase of a sample of the pulse"},
    "pulse_shape": {"units": "1", "long_name": "ground acceleration over its peak at a sample of the pulse",
                    "comment": "linear between the samples"},
}  # fmt: skip
"""Coordinates of a data set of a pulse given by samples, with their attributes."""

MODEL_RESULT = {"units": "1", "coverage_content_type": "modelResult"}
"""Attributes of every dimensionless variable that a model computed."""

VARIABLES: dict[str, tuple[str, dict[str, Any]]] = {
    **{field.name: (field.file_dtype, field.attributes) for field in CUBE_FIELDS},
    "stencil": (
        "i1",
        {"long_name": "kind of interpolation", "equation": "3.2",
         "comment": "what a lookup interpolates in the cell above the node, by four-point Lagrange in slenderness and "
                    "log(frequency_ratio) over the 16 nodes around the cell: peak_rotation p, or (1 - p)^2, which is "
                    "smooth up to the boundary of overturning, or the outcome alone, or nothing",
         "flag_values": np.array([NO_STENCIL, PEAK, SQUARED, OVERTURNS], dtype=np.int8),
         "flag_meanings": "not_interpolated peak_rotation square_of_1_minus_peak_rotation all_overturn_alike"},
    ),
    "interpolation_error": (
        "f4",
        {"long_name": "interpolation error",
         "equation": "3.2",
         "comment": "largest measured error of interpolated peak_rotation around the cell above the node: against "
                    "the solver, in the cell and those around it, at two points of each and at five where the "
                    "error exceeds 1e-6; 0 where all overturn in the same way, missing where no bound is known"},
    ),
    "alpha_error": (
        "f4",
        {"long_name": "error between angles", "equation": "3.2",
         "comment": "largest measured error of peak_rotation interpolated before the next alpha: four-point "
                    "Lagrange in the square of alpha, measured as restitution_error"},
    ),
}  # fmt: skip
"""Type and attributes of each variable of a spectrum cube; fields of a response derive from `rocking._model.fields`."""

RESTITUTION_ERROR: dict[str, tuple[str, dict[str, Any]]] = {
    "restitution_error": (
        "f4",
        {"long_name": "error between restitutions",
         "equation": "3.2",
         "comment": "largest measured error of peak_rotation interpolated before the next restitution: four-point "
                    "Lagrange over the two restitutions on either side, or the four outermost, measured halfway at "
                    "the centres of the cell above the node and of those around it; missing where no bound is known"},
    ),
}  # fmt: skip
"""Variable of the errors between the cubes of a pulse, in a file of their own, or in cubes that were made together."""

OPTIONAL_VARIABLES = {field.name: (field.file_dtype, field.attributes) for field in DERIVED_FIELDS}
"""Variables that a spectrum cube has if they were asked for, at its nodes; they are not interpolated."""

IMPACTS_BEFORE_REST = "impacts_before_rest"
"""Attribute of a spectrum cube: the fewest impacts of a node whose impacts accumulate to rest while the pulse acts."""

VARIABLES["peak_rotation"][1]["ancillary_variables"] = "outcome peak_mode stencil interpolation_error"

_GLOBAL = {
    "Conventions": "CF-1.11, ACDD-1.3",
    **dict.fromkeys(("institution", "creator_name", "creator_institution"), AUTHORS),
    **dict.fromkeys(("publisher_name", "publisher_institution"), AUTHORS),
    **dict.fromkeys(("creator_type", "publisher_type"), "group"),
    "product_version": __version__,
    "license": "CC-BY-4.0",
    "references": "Dimitrakopoulos and DeJong (2012), https://doi.org/10.1098/rspa.2012.0026",
    "keywords": "rocking block, overturning, response spectrum, self-similarity, earthquake engineering",
    "standard_name_vocabulary": "CF Standard Name Table v93",
    "source": "event-by-event solution of the equation of motion (package rocking)",
    "project": "rocking",
    "processing_level": "model result",
    "acknowledgement": "built on the closed forms and similarity laws of Dimitrakopoulos and DeJong (2012)",
}


def build_spectrum_dataset(
    variables: Mapping[str, ArrayLike], *, pulse: str | SampledPulse, restitution: float, axes: Mapping[str, ArrayLike]
) -> xr.Dataset:
    """Assemble a spectrum cube of one pulse and restitution.

    `variables`: the arrays named in `VARIABLES` and any of `OPTIONAL_VARIABLES`, of shape (alpha, slenderness,
    frequency_ratio); `axes`: these [rad], [-], [-], ascending.
    """
    name = as_pulse(pulse).name
    arrays = {}
    for key, (dtype, attributes) in (VARIABLES | RESTITUTION_ERROR | OPTIONAL_VARIABLES).items():
        if key in variables:
            arrays[key] = (DIMENSIONS, np.asarray(variables[key], dtype=dtype), MODEL_RESULT | attributes)
    cube = xr.Dataset(arrays, {key: (key, np.asarray(axes[key], dtype="f8"), AXES[key]) for key in DIMENSIONS})
    return describe(
        cube.assign_coords(scalar_coordinates(pulse, restitution)),
        title=f"Rocking spectrum of the rigid block under the {name} pulse, restitution {restitution:.2f}",
        summary="Peak rotation and outcome of a free-standing rigid block over dimensionless slenderness and frequency "
        "ratio, solved event by event, with the measured error of interpolating between the nodes.",
        history="rocking._spectra.cubes.spectrum",
        id=f"spectra/{name}/eta-{restitution:.2f}",
    )


def build_errors_dataset(
    errors: ArrayLike,
    *,
    pulse: str | SampledPulse,
    restitution: ArrayLike,
    axes: Mapping[str, ArrayLike],
    digests: Sequence[str],
) -> xr.Dataset:
    """Assemble the errors between the cubes of a pulse, (restitution, alpha, slenderness, frequency_ratio).

    `restitution`: eta of the cubes [-], ascending; `axes`: as for `build_spectrum_dataset`; `digests`: `content_sha256`
    of the cubes.
    """
    name = as_pulse(pulse).name
    dtype, attributes = RESTITUTION_ERROR["restitution_error"]
    values = np.asarray(errors, dtype=dtype)
    scalars = scalar_coordinates(pulse, 0.0)
    eta = xr.Variable("restitution", np.asarray(restitution, dtype="f8"), scalars.pop("restitution").attrs)
    dataset = xr.Dataset(
        {"restitution_error": (("restitution", *DIMENSIONS), values, {**MODEL_RESULT, **attributes})},
        coords={key: (key, np.asarray(axes[key], dtype="f8"), AXES[key]) for key in DIMENSIONS} | {"restitution": eta},
    )
    return describe(
        dataset.assign_coords(scalars),
        title=f"Errors of interpolation between the restitutions of the {name} pulse",
        summary="Measured errors of the peak rotation interpolated between the spectrum cubes of a pulse, from each "
        "restitution to the next one.",
        history="rocking._spectra.cubes.restitution_errors",
        id=f"spectra/{name}/restitution-errors",
        cubes_content_sha256=" ".join(digests),
    )


def scalar_coordinates(pulse: str | SampledPulse, restitution: float) -> dict[str, xr.Variable]:
    """Return the scalar coordinates `pulse` (a flag, its name in an attribute) and `restitution` of a data set.

    A pulse given by samples has a flag of its own, its digest in an attribute, and the coordinates `SAMPLES`.
    """
    shape = as_pulse(pulse)
    samples: dict[str, xr.Variable] = {}
    named = {
        "long_name": "shape of the ground acceleration",
        "units": "1",
        "pulse_name": shape.name,
        "phase_window": np.array([shape.start, shape.end]),
    }
    number, names = pulse_number(shape.name), PULSE_NAMES
    if isinstance(shape, SampledPulse):
        number, named["pulse_digest"] = -1, shape.digest
        arrays = dict(zip(SAMPLES, (shape.phases, shape.values), strict=True))
        samples = {key: xr.Variable("pulse_sample", arrays[key], SAMPLES[key]) for key in SAMPLES}
    if number < 0:
        names = (*names, "sampled" if samples else "registered")
    flags = {
        "flag_values": np.array([pulse_number(name) for name in names], dtype=np.int8),
        "flag_meanings": " ".join(names),
    }
    eta = {"long_name": "coefficient of restitution eta", "units": "1", "equation": "2.3"}
    return {
        "pulse": xr.Variable((), np.int8(number), named | flags),
        "restitution": xr.Variable((), np.float64(restitution), eta),
        **samples,
    }


def stored_pulse(dataset: xr.Dataset) -> str | SampledPulse:
    """Return the pulse of a data set: its name, or the pulse made again from the stored samples."""
    name = str(dataset["pulse"].attrs["pulse_name"])
    if not dataset.variables.keys() >= SAMPLES.keys():
        return name
    phases, values = (dataset[key].values for key in SAMPLES)
    return SampledPulse(values, phases, 2.0 * math.pi, name)


def describe(dataset: xr.Dataset, **attributes: Any) -> xr.Dataset:
    """Add the global attributes of all data sets and those of this one (title, summary, id, ...).

    They contain no time of creation: equal content gives equal bytes.
    """
    return dataset.assign_attrs({**_GLOBAL, **dataset.attrs, **attributes})


def write_dataset(dataset: xr.Dataset, path: Path | str, *, chunks: Mapping[str, int] | None = None) -> None:
    """Write a netCDF-4 file atomically; equal content gives equal bytes.

    The data set is written with a digest of its values (`content_sha256`); the file has another digest at its end
    (`append_checksum`). `read_dataset` detects damage by them. Parent folders are created; an existing file is
    replaced. `chunks`: sizes along dimensions; by default a variable is one chunk.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    signed = dataset.assign_attrs(content_sha256=_content_digest(dataset))
    with replacement_of(path) as temporary:
        write_netcdf(signed, temporary, _encoding(signed, chunks or {}))
        append_checksum(temporary)


def read_dataset(path: Path | str) -> xr.Dataset:
    """Read a file written by `write_dataset` into memory and check its digests.

    Raises `DatasetError` if it is missing, cannot be read, was not written by this package, or is damaged.
    """
    return decode_dataset(read_content(path), path)


def check_file(path: Path | str) -> None:
    """Check the digest at the end of a file written by `write_dataset`; raises as `read_dataset`."""
    _raise_if_damaged(read_content(path), path)


def read_content(path: Path | str) -> bytes:
    """Read the bytes of a data set file; raises `DatasetError`."""
    path = Path(path)
    try:
        if path.is_file():
            reject_large(path, path.stat().st_size)
            return path.read_bytes()
    except OSError as error:
        raise DatasetError(f"{path}: cannot be read: {error.strerror}") from error
    raise DatasetError(f"{path}: no such data set; `make reproduce` builds it")


def reject_large(name: Path | str, size: int) -> None:
    """Raise `DatasetError` for a file of more than `MAX_FILE_BYTES`, whose name the message has."""
    if size > MAX_FILE_BYTES:
        raise DatasetError(f"{name}: has {size} bytes; a data set has at most {MAX_FILE_BYTES}")


def decode_dataset(content: bytes, path: Path | str) -> xr.Dataset:
    """Read a data set from the bytes of a file, as `read_dataset`; messages name `path`."""
    with open_checked(content, path) as opened:
        dataset = opened.load()
        if dataset.attrs["content_sha256"] != _content_digest(dataset):
            raise DatasetError(
                f"{path}: damaged, its values do not match its own digest; `make reproduce` builds it again"
            )
    return dataset


@contextmanager
def open_checked(content: bytes, path: Path | str) -> Iterator[xr.Dataset]:
    """Open the data set of the bytes of a file whose digest at its end is right, inside of the `with` block."""
    _raise_if_damaged(content, path)
    try:
        with open_netcdf(content) as opened:
            if "content_sha256" not in opened.attrs:
                raise DatasetError(f"{path}: not written by this package (no content_sha256)")
            yield opened
    except RockingError:
        raise
    except (OSError, RuntimeError, ValueError, KeyError) as error:
        raise DatasetError(f"{path}: damaged, {error}; `make reproduce` builds it again") from error


def _raise_if_damaged(content: bytes, path: Path | str) -> None:
    damage = find_damage(content)
    if damage is not None:  # the netCDF library does not return for some damaged files
        raise DatasetError(f"{path}: {damage}; `make reproduce` builds it again")


def read_spectrum(path: Path | str) -> xr.Dataset:
    """Read a spectrum cube and check it against the schema.

    Raises as `read_dataset`; also if a variable is missing or of another type or shape, or an axis does not ascend.
    """
    return decode_spectrum(read_content(path), path)


def decode_spectrum(content: bytes, path: Path | str) -> xr.Dataset:
    """Read a cube from the bytes of a file, as `read_spectrum`; messages name `path`."""
    cube = decode_dataset(content, path)
    check_spectrum(cube, path)
    return cube


def check_spectrum(cube: xr.Dataset, path: Path | str) -> None:
    """Refuse a data set, which may be open, that has not the schema of spectrum cubes."""
    for name, (dtype, _) in (VARIABLES | OPTIONAL_VARIABLES).items():
        if name in OPTIONAL_VARIABLES and name not in cube:
            continue
        if name not in cube or cube[name].dims != DIMENSIONS or cube[name].dtype != np.dtype(dtype):
            raise DatasetError(f"{path}: no variable `{name}` of type {dtype} over {DIMENSIONS}; build it again")
    for name in DIMENSIONS:
        if name not in cube.coords or not np.all(np.diff(cube[name].values) > 0):
            raise DatasetError(f"{path}: axis `{name}` is missing or does not ascend; build it again")
    if "pulse" not in cube.coords or "restitution" not in cube.coords:
        raise DatasetError(f"{path}: no scalar coordinates `pulse` and `restitution`; build it again")


def _encoding(dataset: xr.Dataset, chunks: Mapping[str, int]) -> dict[str, dict[str, Any]]:
    encoding: dict[str, dict[str, Any]] = {}
    for name, variable in dataset.variables.items():
        chosen: dict[str, Any] = {"_FillValue": None}
        if name not in dataset.coords and variable.dtype.kind == "f":
            chosen["_FillValue"] = np.nan
        if variable.ndim and variable.size > 64 and variable.dtype.kind in "fiu":
            sizes = tuple(chunks.get(str(dimension), size) for dimension, size in variable.sizes.items())
            chosen |= {"zlib": True, "complevel": 4, "shuffle": True, "chunksizes": sizes}
        encoding[str(name)] = chosen
    return encoding


def _content_digest(dataset: xr.Dataset) -> str:
    """Return the sha256 over names, types, shapes and values of all variables."""
    digest = hashlib.sha256()
    for name in sorted(str(name) for name in dataset.variables):
        values = np.ascontiguousarray(dataset.variables[name].values)
        content = "\n".join(values.astype(str).ravel()).encode() if values.dtype.kind in "OUT" else values.tobytes()
        digest.update(f"{name} {values.dtype.kind} {values.shape}\n".encode())
        digest.update(content)
    return digest.hexdigest()
