"""Catalogue of ground-acceleration pulses, each defined by a shape f(phi) of unit peak on a window of the phase phi.

The ground acceleration is `a_g f(phi)` with `phi = omega_g t + start`; a positive one starts a
rotation in the negative direction. Those of the catalogue are of two families: sums of sinusoids, for which the slender
block has exact arcs (3.4), and wavelets, a polynomial times a Gaussian, for which arcs are known but for low
frequencies. To add a pulse, define it here and append it to `_KINDS`; `register` adds one at run time, of these
families or of your own (`SmoothPulse`).

A text names a pulse, mirrors it and states its parameters, with their units: "-mavroeidis_papageorgiou(phase=90 deg)".
"""

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Annotated

from rocking._base.errors import InvalidArgumentError, one_of
from rocking._base.quantity import Kind, Quantity, split_kind
from rocking._base.units import Scalar
from rocking._excitation.motion import AbstractMotion
from rocking._excitation.records.record import Record
from rocking._excitation.shapes import AbstractPulse
from rocking._excitation.sinusoids import SinusoidalPulse
from rocking._excitation.smooth import SmoothPulse
from rocking._excitation.wavelets import WaveletPulse

GroundMotion = AbstractPulse | Record
Motion = str | GroundMotion  # the name of a pulse, or a motion

__all__ = [
    "PULSE_NAMES",
    "AbstractPulse",
    "GroundMotion",
    "Motion",
    "SinusoidalPulse",
    "SmoothPulse",
    "WaveletPulse",
    "as_motion",
    "as_pulse",
    "pulse",
    "pulse_names",
    "pulse_number",
    "register",
]


CYCLES = Quantity(
    "cycles", "-", "number of cycles within the envelope", symbol="gamma", lower=1.0, upper=20.0, closed="right"
)

SINE_CYCLES = Quantity("cycles", "-", "number of full cycles", lower=1.0, upper=40.0, closed="both")

PHASE = Quantity(
    "phase", "rad", "phase within the envelope", symbol="nu", lower=-2 * math.pi, upper=2 * math.pi, closed="both"
)


def _sinusoid(name: str, start: float, end: float, stationary: tuple[float, ...]) -> SinusoidalPulse:
    """cos(phi) on a window of phi."""
    return SinusoidalPulse(name, start, end, stationary, ((1.0, 1.0, 0.0),))


def sine(cycles: Annotated[float, SINE_CYCLES] = 1.0) -> SinusoidalPulse:
    """Full cycles of a sine, sin(phi), 0 to 2 pi for one cycle, (3.2).

    Parameters
    ----------
    cycles : float
        Number of cycles, a whole one [-], [1, 40].
    """
    number = SINE_CYCLES.number(cycles)
    if not number.is_integer():
        raise InvalidArgumentError("cycles", cycles, "a whole number from 1 to 40")
    stationary = tuple((k + 0.5) * math.pi for k in range(2 * int(number)))
    return SinusoidalPulse("sine", 0.0, 2 * math.pi * number, stationary, ((1.0, 1.0, -math.pi / 2),))


def cosine() -> SinusoidalPulse:
    """One full cosine, cos(phi), 0 to 2 pi (figures 5 to 8)."""
    return _sinusoid("cosine", 0.0, 2 * math.pi, (math.pi,))


def half_sine() -> SinusoidalPulse:
    """Half a sine, sin(phi), 0 to pi (Housner 1963; Shi et al. 1996)."""
    return SinusoidalPulse("half_sine", 0.0, math.pi, (math.pi / 2,), ((1.0, 1.0, -math.pi / 2),))


def rectangular() -> SinusoidalPulse:
    """Constant 1, 0 to pi: duration T_p/2, as the half sine (Housner 1963)."""
    return SinusoidalPulse("rectangular", 0.0, math.pi, (), ((1.0, 0.0, 0.0),))


def c1() -> SinusoidalPulse:
    """Type C_1 of Makris & Chang (2000): displacement and velocity end at zero after 1.5 cycles."""
    return _type_c(1)


def c2() -> SinusoidalPulse:
    """Type C_2 of Makris & Chang (2000): displacement and velocity end at zero after 2.5 cycles."""
    return _type_c(2)


TYPE_C_START = {1: 0.2189795224756257, 2: 0.12872979703677595}
"""Phase x at which the displacement ends at zero, by the number of cycles n [rad]: the root in (0, 0.5) of
cos(c - x) + (c - 2x) sin x - cos x, c = (2n + 1) pi."""


def _type_c(cycles: int) -> SinusoidalPulse:
    span, start = (2 * cycles + 1) * math.pi, TYPE_C_START[cycles]
    stationary = tuple(k * math.pi for k in range(1, 2 * cycles + 1))
    return _sinusoid(f"c{cycles}", start, span - start, stationary)


def ricker() -> WaveletPulse:
    """Symmetric Ricker wavelet (1 - phi^2/2) exp(-phi^2/4), -4 pi to 4 pi."""
    root = math.sqrt(6.0)
    return WaveletPulse("ricker", -4 * math.pi, 4 * math.pi, (-root, 0.0, root), (1.0, 0.0, -0.5), 4.0)


def ricker_antisymmetric() -> WaveletPulse:
    """Antisymmetric Ricker wavelet (z^2 - 3) z exp(-z^2/2)/beta, z = phi/sqrt(3), -4 pi to 4 pi."""
    square = 3.0 - math.sqrt(6.0)  # z^2 at the largest peak
    beta = math.sqrt(6.0) * math.sqrt(square) * math.exp(-square / 2)
    inner, outer = math.sqrt(3 * square), math.sqrt(3 * (3.0 + math.sqrt(6.0)))
    polynomial = (0.0, -math.sqrt(3.0) / beta, 0.0, 1.0 / (3.0 * math.sqrt(3.0) * beta))
    return WaveletPulse(
        "ricker_antisymmetric", -4 * math.pi, 4 * math.pi, (-outer, -inner, inner, outer), polynomial, 6.0
    )


def mavroeidis_papageorgiou(
    cycles: Annotated[float, CYCLES] = 2.0, phase: Annotated[float, PHASE] = 0.0
) -> SinusoidalPulse:
    """Acceleration of the velocity pulse of Mavroeidis & Papageorgiou (2003), scaled to unit peak.

    Parameters
    ----------
    cycles : float
        gamma [-], (1, 20]: number of cycles within the envelope.
    phase : float
        nu [rad], [-2 pi, 2 pi].

    Notes
    -----
    -[sin(phi/gamma) cos(phi + nu) + gamma sin(phi + nu) (1 + cos(phi/gamma))] is the sum of three sinusoids
    -[gamma sin B + (gamma + 1)/2 sin(B + A) + (gamma - 1)/2 sin(B - A)], A = phi/gamma, B = phi + nu.
    """
    cycles, phase = CYCLES.number(cycles), PHASE.number(phase)
    shift = phase + math.pi / 2  # -sin x = cos(x + pi/2)
    raw = ((cycles, 1.0, shift), ((cycles + 1) / 2, 1 + 1 / cycles, shift), ((cycles - 1) / 2, 1 - 1 / cycles, shift))
    end = math.pi * cycles
    return SinusoidalPulse.of_unit_peak("mavroeidis_papageorgiou", -end, end, raw)


_KINDS: dict[str, Kind[AbstractPulse]] = {
    make.__name__: Kind(make)
    for make in (
        sine,
        cosine,
        half_sine,
        rectangular,
        c1,
        c2,
        ricker,
        ricker_antisymmetric,
        mavroeidis_papageorgiou,
    )
}

PULSE_NAMES: tuple[str, ...] = tuple(_KINDS)
"""Names of the pulses of this package; a leading minus mirrors one. Files store their positions: append only."""


_REGISTERED: dict[str, AbstractPulse] = {}


def register(pulse: AbstractPulse) -> None:
    """Make a pulse of your own available by its name, to every function and to the service of this process.

    Parameters
    ----------
    pulse : AbstractPulse
        Its name must be an identifier that is not taken, without a leading minus.
    """
    if not isinstance(pulse, AbstractPulse):
        raise InvalidArgumentError("pulse", pulse, "a pulse such as SinusoidalPulse")
    if not pulse.name.isidentifier() or pulse.name in pulse_names():
        raise InvalidArgumentError("name", pulse.name, "an identifier that no other pulse has")
    _REGISTERED[pulse.name] = pulse


def pulse_names() -> tuple[str, ...]:
    """Return the names of all pulses: those of the package, then the registered ones."""
    return (*PULSE_NAMES, *_REGISTERED)


def pulse_number(name: str) -> int:
    """Return the number of a pulse in data files, its index in `PULSE_NAMES`, or -1 for a registered one."""
    return PULSE_NAMES.index(name) if name in PULSE_NAMES else -1


def as_motion(motion: Motion) -> GroundMotion:
    """Return the motion itself, or the pulse of that name; refuse anything else."""
    return motion if isinstance(motion, AbstractMotion) else pulse(motion)


def as_pulse(motion: str | AbstractPulse) -> AbstractPulse:
    """Return the pulse itself, or the one of that name; refuse anything else."""
    return motion if isinstance(motion, AbstractPulse) else pulse(motion)


def pulse_parameters(name: str) -> Mapping[str, Quantity]:
    """Return the parameters of a named pulse without its sign, with their defaults; none of a registered one."""
    return _KINDS[name].fields if name in _KINDS else {}


def pulse(name: str, **parameters: Scalar) -> AbstractPulse:
    """Return the pulse with a name, such as `"sine"`; `"-sine"` is the mirrored sine.

    Parameters
    ----------
    name : str
        One of `PULSE_NAMES` or of a registered pulse, with an optional leading minus, and its parameters in brackets,
        with their units: "mavroeidis_papageorgiou(cycles=3, phase=90 deg)".
    **parameters : float
        The same as arguments: `cycles` for sine, `cycles` and `phase` [rad] for mavroeidis_papageorgiou.

    Returns
    -------
    AbstractPulse
        Its name is the text that makes it again.

    Raises
    ------
    InvalidArgumentError
        For an unknown name or parameter, or a parameter out of range.
    """
    text: object = name
    parts = split_kind(text, "pulse") if isinstance(text, str) else None
    if parts is None:
        allowed = "a pulse such as SinusoidalPulse, or one of " + ", ".join(pulse_names())
        raise InvalidArgumentError("pulse", name, allowed)
    sign, base, stated_values = parts
    values: dict[str, Scalar] = {**stated_values, **parameters}
    if len(values) < len(stated_values) + len(parameters):
        raise InvalidArgumentError("pulse", name, "each parameter once")
    registered = _REGISTERED.get(base)
    if registered is not None and not values:
        return registered.mirrored() if sign else registered
    if base not in _KINDS:
        one_of("pulse", base, pulse_names())
        raise InvalidArgumentError(next(iter(values)), next(iter(values.values())), f"for {base}: no parameters")
    numbers = _KINDS[base].read(values, numbers=True) if values else {}
    return _build_pulse(sign, base, **numbers)


def split_pulses(text: str) -> list[str]:
    """Split the texts of several pulses, separated by commas; those within brackets separate parameters."""
    texts, depth, start = [], 0, 0
    for position, sign in enumerate(text):
        depth += (sign == "(") - (sign == ")")
        if sign == "," and depth <= 0:
            texts.append(text[start:position].strip())
            start = position + 1
    return [*texts, text[start:].strip()]


def _digits(value: float) -> str:
    """Return the shortest text of a number that reads the same."""
    short = f"{value:g}"
    return short if float(short) == value else repr(value)


@lru_cache(maxsize=256)
def _build_pulse(sign: str, base: str, **parameters: float) -> AbstractPulse:
    shape = _KINDS[base].make(**parameters)
    changed = []
    for key, quantity in pulse_parameters(base).items():
        if parameters.get(key, quantity.default) != quantity.default:
            changed.append(f"{key}={_digits(parameters[key])}{quantity.unit.removeprefix('-')}")
    if changed:
        shape = replace(shape, name=f"{base}({','.join(changed)})")
    return shape.mirrored() if sign else shape
