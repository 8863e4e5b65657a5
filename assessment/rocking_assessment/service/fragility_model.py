"""The fragility of a suite as a model for OpenQuake."""

from __future__ import annotations

import io
from typing import Annotated, Literal

from fastapi import APIRouter, Query, Response
from rocking_api.models.params import Params
from rocking_api.models.quantity import said
from rocking_api.routers.suites import SuiteName
from rocking_api.service import Service, ServiceDep

NRML = "application/xml"

router = APIRouter(prefix="/v1/suites", tags=["suites"])


class ModelParams(Params):
    """What a fragility model holds."""

    curves: Literal["discrete", "lognormal"] = said("fractions at the levels, or fitted curves", "discrete")


@router.get(
    "/{name}/nrml",
    summary="Fragility model of OpenQuake",
    response_class=Response,
    responses={200: {"content": {NRML: {}}}},
)
async def get_fragility_model(
    name: SuiteName, params: Annotated[ModelParams, Query()], service: ServiceDep
) -> Response:
    """NRML 0.5 with the limit states rocks and overturns, for suites with the measure PGA or PGV."""
    text = await service.read(lambda _: _model_text(service, name, params.curves))
    return Response(text, media_type=NRML, headers={"Content-Disposition": f'attachment; filename="{name}.xml"'})


def _model_text(service: Service, name: str, curves: Literal["discrete", "lognormal"]) -> str:
    from rocking_assessment._hazard.nrml import write_nrml  # noqa: PLC0415  (the fits take long to import)

    _, outcomes = service.cubes.catalogue.dataset(f"suites/{name}/outcomes")
    content = io.BytesIO()
    write_nrml(outcomes, content, format=curves, description=name)
    return content.getvalue().decode()
