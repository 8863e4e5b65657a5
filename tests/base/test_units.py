"""Units: one table, matched by name and never evaluated; quantities and texts are converted where they enter."""

import math
import time

import numpy as np
import pandas as pd
import pint
import pytest
import xarray as xr

import rocking
from rocking._base.errors import InvalidArgumentError, MissingUnitError, in_range, si_value
from rocking._base.units import UNITS, unit_name

REGISTRY = pint.UnitRegistry()
QUANTITY = REGISTRY.Quantity
GROUPS = {"slenderness": 0.4, "frequency_ratio": 5.0, "restitution": 0.85, "alpha": 0.2}
PINT_NAMES = {"m/s2": "m/s**2", "cm/s2": "cm/s**2", "mm/s2": "mm/s**2", "in/s2": "in/s**2", "ft/s2": "ft/s**2",
              "g": "standard_gravity", "mg": "millistandard_gravity", "%g": "centistandard_gravity",
              "g/10": "decistandard_gravity", "gal": "cm/s**2", "%": "percent",
              "-": "", "N": "N/standard_gravity", "kN": "kN/standard_gravity"}  # fmt: skip

HOSTILE = [
    "9**16000000/9**16000000 m", "9**9**9 m", "2**3 m", "1+1 m", "m*m/m", "1e999 m", "nan m", "inf m", "1_0 m", "m",
    "__import__('os') m", "(" * 30 + "1 m", "0x10 m", "1 m" + " " * 100_000 + "x", "9" * 100_000 + " m",
    " " * 100_000 + "1", "1" + "e1" * 50_000, "1 " + "s" * 100_000, "١ m",
]  # fmt: skip


@pytest.mark.parametrize(("unit", "name"), [(unit, name) for unit, names in UNITS.items() for name in names])
def test_values_of_units_are_those_of_another_library(unit, name):
    pint_name = name if unit == "kg" and name == "g" else PINT_NAMES.get(name, name)
    reference = QUANTITY(1.0, pint_name).to("" if unit == "-" else PINT_NAMES.get(unit, unit))
    for text in (f"3 {name}", f"3{name.upper()}", f"  +3.0e0 {name} "):
        assert si_value("any", text, unit) == pytest.approx(3.0 * reference.magnitude, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "name"),
    [("M/S^2", "m/s2"),
     ("m/s**2", "m/s2"), ("m s-2", "m/s2"), ("m s^-2", "m/s2"), ("(m/s²)", "m/s2"),
     ("m/s/s", "m/s2"), ("cm/sec2", "cm/s2"), ("CM/SEC/SEC", "cm/s2"),
     ("cm/sec^2", "cm/s2"), ("Gal", "gal"), ("gals", "gal"), ("G", "g"),
     ("m * s-2", "m/s2"), ("m·s⁻²", "m/s2"), ("m/sec²", "m/s2"), ("cm/sec/sec", "cm/s2"), ("G/10", "g/10"),
     ("% g", "%g"), ("(%g)", "%g"), ("milli-g", "mg"), ("g s-1", None),
     ("mgal", None), ("m*s2", None), ("kg", None), ("m", None), ("", None)],
)  # fmt: skip
def test_readers_of_records_and_people_write_the_same_units(text, name):
    assert unit_name(text, "m/s2") == name


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("text", HOSTILE, ids=lambda text: text[:20])
def test_units_are_never_evaluated(text, unit):
    started = time.process_time()
    with pytest.raises(InvalidArgumentError):
        si_value("any", text, unit)
    assert time.process_time() - started < 0.5


@pytest.mark.parametrize(
    ("name", "quantity"),
    [("slenderness", QUANTITY(40.0, "percent")), ("restitution", QUANTITY(85.0, "percent")),
     ("alpha", QUANTITY(math.degrees(0.2), "degree")), ("alpha", QUANTITY(200.0, "milliradian")),
     ("frequency_ratio", QUANTITY(5.0, "m/m")), ("alpha", "200 mrad"), ("slenderness", "40 %"), ("restitution", "85%")],
    ids=str,
)  # fmt: skip
def test_quantities_in_groups_are_converted(name, quantity):
    expected = rocking.peak_response("sine", **GROUPS).peak_rotation
    rotation = rocking.peak_response("sine", **GROUPS | {name: quantity}).peak_rotation
    assert 0.0 < expected == pytest.approx(rotation, rel=1e-12)


@pytest.mark.parametrize(
    "angles",
    [QUANTITY([10.0, 20.0], "degree"), [QUANTITY(10.0, "degree"), math.radians(20.0)],
     np.array([QUANTITY(10.0, "degree"), QUANTITY(20.0, "degree")], dtype=object),
     xr.DataArray(QUANTITY([10.0, 20.0], "degree"), dims="block"),
     np.array(["10 deg", "20 deg"]), xr.DataArray(["10 deg", "20 deg"], dims="block"), pd.Series(["10 deg", "20 deg"])],
    ids=["array", "list", "objects", "labelled", "texts", "labelled texts", "texts of pandas"],
)  # fmt: skip
def test_arrays_of_quantities_are_converted(angles):
    expected = rocking.peak_response("sine", **GROUPS | {"alpha": np.radians([10.0, 20.0])})
    np.testing.assert_allclose(rocking.peak_response("sine", **GROUPS | {"alpha": angles}).peak_rotation,
                               expected.peak_rotation, rtol=1e-12)  # fmt: skip


def test_coordinates_of_labelled_texts_are_numbers():
    widths, peaks = xr.DataArray(["30 cm", "0.4 m"], dims="w"), xr.DataArray(["0.3 g", "5 m/s2"], dims="a")
    response = rocking.RigidBody.from_size(widths, "1.6 m").response("sine", peak_acceleration=peaks, period="1 s")
    assert response.sizes == {"w": 2, "a": 2}
    np.testing.assert_allclose(response["left"], [0.15, 0.2], rtol=1e-15)
    np.testing.assert_allclose(response["peak_acceleration"], [0.3 * 9.80665, 5.0], rtol=1e-15)


class OtherQuantity(np.ndarray):
    """An array with a unit as astropy has it: a subclass, `unit` and `value`."""

    def __new__(cls, values, unit):
        array = np.asarray(values, dtype=float).view(cls)
        array.unit = unit
        return array

    def to(self, unit):
        if (self.unit, unit) != ("deg", "rad"):
            raise ValueError("no such conversion")
        return OtherQuantity(np.radians(np.asarray(self)), "rad")

    @property
    def value(self):
        return np.asarray(self)


def test_quantities_of_other_libraries_are_converted_or_refused():
    assert in_range("alpha", OtherQuantity([10.0, 20.0], "deg"), 0.0, 1.57, unit="rad").tolist() == [
        math.radians(10.0), math.radians(20.0)
    ]  # fmt: skip
    with pytest.raises(InvalidArgumentError, match=r"converted to \[m\]"):
        in_range("width", OtherQuantity([10.0], "deg"), 0.0, 1.0, unit="m")


@pytest.mark.parametrize("unit", ["m", "m/s", "m/s2", "s", "rad/s", "kg", "kg m2", "N m", "1/year"])
def test_a_quantity_of_another_dimension_is_refused(unit):
    with pytest.raises(InvalidArgumentError, match="can be converted to") as caught:
        in_range("any", QUANTITY(1.0, "kelvin"), 0.0, 2.0, unit=unit)
    assert caught.value.parameter == "any"


def test_quantities_of_several_base_units_are_converted():
    assert in_range("inertia", QUANTITY(2.0, "tonne * m**2"), 0.0, math.inf, unit="kg m2") == pytest.approx(2000.0)
    assert in_range("stiffness", QUANTITY(2.0, "kN * m"), 0.0, math.inf, unit="N m") == pytest.approx(2000.0)


def test_records_of_quantities():
    plain = rocking.Record([0.1, 0.2, -0.1], 0.01, "g")
    for step in (QUANTITY(10.0, "ms"), "10 ms", "0.01 s"):
        assert rocking.Record([0.1, 0.2, -0.1], step, "g").time_step == pytest.approx(0.01, rel=1e-15)
    samples = QUANTITY([0.1, 0.2, -0.1], "standard_gravity")
    for unit in ("g", "m/s2", "gal"):
        np.testing.assert_allclose(rocking.Record(samples, 0.01, unit).acceleration, plain.acceleration, rtol=1e-12)
    assert plain.resampled("5 ms").time_step == 0.005


BLOCK = rocking.Block(0.4, 1.6)


@pytest.mark.parametrize("sizes", [("20 cm", "800 mm"), (QUANTITY(20, "cm"), QUANTITY(0.8, "m")), (0.2, "0.8m")])
def test_blocks_of_quantities_hold_floats(sizes):
    block = rocking.Block(*sizes, gravity="1 g")
    assert type(block.width) is type(block.height) is type(block.gravity) is float
    assert (block.width, block.height) == pytest.approx((0.2, 0.8), rel=1e-15)
    assert block.gravity == BLOCK.gravity
    angle = rocking.Block.from_slenderness_angle("20 deg", QUANTITY(100, "cm"))
    assert (angle.alpha, angle.half_diagonal) == pytest.approx((math.radians(20.0), 1.0), rel=1e-15)


@pytest.mark.parametrize("peak", ["0.4 g", QUANTITY(0.4, "standard_gravity"), 0.4 * 9.80665])
@pytest.mark.parametrize("period", ["500 ms", QUANTITY(500, "ms"), 0.5])
def test_ground_motions_of_quantities(peak, period):
    expected = BLOCK.response("sine", peak_acceleration=0.4 * 9.80665, period=0.5)
    response = BLOCK.response("sine", peak_acceleration=peak, period=period, restitution="momentum")
    assert response.rotation == pytest.approx(expected.rotation, rel=1e-12)
    assert isinstance(response.peak_acceleration, float)
    assert isinstance(response.period, float)
    history = BLOCK.history("sine", peak_acceleration=peak, period=period, duration="900 ms", samples=10)
    assert float(history["time"][-1]) == pytest.approx(0.9)
    spectrum = BLOCK.spectrum("sine", peak_acceleration=peak, period=QUANTITY([400, 500], "ms"))
    assert float(spectrum["rotation"][1]) == pytest.approx(expected.rotation, rel=1e-12)


def test_equivalent_blocks_of_quantities():
    block = rocking.EquivalentBlock("10 deg", QUANTITY(2.0, "rad/s"), restitution="90 %", uplift_acceleration="0.1 g")
    assert (block.alpha, block.frequency_parameter, block.momentum_restitution) == (math.radians(10.0), 2.0, 0.9)
    assert block.uplift_acceleration == pytest.approx(0.980665, rel=1e-15)
    arch = rocking.EquivalentBlock.masonry_arch(radius="1000 cm", thickness="1.5 m", embrace="157.5 deg", voussoirs=7)
    plain = rocking.EquivalentBlock.masonry_arch(radius=10.0, thickness=1.5, embrace=math.radians(157.5), voussoirs=7)
    assert arch.alpha == pytest.approx(plain.alpha, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [("0.4", MissingUnitError, "missing unit: write 0.4m/s2 or 0.4g"),
     ("40 cm", InvalidArgumentError, "a number with its unit, such as 4 m/s"),
     ("-1 g", InvalidArgumentError, r"\(0, inf\) \[m/s2\]")],
)  # fmt: skip
def test_texts_that_are_no_acceleration_say_what_is_allowed(text, error, message):
    with pytest.raises(error, match=f"^`peak_acceleration` = .*{message}"):
        BLOCK.response("sine", peak_acceleration=text, period=0.5)


@pytest.mark.parametrize(
    ("peak", "warned"),
    [(0.6, True), (np.float64(0.6), True), (1, True), ("0.6 m/s2", False), (QUANTITY(0.6, "m/s**2"), False),
     (0.2, False), (2.46, False), ("0.6 g", False)],
    ids=str,
)  # fmt: skip
def test_a_bare_acceleration_that_looks_like_g_gives_a_warning(peak, warned):
    response = BLOCK.response("sine", peak_acceleration=peak, period=0.5)
    texts = [text for text in response.warnings if "if it was meant in g" in text]
    assert bool(texts) == warned
    if warned:
        assert texts[0].startswith(f"peak_acceleration = {float(peak):.4g} m/s2 is below the uplift acceleration 2.452")
        assert texts[0].endswith(f"write '{float(peak):.4g} g'")
