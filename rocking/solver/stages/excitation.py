"""The excitation inside the stages: the one place that distinguishes the families of f(phi) for `LANES` cells.

`set_angles` sets what the other functions use at a phase: cosines and sines, or the Gaussian of a wavelet.
"""

from __future__ import annotations

from typing import Any

from rocking._numba.compilation import Record, SimdVector, kernel
from rocking._numba.simd import splat
from rocking.solver.excitation import WAVELET
from rocking.solver.stages.sinusoids import (
    expand_sinusoids_at_start,
    set_sinusoid_angles,
    set_sinusoid_end_angles,
    sinusoid_increments,
    sinusoid_restoring_acceleration,
    sinusoid_restoring_derivatives,
    start_sinusoid_arcs,
    sum_and_slope,
    sum_at_angles,
)
from rocking.solver.stages.wavelets import (
    expand_wavelet_at_start,
    set_wavelet_phase,
    start_wavelet_arcs,
    wavelet_and_slope,
    wavelet_at_phase,
    wavelet_increments,
    wavelet_restoring_acceleration,
    wavelet_restoring_derivatives,
)


@kernel
def set_angles(pulse: Record, group: Record, phase: SimdVector) -> None:
    """Set the angles at phases of each flight."""
    if pulse.family == WAVELET:
        set_wavelet_phase(pulse, group, phase)
    else:
        set_sinusoid_angles(pulse, group, phase)


@kernel
def set_end_angles(pulse: Record, group: Record, piece: int) -> None:
    """Set the angles at the left end of a piece of the pulse."""
    if pulse.family == WAVELET:
        set_wavelet_phase(pulse, group, splat(pulse.end_phase[piece]))
    else:
        set_sinusoid_end_angles(pulse, group, piece)


@kernel
def excitation_at_angles(pulse: Record, group: Record) -> Any:
    """f [-] at the angles."""
    if pulse.family == WAVELET:
        return wavelet_at_phase(pulse, group)
    return sum_at_angles(pulse, group)


@kernel
def shapes_and_slopes(pulse: Record, phase: SimdVector) -> Any:
    """f [-] and df/dphi at phases."""
    if pulse.family == WAVELET:
        return wavelet_and_slope(pulse, phase)
    return sum_and_slope(pulse, phase)


@kernel
def start_family_arcs(pulse: Record, group: Record, sign: float, a: SimdVector) -> None:
    """Set the coefficients of the flights from z = 0, see `rocking.solver.stages.arcs.start_arcs`."""
    if pulse.family == WAVELET:
        start_wavelet_arcs(pulse, group, sign, a)
    else:
        start_sinusoid_arcs(pulse, group, sign, a)


@kernel
def particular_increments(pulse: Record, group: Record) -> Any:
    """Change of the particular solution of z, and that of w plus w0, from the start of the flight to the angles."""
    if pulse.family == WAVELET:
        return wavelet_increments(pulse, group)
    return sinusoid_increments(pulse, group)


@kernel
def restoring_acceleration(pulse: Record, group: Record) -> Any:
    """Restoring acceleration q = 1 + F [-] at the angles."""
    if pulse.family == WAVELET:
        return wavelet_restoring_acceleration(pulse, group)
    return sinusoid_restoring_acceleration(pulse, group)


@kernel
def restoring_derivatives(pulse: Record, group: Record) -> Any:
    """q, dq/dtau and its second derivative at the angles."""
    if pulse.family == WAVELET:
        return wavelet_restoring_derivatives(pulse, group)
    return sinusoid_restoring_derivatives(pulse, group)


@kernel
def expand_at_start(pulse: Record, group: Record) -> None:
    """Set row n + 2 of `series` to the coefficient F_n of F about the start of the flight, n >= 1."""
    if pulse.family == WAVELET:
        expand_wavelet_at_start(pulse, group)
    else:
        expand_sinusoids_at_start(pulse, group)
