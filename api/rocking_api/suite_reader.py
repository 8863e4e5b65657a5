"""Suites of records in a results folder, each of their files read once per version."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, TypeVar

import xarray as xr
from pydantic import BaseModel

from rocking._base.errors import DatasetError, finite
from rocking._datasets.catalogue import Catalogue, DataFile, UnknownDatasetError, VersionCache
from rocking._datasets.csv_text import csv_text
from rocking._datasets.cube import decode_dataset
from rocking.suites.intensity import measure_of
from rocking.suites.summary import record_margins, rotation_quantiles
from rocking_api.models import suites as m
from rocking_api.models.responses import Link

T = TypeVar("T")
M = TypeVar("M", bound=BaseModel)

_FOLDER, _FILE = "suites/", "/fragility"


@dataclass(frozen=True)
class _Fragility:
    """What the response holds of the file `fragility`."""

    about: dict[str, Any]
    intensity: list[float]
    records: list[m.SuiteRecord]
    blocks: list[dict[str, Any]]
    demands: list[str]


class SuiteReader:
    """The suites of a catalogue of data sets; what is read of a file is kept until the file changes."""

    def __init__(self, catalogue: Catalogue) -> None:
        self._catalogue = catalogue
        self._fragility = VersionCache[str, _Fragility | DatasetError]()
        self._outcomes = VersionCache[str, list[dict[str, Any]] | DatasetError]()
        self._sensitivity = VersionCache[str, list[list[m.Sensitivity]] | DatasetError]()

    def names(self) -> list[str]:
        """Names of all suites, ascending."""
        found = self._catalogue.names()
        return sorted(one.removeprefix(_FOLDER).removesuffix(_FILE) for one in found if _is_fragility(one))

    def summaries(self, names: list[str]) -> list[m.SuiteSummary]:
        """Those of some suites that can be read; damaged ones are reported by /health."""
        datasets = self._catalogue.names()
        found = []
        for name in names:
            with suppress(UnknownDatasetError, DatasetError):  # removed meanwhile, or damaged
                found.append(self._summary(name, datasets))
        return found

    def _summary(self, name: str, datasets: list[str]) -> m.SuiteSummary:
        found = self._part(self._fragility, name, "fragility", _fragility)
        return m.SuiteSummary(
            name=name,
            title=found.about["title"],
            measure=found.about["measure"],
            unit=found.about["unit"],
            records=len(found.records),
            blocks=len(found.blocks),
            demands=found.demands,
            links=_links(name, datasets),
        )

    def suite(self, name: str, query: m.SuiteParams, url: str) -> m.SuiteResponse:
        """A suite."""
        found = self._part(self._fragility, name, "fragility", _fragility)
        outcomes = self._part(self._outcomes, name, "outcomes", _of_outcomes)
        try:
            sensitivity = self._part(self._sensitivity, name, "sensitivity", _of_sensitivity)
        except UnknownDatasetError:
            sensitivity = [[] for _ in found.blocks]
        if not len(found.blocks) == len(outcomes) == len(sensitivity):
            raise DatasetError(f"{_FOLDER}{name}: its files are of different blocks; ask again after the run has ended")
        return m.SuiteResponse(
            query=query,
            url=url,
            name=name,
            **found.about,
            intensity=found.intensity,
            records=found.records,
            blocks=[
                m.SuiteBlock(**block, **of_outcomes, sensitivity=levels)
                for block, of_outcomes, levels in zip(found.blocks, outcomes, sensitivity, strict=True)
            ],
            links=_links(name, self._catalogue.names()),
        )

    def csv(self, name: str) -> str:
        """Return the fragility of a suite as CSV."""
        from rocking.suites.table import fragility_table  # noqa: PLC0415  (the fits take long to import)

        _, dataset = self._catalogue.dataset(f"{_FOLDER}{name}/fragility")
        return csv_text(fragility_table(dataset))

    def _part(
        self, cache: VersionCache[str, T | DatasetError], suite: str, file: str, read: Callable[[xr.Dataset], T]
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
        [_of(m.SuiteRecord, one, name=str(one["record"].item())) for one in _each(found, "record")],
        [_block(one) for one in _each(found, "block")],
        found["demand"].values.tolist(),
    )


def _links(name: str, datasets: list[str]) -> list[Link]:
    own = [one for one in datasets if one.startswith(f"{_FOLDER}{name}/")]
    files = [Link(rel="data", href=f"/v1/datasets/{one}.nc", type="application/x-netcdf") for one in own]
    return [Link(rel="self", href=f"/v1/suites/{name}", type="application/json"), *files]


def _of(model: type[M], found: xr.Dataset, **own: Any) -> M:
    """A model of which all other fields are variables of a data set; numbers that are not finite are null."""
    read = {
        name: _plain(found[name].values.tolist()) for name in model.model_fields if name in found and name not in own
    }
    return model.model_validate(read | own)


def _plain(value: Any) -> Any:
    if isinstance(value, list):
        return [_plain(one) for one in value]
    return finite(value) if isinstance(value, float) else value


def _names(found: xr.DataArray) -> list[str]:
    """Names that a file holds as one text."""
    text = str(found.item())
    return text.split("; ") if text else []


def _each(found: xr.Dataset, dimension: str) -> list[xr.Dataset]:
    return [found.isel({dimension: k}) for k in range(found.sizes[dimension])]


def _block(found: xr.Dataset) -> dict[str, Any]:
    numbers = {name: float(found[name]) for name in m.SuiteBlock.model_fields if name in found}
    states = [_limit_state(one) for one in _each(found, "demand")]
    return numbers | {"alpha_deg": math.degrees(float(found["alpha"])), "limit_states": states}


def _limit_state(one: xr.Dataset) -> m.LimitState:
    curves = [_curve(of_model) for of_model in _each(one, "model")]
    median = finite(float(one["first_median_intensity"].sel(model="lognormal")))
    named = _names(one["records_surviving_above_first"])
    return _of(m.LimitState, one, curves=curves, first_median_intensity=median, records_surviving_above_first=named)


def _curve(one: xr.Dataset) -> m.FragilityCurve:
    code = one["fit_status"]  # the file states what it means: importing the fits takes longer than the service to start
    name = str(code.attrs["flag_meanings"]).split()[int(code)]
    meanings = dict(text.split(": ", 1) for text in str(code.attrs["comment"]).split("; "))
    return _of(m.FragilityCurve, one, fit_status=name.upper(), fit_meaning=meanings[name])


def _of_outcomes(outcomes: xr.Dataset) -> list[dict[str, Any]]:
    """Margins and rotations of each block."""
    quantiles = rotation_quantiles(outcomes).transpose("block", "quantile", "intensity")
    return [
        {
            "margins": [_of(m.RecordMargin, one) for one in _each(margins, "record")],
            "rotation_quantiles": [
                m.RotationQuantile(quantile=float(one["quantile"]), peak_rotation=_plain(one.values.tolist()))
                for one in quantiles[k]
            ],
        }
        for k, margins in enumerate(_each(record_margins(outcomes), "block"))
    ]


def _of_sensitivity(found: xr.Dataset) -> list[list[m.Sensitivity]]:
    """Each block at each level."""
    return [[_sensitivity(one) for one in _each(block, "intensity")] for block in _each(found, "block")]


def _sensitivity(one: xr.Dataset) -> m.Sensitivity:
    records = [_of(m.RecordSensitivity, record) for record in _each(one, "record")]
    return _of(
        m.Sensitivity, one, records=records, records_changed_by_sampling=_names(one["records_changed_by_sampling"])
    )
