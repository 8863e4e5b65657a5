"""Blocks with a vertical tendon along the centre line and a vertical damper at the edge that uplifts, in SI units."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking._base.arrays import Array
from rocking._base.errors import broadcast, float_array, in_range, number, one_of
from rocking._base.quantities import MASS, RESTRAINTS
from rocking._base.units import Scalar, Values
from rocking._boundary.restraints import HIGHEST, Name, SavingRestraint, search_restraint
from rocking._boundary.scan import RESOLUTION, checked_resolution
from rocking._dimensional.body import RespondingBody
from rocking._excitation.pulses import AbstractPulse
from rocking._excitation.records.record import Record
from rocking._model.block import AbstractBlock
from rocking._model.body import Edge
from rocking._numba.cancellation import StopFlag

UNITS = {"stiffness": "N/m", "prestress": "N", "damping": "N s/m"}
"""Units of a restraint that is stated with the mass of the block."""


@dataclass(frozen=True, eq=False)
class RestrainedBlock(RespondingBody):
    """A block with a tendon and a damper, or an array of them; `rocking.Block.with_restraint` builds it.

    Attributes
    ----------
    block : Block
        The block without them.
    stiffness, prestress, damping : float array
        The groups kappa, sigma and zeta [-]: `rocking.restraint` has the formulas.
    mass : float array or None
        Mass [kg], if the restraint was stated with it.
    """

    block: AbstractBlock
    stiffness: Array
    prestress: Array
    damping: Array
    mass: Array | None = None

    @property
    def right(self) -> Edge:
        """The right edge; without contact forces, to which the tendon adds."""
        edge = self.block.right
        return Edge(edge.alpha, edge.frequency_parameter, edge.restitution, np.full_like(edge.alpha, math.nan))

    @property
    def left(self) -> Edge:
        """The left edge, which is alike."""
        return self.right

    @property
    def gravity(self) -> Array | float:
        """g [m/s2]."""
        return np.asarray(self.block.gravity)

    @property
    def top_height(self) -> Array | float:
        """Height above the base of the point whose displacement is given [m]."""
        return np.asarray(self.block.top_height)

    @property
    def description(self) -> str:
        """The block in words."""
        held = zip(("kappa", "sigma", "zeta"), self.restraint.values(), strict=True)
        stated = ", ".join(f"{name} {float(value):.4g}" for name, value in held if not value.ndim and value != 0.0)
        return f"{self.block.description}, restrained{f' ({stated})' if stated else ''}"

    @property
    def restraint(self) -> dict[str, Array]:
        """Its groups by the names of the cells of the solver [-]."""
        return {"spring": self.stiffness, "prestress": self.prestress, "damping": self.damping}

    @property
    def parameters(self) -> dict[str, Array]:
        """What an array of blocks was made from."""
        groups = {"stiffness": self.stiffness, "prestress": self.prestress, "damping": self.damping}
        return {**self.block.parameters, **groups} if self.shape else {}

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of an array of blocks, () for one."""
        return np.broadcast_shapes(self.block.shape, *(value.shape for value in self.restraint.values()))

    @property
    def uplift_acceleration(self) -> Array:
        """Smallest ground acceleration that starts rocking, (1 + sigma) g tan(alpha) [m/s2]."""
        return np.asarray((1.0 + self.prestress) * self.block.uplift_acceleration)

    def tendon_stretch(self, rotation: Values) -> Array:
        """Elongation of the tendon 2 b sin(|theta|/2) [m] at a rotation theta [rad]."""
        theta = float_array("rotation", rotation, unit="rad")
        return np.asarray(2.0 * self.block.half_width * np.sin(0.5 * np.abs(theta)))

    def tendon_force(self, rotation: Values) -> Array:
        """Force of the tendon P0 + 2 k b sin(|theta|/2) at a rotation [rad]: [N] with a mass, else over the weight."""
        b, radius = self.block.half_width, self.block.half_diagonal
        force = self.prestress + self.stiffness * radius / b**2 * self.tendon_stretch(rotation)
        return np.asarray(force if self.mass is None else force * self.mass * self.gravity)

    def damper_stroke(self, rotation: Values) -> Array:
        """Rise of the uplifted edge 2 b sin(|theta|) [m] at a rotation [rad]."""
        theta = float_array("rotation", rotation, unit="rad")
        return np.asarray(2.0 * self.block.half_width * np.sin(np.abs(theta)))


def group_units(block: AbstractBlock, mass: Values | None) -> dict[str, Any]:
    """Value of each restraint at which its group is 1: [N/m], [N], [N s/m] with a mass [kg], else 1.

    kappa = k b^2/(m g R), sigma = P0/(m g), zeta = 2 b^2 c p/(m g R) = (3/2) (b/R)^2 c/(m p) of a rectangle.
    """
    if mass is None:
        return dict.fromkeys(UNITS, 1.0)
    weight = MASS.convert(mass) * block.gravity
    lever = np.asarray(block.half_width) ** 2 / block.half_diagonal
    return {
        "stiffness": weight / lever,
        "prestress": weight,
        "damping": weight / (2.0 * lever * block.frequency_parameter),
    }


def restrained_block(
    block: AbstractBlock, stiffness: Values, prestress: Values, damping: Values, mass: Values | None
) -> RestrainedBlock:
    """`rocking.Block.with_restraint`."""
    given = {"stiffness": stiffness, "prestress": prestress, "damping": damping}
    units = group_units(block, mass)
    groups = []
    for quantity in RESTRAINTS:
        unit = "-" if mass is None else UNITS[quantity.name]
        value = in_range(quantity.name, given[quantity.name], 0.0, math.inf, closed="left", unit=unit)
        groups.append(quantity.convert(value / units[quantity.name]))
    broadcast({**block.parameters, **given}, [*block.parameters.values(), *groups])
    kappa, sigma, zeta = groups
    return RestrainedBlock(block, kappa, sigma, zeta, None if mass is None else MASS.convert(mass))


def saving_restraint_of_block(
    block: AbstractBlock,
    motion: str | AbstractPulse | Record,
    name: Name,
    *,
    mass: Scalar | None,
    held: dict[str, Scalar],
    highest: Scalar | None,
    resolution: Scalar = RESOLUTION,
    stop: StopFlag | None = None,
    **strength: Any,
) -> SavingRestraint:
    """`rocking.Block.saving_restraint`; `held`: the other restraints, `strength`: arguments of a response."""
    one_of("name", name, HIGHEST)
    unit = float(group_units(block, mass)[name])

    def overturned(values: Array) -> Any:
        restraints: dict[str, Any] = {**held, name: values * unit}
        body = restrained_block(block, **restraints, mass=mass)
        return body.response(motion, **strength, stop=stop).overturned

    top = HIGHEST[name]
    if highest is not None:
        top = number("highest", highest, 0.0, math.inf, closed="neither", unit="-" if mass is None else UNITS[name])
        top /= unit
    found = search_restraint(overturned, name, top, checked_resolution(resolution))
    return found if mass is None else found.in_units(unit, UNITS[name])
