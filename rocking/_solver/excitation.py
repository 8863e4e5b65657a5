"""The excitation inside the solver: the one place that distinguishes families of f(phi), with `stages.excitation`.

Each family is a module of `rocking._solver.families`: fields of the record, value and slope, and the expansion of F in
powers of tau for a Taylor step. A further family adds its module, and a case to each function here; as long as it has
no exact arcs, nothing else. The record has one layout for all families, so that each kernel is compiled once.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking._excitation.series import ExcitationSeries
from rocking._excitation.sinusoids import SinusoidSeries
from rocking._excitation.smooth import PolynomialSeries
from rocking._excitation.wavelets import WaveletSeries
from rocking._numba.compilation import Fields, Record, SimdVector, kernel
from rocking._solver.families.polynomials import (
    POLYNOMIAL_FIELDS,
    POLYNOMIALS,
    expand_polynomials,
    fill_polynomials,
    polynomials_and_slopes,
    polynomials_at,
)
from rocking._solver.families.sinusoids import (
    SINUSOID_END_FIELDS,
    SINUSOID_FIELDS,
    expand_sinusoids,
    fill_sinusoids,
    sinusoids_and_slopes,
    sinusoids_at,
)
from rocking._solver.families.wavelets import (
    WAVELET,
    WAVELET_ARC_FIELDS,
    WAVELET_FIELDS,
    expand_wavelet,
    fill_wavelet,
    wavelet_at,
    wavelets_and_slopes,
)

EXCITATION_FIELDS: Fields = [
    ("family", np.int64),  # see `Family`
    *SINUSOID_FIELDS,
    *WAVELET_FIELDS,
    *POLYNOMIAL_FIELDS,
]

PULSE_FIELDS: Fields = [
    *EXCITATION_FIELDS,
    *SINUSOID_END_FIELDS,
    *WAVELET_ARC_FIELDS,
    ("series_length", np.int64),  # of the series at the start of a flight in `rocking._solver.stages`
]
"""The same with what exact arcs need."""


def fill_excitation(record: Record, series: ExcitationSeries, ends: NDArray[np.float64]) -> None:
    """Write an excitation, the ends of whose monotone pieces are `ends` [rad], into a record with `PULSE_FIELDS`.

    The record is zero on entry.
    """
    record["family"] = series.family
    match series:
        case SinusoidSeries():
            fill_sinusoids(record, series, ends)
        case WaveletSeries():
            fill_wavelet(record, series)
        case PolynomialSeries():
            fill_polynomials(record, series)


@kernel
def shape_at(phi: float, flight: Record) -> float:
    """f of the excitation."""
    if flight.family == WAVELET:
        return wavelet_at(phi, flight)
    if flight.family == POLYNOMIALS:
        return polynomials_at(phi, flight)
    return sinusoids_at(phi, flight)


@kernel
def shapes_and_slopes(pulse: Record, phase: SimdVector) -> Any:
    """f [-] and df/dphi at phases."""
    if pulse.family == WAVELET:
        return wavelets_and_slopes(pulse, phase)
    if pulse.family == POLYNOMIALS:
        return polynomials_and_slopes(pulse, phase)
    return sinusoids_and_slopes(pulse, phase)


@kernel
def expand_excitation(steps: Record) -> None:
    """Fill `f` with the coefficients of F = sgn(theta) a f in powers of tau about `phase`."""
    if steps.family == WAVELET:
        expand_wavelet(steps)
    elif steps.family == POLYNOMIALS:
        expand_polynomials(steps)
    else:
        expand_sinusoids(steps)
