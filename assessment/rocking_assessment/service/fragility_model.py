"""The fragility of a suite as a model for OpenQuake."""

from __future__ import annotations

import io
from functools import partial
from typing import Annotated, Literal

from fastapi import APIRouter, Query, Response
from rocking_api.http.caching import REVALIDATE
from rocking_api.http.parameters import ParamsRoute
from rocking_api.models.params import Params
from rocking_api.models.quantity import said
from rocking_api.routers.suites import SuiteName
from rocking_api.service import Service, ServiceDep

NRML = "application/xml"

router = APIRouter(prefix="/v1/suites", tags=["suites"], route_class=ParamsRoute)


class ModelParams(Params):
    """What a fragility model holds."""

    curves: Literal["discrete", "lognormal"] = said("fractions at the levels, or fitted curves", "discrete")


@router.get("/{name}/nrml", summary="Fragility model of OpenQuake", responses={200: {"content": {NRML: {}}}})
async def get_fragility_model(
    name: SuiteName, params: Annotated[ModelParams, Query()], service: ServiceDep
) -> Response:
    """NRML 0.5 with the limit states rocks and overturns, for suites with the measure PGA or PGV."""
    text = await service.run_io(partial(_model_text, service, name, params.curves))
    headers = {"Cache-Control": REVALIDATE, "Content-Disposition": f'attachment; filename="{name}.xml"'}
    return Response(text, media_type=NRML, headers=headers)


def _model_text(service: Service, name: str, curves: Literal["discrete", "lognormal"]) -> str:
    from rocking_assessment._hazard.nrml import write_nrml  # noqa: PLC0415  (the fits take long to import)

    _, outcomes = service.cubes.catalogue.dataset(f"suites/{name}/outcomes")
    content = io.BytesIO()
    write_nrml(outcomes, content, format=curves, description=name)
    return content.getvalue().decode()
