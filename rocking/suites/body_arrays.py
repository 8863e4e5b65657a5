"""Fragility of arrays of bodies: labelled by their dimensions, and lazy where they are backed by dask."""

import math
from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import Any, Protocol, runtime_checkable

import numpy as np
import xarray as xr

from rocking._base.errors import InvalidArgumentError
from rocking._base.units import Scalar
from rocking._dimensional.equivalent_block import EquivalentBlock
from rocking._dimensional.rigid_body import RigidBody
from rocking._model.block import AbstractBlock, RectangularBlock
from rocking._model.body import AbstractBody
from rocking._model.labelled import broadcast_by_name, with_index, without_place

Analyse = Callable[[Sequence[AbstractBlock] | RigidBody], xr.Dataset]


@runtime_checkable
class HasBody(Protocol):
    """Anything with a body for each direction, such as an object with one for each side of its base."""

    restitution: Scalar

    @property
    def body(self) -> RigidBody:
        """The bodies, labelled by direction."""


OWN_DIMENSIONS = ("intensity", "record", "demand", "model")
"""Dimensions of the results; arguments of a body must not have these names."""


def over_bodies(analyse: Analyse, body: RigidBody) -> xr.Dataset:
    """Return the fragility of each body of an array, over the dimensions of its labelled arguments in place of `block`.

    `analyse` gives the fragility, over `block`, of a sequence of blocks; or of bodies (bodies,) if one of all has two
    different edges. Axes of unlabelled arrays are dim_0, dim_1, ...; the result is lazy, in the chunks of the
    arguments, where one of them is backed by dask. A dimension of the body must not be one of the result.
    """
    labels, equal = body.labels, has_equal_edges(body)
    unlabelled = {name: value for name, value in body.parameters.items() if name not in labels}
    # a variable of the name of a dimension would become its coordinate
    prefixed = {f"of body: {name}": value for name, value in broadcast_by_name(labels).items()}
    arguments = xr.Dataset(prefixed)
    reserved = [name for name in arguments.dims if name in OWN_DIMENSIONS]
    if reserved:
        raise InvalidArgumentError("blocks", reserved[0], "dimensions other than " + ", ".join(OWN_DIMENSIONS))

    def part(chunk: xr.Dataset) -> xr.Dataset:
        labelled = {name: chunk[f"of body: {name}"] for name in labels}
        with without_place():
            bodies = body.changed(**unlabelled, **labelled)
        unnamed = (f"dim_{axis}" for axis in range(len(bodies.shape)))
        dims = tuple(chunk.dims if labels else unnamed)
        fragility = analyse(blocks_of(bodies) if equal else _flattened(bodies))
        fragility = _split_block(fragility, dims, bodies.shape).assign_coords(chunk.coords)
        return with_index(fragility, dims[-1], body.index) if dims else fragility

    if not arguments.chunks:
        return part(arguments)
    first = part(arguments.isel(dict.fromkeys(arguments.dims, slice(1))).compute())
    template = _map_variables(first, lambda variable: _resized(variable, arguments.sizes))
    template = template.assign_coords(arguments.coords).chunk(arguments.chunksizes)
    return xr.map_blocks(part, arguments, template=template)


def has_equal_edges(bodies: RigidBody) -> bool:
    """Return True if all bodies have two equal edges."""
    edge = bodies.right
    return bodies.sides == "both" and bool(
        np.all((bodies.left.alpha == edge.alpha) & (bodies.left.frequency_parameter == edge.frequency_parameter))
    )


def _flattened(bodies: RigidBody) -> RigidBody:
    """Return the bodies as an array (bodies,), in C order."""
    shape = bodies.shape
    parameters = {name: np.broadcast_to(value, shape).ravel() for name, value in bodies.parameters.items()}
    return bodies.changed(**parameters)


def blocks_of(bodies: RigidBody) -> list[AbstractBlock]:
    """Convert bodies with equal edges to blocks, in C order: all rectangles, or blocks of the same alpha and p."""
    edge, shape = bodies.right, bodies.shape
    uniform = np.hypot(bodies.width, bodies.top_height) / math.sqrt(12.0)
    rectangular = bool(np.all((bodies.top_height == 2.0 * bodies.height) & (bodies.gyration == uniform)))
    columns: tuple[Any, ...] = (bodies.width, 2.0 * bodies.height, bodies.gravity)
    if not rectangular:
        columns = edge.alpha, edge.frequency_parameter, np.maximum(edge.restitution, 0.0), bodies.gravity
    flat = [np.broadcast_to(column, shape).ravel().tolist() for column in columns]
    rows = zip(*flat, strict=True)
    if rectangular:
        return [RectangularBlock(*row) for row in rows]
    return [EquivalentBlock(alpha, p, restitution=eta, gravity=gravity) for alpha, p, eta, gravity in rows]


def as_blocks(bodies: Sequence[AbstractBody]) -> tuple[AbstractBlock, ...] | RigidBody:
    """Convert bodies to blocks if all have equal edges, else to one array of bodies with edges of the same sides."""
    blocks = [body for body in map(_with_equal_edges, bodies) if body is not None]
    if len(blocks) == len(bodies):
        return tuple(blocks)
    converted = [*map(_rigid, bodies)]
    rigid = [body for body in converted if isinstance(body, RigidBody)]
    sides = {body.sides for body in rigid}
    if len(rigid) < len(converted) or len(sides) > 1:
        allowed = "bodies with equal edges, or rigid ones that all rock about both edges, or about the same one"
        raise InvalidArgumentError("blocks", [body.description for body in converted], allowed)
    columns: dict[str, list[Any]] = {"inclination": [body.tilt for body in rigid]}
    for name in ("left", "right"):
        columns[name] = [body.parameters[name] for body in rigid]
    for name in ("height", "gyration", "gravity", "top_height"):
        columns[name] = [getattr(body, name) for body in rigid]
    if sides != {"both"}:
        columns |= {"rebound": [body.right.restitution for body in rigid]}
    return RigidBody(**columns, sides=rigid[0].sides)


def as_block(body: AbstractBody) -> AbstractBlock:
    """Convert a body with equal edges to a block."""
    block = _with_equal_edges(body)
    if block is None:
        raise InvalidArgumentError("body", body.description, "a body with equal edges")
    return block


def _with_equal_edges(body: AbstractBody) -> AbstractBlock | None:
    """Return a body as a block, None if its edges differ."""
    if isinstance(body, RigidBody) and has_equal_edges(body):
        return blocks_of(body)[0]
    return body if isinstance(body, AbstractBlock) else None


def _rigid(body: AbstractBody) -> AbstractBody:
    """Return a rectangle as a `RigidBody`, any other body as it is."""
    if isinstance(body, RectangularBlock):
        return RigidBody.from_size(body.width, body.height, gravity=body.gravity)
    return body


def _split_block(fragility: xr.Dataset, names: tuple[Hashable, ...], shape: tuple[int, ...]) -> xr.Dataset:
    """Split the dimension `block` of a data set into several."""

    def split(variable: xr.Variable) -> xr.Variable:
        if "block" not in variable.dims:
            return variable
        axis = variable.dims.index("block")
        dims = variable.dims[:axis] + names + variable.dims[axis + 1 :]
        sizes = variable.shape[:axis] + shape + variable.shape[axis + 1 :]
        return xr.Variable(dims, variable.values.reshape(sizes), variable.attrs)

    return _map_variables(fragility, split)


def _resized(variable: xr.Variable, sizes: Mapping[Hashable, int]) -> xr.Variable:
    """Return zeros of the same kind with `sizes` of these dimensions; a variable without them as it is."""
    if sizes.keys().isdisjoint(variable.dims):
        return variable
    shape = [sizes.get(name, size) for name, size in variable.sizes.items()]
    return xr.Variable(variable.dims, np.broadcast_to(np.zeros((), variable.dtype), shape), variable.attrs)


def _map_variables(dataset: xr.Dataset, change: Callable[[xr.Variable], xr.Variable]) -> xr.Dataset:
    """Change all variables of a data set, also those of coordinates."""
    variables = {name: change(value) for name, value in dataset.variables.items()}
    return xr.Dataset(variables, attrs=dataset.attrs).set_coords([*dataset.coords])
