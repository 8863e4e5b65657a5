"""Arguments that numpy would convert silently, and objects that are no pulse, are rejected by name."""

from functools import partial

import numpy as np
import pandas as pd
import pint
import pytest
import xarray as xr

import rocking
from rocking import InvalidArgumentError, paper
from rocking._base.errors import in_range
from rocking._excitation.pulses import AbstractPulse

GROUPS = {"slenderness": 0.4, "frequency_ratio": 5.0, "restitution": 0.85, "alpha": 0.2}
TIME = np.array(["2014-08-24T10:20:44"], dtype="datetime64[s]")
AMBIGUOUS = {
    "flags": np.array([True, False]),
    "flag": True,
    "complex": np.array([0.4 + 0.1j]),
    "text": np.array(["0.4"]),
    "bytes": b"0.4",
    "instants": TIME,
    "spans": TIME - TIME[0],
    "masked": np.ma.masked_array([0.4, 0.5], mask=[False, True]),
    "masked-constant": np.ma.masked,
    "objects": np.array([0.4, None], dtype=object),
    "object-flags": np.array([0.4, True], dtype=object),
    "ragged": [[0.4], [0.4, 0.5]],
    "labelled-text": xr.DataArray(["0.4"], dims="block"),
}


class Lookalike:
    """An object with the attributes of a pulse that does not derive from `AbstractPulse`."""

    name, start, end, stationary = "lookalike", 0.0, 1.0, ()

    def shape(self, phi):
        return np.ones_like(phi)


@pytest.mark.parametrize("value", AMBIGUOUS.values(), ids=AMBIGUOUS)
@pytest.mark.parametrize("name", GROUPS)
def test_values_that_are_not_real_numbers_are_rejected(name, value):
    with pytest.raises(
        InvalidArgumentError, match=rf"(?s)^`{name}` = .*allowed: real numbers, none of them masked, in"
    ) as e:
        rocking.peak_response("sine", **GROUPS | {name: value})
    assert e.value.parameter == name
    assert e.value.value is value or e.value.value is value.data  # of a labelled array


def test_texts_with_units_are_accepted_in_lists():
    block = rocking.Block("40 cm", "1.6 m")
    responses = block.response("sine", peak_acceleration=["0.4 g", "400 gal", 4.0], period="500 ms")
    expected = block.response("sine", peak_acceleration=[0.4 * 9.80665, 4.0, 4.0], period=0.5)
    np.testing.assert_array_equal(responses.rotation, expected.rotation)
    with pytest.raises(InvalidArgumentError, match=r"`peak_acceleration` = '0.4 s'.*such as 4 m/s\^2"):
        block.response("sine", peak_acceleration=["0.4 g", "0.4 s"], period=0.5)
    with pytest.raises(InvalidArgumentError, match="percentage"):
        rocking.peak_response("sine", **GROUPS | {"slenderness": ["0.4"]})


def test_restitution_from_momentum_where_the_angle_is_known():
    alpha = np.radians([15.0, 20.0])
    rigid = {"slenderness": 0.4, "frequency_ratio": 5.0}
    expected = rocking.peak_response("sine", **rigid, alpha=alpha, restitution=1.0 - 1.5 * np.sin(alpha) ** 2)
    assert rocking.peak_response("sine", **rigid, alpha=alpha, restitution="momentum") == expected
    labelled = xr.DataArray(alpha, dims="angle")
    response = rocking.peak_response("sine", **rigid, alpha=labelled, restitution="momentum")
    np.testing.assert_array_equal(response.peak_rotation, expected.peak_rotation)
    eta = rocking.Block.from_slenderness_angle("15 deg", 1.0).inelastic_restitution
    arguments = {"frequency_ratio": 5.0, "alpha": "15 deg"}
    assert rocking.time_history(
        "sine", slenderness=0.4, restitution="momentum", **arguments
    ).restitution == pytest.approx(eta)
    changes = rocking.thresholds("sine", restitution="momentum", **arguments).amplitude
    np.testing.assert_allclose(changes, rocking.thresholds("sine", restitution=eta, **arguments).amplitude, rtol=1e-9)
    for angle in (None, 0.0):
        with pytest.raises(InvalidArgumentError, match=r"`restitution` = 'momentum'.*needs `alpha` > 0"):
            rocking.peak_response("sine", **rigid, alpha=angle, restitution="momentum")


def test_samples_of_a_pulse_with_units():
    ureg = pint.UnitRegistry()
    expected = rocking.SampledPulse([0, 1, 0], time=[0.0, 0.1, 0.2], period=0.4)
    quantities = rocking.SampledPulse([0, 3, 0] * ureg.m / ureg.s**2, time=[0, 100, 200] * ureg.ms, period="400 ms")
    np.testing.assert_allclose(quantities.phases, expected.phases, rtol=1e-15)


def test_messages_are_short():
    with pytest.raises(InvalidArgumentError, match=r"\(DataArray\) is not allowed") as caught:
        rocking.Record(np.ones(3), xr.DataArray(np.linspace(0.1, 0.2, 1000)), "g")
    assert len(str(caught.value)) < 500


def test_real_numbers_of_any_type_are_accepted():
    expected = rocking.peak_response("sine", **GROUPS).peak_rotation
    unmasked = np.ma.masked_array([0.4], mask=[False])
    for value in (np.float32(0.5), 1, np.array([0.25], dtype=object), np.array([1], dtype=np.uint8), []):
        in_range("slenderness", value, 0.0, 1.0)
    for value in (unmasked, [0.4], pd.Series([0.4]), xr.DataArray([0.4], dims="block")):
        assert rocking.peak_response("sine", **GROUPS | {"slenderness": value}).peak_rotation == expected


LABELLED = {
    "coordinates": (
        xr.DataArray([0.3, 0.4], dims="block", coords={"block": [1, 2]}),
        xr.DataArray([4.0, 5.0], dims="block", coords={"block": [2, 1]}),
    ),
    "series": (pd.Series([0.3, 0.4], index=[1, 2]), pd.Series([4.0, 5.0], index=[2, 1])),
}


@pytest.mark.parametrize(("slenderness", "frequency_ratio"), LABELLED.values(), ids=LABELLED)
def test_arguments_with_different_labels_are_rejected(slenderness, frequency_ratio):
    groups = GROUPS | {"slenderness": slenderness, "frequency_ratio": frequency_ratio}
    with pytest.raises(
        InvalidArgumentError,
        match=r"`slenderness, frequency_ratio.*(equal indexes of a dimension|broadcast or align first)",
    ):
        rocking.peak_response("sine", **groups)
    plain = GROUPS | {"slenderness": slenderness.values, "frequency_ratio": frequency_ratio.values}
    assert rocking.peak_response("sine", **plain).shape == slenderness.shape


QUESTIONS = {
    "peak_response": lambda pulse: rocking.peak_response(pulse, **GROUPS),
    "time_history": lambda pulse: rocking.time_history(pulse, **GROUPS),
    "thresholds": lambda pulse: rocking.thresholds(pulse, frequency_ratio=5.0, restitution=0.85),
    "overturning_boundary": lambda pulse: rocking.overturning_boundary(pulse, restitution=0.85, nodes=16),
    "margin_without_impact": lambda pulse: paper.margin_without_impact(pulse, 2.0, 5.0),
}
NO_PULSES = {
    "none": None,
    "number": 5,
    "bytes": b"sine",
    "list": ["sine"],
    "array": np.array(["sine"]),
    "class": AbstractPulse,
    "lookalike": Lookalike(),
    "unknown": "square",
}


@pytest.mark.parametrize("pulse", NO_PULSES.values(), ids=NO_PULSES)
@pytest.mark.parametrize("ask", QUESTIONS.values(), ids=QUESTIONS)
def test_objects_that_are_no_pulse_are_rejected(ask, pulse):
    with pytest.raises(InvalidArgumentError, match=r"^`pulse` = .*mavroeidis_papageorgiou") as error:
        ask(pulse)
    assert error.value.value is pulse or error.value.value == pulse


BLOCK = rocking.Block(0.4, 1.6)
PULSE = {"peak_acceleration": 4.0, "period": 0.5}
NUMBERS = {
    "Block": (rocking.Block, {"width": 0.4, "height": 1.6}),
    "RigidBody": (rocking.RigidBody, {"left": 0.1, "right": 0.2, "height": 0.6, "gyration": 0.3}),
    "response": (partial(BLOCK.response, "sine"), PULSE | {"restitution": 0.9}),
    "history": (partial(BLOCK.history, "sine"), PULSE | {"restitution": 0.9, "duration": 3.0}),
    "thresholds": (partial(BLOCK.thresholds, "sine"), {"period": 0.5, "restitution": 0.9}),
    "peak_response": (partial(rocking.peak_response, "sine"), GROUPS),
    "time_history": (partial(rocking.time_history, "sine"), GROUPS | {"duration": 3.0}),
    "overturning_boundary": (partial(rocking.overturning_boundary, "sine"), {"restitution": 0.9, "alpha": 0.2}),
}
"""Functions, and numbers that they accept."""


@pytest.mark.parametrize(
    ("function", "numbers", "name"), [(*call, name) for call in NUMBERS.values() for name in call[1]]
)
def test_what_is_no_number_or_out_of_its_range_is_refused_by_its_name(function, numbers, name):
    for wrong in (np.nan, np.inf, -1.0, "wide", True, object(), 0.4 + 0.1j):
        with pytest.raises(InvalidArgumentError, match=rf"^`{name}`") as caught:
            function(**numbers | {name: wrong})
        assert caught.value.parameter == name


def test_the_place_of_a_wrong_number_is_named():
    with pytest.raises(InvalidArgumentError, match=r"`slenderness` = -1.0 at index 2 is not allowed") as caught:
        rocking.peak_response("sine", **GROUPS | {"slenderness": [0.4, 0.5, -1.0, -2.0]})
    assert (caught.value.parameter, caught.value.value, caught.value.index) == ("slenderness", -1.0, (2,))
    with pytest.raises(InvalidArgumentError, match=r"`restitution` = nan at index \(1, 0\) is"):
        rocking.peak_response("sine", **GROUPS | {"restitution": np.array([[0.1, 0.2], [np.nan, 2.0]])})


def test_angles_in_degrees_are_asked_about():
    with pytest.raises(InvalidArgumentError, match=r"\[rad\]; write '20 deg' if degrees were meant$"):
        rocking.peak_response("sine", **GROUPS | {"alpha": 20})
    with pytest.raises(InvalidArgumentError, match=r"at index 1 .*; numpy.radians converts degrees$"):
        rocking.peak_response("sine", **GROUPS | {"alpha": [0.1, 20.0]})
    for wrong in (1000.0, -20.0, np.inf, "95 deg"):
        with pytest.raises(InvalidArgumentError, match=r"\[rad\]$"):
            rocking.peak_response("sine", **GROUPS | {"alpha": wrong})
