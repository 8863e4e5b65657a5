"""A rocking spectrum: the peak against the frequency ratio (figure 8)."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from fastapi import APIRouter, Query, Request, Response
from numpy.typing import NDArray

from rocking._numba.cancellation import StopFlag
from rocking.errors import in_range
from rocking_api.execution.evaluation import ask_many
from rocking_api.http.formats import CONTENT, csv_stream, dataset_of, form_of, json_response, netcdf_response
from rocking_api.http.params_route import QuestionRoute
from rocking_api.http.problems import TooLargeError
from rocking_api.models.params import FREQUENCY_RATIOS, SpectrumQuestion
from rocking_api.models.responses import SpectrumAnswer, columns_of
from rocking_api.service import Service, ServiceDep

router = APIRouter(prefix="/v1", tags=["curves"], route_class=QuestionRoute)


@router.get(
    "/spectrum", summary="Peak rotation against frequency ratio", response_model=SpectrumAnswer, responses=CONTENT
)
async def get_spectrum(
    question: Annotated[SpectrumQuestion, Query()], request: Request, service: ServiceDep
) -> Response:
    """Blocks of one slenderness over a window of the frequency ratio."""
    form = form_of(request, question.format)
    frequency_ratio = _axis(service, question)
    return await service.off_loop(
        question, lambda stop: _spectrum(service, question, frequency_ratio, form, stop), request
    )


def _axis(service: Service, question: SpectrumQuestion) -> NDArray[np.float64]:
    """The points of the curve, inside the border of the service."""
    smallest, largest = FREQUENCY_RATIOS
    low = float(in_range("frequency_ratio_min", question.frequency_ratio_min, smallest, largest))
    high = float(in_range("frequency_ratio_max", question.frequency_ratio_max, low, largest, closed="right"))
    in_range("points", question.points, 2, np.inf, closed="left")
    if question.points > service.settings.max_samples:
        raise TooLargeError("points", question.points, f"at most {service.settings.max_samples}")
    return np.geomspace(low, high, question.points)


def _spectrum(
    service: Service, question: SpectrumQuestion, frequency_ratio: NDArray[np.float64], form: str, stop: StopFlag
) -> Response:
    shape = frequency_ratio.shape
    groups = {
        "slenderness": np.broadcast_to(np.float64(question.slenderness), shape),
        "frequency_ratio": frequency_ratio,
        "restitution": np.broadcast_to(np.float64(question.restitution), shape),
    }
    result = ask_many(service.atlas, question, groups, stop)
    query = question.model_dump(exclude={"format"})
    if form == "nc":
        attributes = {name: value for name, value in query.items() if value is not None}
        return netcdf_response(dataset_of({"frequency_ratio": frequency_ratio}, result, attributes), "spectrum")
    curve = {"frequency_ratio": frequency_ratio} | columns_of(result)
    if form == "csv":
        return csv_stream(curve, "spectrum")
    lists = {name: column[:].tolist() for name, column in curve.items()}
    return json_response(SpectrumAnswer.model_construct(query=query, data_versions=list(result.versions), **lists))
