"""Suites of records in a results folder, each of their files read once per version."""

from __future__ import annotations

import io
import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Literal, TypeVar

import numpy as np
import xarray as xr

from rocking._base.errors import DatasetError, finite
from rocking._datasets.catalogue import Catalogue, DataFile, UnknownDatasetError, VersionCache
from rocking._datasets.csv_text import csv_text
from rocking._datasets.cube import decode_dataset
from rocking.suites.intensity import measure_of
from rocking.suites.summary import record_margins, rotation_quantiles
from rocking_api.models.responses import Link
from rocking_api.models.suites import (
    FragilityCurve,
    LimitState,
    RecordMargin,
    RecordSensitivity,
    RotationQuantile,
    Sensitivity,
    SuiteBlock,
    SuiteParams,
    SuiteRecord,
    SuiteResponse,
    SuiteSummary,
)

T = TypeVar("T")

_FOLDER, _FILE = "suites/", "/fragility"

_BLOCK = ("width", "height", "half_diagonal", "frequency_parameter", "uplift_acceleration", "restitution")
_RECORD = ("peak_acceleration", "peak_velocity", "mean_period", "time_step")
_COUNTS = ("exceedances", "fraction", "fraction_lower", "fraction_upper", "first_exceedances")
_CURVE = (
    *("median_intensity", "median_intensity_lower", "median_intensity_upper"),
    *("dispersion", "dispersion_lower", "dispersion_upper"),
)
_CHANGES = ("low_restitution", "high_restitution", "resampled")
_SENSITIVITY = (
    *("intensity", "exceedances", "fraction", "fraction_lower", "fraction_upper"),
    *("restitution_low", "restitution_high", "friction_demand_median", "friction_demand_largest"),
    *(f"{kind}_{change}" for kind in ("fraction", "changed") for change in _CHANGES),
)


@dataclass(frozen=True)
class _Fragility:
    """What the response holds of the file `fragility`."""

    about: dict[str, Any]
    intensity: list[float]
    records: list[SuiteRecord]
    blocks: list[dict[str, Any]]
    demands: list[str]


class SuiteReader:
    """The suites of a catalogue of data sets; what is read of a file is kept until the file changes.

    Parameters
    ----------
    catalogue : Catalogue
        Data sets of the results folder.
    """

    def __init__(self, catalogue: Catalogue) -> None:
        self._catalogue = catalogue
        self._fragility = VersionCache[str, _Fragility | DatasetError]()
        self._outcomes = VersionCache[str, list[dict[str, Any]] | DatasetError]()
        self._sensitivity = VersionCache[str, list[list[Sensitivity]] | DatasetError]()

    def names(self) -> list[str]:
        """Names of all suites, ascending."""
        found = self._catalogue.names()
        return sorted(one.removeprefix(_FOLDER).removesuffix(_FILE) for one in found if _is_fragility(one))

    def summaries(self, names: list[str]) -> list[SuiteSummary]:
        """Those of some suites that can be read; damaged ones are reported by /health."""
        datasets = self._catalogue.names()
        found = []
        for name in names:
            with suppress(UnknownDatasetError, DatasetError):  # removed meanwhile, or damaged
                found.append(self._summary(name, datasets))
        return found

    def _summary(self, name: str, datasets: list[str]) -> SuiteSummary:
        found = self._part(self._fragility, name, "fragility", _fragility)
        return SuiteSummary(
            name=name,
            title=found.about["title"],
            measure=found.about["measure"],
            unit=found.about["unit"],
            records=len(found.records),
            blocks=len(found.blocks),
            demands=found.demands,
            links=_links(name, datasets),
        )

    def suite(self, name: str, query: SuiteParams) -> SuiteResponse:
        """A suite.

        Raises
        ------
        UnknownDatasetError
            If there is none of that name.
        DatasetError
            If one of its files is damaged.
        """
        found = self._part(self._fragility, name, "fragility", _fragility)
        outcomes = self._part(self._outcomes, name, "outcomes", _of_outcomes)
        try:
            sensitivity = self._part(self._sensitivity, name, "sensitivity", _of_sensitivity)
        except UnknownDatasetError:
            sensitivity = [[] for _ in found.blocks]
        if not len(found.blocks) == len(outcomes) == len(sensitivity):
            raise DatasetError(f"{_FOLDER}{name}: its files are of different blocks; ask again after the run has ended")
        return SuiteResponse(
            query=query,
            name=name,
            **found.about,
            intensity=found.intensity,
            records=found.records,
            blocks=[
                SuiteBlock(**block, **of_outcomes, sensitivity=levels)
                for block, of_outcomes, levels in zip(found.blocks, outcomes, sensitivity, strict=True)
            ],
            links=_links(name, self._catalogue.names()),
        )

    def text(self, name: str, form: str, curves: Literal["discrete", "lognormal"]) -> str:
        """The fragility of a suite as CSV or NRML.

        Raises
        ------
        UnknownDatasetError, DatasetError
            As `suite`.
        InvalidArgumentError
            As `rocking.suites.nrml.write_nrml`.
        """
        # the fits take longer to import than the service to start
        from rocking.suites.nrml import write_nrml  # noqa: PLC0415
        from rocking.suites.table import fragility_table  # noqa: PLC0415

        file = "fragility" if form == "csv" else "outcomes"
        _, found = self._catalogue.dataset(f"{_FOLDER}{name}/{file}")
        if form == "csv":
            return csv_text(fragility_table(found))
        written = io.BytesIO()
        write_nrml(found, written, format=curves, description=name)
        return written.getvalue().decode()

    def _part(
        self,
        cache: VersionCache[str, T | DatasetError],
        suite: str,
        file: str,
        read: Callable[[xr.Dataset], T],
    ) -> T:
        """What `read` makes of a file of a suite, once per version of the file."""
        name = f"{_FOLDER}{suite}/{file}"
        known = cache.current(name)
        if known is None:

            def compute(opened: DataFile) -> T | DatasetError:
                try:
                    return read(decode_dataset(opened.content(), name))
                except KeyError as error:
                    return DatasetError(f"{name}: is no {file} of a suite: {error}")
                except DatasetError as error:
                    return error

            # under the lock: another thread may read the same file, which is then read once
            with self._catalogue.open(name) as opened, self._catalogue.lock:
                known = cache.value(name, opened, compute)
        if isinstance(known, DatasetError):
            raise known
        return known


def _is_fragility(name: str) -> bool:
    parts = name.split("/")
    return parts[0] == "suites" and parts[2:] == ["fragility"]


def _fragility(found: xr.Dataset) -> _Fragility:
    measure = str(found.attrs["measure"])
    about = {
        "title": str(found.attrs["title"]),
        "measure": measure,
        "measure_meaning": measure_of(measure).meaning,
        "unit": str(found["intensity"].attrs["units"]),
        "confidence": float(found.attrs["confidence"]),
    }
    return _Fragility(
        about,
        found["intensity"].values.tolist(),
        [_record(found.isel(record=k)) for k in range(found.sizes["record"])],
        [_block(found.isel(block=k)) for k in range(found.sizes["block"])],
        found["demand"].values.tolist(),
    )


def _links(name: str, datasets: list[str]) -> list[Link]:
    own = [one for one in datasets if one.startswith(f"{_FOLDER}{name}/")]
    files = [Link(rel="data", href=f"/v1/datasets/{one}.nc", type="application/x-netcdf") for one in own]
    return [Link(rel="self", href=f"/v1/suites/{name}", type="application/json"), *files]


def _record(one: xr.Dataset) -> SuiteRecord:
    numbers: dict[str, Any] = {key: finite(float(one[key])) for key in _RECORD}
    return SuiteRecord(name=str(one["record"].item()), digest=str(one["digest"].item()), **numbers)


def _block(found: xr.Dataset) -> dict[str, Any]:
    return {key: float(found[key]) for key in _BLOCK} | {
        "alpha_deg": math.degrees(float(found["alpha"])),
        "limit_states": [_limit_state(found.isel(demand=n)) for n in range(found.sizes["demand"])],
    }


def _limit_state(one: xr.Dataset) -> LimitState:
    named = str(one["records_surviving_above_first"].item())
    counts: dict[str, Any] = {key: one[key].values.tolist() for key in _COUNTS}
    return LimitState(
        demand=str(one["demand"].item()),
        **counts,
        first_median_intensity=finite(float(one["first_median_intensity"].sel(model="lognormal"))),
        curves=[_curve(one.isel(model=n)) for n in range(one.sizes["model"])],
        records_surviving_above_first=named.split("; ") if named else [],
    )


def _curve(one: xr.Dataset) -> FragilityCurve:
    status, meaning = _status(one["fit_status"])
    numbers: dict[str, Any] = {key: finite(float(one[key])) for key in _CURVE}
    return FragilityCurve(
        model=str(one["model"].item()),
        fit_status=status.upper(),
        fit_meaning=meaning,
        **numbers,
        annual_rate=finite(float(one["annual_rate"])) if "annual_rate" in one else None,
        fitted=_numbers(one["fitted"].values),
    )


def _status(code: xr.DataArray) -> tuple[str, str]:
    """Name and meaning of a code, which the file states: importing the fits takes longer than the service to start."""
    name = str(code.attrs["flag_meanings"]).split()[int(code)]
    meanings = dict(one.split(": ", 1) for one in str(code.attrs["comment"]).split("; "))
    return name, meanings[name]


def _of_outcomes(outcomes: xr.Dataset) -> list[dict[str, Any]]:
    """Margins and rotations of each block."""
    margins = record_margins(outcomes)
    quantiles = _quantiles(outcomes)
    return [
        {
            "margins": [_margin(margins.isel(block=k, record=n)) for n in range(margins.sizes["record"])],
            "rotation_quantiles": quantiles[k],
        }
        for k in range(outcomes.sizes["block"])
    ]


def _quantiles(outcomes: xr.Dataset) -> list[list[RotationQuantile]]:
    """Of each block."""
    return [
        [RotationQuantile(quantile=float(one["quantile"]), peak_rotation=_numbers(one.values)) for one in of_block]
        for of_block in rotation_quantiles(outcomes).transpose("block", "quantile", "intensity")
    ]


def _of_sensitivity(found: xr.Dataset) -> list[list[Sensitivity]]:
    """Each block at each level."""
    return [
        [_sensitivity(found.isel(block=k, intensity=n)) for n in range(found.sizes["intensity"])]
        for k in range(found.sizes["block"])
    ]


def _sensitivity(one: xr.Dataset) -> Sensitivity:
    named = str(one["records_changed_by_sampling"].item())
    numbers: dict[str, Any] = {key: finite(one[key].item()) for key in _SENSITIVITY}
    return Sensitivity(
        **numbers,
        records_changed_by_sampling=named.split("; ") if named else [],
        records=[_changes(one.isel(record=k)) for k in range(one.sizes["record"])],
    )


def _changes(one: xr.Dataset) -> RecordSensitivity:
    return RecordSensitivity(
        record=str(one["record"].item()),
        overturned=bool(one["overturned"]),
        peak_rotation=finite(float(one["peak_rotation"])),
        friction_demand=finite(float(one["friction_demand"])),
        **{f"overturned_{name}": bool(one[f"overturned_{name}"]) for name in _CHANGES},
    )


def _margin(one: xr.Dataset) -> RecordMargin:
    return RecordMargin(
        record=str(one["record"].item()),
        overturning_intensity=finite(float(one["overturning_intensity"])),
        overturning_scale=finite(float(one["overturning_scale"])),
        levels_survived_above=int(one["levels_survived_above"]),
    )


def _numbers(values: np.ndarray[Any, np.dtype[np.float64]]) -> list[float | None]:
    return [finite(value) for value in values.tolist()]
