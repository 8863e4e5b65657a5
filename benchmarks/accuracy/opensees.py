"""A block under a sine pulse by OpenSees and by the package: `python -m benchmarks.accuracy.opensees`.

OpenSees models the body with its element RockingBC (Avgenakis & Psycharis 2020): an elastic member on a rigid base
without tension. Damping in proportion to the current stiffness stands for the loss at an impact. The stiffness is
stated by the strain rho g h/E of the body under its weight; that of stone is about 2e-6. The numbers are those of
docs/other-software.md. openseespy is not a dependency of the project; it needs BLAS and LAPACK of the system.
"""

from __future__ import annotations

import math
import time

import openseespy.opensees as ops

from benchmarks.accuracy.siconos import HEIGHT, PERIOD, WIDTH, rows
from rocking._base.constants import STANDARD_GRAVITY

DENSITY = 2500.0
DURATION = 3.0
"""Time after which a body that has not overturned is taken to survive: several swings after the pulse."""

STRAINS = (1e-4, 1e-5, 2e-6)
"""Of a soft base, a stiffer one, and stone."""

DAMPING = 0.05
"""Share of the critical damping of the first mode of the body on its base, as in the example of the element."""

LONGEST_STEP, SHORTEST_STEP = 5e-4, 1e-8
"""Time steps [s]: halved where the element or Newton's method fails, lengthened again after ten successful steps."""


def model(strain: float) -> None:
    """Make a body whose material has the strain `strain` under its weight, at rest under gravity."""
    stiffness = DENSITY * STANDARD_GRAVITY * HEIGHT / strain
    mass = DENSITY * WIDTH * HEIGHT
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.node(1, 0.0, 0.0)
    ops.node(2, 0.0, HEIGHT / 2.0)
    # 15 points on the base, no yielding, no sliding; the step is refused where the axial force changes by a tenth
    limits = ("-NlimN", 0.1, "-NlimT", 1.0, "-Dtlim", SHORTEST_STEP, "-errorifNexceeds", 1)
    ops.element("RockingBC", 1, 2, 1, 15, stiffness, 0.0, -stiffness, WIDTH, 1.0, 0.0, *limits)
    ops.fix(1, 1, 1, 1)
    ops.mass(2, mass, mass, mass * (WIDTH**2 + HEIGHT**2) / 12.0)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(2, 0.0, -mass * STANDARD_GRAVITY, 0.0)
    analysis("EnergyIncr", ("LoadControl", 0.1), "Static")
    if ops.analyze(10) != 0:
        raise ArithmeticError(f"no equilibrium under gravity, strain {strain}")
    ops.loadConst("-time", 0.0)
    frequency = math.sqrt(ops.eigen("-fullGenLapack", 1)[0])
    ops.rayleigh(0.0, 2.0 * DAMPING / frequency, 0.0, 0.0)
    ops.wipeAnalysis()


def analysis(test: str, integrator: tuple[str | float, ...], kind: str) -> None:
    """Choose the methods by which the next steps are found."""
    ops.constraints("Transformation")
    ops.numberer("RCM")
    ops.system("UmfPack")
    ops.test(test, 1e-10, 50)
    ops.algorithm("Newton")
    ops.integrator(*integrator)
    ops.analysis(kind)


def peak_rotation(level: float, strain: float) -> tuple[float, float]:
    """Return the largest rotation [rad], nan if the body overturns under a pulse of `level` g, and the time [s]."""
    begun = time.perf_counter()
    model(strain)
    samples = [level * STANDARD_GRAVITY * math.sin(2.0 * math.pi * i / 2000.0) for i in range(2001)]
    ops.timeSeries("Path", 2, "-dt", PERIOD / 2000.0, "-values", *samples)
    ops.pattern("UniformExcitation", 2, 1, "-accel", 2)
    analysis("RelativeNormUnbalance", ("Newmark", 0.5, 0.25), "Transient")
    step, successes, peak = LONGEST_STEP, 0, 0.0
    while ops.getTime() < DURATION:
        if ops.analyze(1, step) != 0:
            if step <= SHORTEST_STEP:
                raise ArithmeticError(f"no step from {ops.getTime()} s, strain {strain}")
            step, successes = max(SHORTEST_STEP, step / 2.0), 0
            continue
        successes += 1
        if successes >= 10:
            step = min(LONGEST_STEP, 1.5 * step)
        peak = max(peak, abs(ops.nodeDisp(2, 3)))
        if peak > math.pi / 2.0:
            return math.nan, time.perf_counter() - begun
    return peak, time.perf_counter() - begun


if __name__ == "__main__":
    found = list(rows(peak_rotation, STRAINS, digits=3))  # printed at the end: OpenSees writes to the same stream
    print("\n".join(found))
