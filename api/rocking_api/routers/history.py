"""The motion of one block against time (figures 2 and 7)."""

from __future__ import annotations

from typing import Annotated, Any

import xarray as xr
from fastapi import APIRouter, Query, Request, Response

from rocking._numba.cancellation import StopFlag
from rocking.history.contact import ATTRIBUTES, COLUMNS
from rocking.history.time_history import time_history
from rocking_api.http.formats import CONTENT, csv_response, form_of, json_response, netcdf_response
from rocking_api.http.params_route import QuestionRoute
from rocking_api.http.problems import TooLargeError
from rocking_api.models.params import HistoryQuestion, alpha_of
from rocking_api.models.responses import ContactAnswer, HistoryAnswer, finite
from rocking_api.service import ServiceDep

router = APIRouter(prefix="/v1", tags=["curves"], route_class=QuestionRoute)


@router.get("/history", summary="Motion of one block", response_model=HistoryAnswer, responses=CONTENT)
async def get_history(question: Annotated[HistoryQuestion, Query()], request: Request, service: ServiceDep) -> Response:
    """Rotation and angular velocity from the start of the pulse through free rocking; the solver always answers.

    With `contact`, the reactions of the ground too, and the friction that pure rocking needs.
    """
    if question.samples > service.settings.max_samples:
        raise TooLargeError("samples", question.samples, f"at most {service.settings.max_samples}")
    form = form_of(request, question.format)
    return await service.off_loop(question, lambda stop: _history(question, form, stop), request)


def _history(question: HistoryQuestion, form: str, stop: StopFlag) -> Response:
    motion = time_history(
        question.pulse,
        slenderness=question.slenderness,
        frequency_ratio=question.frequency_ratio,
        restitution=question.restitution,
        alpha=alpha_of(question.alpha_deg),
        duration=question.duration,
        samples=question.samples,
        contact=question.contact,
        stop=stop,
    )
    if form == "nc":
        return netcdf_response(motion, "history")
    sampled = ("tau", "rotation", "angular_velocity", "ground_acceleration")
    columns: dict[str, Any] = {name: motion[name].values.tolist() for name in sampled}
    reactions: dict[str, Any] = {name: motion[name].values.tolist() for name in COLUMNS if question.contact}
    if form == "csv":
        return csv_response(columns | reactions, "history")
    contact = _contact(motion, reactions) if question.contact else None
    return json_response(_answer(question, motion, columns, contact))


def _contact(motion: xr.Dataset, reactions: dict[str, Any]) -> ContactAnswer:
    fields: dict[str, Any] = {name: [finite(value) for value in column] for name, column in reactions.items()}
    fields |= {name: finite(float(motion.attrs[name])) for name in ATTRIBUTES}
    return ContactAnswer.model_construct(
        **fields, lifts_off=bool(motion.attrs["lifts_off"]), warnings=motion.attrs["warnings"]
    )


def _answer(
    question: HistoryQuestion, motion: xr.Dataset, columns: dict[str, Any], contact: ContactAnswer | None
) -> HistoryAnswer:
    return HistoryAnswer.model_construct(
        query=question,
        overturned=bool(motion.attrs["overturned"]),
        outcome=motion.attrs["outcome"],
        peak_rotation=finite(float(motion.attrs["peak_rotation"])),
        impacts=int(motion.attrs["impacts"]),
        impact_time=motion["impact_time"].values.tolist(),
        contact=contact,
        **columns,
    )
