"""Every number that enters through Python or the command line, from 1e-300 to 1e300, under a limit of memory.

`python -m tests.base.extreme_numbers RESULTS` replaces one number of an ordinary call at a time and prints the faults:
errors other than those about an argument, warnings, calls beyond the time limit. The parameters are read from the
signatures, where one that has no ordinary value here is a fault as well. `--only NAME` restricts it to the
calls whose name contains NAME, and `--sample SEED` to some of the calls, with a few of the values of each number, drawn
at random.
"""

import argparse
import inspect
import json
import math
import random
import re
import resource
import signal
import sys
import tempfile
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from functools import partial
from itertools import chain
from pathlib import Path
from types import FrameType
from typing import Any
from unittest.mock import patch

import numpy as np
import rocking_assessment
from typer.testing import CliRunner

import rocking
from benchmarks.accuracy.free_rocking import free_rocking
from rocking._base.errors import InvalidArgumentError
from rocking._cli.app import app as command_line
from rocking.paper import Groups, GroupSet, Orientation, Problem
from tests.suites.motions import noise

MEMORY = 2 * 1024**3
"""Limit of the writable memory of the process [bytes]."""

SECONDS = 60.0
"""Time limit of a call [s]."""

PART = 0.04
"""Part of the calls of a sample that are made."""

POWERS = (300, 30, 12, 6)
EXTREMES = (
    tuple(sign * 10.0 ** (end * power) for power in POWERS for end in (-1, 1) for sign in (1, -1)),
    (0.0, math.nan, math.inf, -math.inf, 10**400),
)
"""Values that replace each number: powers of ten, and others, among them an integer beyond all floats."""

INTEGERS = (0, *(sign * 10**power for power in POWERS for sign in (1, -1)))
"""Values that replace an integer as well."""

NUMBERS: dict[str, Any] = {
    "slenderness": 0.4, "frequency_ratio": 3.0, "restitution": 0.85, "alpha": 0.3,
    "relative_tolerance": 1e-6, "absolute_tolerance": 1e-4, "threads": 1,
    "highest": 10.0,
    "nodes": 16, "duration": 5.0, "samples": 20, "scale": 1.2, "period": 0.6,
    "width": 0.5, "height": 2.0, "half_diagonal": 1.0, "gravity": 9.81, "peak_acceleration": 5.0,
    "frequency_parameter": 2.0, "pulse_frequency": 10.0, "cycles": 2.0, "phase": 0.5,
    "acceleration": [0.0, 1.0, -2.0, 0.5], "vertical": [0.1, -0.2, 0.0, 0.3], "time_step": 0.01, "order": 1,
    "vertical_scale": 1.0, "periods": [0.5, 0.1], "damping": 0.1, "participation": [1.3, -0.3], "tail": 1.0,
    "intensity": [3.0, 9.0], "demand": 0.5, "confidence": 0.9, "restitution_step": 0.05,
    "years": 100.0, "probability": 0.9, "resolution": 0.01, "skip": 0,
    "mass": 100.0, "inertia": 50.0, "base": 0.4, "centre_height": 1.0, "top_height": 2.0, "mass_ratio": 2.0,
    "stiffness": 500.0, "restoring": 100.0, "load": 200.0,
    "uplift_acceleration": 2.0, "radius": 4.0, "thickness": 0.6, "embrace": 2.7, "voussoirs": 8,
    "edges": 1, "points": 2, "folds": 2,
    "amplitude": 4.0, "time": 0.5, "velocity": 0.5, "rotation": 0.5, "scaled": 0.5, "impact_time": 1.5,
    "phi": [0.5, 7.0], "falling": 1.0, "growing": 0.5, "constant": 0.2, "most": 2, "impacts": 1,
    "start_phase": 1.0, "impact_phase": 3.0, "impact_velocity": 0.5,
    "depth": 0.3, "diameter": 0.4, "mass_height": 0.7, "offset": 0.0, "friction": 0.5,
    "offset_width": 0.01, "offset_depth": 0.01, "pga": 3.0, "pgv": 0.4, "seed": 1,
    "floor_periods": [0.5, 0.1], "floor_damping": 0.1, "floor_participation": 1.3,
    "hazard": ([1.0, 10.0], [1e-2, 1e-4]),
    "exponents": {"a_g/g": 1, "alpha": -2}, "largest": 2, "cos_alpha": math.cos(0.3),
}  # fmt: skip
"""Ordinary values of the parameters of Python by their names."""

TRACE = np.arange(81) * 0.05, free_rocking(np.array([0.1]), *np.array([0.25, 2.5, 0.9]), 4.0, 20)[0]
"""Times [s] and rotations [rad] of a body that rocks freely: under other rotations a fit takes hundreds of steps."""

WINDOWS: dict[str, Any] = {
    "rocking.SampledPulse": {"time": [0.0, 1.0, 2.0, 4.0]},
    "rocking_assessment.calibrate": {"alpha": (0.1, 0.2), "half_diagonal": (0.5, 1.0), "restitution": (0.8, 0.9)},
    "rocking_assessment.identify_free_rocking": dict(
        zip(("time", "rotation"), (trace.tolist() for trace in TRACE), strict=True)
    ),
    "rocking.overturning_boundary": {"frequency_ratio": (2.0, 3.0), "slenderness": (0.3, 0.6)},
    "rocking.Block.boundary": {"period": (0.5, 0.6)},
    "rocking.paper.overturning_interval": {"amplitude": (2.0, 4.0)},
    "rocking.paper.island_tip": {"amplitude": (2.0, 4.0), "frequency_ratio": (2.0, 6.0)},
}
"""Parameters that are windows, by the function."""

RECORD, BLOCK = noise(1), rocking.Block(0.5, 2.0)
FRAGILITY = rocking.fragility([RECORD, noise(2)], BLOCK, intensity=[2.0, 4.0, 8.0, 16.0])
OBJECTS: dict[str, Any] = {
    "pulse": "sine", "motion": "sine", "unit": "m/s2", "name": "mavroeidis_papageorgiou",
    "record": RECORD, "records": [RECORD, noise(2)], "outcomes": np.arange(4) > 1,
    "blocks": BLOCK, "body": BLOCK, "objects": rocking_assessment.Object("vase", width=0.4, height=1.6),
    "motions": [noise(k) for k in range(4)], "column": BLOCK,
    "target": Orientation.LZ, "factors": dict.fromkeys(("a_g/g", "alpha"), Orientation.LZ), "function": math.sin,
    "fragility": FRAGILITY, "site": rocking_assessment.Site(pga=3.0, pgv=0.4), "argument": Orientation.L0,
    "description": "rectangle(width=0.5m, height=2m)",
    "group_set": GroupSet.RIGID_SMALL_ROTATION, "problem": Problem(0.3, 2.0, 5.0, 10.0), "groups": Groups(5.0, 0.6),
}  # fmt: skip
"""Arguments that are no numbers."""

OF_PULSES = ("peak_acceleration", "period", "frequency_ratio", "relative_tolerance", "start")
OF_RECORDS = ("scale", "frequency_parameter", "vertical_scale", "start")
"""Numbers that do not belong to the other kind of motion; a start from rest excludes both."""

MADE = (rocking.Block, rocking.EquivalentBlock, rocking.Record, rocking.SampledPulse, Groups, Problem)
"""Classes that are made from numbers."""

MEASURES = [name for kind in (rocking.Record, rocking.Block) for name in dir(kind) if not name.startswith("_")]
"""Properties that are read of what was made."""

UNUSED = ("evaluate", "interpolate", "used", "level", "slice_at")
"""Methods of a cube that are not public."""

SIZE, STRENGTH = "--restitution=0.85 --width=0.5m --height=2m", "--peak-acceleration=4m/s^2 --period=0.5s"
PERIODS = "--period-min=0.5s --period-max=0.6s"

OF_FILES = f"record.csv --unit=m/s2 --time-step=0.02s --skip=0 --baseline-order=1 --scale=1.2 {SIZE}"
COMMANDS = [
    f"response --pulse=sine {SIZE} {STRENGTH}",
    f"history --pulse=sine {SIZE} {STRENGTH} --duration=5s --samples=20 --format=csv",
    f"spectrum --pulse=sine {SIZE} --peak-acceleration=4m/s^2 {PERIODS} --points=5",
    f"boundary --pulse=sine {SIZE} {PERIODS}",
    f"response --pulse=sine {STRENGTH} --body=offset_mass(width=0.5m,height=2m,offset=0.05m,rebound=0.4,sides=left)",
    f"response --pulse=sine {STRENGTH} --body=two_edges(left=0.2m,right=0.3m,mass_height=0.8m,gyration=0.6m)",
    "history --restitution=0.85 --width=0.5m --height=2m --start=0.05rad --duration=5s",
    f"record {OF_FILES}",
    f"assess objects.csv --shapes=sine --pga=3m/s^2 {PERIODS}",
    "assess objects.csv --shapes=sine --pga=3m/s^2 --pgv=0.4m/s --samples=20 --seed=1 --resolution=0.01",
    "assess objects.csv --record=record.csv --unit=m/s2 --time-step=0.02s --skip=0 --baseline-order=1",
    "identify trace.csv --edges=1 --confidence=0.9",
    "identify rotations.csv --time-step=0.05s",
    "fragility suite.json",
    "serve --port=8000 --workers=1",
]
"""Ordinary commands, of which each number is replaced; the numbers of `fragility` are in its file."""

MOTION = [round(math.sin(0.5 * k) * math.sin(0.05 * k), 6) for k in range(60)]
SAMPLES = "acceleration [m/s2]\n" + "".join(f"{4.0 * value:.6f}\n" for value in MOTION)
PULSE = {"acceleration": [0.0, 1.0, -0.5, 0.0], "time": [0.0, 1.0, 2.0, 4.0], "period": 2.0}
GRID = {"low": 2.0, "high": 9.0, "points": 3}
SUITE: dict[str, Any] = {
    "name": "extreme",
    "records": {"folder": ".", "pattern": "record.csv", "unit": "m/s2", "time_step": 0.02, "baseline_order": 1},
    "blocks": [{"width": 0.5, "height": 2.0}, {"width": 0.5, "height": 1.0}],
    "restitution": 0.85,
    "measure": "pga",
    "intensity": GRID,
    "demand": ["overturning", 0.5],
    "confidence": 0.9,
    "map": {"intensity": 6.0, "half_diagonal": GRID, "alpha_deg": GRID},
    "hazard": {"intensity": [1.0, 20.0], "annual_rate": [1e-2, 1e-5]},
    "sensitivity": {"intensity": [4.0], "restitution_step": 0.05},
}

NUMERIC = re.compile(r"\b(float|int|ArrayLike|Array|Hazard|Restitution|Scalar|Any)\b")


class LateError(BaseException):
    """A call beyond the time limit."""


class Walk:
    """Counts and faults of the calls."""

    def __init__(self, only: str, sample: int | None) -> None:
        self.only = only
        self.draw = None if sample is None else random.Random(sample)
        self.results: Counter[str] = Counter()
        self.faults: list[str] = []

    def call(self, name: str, given: Any, function: Callable[[], str]) -> None:
        """Call a function that returns how it ended."""
        if self.only not in name or (self.draw is not None and self.draw.random() > PART):
            return
        signal.setitimer(signal.ITIMER_REAL, SECONDS)
        try:
            ended = function()
        except LateError:
            ended = f"not ended after {SECONDS:g} s"
        except Exception as error:  # noqa: BLE001  (any other error is a fault)
            ended = f"{error!r} in {traceback.extract_tb(error.__traceback__)[-1]}"
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
        self.results[ended if ended in ("answered", "refused") else "faults"] += 1
        if ended not in ("answered", "refused"):
            self.faults.append(f"{name} {given}: {ended}")

    def values(self, number: float) -> list[float]:
        """The values that replace a number: all, or one of each kind."""
        kinds = (*EXTREMES, INTEGERS) if isinstance(number, int) else EXTREMES
        return [*chain(*kinds)] if self.draw is None else [self.draw.choice(kind) for kind in kinds]

    def replaced(self, given: Any) -> Iterator[Any]:
        """The given values with one number replaced, for each number and each replacement; of many samples a few.

        Also all numbers of a list times a factor.
        """
        if isinstance(given, dict):
            yield from ({**given, name: other} for name, value in given.items() for other in self.replaced(value))
        elif isinstance(given, (list, tuple)):
            if len(given) > 1 and all(isinstance(one, float) for one in given):  # all of them, as in a wrong unit
                for factor in filter(lambda one: isinstance(one, float), self.values(1.0)):
                    yield type(given)(one * factor for one in given)
            for place in range(0, len(given), max(len(given) // 4, 1)):
                others = self.replaced(given[place])
                yield from (type(given)([*given[:place], other, *given[place + 1 :]]) for other in others)
        elif isinstance(given, (float, int)) and not isinstance(given, bool):
            yield from self.values(given)


def late(_: int, __: FrameType | None) -> None:
    raise LateError


def walk_python(walk: Walk, results: Path) -> None:
    """The public functions, classes and methods of `rocking` with numeric parameters."""
    cube = rocking.open_cube(results / "spectra" / "sine" / "eta-0.85.nc")
    equivalent = rocking.EquivalentBlock(0.3, 2.0, restitution=0.85)
    fit = rocking.suites.fit_pulse(RECORD, family="ricker", blocks=BLOCK)
    modules = (rocking, rocking.paper)
    named = (
        (f"{one.__name__}.{key}", getattr(one, key))
        for one in modules
        for key in (*rocking.__all__, *vars(one))
        if hasattr(one, key)
    )
    functions: dict[str, Callable[..., Any]] = {
        name: value
        for name, value in named
        if value in MADE or (inspect.isfunction(value) and value.__module__ != "rocking._base.errors")
    }
    objects = {"Block": BLOCK, "EquivalentBlock": equivalent, "Record": RECORD, "Cube": cube, "PulseFit": fit}
    objects["SampledPulse"] = rocking.SampledPulse(**PULSE)
    for name, thing in objects.items():
        members = {key: getattr(thing, key) for key in dir(thing) if key not in UNUSED}
        functions |= {f"rocking.{name}.{key}": value for key, value in members.items() if inspect.ismethod(value)}
    for name, function in functions.items():
        parameters = inspect.signature(function).parameters
        if "._" in name or not any(NUMERIC.search(str(one.annotation)) for one in parameters.values()):
            continue
        for motion in ("sine", RECORD) if "motion" in parameters and name[-8:] != "spectrum" else ("sine",):
            try:
                given = ordinary_arguments(name, function, motion)
            except KeyError as error:
                walk.faults.append(f"{name}: the parameter {error} has no ordinary value in this test")
                continue
            numbers = {key: value for key, value in given.items() if key not in OBJECTS}
            for other in walk.replaced(numbers):
                changed = ", ".join(f"{key} = {other[key]}" for key in numbers if other[key] is not numbers[key])
                walk.call(name, changed, partial(evaluate, function, given | other))


def ordinary_arguments(name: str, function: Callable[..., Any], motion: Any) -> dict[str, Any]:
    """The numbers, and the required objects."""
    given: dict[str, Any] = {}
    for key, parameter in inspect.signature(function).parameters.items():
        if parameter.kind is parameter.VAR_KEYWORD:
            given |= {"cycles": 2.0, "phase": 0.5}  # of `pulse`
        elif key in OBJECTS:
            given[key] = motion if key == "motion" else OBJECTS[key]
        elif NUMERIC.search(str(parameter.annotation)):
            if "motion" not in given or key not in (OF_PULSES if motion is RECORD else OF_RECORDS):
                given[key] = WINDOWS.get(name, NUMBERS).get(key) or NUMBERS[key]
        elif parameter.annotation == "bool":
            given[key] = True
        elif parameter.default is parameter.empty:
            raise KeyError(key)
    return given


def evaluate(function: Callable[..., Any], given: dict[str, Any]) -> str:
    try:
        found = function(**given)
        repr(found)
        for name in MEASURES if isinstance(found, (rocking.Record, rocking.Block)) else ():
            getattr(found, name, None)
    except InvalidArgumentError:
        return "refused"
    return "answered"


def walk_commands(walk: Walk, folder: Path) -> None:
    """All options of all commands that take a number, and the numbers of the configuration of a suite."""
    rows = "\n".join(f"{time},{rotation}" for time, rotation in zip(*TRACE, strict=True))
    files = {
        "record.csv": SAMPLES,
        "trace.csv": f"time [s],rotation [rad]\n{rows}",
        "rotations.csv": "\n".join(["rotation [rad]", *map(str, TRACE[1])]),
        "objects.csv": "width [m],height [m]\n0.4,1.6\n",
        "suite.json": json.dumps(SUITE),
    }
    for name, content in files.items():
        (folder / name).write_text(content, encoding="utf-8")
    for one in COMMANDS:
        walk.call(one, "", partial(run_command, one, folder, refused="an ordinary command is refused"))
        for place in re.finditer(r"(?<==)\d+(\.\d+)?(?![\d:])", one):
            for other in walk.values(float(place[0]) if "." in place[0] else int(place[0])):
                changed = one[: place.start()] + str(other) + one[place.end() :]
                walk.call(one, changed, partial(run_command, changed, folder))
    for other in walk.replaced(SUITE):
        (folder / "suite.json").write_text(json.dumps(other), encoding="utf-8")
        walk.call("fragility", other, partial(run_command, "fragility suite.json", folder))


def run_command(text: str, folder: Path, refused: str = "refused") -> str:
    argv = [str(folder / one) if one.endswith((".csv", ".json")) and one[0] != "-" else one for one in text.split()]
    argv = [one.replace("=record.csv", f"={folder}/record.csv") for one in argv]
    found = CliRunner().invoke(command_line, argv)
    if found.exception is not None and not isinstance(found.exception, SystemExit):
        raise found.exception
    endings = {0: "answered", 2: refused}
    return endings.get(found.exit_code, f"exit code {found.exit_code}, {found.output[-300:]}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=Path, help="folder that the workflow filled")
    parser.add_argument("--part", choices=["all", "python", "commands"], default="all", help="only this part")
    parser.add_argument("--only", default="", help="part of the name of a function or command")
    parser.add_argument("--sample", type=int, metavar="SEED", help="some calls, one value of each kind")
    given = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))
    signal.signal(signal.SIGALRM, late)
    warnings.simplefilter("error")
    warnings.filterwarnings("ignore", category=DeprecationWarning)
    walk = Walk(given.only, given.sample)
    with ExitStack() as stack:
        for name in (
            "rocking_api.command.main",
            "rocking_assessment._commands.assess._write",
        ):
            stack.enter_context(patch(name))  # no server, and no files
        stack.enter_context(patch.dict(rocking.overturning_boundary.__kwdefaults__, nodes=16))
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        OBJECTS["path"] = str(folder / "record.csv")
        Path(OBJECTS["path"]).write_text(SAMPLES, encoding="utf-8")
        parts = {
            "python": partial(walk_python, walk, given.results),
            "commands": partial(walk_commands, walk, folder),
        }
        for part in parts if given.part == "all" else [given.part]:
            parts[part]()
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
    counts = ", ".join(f"{count} {ended}" for ended, count in sorted(walk.results.items()))
    sys.stdout.write("\n".join([*walk.faults, f"{counts}; peak {memory} MB", ""]))
    sys.exit(bool(walk.faults))


if __name__ == "__main__":
    main()
