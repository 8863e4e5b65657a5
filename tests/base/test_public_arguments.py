"""Every number that a public function takes: what is no number, and what is out of its range, is refused by its name.

The calls are made from the signatures, with the ordinary values of `tests/base/extreme_numbers.py`; the ranges are
those that `rocking._base.quantities` declares.
"""

import inspect
import math
import re
from collections.abc import Callable, Iterator
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import rocking_assessment
from scipy import stats

import rocking
import rocking._base.quantities as quantities
from rocking import EquivalentBlock, InvalidArgumentError, paper
from rocking._base.quantity import Quantity
from rocking._base.units import Scalar
from rocking._datasets.cube import write_dataset
from rocking._spectra.cubes import spectrum
from tests.base.extreme_numbers import BLOCK, RECORD, ordinary_arguments
from tests.lookup_grid import GRID
from tests.sampling import sample

PROBLEM = {"slenderness": 0.4, "frequency_ratio": 5.0, "restitution": 0.85, "alpha": 0.2}
UPWARDS = rocking.Record(RECORD.acceleration, RECORD.time_step, "m/s2", vertical=0.1 * RECORD.acceleration)
BODY = rocking.RigidBody(0.15, 0.2, 0.6)
OWN = {"name": "own", "start": 0.0, "end": 6.0, "stationary": ()}


class Hump(rocking.SmoothPulse):
    def curve(self, phase):
        return np.sin(phase * np.pi / 3.0)


def flat_spectrum(frequency, damping):
    return np.full(frequency.shape, 5.0 - damping)


OBJECT = {
    "name": "vase", "width": 0.4, "height": 1.6, "depth": 0.3, "mass_height": 0.7, "offset_width": 0.01,
    "offset_depth": 0.01, "mass": 100.0, "friction": 0.5, "restitution": 0.9, "tolerance": 0.01,
}  # fmt: skip
ROUND = {"name": "amphora", "diameter": 0.4, "height": 1.6}
GIVEN: dict[str, dict[str, Any]] = {
    "overturning_probability": {"site": rocking_assessment.Site(pga=3.0, pgv=0.4), "width": stats.norm(0.4, 0.01),
                                "height": 1.6, "samples": 64, "seed": 1},
    "paper.largest_deviation": {"peak_rotation": [1.0, 2.0], "restitution": [0.8, 0.9], "reference": 0.9, "axis": 0},
    "paper.restitution_exponent": {"peak_rotation": [1.0, 2.0], "restitution": [0.8, 0.9], "axis": 0},
    "paper.scale_law_deviation": {"peak_rotation": [1.0, 2.0], "restitution": [0.8, 0.9], "reference": 0.9, "axis": 0},
    "pulse": {"name": "mavroeidis_papageorgiou", "cycles": 2.0, "phase": 0.5},
    "read_record": {"file": __file__, "time_step": 0.01, "skip": 0},
    "RigidBody": {"left": 0.1, "right": 0.2, "height": 0.6, "gyration": 0.3, "gravity": 9.81, "top_height": 1.0},
    "rocking_assessment.body_from_mesh": {"path": __file__, "direction": 0.5, "unit": "m", "gravity": 9.81,
                                          "contact_tolerance": 1e-3},
    "RigidBody.from_polygon": {"vertices": [(0, 0), (0.3, 0), (0.2, 1)], "gravity": 9.81},
    "RigidBody.from_size": {"width": 0.4, "height": 1.6, "gyration": 0.3, "mass_height": 0.7, "gravity": 9.81},
    "SampledPulse.from_file": {"path": __file__, "period": 2.0, "skip": 0},
    "SinusoidalPulse": OWN | {"terms": ((1.0, 1.0, -0.5 * math.pi),)},
    "SinusoidalPulse.of_unit_peak": {"name": "own", "start": 0.0, "end": 6.0, "terms": ((1.0, 1.0, 0.0),)},
    "SmoothPulse": {"name": "own", "start": 0.0, "end": 3.0},
    "Site": {"pga": 3.0, "pgv": 0.4},
    "standards.asce43_rocking_angle": {"spectrum": flat_spectrum, "half_width": 0.2, "mass_height": 0.8,
                                       "gyration": 0.5},
    "standards.asce43_sliding_distance": {"spectrum": flat_spectrum, "friction": 0.3, "vertical_acceleration": 1.0},
    "suites.distribution": {"ensemble": rocking.fragility(RECORD, BLOCK, intensity=[3.0]), "confidence": 0.9},
    "suites.spectrum_volume": {"record": RECORD, "restitution": 0.9, "points": 2},
    "WaveletPulse": OWN | {"start": -3.0, "end": 3.0, "polynomial": (1.0, 0.0, -1.0), "spread": 1.0},
}  # fmt: skip
"""Arguments of functions whose signature does not tell all of them."""

INSTANCES = {
    "Block": BLOCK,
    "EquivalentBlock": EquivalentBlock.rocking_frame(BLOCK, mass_ratio=0.5),
    "Record": RECORD,
    "RigidBody": BODY,
}
"""Of which methods are called."""

RESULTS = {"suites.PulseFit", "paper.Quantity", "Block.top_displacement", "EquivalentBlock.top_displacement"}
"""What the package makes itself, and functions of its results, which may be nan."""

OPTIONAL = {
    "alpha", "threads", "relative_tolerance", "absolute_tolerance", "time_step", "duration", "samples",
    "uplift_acceleration", "top_height", "restitution", "scale", "vertical_scale", "highest", "size",
    "peak_acceleration", "period", "depth", "diameter", "mass_height", "mass", "friction", "pgv",
    "tail", "skip", "gyration", "start", "order",
}  # fmt: skip
"""Arguments that may be None somewhere."""

SCALAR = re.compile(r"(units\.)?(float|int|Scalar|Restitution)( \| None)?")


def scalars(function: Callable[..., Any]) -> list[str]:
    try:
        parameters = inspect.signature(function).parameters.values()
    except ValueError:  # an enumeration, an error
        return []
    return [one.name for one in parameters if is_scalar(one.annotation)]


def is_scalar(annotation: Any) -> bool:
    """Whether an annotation, a text in modules that import annotations from the future, is that of a number."""
    if isinstance(annotation, str):
        return bool(SCALAR.fullmatch(annotation))
    return any(annotation in (one, one | None) for one in (float, int, Scalar))


def public_functions(module: ModuleType, prefix: str = "") -> Iterator[tuple[str, list[str]]]:
    for name in getattr(module, "__all__", [key for key in vars(module) if not key.startswith("_")]):
        value = getattr(module, name)
        if inspect.ismodule(value) and value is not rocking.plot:
            yield from public_functions(value, f"{name}.")
        if value is rocking.BodyResponse or not (getattr(value, "__module__", None) or "").startswith("rocking"):
            continue  # what a function returns is not made by users
        found = {prefix + name: value} if callable(value) else {}
        if inspect.isclass(value):
            members = {key: inspect.getattr_static(value, key) for key in dir(value) if not key.startswith("_")}
            found |= {f"{prefix}{name}.{key}": getattr(one, "__func__", one) for key, one in members.items()}
        yield from ((key, scalars(one)) for key, one in found.items() if callable(one) and scalars(one))


def resolved(name: str) -> Callable[..., Any]:
    owner, _, member = name.rpartition(".")
    if owner in INSTANCES:
        return getattr(INSTANCES[owner], member)
    found: Any = Hump if name == "SmoothPulse" else rocking
    for part in name.split(".") if found is rocking else ():
        found = getattr(found, part)
    return found


def calls(name: str) -> list[dict[str, Any]]:
    """Arguments that a function accepts: for a pulse, for a record, and for a release where it takes them."""
    if name == "Object":
        return [OBJECT, ROUND]
    if name in GIVEN:
        return [GIVEN[name]]
    function = resolved(name)
    takes = inspect.signature(function).parameters.keys()
    found = [ordinary_arguments(f"rocking.{name}", function, motion) for motion in ("sine", RECORD)]
    if "motion" not in takes:
        return found[:1]
    found[0].pop("resolution", None)
    found[1]["motion"] = UPWARDS
    if name.endswith("boundary"):
        return found[:1]
    if name == "suites.record_amplification":
        return found[1:]
    for given in found if "start" in takes else ():
        given["start"] = None
    return found + [{"start": 0.01}] * ("start" in takes)


FOUND = {name: scalars for name, scalars in public_functions(rocking) if name not in RESULTS}
CALLS = {name: calls(name) for name in FOUND}
ASKED = [
    (name, number, argument)
    for name, each in CALLS.items()
    for number, given in enumerate(each)
    for argument in ([*given] if name == "pulse" else FOUND[name])
    if given.get(argument) is not None and argument != "name"
]


def test_every_number_of_a_public_function_is_asked():
    asked = {(name, argument) for name, _, argument in ASKED}
    assert {(name, one) for name, found in FOUND.items() for one in found} - asked == {("pulse", "parameters")}


WRONG = {
    "list": lambda value: [value],
    "pair": lambda value: (value, value),
    "array": lambda value: np.array([value]),
    "text": lambda _: "wide",
    "boolean": lambda _: True,
    "none": lambda _: None,
    "object": lambda _: object(),
    "complex": lambda value: value + 0.1j,
}


@pytest.mark.parametrize(("name", "number", "argument"), sample(ASKED, 60))
def test_what_is_no_number_is_refused_by_its_name(name, number, argument):
    function, given = resolved(name), CALLS[name][number]
    for kind, wrong in WRONG.items():
        value = wrong(given[argument])
        if value is None and (argument in OPTIONAL or (name[:12], argument) == ("SampledPulse", "period")):
            continue
        with pytest.raises(InvalidArgumentError, match=rf"^`{argument}` = ") as caught:
            function(**given | {argument: value})
        assert caught.value.parameter == argument, kind
        if isinstance(value, list | tuple | np.ndarray):
            assert "one number in " in caught.value.allowed, kind


DECLARED = {one.name: one for one in vars(quantities).values() if isinstance(one, Quantity)}


def outside(quantity: Quantity) -> list[float]:
    found = [math.nan, math.inf, -math.inf, 10**400]
    for end, away in ((quantity.lower, -1.0), (quantity.upper, 1.0)):
        if math.isfinite(end):
            found += [end + away * (0.5 + abs(end)), *([end] if quantity.closed not in ("both", SIDE[away]) else [])]
    return found


SIDE = {-1.0: "left", 1.0: "right"}
OWN_START = {"SinusoidalPulse", "SinusoidalPulse.of_unit_peak", "SmoothPulse", "WaveletPulse"}
"""Their `start` is a phase, not a rotation."""

POSITIVE = Quantity("frequency_ratio", "-", "frequency ratio or parameter of a closed form", lower=0.0)
"""What closed forms accept: no end of the solver's range."""

CLOSED_FORMS = [f"paper.{name}" for name in paper.__all__ if inspect.isfunction(getattr(paper, name))]
RANGED = [
    (name, number, argument)
    for name in dict.fromkeys([*CALLS, *CLOSED_FORMS, "Block", "RigidBody", "RigidBody.from_size", "paper.Groups"])
    if name in CALLS or name in GIVEN or DECLARED.keys() & inspect.signature(resolved(name)).parameters.keys()
    for number, given in enumerate(calls(name))
    for argument, value in given.items()
    if argument in DECLARED and isinstance(value, float) and not (argument == "start" and name in OWN_START)
]


def range_of(name: str, argument: str) -> Quantity:
    closed_form = name.startswith("paper.") and argument in ("frequency_ratio", "frequency_parameter")
    return POSITIVE if closed_form else DECLARED[argument]


@pytest.mark.parametrize(("name", "number", "argument"), sample(RANGED, 60))
def test_a_number_out_of_its_range_is_refused_by_its_name(name, number, argument):
    function, given = resolved(name), calls(name)[number]
    for value in outside(range_of(name, argument)):
        with pytest.raises(InvalidArgumentError, match=rf"^`{argument}`") as caught:
            function(**given | {argument: value})
        assert caught.value.parameter == argument, value


@pytest.mark.parametrize(
    "argument", ["threads", "samples", "nodes", "order", "voussoirs", "impacts", "most", "largest"]
)
def test_whole_numbers_are_whole(argument):
    for name, number, own in ASKED:
        if own == argument:
            given = CALLS[name][number]
            with pytest.raises(InvalidArgumentError, match=rf"^`{argument}` = .*whole number") as caught:
                resolved(name)(**given | {argument: given[argument] + 0.5})
            assert caught.value.parameter == argument


@pytest.mark.parametrize("argument", ["absolute_tolerance", "threads"])
@pytest.mark.parametrize("wrong", WRONG.values(), ids=WRONG)
def test_of_cubes_too(argument, wrong, cube):
    given = {"slenderness": 0.4, "frequency_ratio": 5.0, "absolute_tolerance": 1.0, "threads": 1}
    value = wrong(given[argument])
    if value is not None or argument == "absolute_tolerance":
        with pytest.raises(InvalidArgumentError, match=rf"^`{argument}` = "):
            cube.response(**given | {argument: value})


@pytest.fixture(scope="module")
def cube(tmp_path_factory):
    path = tmp_path_factory.mktemp("cube") / "eta-0.85.nc"
    write_dataset(spectrum("sine", restitution=0.85, **GRID), path)
    return rocking.open_cube(path)


def test_the_place_of_a_wrong_number_is_named():
    with pytest.raises(InvalidArgumentError, match=r"`slenderness` = -1.0 at index 2 is not allowed") as caught:
        rocking.peak_response("sine", **PROBLEM | {"slenderness": [0.4, 0.5, -1.0, -2.0]})
    assert (caught.value.parameter, caught.value.value, caught.value.index) == ("slenderness", -1.0, (2,))
    with pytest.raises(InvalidArgumentError, match=r"`restitution` = nan at index \(1, 0\) is"):
        rocking.peak_response("sine", **PROBLEM | {"restitution": np.array([[0.1, 0.2], [np.nan, 2.0]])})
    with pytest.raises(InvalidArgumentError, match=r"`alpha` = 1e-13 at index 1 is"):
        rocking.peak_response("sine", **PROBLEM | {"alpha": [0.0, 1e-13]})


def test_angles_in_degrees_are_asked_about():
    with pytest.raises(InvalidArgumentError, match=r"\[rad\]; write '20 deg' if degrees were meant$"):
        rocking.peak_response("sine", **PROBLEM | {"alpha": 20})
    with pytest.raises(InvalidArgumentError, match=r"at index 1 .*; numpy.radians converts degrees$"):
        rocking.peak_response("sine", **PROBLEM | {"alpha": [0.1, 20.0]})
    with pytest.raises(InvalidArgumentError, match=r"\[rad\]; write '45 deg' if degrees were meant$"):
        rocking.Block.from_slenderness_angle(45, 1.0)
    for wrong in (1000.0, -20.0, np.inf, "95 deg"):
        with pytest.raises(InvalidArgumentError, match=r"\[rad\]$"):
            rocking.peak_response("sine", **PROBLEM | {"alpha": wrong})
