"""Rocking and overturning of free-standing rigid bodies under pulses and recorded ground motions.

Bodies, one or arrays of them: `Block`, `RigidBody`, `EquivalentBlock`, each with `response`, `history`, `spectrum`,
    `thresholds` and `boundary`.
Motions: a name of `PULSE_NAMES`, or `pulse` of it; `SampledPulse`, `SinusoidalPulse`, `WaveletPulse`, `SmoothPulse` of
    your own; `Record` and `read_record`; `floor_motion` and `isolated_motion` of a structure under a record;
    `elastic_spectrum`.
Suites of records: `fragility`, and the package `rocking.suites`.
Blocks in the groups of the paper: `peak_response`, `time_history`, `thresholds`, `overturning_boundary`, `open_cube`,
    and the formulas of `rocking.paper`.
Pictures: `rocking.plot`. Names for packages that extend this one, such as `rocking_assessment`: `rocking.extension`.

>>> import rocking
>>> block = rocking.Block(width="40 cm", height="160 cm")
>>> block.response("sine", peak_acceleration="0.6 g", period="0.5 s")
<rocking.BodyResponse: overturns after one or more impacts; block of 0.4 m x 1.6 m under sine of 5.884 m/s2 and 0.5 s>

Numbers are in SI units and radians, lengths are full sizes; texts such as "40 cm" and quantities of pint are converted.
Every error is a `RockingError`, of an argument also a `ValueError`. Every function raises `InvalidArgumentError` for an
argument that is not as described, and `StoppedError` soon after another thread has set its `stop`; its description
names other reasons only. The public names are listed in `__init__.pyi` and loaded at first use, so that a command or a
worker of the service imports only what it needs.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
