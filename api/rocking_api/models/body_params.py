"""A body in SI units by the kinds of `rocking.body`: their parameters, or a text; in JSON also an object."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, ValidationInfo, field_validator

import rocking._base.quantities as quantities
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError
from rocking._base.quantity import Quantity
from rocking._dimensional.body import RespondingBody
from rocking._dimensional.body_kinds import BODIES as KINDS
from rocking._dimensional.body_kinds import described, signatures
from rocking_api.models import quantity as q
from rocking_api.models.params import Params

MAX_VERTICES = 200  # most vertices of an outline [-]

PARAMETERS: dict[str, Quantity] = {}
"""The parameters of all kinds of bodies by name, of those with one name the first."""
for _kind in KINDS.values():
    for _name, _quantity in _kind.fields.items():
        PARAMETERS.setdefault(_name, _quantity)

Text = Annotated[str, Field(max_length=2000)]
_Point = Annotated[list[float], Field(min_length=2, max_length=2)]
Points = Annotated[
    Annotated[list[_Point], Field(max_length=MAX_VERTICES)],
    AfterValidator(lambda points: "; ".join(f"{x!r} {y!r}" for x, y in points)),
]
_BODY = q.said(
    "a body of any kind, with its parameters in brackets, such as hollow(width=40cm, height=1.6m, wall=2cm), or the "
    f"kind of the parameters beside it: {signatures().replace('[', '(').replace(']', ')')}",
    None,
)


def _parameter(name: str, **more: Any) -> Any:
    """A parameter of some kinds of bodies, which an answer repeats only if it was stated."""
    quantity = PARAMETERS[name]
    unit = "" if quantity.unit in ("", "bool") else quantity.unit
    return q.said(quantity.named, None, unit=unit, exclude_if=lambda value: value is None, **more)


class BodyParameters(Params):
    """The parameters of the kinds of bodies; numbers in SI units, or texts with another unit."""

    width: float | None = _parameter("width", examples=[0.4])
    height: float | None = _parameter("height", examples=[1.6])
    sides: Text | None = _parameter("sides")
    rebound: float | None = _parameter("rebound")
    offset: float | None = _parameter("offset")
    mass_height: float | None = _parameter("mass_height")
    gyration: float | None = _parameter("gyration")
    left: float | None = _parameter("left")
    right: float | None = _parameter("right")
    top_height: float | None = _parameter("top_height")
    inclination: float | None = _parameter("inclination")
    diameter: float | None = _parameter("diameter")
    wall: float | None = _parameter("wall")
    depth: float | None = _parameter("depth")
    pedestal_width: float | None = _parameter("pedestal_width")
    pedestal_height: float | None = _parameter("pedestal_height")
    pedestal_mass: float | None = _parameter("pedestal_mass")
    vertices: Text | Points | None = _parameter("vertices")
    stiffness: float | None = _parameter("stiffness")
    prestress: float | None = _parameter("prestress")
    damping: float | None = _parameter("damping")
    mass_ratio: float | None = _parameter("mass_ratio")
    radius: float | None = _parameter("radius")
    thickness: float | None = _parameter("thickness")
    embrace: float | None = _parameter("embrace")
    voussoirs: float | None = _parameter("voussoirs")
    mass: float | None = _parameter("mass")
    inertia: float | None = _parameter("inertia")
    base: float | None = _parameter("base")
    centre_height: float | None = _parameter("centre_height")
    alpha: float | None = _parameter("alpha")
    frequency_parameter: float | None = _parameter("frequency_parameter")
    uplift_acceleration: float | None = _parameter("uplift_acceleration")

    @field_validator(*(name for name in PARAMETERS if PARAMETERS[name].unit), mode="before", check_fields=False)
    @classmethod
    def _read(cls, value: Any, info: ValidationInfo) -> Any:
        return value if value is None else q.served(PARAMETERS[str(info.field_name)]).read(value, si=True)


class BodyDescription(BodyParameters):
    """A body in JSON: its kind, unless its parameters say it, and its parameters in SI units or as texts."""

    kind: Literal[tuple(KINDS)] | None = q.said("kind of body", None)  # type: ignore[valid-type]
    restitution: float | None = q.said("eta of an arch or a structure", None, unit="-")
    gravity: float | None = q.said(quantities.GRAVITY.named, None, unit="m/s2")


def _as_text(body: BodyDescription) -> str:
    kind, parameters = described(body.kind, body.model_dump(exclude_none=True, exclude={"kind"}))
    stated = (f"{name}={value} {kind.fields[name].unit.strip('-')}" for name, value in kind.read(parameters).items())
    return f"{kind.name}({', '.join(text.strip() for text in stated)})"


JsonBody: Any = Annotated[Text | Annotated[BodyDescription, AfterValidator(_as_text)] | None, _BODY]
"""A body in JSON; a text once it is read."""


class BodyShape(BodyParameters):
    """A body by the parameters of its kind, or by a text."""

    body: Text | None = _BODY

    def made(self, gravity: float = STANDARD_GRAVITY, restitution: float | str | None = None) -> RespondingBody:
        """The body; the restitution is that of an arch or a structure, whose kinds have it.

        The mass of a kind whose motion does not depend on it is left out.
        """
        stated = {name: getattr(self, name) for name in BodyParameters.model_fields}
        stated = {name: value for name, value in stated.items() if value is not None}
        mass = stated.pop("mass", None) if "inertia" not in stated else None
        if self.body is None and stated.keys() < {"width", "height"}:
            missing = next(name for name in ("width", "height") if name not in stated)
            raise InvalidArgumentError(missing, None, "required, or the parameters of another kind, or `body`")
        kind, parameters = described(self.body, stated)
        if mass is not None and "mass" in kind.fields:
            parameters.setdefault("mass", mass)
        if "gravity" in kind.fields or gravity != STANDARD_GRAVITY:
            parameters.setdefault("gravity", gravity)
        if "restitution" in kind.fields and isinstance(restitution, float):
            parameters.setdefault("restitution", restitution)
        for name, value in kind.read(parameters).items():
            if kind.fields[name].unit:
                q.served(kind.fields[name]).convert(value)
        return kind(**parameters)


class BodyParams(BodyShape):
    """A body in SI units."""

    restitution: q.BodyRestitution = "momentum"
    gravity: q.Gravity = STANDARD_GRAVITY

    @property
    def rocking_body(self) -> RespondingBody:
        """The body."""
        return self.made(self.gravity, self.restitution)
