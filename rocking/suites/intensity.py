"""Measures of the intensity of a record for a block.

| measure | definition | unit | a level is reached by |
|---|---|---|---|
| pga | PGA = max abs(a_g) | m/s2 | scaling the amplitude |
| pgv | PGV = max abs(v_g) | m/s | scaling the amplitude |
| pga_ratio | PGA/(g tan alpha); uplift from 1 on | 1 | scaling the amplitude |
| pgv_ratio | p PGV/(g tan alpha) | 1 | scaling the amplitude |
| frequency_ratio | omega_p/p, omega_p = 2 pi/T_m, T_m the mean period | 1 | changing the size of the block |

The first two are compared with a hazard curve. The ratios are the groups of Dimitrakopoulos & Paraskeva (2015), in
which blocks of different size and shape have similar fragilities. No scaling of the amplitude changes omega_p/p: at its
levels the record stays as it is, and the block has the same shape and restitution, but the size that gives the level.
Larger blocks survive more, so that the probability falls as omega_p/p rises.

References
----------
Dimitrakopoulos E. G., Paraskeva T. S. (2015), Dimensionless fragility curves for rocking response to near-fault
excitations, Earthquake Engineering & Structural Dynamics 44(12), 2015-2033.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

from rocking._base.errors import one_of
from rocking._excitation.records.record import Record
from rocking._model.block import AbstractBlock


@dataclass(frozen=True)
class Measure:
    """A measure of intensity."""

    name: str  # as in the signature of `rocking.fragility`
    unit: str  # as CF writes it; "1" for a number
    meaning: str  # in a few words
    of: Callable[[Record, AbstractBlock], float]  # its value > 0 from a record and a block
    # whether a level is reached by scaling the amplitude of the record; else by changing the size of the block
    scales_amplitude: bool = True


def _pga_ratio(record: Record, block: AbstractBlock) -> float:
    return float(record.peak_acceleration / block.uplift_acceleration)


def _pgv_ratio(record: Record, block: AbstractBlock) -> float:
    return float(block.frequency_parameter * record.peak_velocity / block.uplift_acceleration)


def _frequency_ratio(record: Record, block: AbstractBlock) -> float:
    return float(2.0 * math.pi / (record.mean_period * block.frequency_parameter))


MEASURES = {
    measure.name: measure
    for measure in (
        Measure("pga", "m s-2", "peak acceleration PGA", lambda record, _: record.peak_acceleration),
        Measure("pgv", "m s-1", "peak ground velocity", lambda record, _: record.peak_velocity),
        Measure("pga_ratio", "1", "peak ground acceleration over g tan(alpha)", _pga_ratio),
        Measure("pgv_ratio", "1", "peak ground velocity times p over g tan(alpha)", _pgv_ratio),
        Measure(
            "frequency_ratio", "1", "mean frequency of the record over p", _frequency_ratio, scales_amplitude=False
        ),
    )
}


def measure_of(name: str) -> Measure:
    """Return the measure of that name."""
    return MEASURES[one_of("measure", name, MEASURES)]
