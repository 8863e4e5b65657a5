"""A body in SI units by the kinds of `rocking.body`: their parameters, or a text; in JSON also an object."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeVar

from pydantic import AfterValidator, Field, create_model

import rocking._base.quantities as quantities
from rocking._base.errors import InvalidArgumentError
from rocking._base.units import STANDARD_GRAVITY
from rocking._dimensional.body import RespondingBody
from rocking._dimensional.body_kinds import BODIES as KINDS
from rocking._dimensional.body_kinds import described, signatures
from rocking_api.models import quantity as q
from rocking_api.models.params import Params

P = TypeVar("P", bound=Params)

MAX_VERTICES = 200  # most vertices of an outline [-]
EXAMPLES = {quantities.WIDTH.name: 0.4, quantities.HEIGHT.name: 1.6}  # values that the pages of the description fill in
APART = ("restitution", "gravity")  # parameters of kinds that belong to every body

Text = Annotated[str, Field(max_length=2000)]
_Point = Annotated[list[float], Field(min_length=2, max_length=2)]
Points = Annotated[
    Annotated[list[_Point], Field(max_length=MAX_VERTICES)],
    AfterValidator(lambda points: "; ".join(f"{x!r} {y!r}" for x, y in points)),
]
_SAID = q.said(
    "a body of any kind, with its parameters in brackets, such as hollow(width=40cm, height=1.6m, wall=2cm), or the "
    f"kind of the parameters beside it: {signatures().replace('[', '(').replace(']', ')')}",
    None,
)


def with_parameters(model: type[P]) -> type[P]:
    """A decorator that adds the parameters of the kinds of bodies to a model; absent ones are not repeated."""
    found: dict[str, Any] = {}
    for kind in KINDS.values():
        for name, quantity in kind.fields.items():
            hidden: dict[str, Any] = {"exclude_if": lambda value: value is None}
            if name in EXAMPLES:
                hidden["examples"] = [EXAMPLES[name]]
            if quantity.unit:
                hint = q.si(quantity, kind=float | None, **hidden)
            else:
                text: Any = Text | Points if kind.hints[name].__origin__ is Any else Text
                hint = Annotated[text | None, Field(description=quantity.help, **hidden)]
            if name not in APART:
                found.setdefault(name, (hint, None))
    return create_model(model.__name__, __base__=model, __doc__=model.__doc__, **found)


@with_parameters
class BodyDescription(Params):
    """A body in JSON: its kind, unless its parameters say it, and its parameters in SI units or as texts."""

    kind: Literal[tuple(KINDS)] | None = q.said("kind of body", None)  # type: ignore[valid-type]
    restitution: q.si(quantities.RESTITUTION, "eta of an arch or a structure", float | None) = None  # type: ignore[valid-type]
    gravity: q.si(quantities.GRAVITY, kind=float | None) = None  # type: ignore[valid-type]


def _as_text(given: BodyDescription) -> str:
    kind, parameters = described(given.kind, given.model_dump(exclude_none=True, exclude={"kind"}))
    stated = (f"{name}={value} {kind.fields[name].unit.strip('-')}" for name, value in kind.read(parameters).items())
    return f"{kind.name}({', '.join(one.strip() for one in stated)})"


JsonBody = Annotated[Text | Annotated[BodyDescription, AfterValidator(_as_text)] | None, _SAID]
"""A body in JSON; a text once it is read."""


@with_parameters
class BodyShape(Params):
    """A body by the parameters of its kind, or by a text."""

    body: Text | None = _SAID

    def made(self, gravity: float = STANDARD_GRAVITY, restitution: float | str | None = None) -> RespondingBody:
        """The body; the restitution is that of an arch or a structure, whose kinds have it."""
        given = {name: getattr(self, name) for name in _PARAMETERS if getattr(self, name) is not None}
        if self.body is None and given.keys() < EXAMPLES.keys():
            missing = next(name for name in EXAMPLES if name not in given)
            raise InvalidArgumentError(missing, None, "required, or the parameters of another kind, or `body`")
        kind, parameters = described(self.body, given)
        if "gravity" in kind.fields or gravity != STANDARD_GRAVITY:
            parameters.setdefault("gravity", gravity)
        if "restitution" in kind.fields and isinstance(restitution, float):
            parameters.setdefault("restitution", restitution)
        for name, value in kind.read(parameters).items():
            if kind.fields[name].unit:
                q.served(kind.fields[name]).convert(value)
        return kind(**parameters)


_PARAMETERS = BodyShape.model_fields.keys() - {"body"}


class BodyParams(BodyShape):
    """A body in SI units."""

    restitution: q.BodyRestitution = "momentum"
    gravity: q.Gravity = STANDARD_GRAVITY

    @property
    def rocking_body(self) -> RespondingBody:
        """The body."""
        return self.made(self.gravity, self.restitution)
