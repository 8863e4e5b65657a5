"""The kinds of bodies by name: Python, options, HTTP, tables and configurations describe a body by them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from importlib.metadata import entry_points
from typing import TYPE_CHECKING, Any

from rocking._base.quantity import Kind, Quantity, kind_with, split_kind
from rocking._dimensional.bodies.composite import hollow, on_pedestal
from rocking._dimensional.bodies.rigid import anchored, cylinder, offset_mass, outline, rectangle, two_edges, with_wall
from rocking._dimensional.bodies.structures import arch, frame, on_pivots, structure

if TYPE_CHECKING:
    from rocking._dimensional.body import RespondingBody

Makers = tuple[Callable[..., Any], ...]

_RIGID: Makers = rectangle, offset_mass, two_edges, cylinder, hollow, on_pedestal, outline
RIGID = tuple(map(with_wall, _RIGID))  # rigid bodies, which an object of a table may be

_ALL: Makers = *RIGID, anchored, frame, arch, on_pivots, structure
BODIES: dict[str, Kind[RespondingBody]] = {make.__name__: Kind(make) for make in _ALL}
"""Where only parameters are given, the first kind that has them. Further packages add kinds by name through the entry
points `rocking.bodies`; only `body` and the options of commands take these, neither the service nor tables."""

KIND = Quantity("body", "", "kind of body; absent: the one that its parameters determine")

_TABLED = [BODIES[make.__name__] for make in RIGID]


def columns_beside(own: Iterable[Quantity], *left_out: str) -> tuple[Quantity, ...]:
    """The columns of tables of bodies: the kind, and the parameters of rigid ones that are not among a table's own."""
    taken = {quantity.name for quantity in own} | {"gravity", *left_out}
    found = {name: one for kind in _TABLED for name, one in kind.fields.items() if name not in taken}
    return (KIND, *found.values())


def body(description: str | Mapping[str, Any], **parameters: Any) -> RespondingBody:
    """The body of a description, such as `"hollow(width=40cm, height=1.6m, wall=2cm)"`.

    Parameters
    ----------
    description : str or mapping
        The name of a kind, with its parameters and their units in brackets; or a mapping of the parameters, with `kind`
        unless they say which one it is. Kinds: rectangle, offset_mass, two_edges, cylinder, hollow, on_pedestal,
        outline, anchored, frame, arch, on_pivots, structure, and those of the entry points `rocking.bodies` of other
        packages; all up to outline also with `sides` and `rebound` of `rocking.RigidBody`, for a wall at one side.
    **parameters
        The same as arguments: numbers in SI units, texts such as "40 cm", quantities of pint.

    Raises
    ------
    InvalidArgumentError
        For an unknown kind, or a parameter that is missing, unknown, stated twice or out of range.

    Examples
    --------
    >>> body("cylinder", diameter="30 cm", height="1.2 m")
    <rocking.RigidBody: body on edges 0.15 m left and 0.15 m right of its mass at 0.6 m>
    """
    kind, given = described(description, parameters, added_kind)
    return kind(**given)


def added_kind(name: str) -> Kind[RespondingBody] | None:
    """Return the kind that another package adds by an entry point of the group `rocking.bodies`, None if none does."""
    for entry_point in entry_points(group="rocking.bodies", name=name):
        return Kind(entry_point.load())
    return None


def described(
    description: str | Mapping[str, Any] | None,
    parameters: Mapping[str, Any],
    added: Callable[[str], Kind[RespondingBody] | None] = lambda _: None,
) -> tuple[Kind[RespondingBody], dict[str, Any]]:
    """Return the kind of a body and its parameters as they are stated.

    The arguments and errors are those of `body`; `added` returns a kind that `BODIES` does not have.
    """
    from rocking._base.errors import InvalidArgumentError, one_of  # noqa: PLC0415

    text: Any = description
    if isinstance(text, Mapping):
        parameters = {str(key): value for key, value in text.items() if key != "kind"} | dict(parameters)
        text = text.get("kind")
    kind = kind_with(BODIES, parameters)
    if text is None and kind is not None:
        return kind, dict(parameters)
    parts = split_kind(text, "body") if isinstance(text, str) else None
    if parts is None or parts[0]:
        stated = ", ".join(parameters) if text is None else text
        raise InvalidArgumentError("body", stated, f"the name or the parameters of one of: {signatures()}")
    if parts[2].keys() & parameters.keys():
        raise InvalidArgumentError("body", text, "each parameter once")
    name = parts[1]
    kind = BODIES.get(name) or added(name) or BODIES[one_of("body", name, BODIES)]
    return kind, {**parts[2], **parameters}


def signatures(kinds: Mapping[str, Kind[Any]] = BODIES) -> str:
    """The kinds with the parameters that they need, and those that they may have in square brackets."""

    def written(kind: Kind[Any]) -> str:
        names = (
            name if name in kind.needed else f"[{name}]"
            for name in kind.fields
            if name not in ("gravity", "sides", "rebound")
        )
        return f"{kind.name}({', '.join(names)})"

    return "; ".join(map(written, kinds.values()))
