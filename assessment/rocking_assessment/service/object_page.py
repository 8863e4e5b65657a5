"""The page of one object: the factors on the motions of a site that overturn it, over their direction."""

from __future__ import annotations

from typing import Any
from urllib.parse import urlencode

import numpy as np
import xarray as xr
from fastapi import APIRouter, Request, Response
from fastapi.responses import HTMLResponse
from rocking_api.routers.pages import POLICY, html
from rocking_api.service import ServiceDep
from rocking_api.settings import Settings

from rocking.extension import RESTITUTION, Array, InvalidArgumentError, Scalar, StopFlag
from rocking_assessment._objects.directions import factors_by_direction
from rocking_assessment._objects.objects import Object
from rocking_assessment._objects.search import HIGHEST_FACTOR
from rocking_assessment._objects.site import Site
from rocking_assessment._objects.summary import number_of
from rocking_assessment.service.dial import dial_of, worst_directions
from rocking_assessment.service.mesh_reader import ENDINGS, read_mesh
from rocking_assessment.service.models import modes_of

PATH = "/object"

SHAPES = {"rectangle": "Rectangular base", "round": "Round base", "outline": "Outline", "mesh": "Mesh file"}
"""Labels of the ways to describe an object."""

_MASS = {
    "height": "Height",
    "mass_height": "Height of the centre of mass, half the height if empty",
    "offset_width": "Centre of mass from the middle, along the width",
    "offset_depth": "Centre of mass from the middle, along the depth",
}

LENGTHS = {
    "rectangle": {"width": "Width of the base", "depth": "Depth of the base"} | _MASS,
    "round": {"diameter": "Diameter of the base"} | _MASS,
    "outline": {},
    "mesh": {},
}
"""Fields of lengths of each way, and their labels."""

UNITS_SHOWN = ("cm", "m", "mm", "ft", "in")

SITE = {
    "pga": "0.3",
    "pga_unit": "g",
    "pgv": "30",
    "pgv_unit": "cm/s",
    "period_min": "",
    "period_max": "",
    "floor_periods": "",
    "floor_participation": "1",
}
"""Fields of a site with their first values."""

USUAL_PGV = (
    "a number, usually about 100 cm/s for each g of PGA on firm ground, 30 cm/s at 0.3 g; or in its place the shortest "
    "and the longest period of the pulses"
)
"""Allowed values where the PGV is empty."""

EXAMPLES = {
    "rectangle": {"width": "40", "depth": "30", "height": "160"},
    "round": {"diameter": "35", "height": "120"},
    "outline": {"vertices": "0, 0\n30, 0\n30, 100\n10, 120\n0, 100"},
    "mesh": {},
}
"""First values of the other fields."""

MAX_TEXT = 10_000  # longest outline [characters]
MAX_VERTICES = 200  # most vertices of an outline [-]

router = APIRouter(prefix=PATH, include_in_schema=False)


@router.get("")
async def get_object_page(request: Request, service: ServiceDep) -> Response:
    """The page with the object of its address, or an example."""
    query = dict(request.query_params)
    form = fields_of(query)
    if form["shape"] == "mesh" or not ("pga" in query or service.kernels.is_loaded):
        return page_of(form, settings=service.settings)

    def work(stop: StopFlag) -> tuple[Object, xr.Dataset]:
        obj = _object(form)
        return obj, factors_by_direction(obj.planes_around, obj.restitution, site_of(form).find_motions(stop), stop)

    try:
        obj, factors = await service.solve_one(work, request)
    except InvalidArgumentError as error:
        return page_of(form, error=error, settings=service.settings)
    return page_of(form, factors=factors, footprint=obj.footprint, settings=service.settings)


@router.post("")
async def post_mesh(request: Request, service: ServiceDep, file: str = "") -> Response:
    """The page with the object of a mesh, the body; `file` is its name."""
    form = fields_of({**request.query_params, "shape": "mesh"})
    site, restitution = site_of(form), _restitution(form)
    mesh = await read_mesh(service.helper, await request.body(), file, form["unit"])

    def work(stop: StopFlag) -> xr.Dataset:
        return factors_by_direction(mesh.planes, restitution, site.find_motions(stop), stop)

    factors = await service.solve(work, request)
    notes = [f"The mesh {remark}." for remark in mesh.remarks]
    form["name"] = file
    return page_of(form, factors=factors, footprint=np.array(mesh.footprint), notes=notes, settings=service.settings)


def site_of(form: dict[str, str]) -> Site:
    """The site of the fields of a form."""
    modes: dict[str, Any] = {}
    if form["floor_periods"].strip():
        for name in ("floor_periods", "floor_participation"):
            modes[name] = modes_of(name, form[name])
    periods = periods_of(form)
    if periods is None and not form["pgv"].strip():
        raise InvalidArgumentError("pgv", None, USUAL_PGV)
    pgv = quantity_of(form, "pgv") if form["pgv"].strip() else None
    return Site(quantity_of(form, "pga"), pgv, periods, **modes)


def periods_of(form: dict[str, str]) -> tuple[str, str] | None:
    """The shortest and the longest period of the pulses from the fields of a form; None if both are empty."""
    shortest, longest = (form[name].strip().replace(",", ".") for name in ("period_min", "period_max"))
    if not shortest and not longest:
        return None
    if not shortest or not longest:
        missing = "period_max" if shortest else "period_min"
        raise InvalidArgumentError(missing, None, "a number of seconds: the shortest and the longest period")
    return f"{shortest} s", f"{longest} s"


def address_of(obj: Object, form: dict[str, str]) -> str:
    """The address of the page with an object, at the site of the fields of a form."""
    shape = "rectangle" if obj.diameter is None else "round"
    fields = {"shape": shape, "name": obj.name} | {name: form[name] for name in SITE}
    for name in LENGTHS[shape]:
        if value := getattr(obj, name):
            fields |= {name: f"{100.0 * value:.10g}", f"{name}_unit": "cm"}
    return f"{PATH}?{urlencode(fields | {'restitution': obj.restitution})}"


def fields_of(query: dict[str, str]) -> dict[str, str]:
    """The fields of the form.

    Fields that an address leaves out have their first values, or are empty if it describes an object, with a PGA.
    """
    shape = query.get("shape", "rectangle")
    if shape not in SHAPES:
        raise InvalidArgumentError("shape", shape, f"one of {', '.join(SHAPES)}")
    fields = SITE | {"name": "", "restitution": "momentum", "vertices": "", "unit": "m"}
    for name in LENGTHS[shape]:
        fields |= {name: "", f"{name}_unit": "cm"}
    if "pga" not in query:
        fields |= EXAMPLES[shape]
    return fields | query | {"shape": shape}


def quantity_of(form: dict[str, str], name: str) -> str:
    """The text of a number and its unit from the fields of a form."""
    return f"{form[name].strip().replace(',', '.')} {form[f'{name}_unit']}"


def _restitution(form: dict[str, str]) -> Scalar:
    restitution: Scalar = RESTITUTION.read(form["restitution"].strip().replace(",", "."))
    return restitution


def _object(form: dict[str, str]) -> Object:
    name, restitution = form["name"], _restitution(form)
    if form["shape"] == "outline":
        return Object.from_outline(_vertices(form["vertices"]), name=name, restitution=restitution)
    sizes = [size for size in LENGTHS[form["shape"]] if form[size].strip()]
    base = "width" if form["shape"] == "rectangle" else "diameter"
    if base not in sizes:
        raise InvalidArgumentError(base, form[base], "a length")
    lengths: dict[str, Any] = {size: quantity_of(form, size) for size in sizes}
    return Object(name, **lengths, restitution=restitution)


def _vertices(text: str) -> Array:
    """Corners of an outline [m] from lines of two numbers [cm]."""
    if len(text) > MAX_TEXT:
        raise InvalidArgumentError("vertices", f"{len(text)} characters", f"at most {MAX_TEXT}")
    lines = [line for line in text.replace(";", "\n").splitlines() if line.strip()]
    if len(lines) > MAX_VERTICES:
        raise InvalidArgumentError("vertices", f"{len(lines)} points", f"at most {MAX_VERTICES}")
    corners = []
    for line in lines:
        try:
            x, y = (float(part) for part in line.replace(",", " ").split())
        except ValueError:
            raise InvalidArgumentError("vertices", line, "two numbers on each line, such as 30, 100") from None
        corners.append((0.01 * x, 0.01 * y))
    return np.array(corners)


def page_of(
    form: dict[str, str],
    *,
    factors: xr.Dataset | None = None,
    footprint: Array | None = None,
    notes: list[str] | None = None,
    error: InvalidArgumentError | None = None,
    settings: Settings | None = None,
) -> HTMLResponse:
    """The page with the fields of its form, and the factors by direction or the error."""
    rows, worst, dial = None, [], None
    if factors is not None:
        rows = factors.to_dataframe().reset_index().to_dict("records")
        worst = worst_directions(factors)
        if worst and footprint is not None:
            dial = dial_of(factors, footprint)
    wrong, problem = {}, ""
    if error is not None:
        wrong = {error.parameter: _words(error)}
        problem = "see the field marked in red" if error.parameter in form else str(error)
        problem = f"No answer: {problem}."
    text = html(
        "object.html",
        "In which direction does it overturn?",
        PATH,
        settings,
        form=form,
        shapes=SHAPES,
        lengths=LENGTHS[form["shape"]],
        units=UNITS_SHOWN,
        endings=ENDINGS,
        wrong=wrong,
        problem=problem,
        rows=rows,
        worst=worst,
        dial=dial,
        highest=HIGHEST_FACTOR,
        number_of=number_of,
        notes=notes or [],
        depth_missing=form["shape"] == "rectangle" and not form["depth"].strip(),
    )
    headers = {"Content-Security-Policy": POLICY, "Cache-Control": "no-cache"}
    return HTMLResponse(text, 200 if error is None else 422, headers)


def _words(error: InvalidArgumentError) -> str:
    """The error of a field, in the words that the other pages have."""
    name = error.parameter.replace("_", " ")
    if error.value is None:
        return f"{name} is missing; needed: {error.allowed}"
    value = str(error.value)
    return f"{name} is {value if len(value) <= 60 else 'wrong'}; allowed: {error.allowed}"
