"""The curves that separate standing from falling (figure 4)."""

from __future__ import annotations

from functools import lru_cache
from typing import Annotated

import numpy as np
import xarray as xr
from fastapi import APIRouter, Query, Request, Response
from numpy.typing import NDArray

from rocking._numba.cancellation import StopFlag
from rocking.boundary.curves import curves_at
from rocking.boundary.tracing import overturning_boundary
from rocking.datasets.catalogue import UnknownDatasetError
from rocking.errors import DatasetError
from rocking_api.http.formats import CONTENT, csv_response, form_of, json_response, netcdf_response
from rocking_api.http.params_route import QuestionRoute
from rocking_api.models.params import OverturningQuestion, alpha_of
from rocking_api.models.responses import OUTCOMES, Curve, OverturningAnswer
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1", tags=["curves"], route_class=QuestionRoute)

NODES = 201
"""Grid on which curves are looked for on request: half as fine as the workflow's, seconds for the wavelets [-]."""

KEPT = 64
"""Questions whose traced curves are kept [-]: some tens of kB each."""


@router.get("/overturning", summary="Boundary curves", response_model=OverturningAnswer, responses=CONTENT)
async def get_overturning(
    question: Annotated[OverturningQuestion, Query()], request: Request, service: ServiceDep
) -> Response:
    """The curves of the workflow; where there are none for this restitution, they are traced, once for all who ask."""
    form = form_of(request, question.format)
    return await service.off_loop(question, lambda stop: _overturning(service, question, form, stop), request)


def _overturning(service: Service, question: OverturningQuestion, form: str, stop: StopFlag) -> Response:
    curves, version = _read(service, question)
    if curves is None:
        curves = _traced(question.pulse, question.restitution, alpha_of(question.alpha_deg), stop)
    if form == "nc":
        return netcdf_response(curves.drop_vars("pulse", errors="ignore"), "overturning")
    if form == "csv":
        sizes = curves["row_size"].values
        columns = {
            "curve": np.repeat(np.arange(sizes.size), sizes).tolist(),
            "slenderness": curves["slenderness"].values.tolist(),
            "frequency_ratio": curves["frequency_ratio"].values.tolist(),
            "outcome": np.repeat(_names(curves), sizes).tolist(),
            "impacts": np.repeat(curves["impacts"].values, sizes).tolist(),
        }
        return csv_response(columns, "overturning")
    source = "dataset" if version else "solver"
    return json_response(OverturningAnswer(query=question, curves=_curves(curves), source=source, data_version=version))


def _read(service: Service, question: OverturningQuestion) -> tuple[xr.Dataset | None, str | None]:
    """The curves of this question in the data set of its pulse and restitution, and its sha256; None if not there."""
    # a mirrored pulse overturns the same blocks
    name = f"overturning/{question.pulse.removeprefix('-')}/eta-{question.restitution:.2f}"
    catalogue = service.atlas.catalogue
    try:
        product, stored = catalogue.dataset(name)
    except (UnknownDatasetError, DatasetError):
        return None, None  # /health tells of a damaged or unreadable one
    found = curves_at(stored, alpha_of(question.alpha_deg) or 0.0)
    if float(stored["restitution"]) != question.restitution or not found.sizes["curve"]:
        return None, None
    return found, product.sha256


def _traced(pulse: str, restitution: float, alpha: float | None, stop: StopFlag) -> xr.Dataset:
    """Curves for which there is no data set; whoever moves a slider back and forth does not trace them again."""
    kept = _kept(pulse, restitution, alpha)
    if not kept:
        kept.append(overturning_boundary(pulse, restitution=restitution, alpha=alpha, nodes=NODES, stop=stop))
    return kept[0]


@lru_cache(maxsize=KEPT)
def _kept(_pulse: str, _restitution: float, _alpha: float | None) -> list[xr.Dataset]:
    """Where the curves of a question are kept once they are traced."""
    return []


def _names(curves: xr.Dataset) -> NDArray[np.str_]:
    return np.asarray(np.array(OUTCOMES)[curves["outcome"].values])


def _curves(curves: xr.Dataset) -> list[Curve]:
    ends = np.cumsum(curves["row_size"].values)
    parts = zip(
        np.split(curves["slenderness"].values, ends[:-1]),
        np.split(curves["frequency_ratio"].values, ends[:-1]),
        _names(curves).tolist(),
        curves["impacts"].values.tolist(),
        strict=True,
    )
    return [
        Curve(outcome=outcome, impacts=impacts, slenderness=s.tolist(), frequency_ratio=w.tolist())
        for s, w, outcome, impacts in parts
        if s.size
    ]
