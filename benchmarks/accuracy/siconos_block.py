"""A rigid block under a sine pulse by Siconos: `python -P siconos_block.py WIDTH HEIGHT PERIOD LEVEL STEP`.

Prints the largest rotation [rad], nan if the block overturns, and the processor time [s]. siconos.py runs it by the
Python that has Siconos; so it imports nothing of the project. A C compiler is needed. Without -P Python would take
siconos.py for Siconos.

docs/other-software.md says how the block is modelled.
"""

from __future__ import annotations

import math
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import siconos.kernel as sk
import siconos.numerics as sn

GRAVITY = 9.80665  # [m/s2]
MASS = 1.0  # [kg], of which the motion does not depend
FRICTION = 5.0
"""Larger than the ratio of horizontal to vertical impulse at an impact, which is near height over width."""

TOLERANCE = 1e-12
"""Of the contact problem of a step, and of Newton's method for its geometry."""

DURATION = 5.0
"""Time [s] after which a body that has not overturned is taken to survive. Near its threshold a body overturns slowly:
with 3 s the threshold seemed 0.004 g higher."""

CORNERS = Path(__file__).with_name("siconos_corner.c")


def compiled(width: float, height: float, folder: str) -> str:
    """Compile the contacts in `folder` and return the name of the plug-in."""
    library = f"{folder}/corners"
    sizes = (f"-DHALF_WIDTH={width / 2.0!r}", f"-DHALF_HEIGHT={height / 2.0!r}")
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", *sizes, "-o", f"{library}.so", CORNERS, "-lm"], check=True)
    return library


def peak_rotation(width: float, height: float, period: float, level: float, step: float, library: str) -> float:
    """Return the largest rotation [rad] under a pulse of `level` g and `period` [s], nan if the block overturns."""
    inertia = MASS * (width**2 + height**2) / 12.0
    block = sk.LagrangianLinearTIDS([0.0, height / 2.0, 0.0], [0.0, 0.0, 0.0], np.diag([MASS, MASS, inertia]))
    force = np.array([0.0, -MASS * GRAVITY, 0.0])
    block.setFExtPtr(force)
    system = sk.NonSmoothDynamicalSystem(0.0, DURATION)
    system.insertDynamicalSystem(block)
    law = sk.NewtonImpactFrictionNSL(0.0, 0.0, FRICTION, 2)
    for corner in ("left", "right"):
        relation = sk.LagrangianScleronomousR(f"{library}:gap_{corner}", f"{library}:jacobian_{corner}")
        system.link(sk.Interaction(law, relation), block)
    scheme, contacts = sk.MoreauJeanOSI(0.5), sk.FrictionContact(2)
    simulation = sk.TimeStepping(system, sk.TimeDiscretisation(0.0, step), scheme, contacts)
    contacts.numericsSolverOptions().dparam[sn.SICONOS_DPARAM_TOL] = TOLERANCE
    simulation.setNewtonTolerance(TOLERANCE)
    peak = 0.0
    while simulation.hasNextEvent():
        middle = simulation.nextTime() - step / 2.0
        pulse = level * GRAVITY * math.sin(2.0 * math.pi * middle / period) if middle < period else 0.0
        force[0] = -MASS * pulse  # of inertia, in coordinates that move with the ground
        block.setFExtPtr(force)
        simulation.computeOneStep()
        peak = max(peak, abs(block.q()[2]))
        if peak > math.pi / 2.0:
            return math.nan
        simulation.nextStep()
    return peak


def main() -> None:
    """Run the block of the command line."""
    width, height, period, level, step = (float(one) for one in sys.argv[1:])
    with tempfile.TemporaryDirectory() as folder:
        library = compiled(width, height, folder)
        start = time.process_time()
        peak = peak_rotation(width, height, period, level, step, library)
        print(repr(peak), time.process_time() - start)


if __name__ == "__main__":
    main()
