"""Suites of records: catalogue, and the fragility of their blocks, from the data sets of the workflow."""

from __future__ import annotations

import math
from contextlib import suppress
from functools import partial
from typing import Annotated, Any

import numpy as np
import xarray as xr
from fastapi import APIRouter, Path, Response

from rocking.datasets.catalogue import UnknownDatasetError
from rocking.errors import DatasetError
from rocking.suites.intensity import measure_of
from rocking.suites.summary import record_margins, rotation_quantiles
from rocking_api.http.caching import REVALIDATE
from rocking_api.http.encoding import json_response
from rocking_api.http.params_route import ParamsRoute
from rocking_api.models.responses import Link, finite
from rocking_api.models.suites import (
    FragilityCurve,
    LimitState,
    RecordMargin,
    RotationQuantile,
    SuiteBlock,
    SuiteCatalogue,
    SuiteRecord,
    SuiteResponse,
    SuiteSummary,
)
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1/suites", tags=["suites"], route_class=ParamsRoute)

SuiteName = Annotated[str, Path(description="name of a suite, see /v1/suites", examples=["demonstration"])]

_FOLDER, _FILE = "suites/", "/fragility"

_BLOCK = ("half_width", "half_height", "half_diagonal", "frequency_parameter", "uplift_acceleration", "restitution")
_RECORD = ("peak_acceleration", "peak_velocity", "mean_period", "time_step")
_COUNTS = ("exceedances", "fraction", "fraction_lower", "fraction_upper", "first_exceedances")
_CURVE = (
    *("median_intensity", "median_intensity_lower", "median_intensity_upper"),
    *("dispersion", "dispersion_lower", "dispersion_upper"),
)


@router.get("", summary="Catalogue", response_model=SuiteCatalogue)
async def get_suites(service: ServiceDep) -> Response:
    """All suites in the results folder that can be read; `make reproduce CONFIG=...` makes one."""

    def work() -> list[SuiteSummary]:
        datasets = service.cubes.catalogue.names()
        found = []
        for name in (one.removeprefix(_FOLDER).removesuffix(_FILE) for one in datasets if _is_fragility(one)):
            with suppress(UnknownDatasetError, DatasetError):  # removed meanwhile, or damaged: see /health
                found.append(_summary(service, name, datasets))
        return found

    return json_response(SuiteCatalogue(suites=await service.run_io(work)), {"Cache-Control": REVALIDATE})


@router.get("/{name}", summary="Fragility of the blocks", response_model=SuiteResponse)
async def get_suite(name: SuiteName, service: ServiceDep) -> Response:
    """Counts with intervals and fitted curves of each block and limit state, margins of each record, rotations.

    The data sets of the suite are under `links`.
    """
    found = await service.run_io(partial(_suite, service, name))
    return json_response(found, {"Cache-Control": REVALIDATE})


def _is_fragility(name: str) -> bool:
    parts = name.split("/")
    return parts[0] == "suites" and parts[2:] == ["fragility"]


def _read(service: Service, name: str, file: str) -> xr.Dataset:
    return service.cubes.catalogue.dataset(f"{_FOLDER}{name}/{file}")[1]


def _summary(service: Service, name: str, datasets: list[str]) -> SuiteSummary:
    found = _read(service, name, "fragility")
    try:
        return SuiteSummary(
            name=name,
            title=str(found.attrs["title"]),
            measure=str(found.attrs["measure"]),
            unit=str(found["intensity"].attrs["units"]),
            records=found.sizes["record"],
            blocks=found.sizes["block"],
            demands=found["demand"].values.tolist(),
            links=_links(name, datasets),
        )
    except KeyError as error:
        raise DatasetError(f"{_FOLDER}{name}{_FILE}: is no fragility of a suite: {error}") from None


def _suite(service: Service, name: str) -> SuiteResponse:
    found, outcomes = _read(service, name, "fragility"), _read(service, name, "outcomes")
    try:
        return SuiteResponse(
            name=name,
            title=str(found.attrs["title"]),
            measure=str(found.attrs["measure"]),
            measure_meaning=measure_of(str(found.attrs["measure"])).meaning,
            unit=str(found["intensity"].attrs["units"]),
            confidence=float(found.attrs["confidence"]),
            intensity=found["intensity"].values.tolist(),
            records=[_record(found.isel(record=k)) for k in range(found.sizes["record"])],
            blocks=_blocks(found, outcomes),
            links=_links(name, service.cubes.catalogue.names()),
        )
    except KeyError as error:
        raise DatasetError(f"{_FOLDER}{name}{_FILE}: is no fragility of a suite: {error}") from None


def _links(name: str, datasets: list[str]) -> list[Link]:
    own = [one for one in datasets if one.startswith(f"{_FOLDER}{name}/")]
    files = [Link(rel="data", href=f"/v1/datasets/{one}.nc", type="application/x-netcdf") for one in own]
    return [Link(rel="self", href=f"/v1/suites/{name}", type="application/json"), *files]


def _record(one: xr.Dataset) -> SuiteRecord:
    numbers: dict[str, Any] = {key: finite(float(one[key])) for key in _RECORD}
    return SuiteRecord(name=str(one["record"].item()), digest=str(one["digest"].item()), **numbers)


def _blocks(found: xr.Dataset, outcomes: xr.Dataset) -> list[SuiteBlock]:
    margins, rotations = record_margins(outcomes), rotation_quantiles(outcomes)
    blocks = []
    for k in range(found.sizes["block"]):
        of_block = found.isel(block=k)
        blocks.append(
            SuiteBlock(
                **{key: float(of_block[key]) for key in _BLOCK},
                alpha_deg=math.degrees(float(of_block["alpha"])),
                limit_states=[_limit_state(of_block.isel(demand=n)) for n in range(found.sizes["demand"])],
                margins=[_margin(margins.isel(block=k, record=n)) for n in range(margins.sizes["record"])],
                rotation_quantiles=[
                    RotationQuantile(quantile=float(one["quantile"]), peak_rotation=_numbers(one.values))
                    for one in rotations.isel(block=k)
                ],
            )
        )
    return blocks


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


def _margin(one: xr.Dataset) -> RecordMargin:
    return RecordMargin(
        record=str(one["record"].item()),
        overturning_intensity=finite(float(one["overturning_intensity"])),
        overturning_scale=finite(float(one["overturning_scale"])),
        levels_survived_above=int(one["levels_survived_above"]),
    )


def _numbers(values: np.ndarray[Any, np.dtype[np.float64]]) -> list[float | None]:
    return [finite(value) for value in values.tolist()]
