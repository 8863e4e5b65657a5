"""The motion of one block against time (figures 2 and 7)."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
import xarray as xr
from fastapi import APIRouter, Query, Request, Response

from api.answers import HistoryAnswer
from api.formats import CONTENT, csv_response, form_of, json_response, netcdf_response
from api.problems import TooLargeError
from api.questions import HistoryQuestion, alpha_of, checked
from api.service import ServiceDep
from rocking.history import time_history

router = APIRouter(prefix="/v1", tags=["curves"])


@router.get("/history", summary="Motion of one block", response_model=HistoryAnswer, responses=CONTENT)
async def get_history(question: Annotated[HistoryQuestion, Query()], request: Request, service: ServiceDep) -> Response:
    """Rotation and angular velocity from the start of the pulse through free rocking; the solver always answers."""
    if question.samples > service.settings.max_samples:
        raise TooLargeError("samples", question.samples, f"at most {service.settings.max_samples}")
    form = form_of(request, question.format)
    return await service.off_loop(lambda: _history(question, form))


def _history(question: HistoryQuestion, form: str) -> Response:
    motion = time_history(
        question.pulse,
        slenderness=float(checked("slenderness", question.slenderness)),
        frequency_ratio=float(checked("frequency_ratio", question.frequency_ratio)),
        restitution=question.restitution,
        alpha=alpha_of(question.alpha_deg),
        duration=question.duration,
        samples=question.samples,
    )
    if form == "nc":
        return netcdf_response(motion, "history")
    sampled = ("tau", "rotation", "angular_velocity", "ground_acceleration")
    columns: dict[str, Any] = {name: motion[name].values.tolist() for name in sampled}
    if form == "csv":
        return csv_response(columns, "history")
    return json_response(_answer(question, motion, columns))


def _answer(question: HistoryQuestion, motion: xr.Dataset, columns: dict[str, Any]) -> HistoryAnswer:
    peak = float(motion.attrs["peak_rotation"])
    return HistoryAnswer.model_construct(
        query=question,
        overturned=bool(motion.attrs["overturned"]),
        outcome=motion.attrs["outcome"],
        peak_rotation=peak if np.isfinite(peak) else None,
        impacts=int(motion.attrs["impacts"]),
        impact_time=motion["impact_time"].values.tolist(),
        **columns,
    )
