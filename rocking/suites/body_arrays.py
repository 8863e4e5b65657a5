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
    """The fragility of each body of an array, over the dimensions of its labelled arguments in place of `block`.

    `analyse` gives the fragility, over `block`, of a sequence of blocks; or of bodies (bodies,) if one of all has two
    different edges. Axes of unlabelled arrays are dim_0, dim_1, ...; the result is lazy, in the chunks of the
    arguments, where one of them is backed by dask. A dimension of the body must not be one of the result.
    """
    labels, equal = body.labels, has_equal_edges(body)
    plain = {name: value for name, value in body.parameters.items() if name not in labels}
    # a variable of the name of a dimension would become its coordinate
    given = xr.Dataset({f"of body: {name}": value for name, value in broadcast_by_name(labels).items()})
    taken = [name for name in given.dims if name in OWN_DIMENSIONS]
    if taken:
        raise InvalidArgumentError("blocks", taken[0], "dimensions other than " + ", ".join(OWN_DIMENSIONS))

    def part(chunk: xr.Dataset) -> xr.Dataset:
        with without_place():
            bodies = body.changed(**plain, **{name: chunk[f"of body: {name}"] for name in labels})
        names = tuple(chunk.dims) if labels else tuple(f"dim_{axis}" for axis in range(len(bodies.shape)))
        found = _over(analyse(blocks_of(bodies) if equal else _in_a_row(bodies)), names, bodies.shape).assign_coords(
            chunk.coords
        )
        return with_index(found, names[-1], body.index) if names else found

    if not given.chunks:
        return part(given)
    first = part(given.isel(dict.fromkeys(given.dims, slice(1))).compute())
    template = _each(first, lambda one: _unknown(one, given.sizes)).assign_coords(given.coords)
    return xr.map_blocks(part, given, template=template.chunk(given.chunksizes))


def has_equal_edges(bodies: RigidBody) -> bool:
    """Whether all bodies have two equal edges."""
    edge = bodies.right
    return bodies.sides == "both" and bool(
        np.all((bodies.left.alpha == edge.alpha) & (bodies.left.frequency_parameter == edge.frequency_parameter))
    )


def _in_a_row(bodies: RigidBody) -> RigidBody:
    """The bodies as an array (bodies,), in C order."""
    return bodies.changed(
        **{name: np.broadcast_to(value, bodies.shape).ravel() for name, value in bodies.parameters.items()}
    )


def blocks_of(bodies: RigidBody) -> list[AbstractBlock]:
    """Bodies with equal edges as blocks, in C order: rectangles where all are, else blocks of the same alpha and p."""
    edge, shape = bodies.right, bodies.shape
    uniform = np.hypot(bodies.width, bodies.top_height) / math.sqrt(12.0)
    rectangular = bool(np.all((bodies.top_height == 2.0 * bodies.height) & (bodies.gyration == uniform)))
    columns: tuple[Any, ...] = (bodies.width, 2.0 * bodies.height, bodies.gravity)
    if not rectangular:
        columns = edge.alpha, edge.frequency_parameter, np.maximum(edge.restitution, 0.0), bodies.gravity
    rows = zip(*(np.broadcast_to(column, shape).ravel().tolist() for column in columns), strict=True)
    if rectangular:
        return [RectangularBlock(*row) for row in rows]
    return [EquivalentBlock(alpha, p, restitution=eta, gravity=gravity) for alpha, p, eta, gravity in rows]


def as_blocks(bodies: Sequence[AbstractBody]) -> tuple[AbstractBlock, ...] | RigidBody:
    """Bodies as blocks where all have equal edges, else rigid ones that rock about the same edges as an array."""
    equal = [blocks_of(one)[0] if isinstance(one, RigidBody) and has_equal_edges(one) else one for one in bodies]
    blocks = tuple(one for one in equal if isinstance(one, AbstractBlock))
    if len(blocks) == len(equal):
        return blocks
    rigid = [
        RigidBody.from_size(one.width, one.height, gravity=one.gravity) if isinstance(one, RectangularBlock) else one
        for one in bodies
    ]
    rows = [one for one in rigid if isinstance(one, RigidBody) and one.sides == getattr(rigid[0], "sides", "")]
    if len(rows) < len(rigid):
        allowed = "bodies with equal edges, or rigid ones that all rock about both edges, or about the same one"
        raise InvalidArgumentError("blocks", [one.description for one in rigid], allowed)
    columns = {name: [one.parameters[name] for one in rows] for name in ("left", "right")}
    columns |= {name: [getattr(one, name) for one in rows] for name in ("height", "gyration", "gravity", "top_height")}
    columns |= {"inclination": [one.tilt for one in rows]}
    if rows[0].sides != "both":
        columns |= {"rebound": [one.right.restitution for one in rows]}
    return RigidBody(**columns, sides=rows[0].sides)


def as_block(body: AbstractBody) -> AbstractBlock:
    """One body with equal edges as a block."""
    made = body if isinstance(body, AbstractBlock) else None
    if isinstance(body, RigidBody) and has_equal_edges(body):
        (made,) = blocks_of(body)
    if made is None:
        raise InvalidArgumentError("body", body.description, "a body with equal edges")
    return made


def _over(found: xr.Dataset, names: tuple[Hashable, ...], shape: tuple[int, ...]) -> xr.Dataset:
    """A data set with its dimension `block` split into several."""

    def split(variable: xr.Variable) -> xr.Variable:
        if "block" not in variable.dims:
            return variable
        place = variable.dims.index("block")
        dims = variable.dims[:place] + names + variable.dims[place + 1 :]
        sizes = variable.shape[:place] + shape + variable.shape[place + 1 :]
        return xr.Variable(dims, variable.values.reshape(sizes), variable.attrs)

    return _each(found, split)


def _unknown(variable: xr.Variable, sizes: Mapping[Hashable, int]) -> xr.Variable:
    """A variable of the same kind with `sizes` of some dimensions; without these, the variable."""
    if sizes.keys().isdisjoint(variable.dims):
        return variable
    shape = [sizes.get(name, size) for name, size in variable.sizes.items()]
    return xr.Variable(variable.dims, np.broadcast_to(np.zeros((), variable.dtype), shape), variable.attrs)


def _each(found: xr.Dataset, change: Callable[[xr.Variable], xr.Variable]) -> xr.Dataset:
    """A data set whose variables, also those of coordinates, are changed."""
    variables = {name: change(value) for name, value in found.variables.items()}
    return xr.Dataset(variables, attrs=found.attrs).set_coords([*found.coords])
