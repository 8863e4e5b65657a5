"""Every argument that is one number: of each public function, what is no number is refused by its name."""

import inspect
import re
from collections.abc import Callable, Iterator
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from scipy import stats

import rocking
from rocking import EquivalentBlock, InvalidArgumentError, paper
from rocking._base.units import Scalar
from rocking._datasets.cube import write_dataset
from rocking._spectra.cubes import spectrum
from rocking.paper import Orientation
from tests.lookup_grid import GRID

BLOCK = rocking.Block(0.4, 1.6)
BODY = rocking.RigidBody(0.15, 0.2, 0.6)
FRAME = EquivalentBlock.rocking_frame(BLOCK, mass_ratio=0.5)
TIME = np.arange(0.0, 3.0, 0.01)
RECORD = rocking.Record(3.0 * np.sin(6.0 * TIME), 0.01, "m/s2")
TRACE = TIME, 0.1 * np.cos(6.0 * TIME) * np.exp(-TIME)
UPWARDS = rocking.Record(RECORD.acceleration, 0.01, "m/s2", vertical=0.1 * RECORD.acceleration)
PROBLEM = {"slenderness": 0.4, "frequency_ratio": 5.0, "restitution": 0.85, "alpha": 0.2}
OF_RECORD = {"frequency_parameter": 3.0, "slenderness": 0.4, "restitution": 0.85, "alpha": 0.2}
PULSE = {"motion": "sine", "peak_acceleration": 4.0, "period": 0.5, "restitution": 0.9}
SUITE = {"records": RECORD, "blocks": BLOCK, "intensity": [3.0], "restitution": 0.9, "confidence": 0.9, "threads": 1}
SIZE = {"gravity": 9.81}
GROUPS = paper.Groups(5.0, 0.4)
PEAKS = {"peak_rotation": [1.0, 2.0], "restitution": [0.8, 0.9]}
RIGID = paper.GroupSet.RIGID_SMALL_ROTATION
SCALED = {"motion": RECORD, "scale": 1.0, "restitution": 0.9}


class Hump(rocking.SmoothPulse):
    """A family of one's own."""

    def curve(self, phase):
        return np.sin(phase * np.pi / 3.0)


def flat_spectrum(frequency, damping):
    """5 m/s2 at every frequency."""
    return np.full(frequency.shape, 5.0 - damping)


CALLS: dict[str, tuple[Callable[..., Any], list[dict[str, Any]]]] = {
    "Object": (
        rocking.Object,
        [{"name": "vase", "width": 0.4, "height": 1.6, "depth": 0.3, "mass_height": 0.7, "offset_width": 0.01,
          "offset_depth": 0.01, "mass": 100.0, "friction": 0.5, "restitution": 0.9, "tolerance": 0.01},
         {"name": "amphora", "diameter": 0.4, "height": 1.6}],
    ),
    "Site": (rocking.Site, [{"pga": 3.0, "pgv": 0.4}]),
    "assess": (
        rocking.assess,
        [{"objects": rocking.Object("vase", width=0.4, height=1.6), "site": rocking.Site(3.0, 0.4, shapes=["sine"]),
          "sensitivity": False, "samples": 64, "seed": 1, "resolution": 0.01}],
    ),
    "overturning_probability": (
        rocking.overturning_probability,
        [{"site": rocking.Site(pga=3.0, pgv=0.4), "width": stats.norm(0.4, 0.01), "height": 1.6, "samples": 64,
          "seed": 1}],
    ),
    "SampledPulse": (rocking.SampledPulse, [{"period": 2.0, "acceleration": [0.0, 1.0, 0.0]}]),
    "SampledPulse.from_file": (rocking.SampledPulse.from_file, [{"path": __file__, "period": 2.0}]),
    "Block.from_slenderness_angle": (
        rocking.Block.from_slenderness_angle,
        [{"alpha": 0.2, "half_diagonal": 1.0} | SIZE],
    ),
    "EquivalentBlock": (
        EquivalentBlock,
        [{"alpha": 0.2, "frequency_parameter": 2.0, "restitution": 0.9, "uplift_acceleration": 1.0, "top_height": 1.0}
         | SIZE],
    ),
    "EquivalentBlock.linear_mechanism": (
        EquivalentBlock.linear_mechanism,
        [{"mass": 5.0, "stiffness": 20.0, "restoring": 4.0, "load": 2.0, "restitution": 0.9, "top_height": 1.0} | SIZE],
    ),
    "EquivalentBlock.masonry_arch": (
        EquivalentBlock.masonry_arch,
        [{"radius": 10.0, "thickness": 1.5, "embrace": 2.7, "voussoirs": 7, "restitution": 0.9} | SIZE],
    ),
    "EquivalentBlock.rigid_body": (
        EquivalentBlock.rigid_body,
        [{"mass": 700.0, "inertia": 900.0, "base": 0.6, "centre_height": 2.0, "top_height": 4.0} | SIZE],
    ),
    "EquivalentBlock.rocking_frame": (EquivalentBlock.rocking_frame, [{"column": BLOCK, "mass_ratio": 0.5}]),
    "Record": (rocking.Record, [{"acceleration": [1.0, 2.0], "time_step": 0.01, "unit": "g"}]),
    "Record.baseline_corrected": (RECORD.baseline_corrected, [{"order": 1}]),
    "Record.resampled": (RECORD.resampled, [{"time_step": 0.005}]),
    "paper.discounted_integral": (
        paper.discounted_integral, [{"pulse": "sine", "frequency_ratio": 5.0, "start_phase": 1.0}],
    ),
    "calibrate": (
        rocking.calibrate,
        [{"motions": [RECORD, UPWARDS], "outcomes": np.array([True, False]), "alpha": (0.1, 0.2),
          "half_diagonal": (0.5, 1.0), "restitution": (0.8, 0.9), "points": 2, "folds": 2, "confidence": 0.9}],
    ),
    "paper.first_uplift_phase": (paper.first_uplift_phase, [{"pulse": "sine", "amplitude": 2.0}]),
    "paper.impacts_in_pulse": (
        paper.impacts_in_pulse,
        [{"pulse": "sine", "amplitude": 2.0, "frequency_ratio": 5.0, "restitution": 0.9, "most": 2}],
    ),
    "paper.margin_after_impacts": (
        paper.margin_after_impacts,
        [{"pulse": "sine", "amplitude": 2.0, "frequency_ratio": 5.0, "restitution": 0.9, "impacts": 1}],
    ),
    "paper.overturning_interval": (
        paper.overturning_interval,
        [{"pulse": "sine", "frequency_ratio": 5.0, "restitution": 0.9, "impacts": 1, "amplitude": (2.0, 20.0)}],
    ),
    "paper.island_tip": (
        paper.island_tip,
        [{"pulse": "sine", "restitution": 0.9, "impacts": 1, "frequency_ratio": (4.0, 8.0), "amplitude": (2.0, 20.0)}],
    ),
    "paper.margin_after_impact": (
        paper.margin_after_impact,
        [{"pulse": "sine", "amplitude": 2.0, "frequency_ratio": 5.0, "restitution": 0.9, "impact_phase": 4.0,
          "impact_velocity": 1.0}],
    ),
    "paper.margin_without_impact": (
        paper.margin_without_impact, [{"pulse": "sine", "amplitude": 2.0, "frequency_ratio": 5.0}],
    ),
    "thresholds": (
        rocking.thresholds,
        [{"motion": "sine", "frequency_ratio": 5.0, "restitution": 0.9, "alpha": 0.2, "highest": 20.0},
         {"motion": UPWARDS, "vertical_scale": 1.0, "highest": 20.0, "resolution": 0.01}
         | {key: value for key, value in OF_RECORD.items() if key != "slenderness"}],
    ),
    "standards.asce43_rocking_angle": (
        rocking.standards.asce43_rocking_angle,
        [{"spectrum": flat_spectrum, "half_width": 0.2, "mass_height": 0.8, "gyration": 0.5}],
    ),
    "standards.asce43_sliding_distance": (
        rocking.standards.asce43_sliding_distance,
        [{"spectrum": flat_spectrum, "friction": 0.3, "vertical_acceleration": 1.0}],
    ),
    "floor_motion": (
        rocking.floor_motion, [{"record": RECORD, "periods": 0.5, "relative_tolerance": 0.01, "tail": 1.0}],
    ),
    "fragility": (rocking.fragility, [SUITE]),
    "pulse": (
        lambda **given: rocking.pulse("mavroeidis_papageorgiou", **given), [{"cycles": 2.0}, {"phase": 0.5}],
    ),
    "paper.Problem": (
        paper.Problem,
        [{"alpha": 0.2, "frequency_parameter": 2.0, "peak_acceleration": 4.0, "pulse_frequency": 8.0} | SIZE],
    ),
    "paper.problem_of_block": (
        paper.problem_of_block,
        [{"groups": GROUPS, "group_set": RIGID, "alpha": 0.2, "frequency_parameter": 2.0} | SIZE],
    ),
    "paper.problem_of_pulse": (
        paper.problem_of_pulse,
        [{"groups": GROUPS, "group_set": RIGID, "peak_acceleration": 4.0, "pulse_frequency": 8.0} | SIZE],
    ),
    "paper.scale_law_deviation": (paper.scale_law_deviation, [PEAKS | {"reference": 0.9, "axis": 0}]),
    "paper.largest_deviation": (paper.largest_deviation, [PEAKS | {"reference": 0.9, "axis": 0}]),
    "paper.restitution_exponent": (paper.restitution_exponent, [PEAKS | {"axis": 0}]),
    "paper.admissible_exponents": (
        paper.admissible_exponents, [{"target": Orientation.L0, "factors": {}, "largest": 2}],
    ),
    "identify_free_rocking": (
        rocking.identify_free_rocking, [{"time": TRACE[0], "rotation": TRACE[1], "edges": 1, "confidence": 0.9}],
    ),
    "isolated_motion": (
        rocking.isolated_motion, [{"record": RECORD, "period": 0.5, "damping": 0.1, "relative_tolerance": 0.01}],
    ),
    "overturning_boundary": (
        rocking.overturning_boundary, [{"motion": "sine", "restitution": 0.9, "alpha": 0.2, "nodes": 32, "threads": 1}],
    ),
    "peak_response": (
        rocking.peak_response,
        [{"motion": "sine", "relative_tolerance": 1e-6, "threads": 1} | PROBLEM,
         {"motion": UPWARDS, "vertical_scale": 1.0, "threads": 1} | OF_RECORD],
    ),
    "SinusoidalPulse": (
        rocking.SinusoidalPulse,
        [{"name": "own", "start": 0.0, "end": 6.0, "stationary": (), "terms": ((1.0, 1.0, -1.5707963267948966),)}],
    ),
    "SinusoidalPulse.of_unit_peak": (
        rocking.SinusoidalPulse.of_unit_peak,
        [{"name": "own", "start": 0.0, "end": 6.0, "terms": ((1.0, 1.0, 0.0),)}],
    ),
    "WaveletPulse": (
        rocking.WaveletPulse,
        [{"name": "own", "start": -3.0, "end": 3.0, "stationary": (), "polynomial": (1.0, 0.0, -1.0), "spread": 1.0}],
    ),
    "SmoothPulse": (Hump, [{"name": "own", "start": 0.0, "end": 3.0}]),
    "read_record": (rocking.read_record, [{"path": __file__, "time_step": 0.01, "skip": 0}]),
    "suites.record_amplification": (
        rocking.suites.record_amplification, [{"motion": RECORD, "threads": 1} | OF_RECORD]
    ),
    "suites.spectrum_volume": (
        rocking.suites.spectrum_volume, [{"record": RECORD, "restitution": 0.9, "points": 2}]
    ),
    "suites.suite_sensitivity": (rocking.suites.suite_sensitivity, [{"restitution_step": 0.05} | SUITE]),
    "time_history": (
        rocking.time_history,
        [{"motion": "sine", "duration": 5.0, "samples": 10} | PROBLEM,
         {"motion": UPWARDS, "vertical_scale": 1.0, "duration": 5.0, "samples": 10} | OF_RECORD],
    ),
    "survival": (
        rocking.survival,
        [{"fragility": None, "hazard": ([1.0, 2.0], [1e-2, 1e-3]), "years": 10.0}],
    ),
    "unexceeded": (rocking.unexceeded, [{"body": BLOCK, "motions": [RECORD], "probability": 0.9, "resolution": 0.01}]),
}  # fmt: skip
"""Public functions with arguments that they accept."""

for kind, body in (("Block", BLOCK), ("EquivalentBlock", FRAME)):
    CALLS |= {
        f"{kind}.boundary": (body.boundary, [{"motion": "sine", "restitution": 0.9}]),
        f"{kind}.history": (
            body.history,
            [{"duration": 1.0, "samples": 10} | more for more in (PULSE, SCALED, {"start": 0.01})],
        ),
        f"{kind}.response": (body.response, [PULSE | {"threads": 1}]),
        f"{kind}.spectrum": (body.spectrum, [PULSE, SCALED | {"size": [1.0]}]),
        f"{kind}.thresholds": (
            body.thresholds,
            [{"motion": "sine", "period": 0.5, "restitution": 0.9, "highest": 9.0, "resolution": 0.01}],
        ),
    }

CALLS |= {
    "RigidBody.from_polygon": (rocking.RigidBody.from_polygon, [{"vertices": [(0, 0), (0.3, 0), (0.2, 1)]} | SIZE]),
    "RigidBody.from_mesh": (rocking.RigidBody.from_mesh, [{"path": __file__, "direction": 0.5} | SIZE]),
    "RigidBody.boundary": (BODY.boundary, [{"motion": "sine", "restitution": 0.9}]),
    "RigidBody.history": (
        BODY.history,
        [{"motion": "sine", "peak_acceleration": 4.0, "period": 0.5, "restitution": 0.9, "duration": 1.0,
          "samples": 10}, {"motion": RECORD, "scale": 1.0}, {"start": 0.01}],
    ),
    "RigidBody.response": (
        BODY.response, [{"motion": "sine", "peak_acceleration": 4.0, "period": 0.5, "threads": 1}],
    ),
    "RigidBody.spectrum": (
        BODY.spectrum,
        [{"motion": "sine", "peak_acceleration": 4.0, "period": [0.5], "restitution": 0.9},
         {"motion": RECORD, "scale": 1.0, "size": [1.0]}],
    ),
    "suites.distribution": (
        rocking.suites.distribution,
        [{"ensemble": rocking.fragility(RECORD, BLOCK, intensity=[3.0]), "confidence": 0.9}],
    ),
    "RigidBody.thresholds": (
        BODY.thresholds,
        [{"motion": "sine", "period": 0.5, "highest": 9.0, "resolution": 0.01}],
    ),
}  # fmt: skip

RESULTS = {"suites.PulseFit", "paper.Quantity", "Block.top_displacement", "EquivalentBlock.top_displacement"}
"""What the package makes itself, and functions of its results, which may be nan."""

OPTIONAL = {
    "alpha", "threads", "relative_tolerance", "absolute_tolerance", "time_step", "duration", "samples",
    "uplift_acceleration", "top_height", "restitution", "scale", "vertical_scale", "highest", "size",
    "peak_acceleration", "period", "depth", "diameter", "mass_height", "mass", "friction", "pgv",
    "tail", "skip", "gyration", "start",
}  # fmt: skip
"""Arguments that may be None somewhere."""

SCALAR = re.compile(r"(units\.)?(float|int|Scalar|Restitution)( \| None)?")


def scalars(function: Callable[..., Any]) -> list[str]:
    """Return the names of the arguments that are annotated as one number."""
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
    """Yield public functions, classes and methods with arguments that are numbers."""
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


def test_every_public_function_with_a_number_is_asked():
    found = dict(public_functions(rocking))
    assert found.keys() - RESULTS == CALLS.keys()
    for name in found.keys() - RESULTS - {"pulse"}:
        assert set(found[name]) <= {key for given in CALLS[name][1] for key in given}, name


ASKED = [
    (name, number, argument)
    for name, (function, calls) in CALLS.items()
    for number, given in enumerate(calls)
    for argument in ([*given] if name == "pulse" else [key for key in scalars(function) if key in given])
]
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


@pytest.mark.parametrize(("name", "number", "argument"), ASKED)
def test_what_is_no_number_is_refused_by_its_name(name, number, argument):
    function, calls = CALLS[name]
    given = calls[number]
    for kind, wrong in WRONG.items():
        value = wrong(given[argument])
        if value is None and (argument in OPTIONAL or (name[:12], argument) == ("SampledPulse", "period")):
            continue
        with pytest.raises(InvalidArgumentError, match=rf"^`{argument}` = ") as caught:
            function(**given | {argument: value})
        assert caught.value.parameter == argument, kind
        if isinstance(value, list | tuple | np.ndarray):
            assert "one number in " in caught.value.allowed, kind


@pytest.mark.parametrize(
    "argument", ["threads", "samples", "nodes", "order", "voussoirs", "impacts", "most", "largest"]
)
def test_whole_numbers_are_whole(argument):
    for name, number, own in ASKED:
        if own == argument:
            function, calls = CALLS[name]
            with pytest.raises(InvalidArgumentError, match=rf"^`{argument}` = .*whole number") as caught:
                function(**calls[number] | {argument: calls[number][argument] + 0.5})
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
    for wrong in (1000.0, -20.0, np.inf):
        with pytest.raises(InvalidArgumentError, match=r"\[rad\]$"):
            rocking.peak_response("sine", **PROBLEM | {"alpha": wrong})


@pytest.mark.parametrize(
    ("argument", "text", "allowed"),
    [("alpha", "45%", "a number with its unit, such as 20 deg, 0.35 rad"),
     ("restitution", "145%", r"\[0, 1\] \[-\]"), ("restitution", "0.45", None), ("slenderness", "45 deg", None)],
)  # fmt: skip
def test_percentages_say_what_is_allowed(argument, text, allowed):
    with pytest.raises(InvalidArgumentError, match=allowed or "a percentage such as '45 %'"):
        rocking.peak_response("sine", **PROBLEM | {argument: text})
