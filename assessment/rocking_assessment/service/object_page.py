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
"""Ways to describe an object, and what the page calls them."""

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
"""Fields of a site, and what they hold at first."""

USUAL_PGV = (
    "a number, usually about 100 cm/s for each g of PGA on firm ground, 30 cm/s at 0.3 g; or in its place the shortest "
    "and the longest period of the pulses"
)
"""What is asked for where the PGV is empty."""

EXAMPLES = {
    "rectangle": {"width": "40", "depth": "30", "height": "160"},
    "round": {"diameter": "35", "height": "120"},
    "outline": {"vertices": "0, 0\n30, 0\n30, 100\n10, 120\n0, 100"},
    "mesh": {},
}
"""What the fields hold at first."""

MAX_TEXT = 10_000  # longest outline [characters]
MAX_VERTICES = 200  # most vertices of an outline [-]

router = APIRouter(prefix=PATH, include_in_schema=False)


@router.get("")
async def get_object_page(request: Request, service: ServiceDep) -> Response:
    """The page with the object of its address, or an example."""
    asked = dict(request.query_params)
    given = fields_of(asked)
    if given["shape"] == "mesh" or not (_is_asked(asked) or service.kernels.is_loaded):
        return page_of(given, settings=service.settings)

    def work(stop: StopFlag) -> tuple[Object, xr.Dataset]:
        one = _object(given)
        return one, factors_by_direction(one.planes_around, one.restitution, site_of(given).find_motions(stop), stop)

    try:
        one, found = await service.solve_one(work, request)
    except InvalidArgumentError as error:
        return page_of(given, error=error, settings=service.settings)
    return page_of(given, found=found, footprint=one.footprint, settings=service.settings)


@router.post("")
async def post_mesh(request: Request, service: ServiceDep, file: str = "") -> Response:
    """The page with the object of a mesh, the body; `file` is its name."""
    given = fields_of({**request.query_params, "shape": "mesh"})
    site, restitution = site_of(given), _restitution(given)
    mesh = await read_mesh(service.helper, await request.body(), file, given["unit"])

    def work(stop: StopFlag) -> xr.Dataset:
        return factors_by_direction(mesh.planes, restitution, site.find_motions(stop), stop)

    found = await service.solve(work, request)
    notes = [f"The mesh {remark}." for remark in mesh.remarks]
    given |= {"name": file}
    return page_of(given, found=found, footprint=np.array(mesh.footprint), notes=notes, settings=service.settings)


def site_of(given: dict[str, str]) -> Site:
    """The site of the fields of a form."""
    modes: dict[str, Any] = {}
    if given["floor_periods"].strip():
        for name in ("floor_periods", "floor_participation"):
            modes[name] = modes_of(name, given[name])
    periods = periods_of(given)
    if periods is None and not given["pgv"].strip():
        raise InvalidArgumentError("pgv", None, USUAL_PGV)
    pgv = quantity_of(given, "pgv") if given["pgv"].strip() else None
    return Site(quantity_of(given, "pga"), pgv, periods, **modes)


def periods_of(given: dict[str, str]) -> tuple[str, str] | None:
    """The shortest and the longest period of the pulses from the fields of a form; None if both are empty."""
    texts = {name: given[name].strip().replace(",", ".") for name in ("period_min", "period_max")}
    for name, text in texts.items():
        if not text and any(texts.values()):
            raise InvalidArgumentError(name, None, "a number of seconds: the shortest and the longest period")
    return (f"{texts['period_min']} s", f"{texts['period_max']} s") if any(texts.values()) else None


def address_of(one: Object, given: dict[str, str]) -> str:
    """The address of the page with an object, at the site of the fields of a form."""
    shape = "rectangle" if one.diameter is None else "round"
    fields = {"shape": shape, "name": one.name} | {name: given[name] for name in SITE}
    for name in LENGTHS[shape]:
        if value := getattr(one, name):
            fields |= {name: f"{100.0 * value:.10g}", f"{name}_unit": "cm"}
    return f"{PATH}?{urlencode(fields | {'restitution': one.restitution})}"


def _is_asked(asked: dict[str, str]) -> bool:
    """Whether an address describes an object."""
    return "pga" in asked


def fields_of(asked: dict[str, str]) -> dict[str, str]:
    """The fields of the form; those that an address leaves out are as at first, or empty if it describes an object."""
    shape = asked.get("shape", "rectangle")
    if shape not in SHAPES:
        raise InvalidArgumentError("shape", shape, f"one of {', '.join(SHAPES)}")
    lengths = {field: value for name in LENGTHS[shape] for field, value in ((name, ""), (f"{name}_unit", "cm"))}
    first = {} if _is_asked(asked) else EXAMPLES[shape]
    empty = SITE | {"name": "", "restitution": "momentum", "vertices": "", "unit": "m"} | lengths
    return empty | first | asked | {"shape": shape}


def quantity_of(given: dict[str, str], name: str) -> str:
    """The text of a number and its unit from the fields of a form."""
    return f"{given[name].strip().replace(',', '.')} {given[f'{name}_unit']}"


def _restitution(given: dict[str, str]) -> Scalar:
    found: Scalar = RESTITUTION.read(given["restitution"].strip().replace(",", "."))
    return found


def _object(given: dict[str, str]) -> Object:
    others: dict[str, Any] = {"name": given["name"], "restitution": _restitution(given)}
    if given["shape"] == "outline":
        return Object.from_outline(_vertices(given["vertices"]), **others)
    lengths: dict[str, Any] = {
        name: quantity_of(given, name) for name in LENGTHS[given["shape"]] if given[name].strip()
    }
    base = "width" if given["shape"] == "rectangle" else "diameter"
    if base not in lengths:
        raise InvalidArgumentError(base, given[base], "a length")
    return Object(**lengths, **others)


def _vertices(text: str) -> Array:
    """Corners of an outline [m] from lines of two numbers [cm]."""
    if len(text) > MAX_TEXT:
        raise InvalidArgumentError("vertices", f"{len(text)} characters", f"at most {MAX_TEXT}")
    lines = [line for line in text.replace(";", "\n").splitlines() if line.strip()]
    if len(lines) > MAX_VERTICES:
        raise InvalidArgumentError("vertices", f"{len(lines)} points", f"at most {MAX_VERTICES}")
    found = []
    for line in lines:
        try:
            x, y = (float(part) for part in line.replace(",", " ").split())
        except ValueError:
            raise InvalidArgumentError("vertices", line, "two numbers on each line, such as 30, 100") from None
        found.append((0.01 * x, 0.01 * y))
    return np.array(found)


def page_of(
    given: dict[str, str],
    *,
    found: xr.Dataset | None = None,
    footprint: Array | None = None,
    notes: list[str] | None = None,
    error: InvalidArgumentError | None = None,
    settings: Settings | None = None,
) -> HTMLResponse:
    """The page with the fields of its form, and what was found or is wrong."""
    worst = [] if found is None else worst_directions(found)
    wrong = {} if error is None else {error.parameter: _words(error)}
    problem = "" if error is None else "see the field marked in red." if error.parameter in given else f"{error}."
    text = html(
        "object.html",
        "In which direction does it overturn?",
        PATH,
        settings,
        given=given,
        shapes=SHAPES,
        lengths=LENGTHS[given["shape"]],
        units=UNITS_SHOWN,
        kept={name: given[name] for name in SITE},
        endings=ENDINGS,
        wrong=wrong,
        problem=problem and f"No answer: {problem}",
        rows=None if found is None else found.to_dataframe().reset_index().to_dict("records"),
        worst=worst,
        dial=dial_of(found, footprint) if worst and found is not None and footprint is not None else None,
        highest=HIGHEST_FACTOR,
        number_of=number_of,
        notes=notes or [],
        depth_missing=given["shape"] == "rectangle" and not given["depth"].strip(),
    )
    headers = {"Content-Security-Policy": POLICY, "Cache-Control": "no-cache"}
    return HTMLResponse(text, 200 if error is None else 422, headers)


def _words(error: InvalidArgumentError) -> str:
    """What is wrong with a field, in the words that the other pages have."""
    name = error.parameter.replace("_", " ")
    if error.value is None:
        return f"{name} is missing; needed: {error.allowed}"
    value = str(error.value)
    return f"{name} is {value if len(value) <= 60 else 'wrong'}; allowed: {error.allowed}"
