"""The protocol of a ground motion, `AbstractMotion`: pulses and records implement it."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, ClassVar

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, needed
from rocking._base.quantity import Quantity


class AbstractMotion(ABC):
    """A motion of the ground, as all code above the solver uses it.

    Attributes
    ----------
    name : str
        Name for output.
    remarks : tuple of str
        Doubts about the motion, which every response to it repeats among its warnings.
    time_step : float
        Time between its samples [s]; nan where a period states it.
    vertical : float64 array or None
        Vertical acceleration at the samples [m/s2], upwards; None without one.
    """

    kind: ClassVar[str]
    """Name of its kind in answers: "pulse" or "record"."""

    strength: ClassVar[Quantity]
    """The quantity that scales the motion."""

    arguments: ClassVar[tuple[Quantity, ...]]
    """The quantities in SI units that complete the motion, the strength first; `default` where none is stated."""

    rate: ClassVar[Quantity]
    """The quantity in groups that states its time scale."""

    highest_amplitude: ClassVar[float]
    """Largest strength over that of uplift that is searched unless stated [-]."""

    is_scanned: ClassVar[bool]
    """True if searches try strengths a stated distance apart, because the outcome may change anywhere between."""

    name: str
    remarks: tuple[str, ...] = ()
    time_step: float = math.nan
    vertical: Array | None = None

    @property
    @abstractmethod
    def unit_acceleration(self) -> float:
        """Largest horizontal acceleration at the strength 1 [m/s2]."""

    @property
    def drift(self) -> float:
        """Velocity of the ground at the end over its largest, without its sign [-]; 0 of pulses."""
        return 0.0

    def refined(self) -> AbstractMotion | None:
        """Return the motion with finer samples, which shows how much sampling matters; None if that has no meaning."""
        return None

    @abstractmethod
    def duration_at(self, period: Any) -> Any:
        """Duration [s]; `period`: that of a pulse [s], > 0."""

    @abstractmethod
    def rate_at(self, frequency_parameter: Array, period: Array) -> Array:
        """Rate of the solver: p times the unit of the times of samples, or omega_g/p of a pulse [-].

        `frequency_parameter`: p of the body [rad/s]; `period`: that of a pulse [s]. Raises `InvalidArgumentError` where
        the solver does not serve the rate.
        """


def stated_values(motion: AbstractMotion, quantities: Sequence[Quantity], **arguments: Any) -> dict[str, Any]:
    """Return by name the arguments that state the quantities of a kind of motion.

    None becomes the default. Raises `InvalidArgumentError` where a quantity is missing, and for any other argument.
    """
    names = [quantity.name for quantity in quantities]
    for name, value in arguments.items():
        if value is not None and name not in names:
            raise InvalidArgumentError(name, value, f"nothing for a {motion.kind}: state `{names[0]}`")
    values = {}
    for quantity in quantities:
        value = arguments[quantity.name]
        if value is None:
            value = quantity.default
        values[quantity.name] = needed(f"a {motion.kind}", **{quantity.name: value})
    return values
