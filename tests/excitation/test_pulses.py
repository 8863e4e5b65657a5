"""Pulses: independent definitions, unit peak, stationary phases, sign, final velocity and displacement of type C."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy import cos, exp, pi, sin, sqrt

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking._excitation.impulse import impulse_of
from rocking._excitation.pulses import (
    PULSE_NAMES,
    SinusoidalPulse,
    WaveletPulse,
    as_pulse,
    split_pulses,
)
from rocking._excitation.shapes import MAX_PIECES
from rocking._excitation.sinusoids import MAX_SINUSOIDS
from rocking._excitation.wavelets import MAX_POLYNOMIAL

PHI_1, PHI_2 = 0.0697034 * pi, 0.0409760 * pi
BETA = sqrt(6) * sqrt(3 - sqrt(6)) * exp(-(3 - sqrt(6)) / 2)


def antisymmetric(phi):
    z = phi / sqrt(3)
    return (z**2 - 3) * z * exp(-(z**2) / 2) / BETA


# name: (f(phi), start, end), from the definitions
PLAIN = {
    "sine": (sin, 0, 2 * pi),
    "cosine": (cos, 0, 2 * pi),
    "half_sine": (sin, 0, pi),
    "rectangular": (np.ones_like, 0, pi),
    "c1": (cos, PHI_1, 3 * pi - PHI_1),
    "c2": (cos, PHI_2, 5 * pi - PHI_2),
    "ricker": (lambda phi: (1 - phi**2 / 2) * exp(-(phi**2) / 4), -4 * pi, 4 * pi),
    "ricker_antisymmetric": (antisymmetric, -4 * pi, 4 * pi),
}
FAMILY = [(1.0 + 1e-6, 0.0), (1.3, 0.7), (2.0, 0.0), (2.0, pi / 2), (3.7, -1.0), (20.0, 2.0)]
EVERY = [rocking.pulse(name) for name in PULSE_NAMES]
EVERY += [rocking.pulse("mavroeidis_papageorgiou", cycles=g, phase=n) for g, n in FAMILY]


def label(pulse):
    return f"{pulse.name}-{pulse.end:.3f}"


def mavroeidis_papageorgiou(phi, gamma, nu):
    return -(sin(phi / gamma) * cos(phi + nu) + gamma * sin(phi + nu) * (1 + cos(phi / gamma)))


def test_every_name_has_a_definition_in_the_test():
    assert set(PULSE_NAMES) == {*PLAIN, "mavroeidis_papageorgiou"}


@pytest.mark.parametrize("name", PLAIN)
def test_definition(name):
    formula, start, end = PLAIN[name]
    pulse = rocking.pulse(name)
    assert (pulse.start, pulse.end) == pytest.approx((start, end), abs=2e-7 * pi)
    phi = np.linspace(pulse.start, pulse.end, 999)
    np.testing.assert_allclose(pulse.shape(phi), formula(phi), atol=1e-14)


@pytest.mark.parametrize(("gamma", "nu"), FAMILY)
def test_definition_of_mavroeidis_papageorgiou(gamma, nu):
    pulse = rocking.pulse("mavroeidis_papageorgiou", cycles=gamma, phase=nu)
    assert (pulse.start, pulse.end) == pytest.approx((-pi * gamma, pi * gamma))
    assert isinstance(pulse, SinusoidalPulse)
    assert len(pulse.terms) == 3
    phi = np.linspace(pulse.start, pulse.end, 400_001)
    plain = mavroeidis_papageorgiou(phi, gamma, nu)
    np.testing.assert_allclose(pulse.shape(phi), plain / np.abs(plain).max(), atol=2e-8)


@pytest.mark.parametrize("pulse", EVERY, ids=label)
def test_unit_peak(pulse):
    phi = np.linspace(pulse.start, pulse.end, 100_001)
    ends_and_turns = np.array([pulse.start, *pulse.stationary, pulse.end])
    assert np.abs(pulse.shape(ends_and_turns)).max() == pytest.approx(1, abs=4e-15)
    assert np.abs(pulse.shape(phi)).max() <= 1 + 4e-15


@pytest.mark.parametrize("pulse", EVERY, ids=label)
def test_stationary_phases_are_all_sign_changes_of_the_slope(pulse):
    # no stationary phase at a point
    phi = pulse.start + (pulse.end - pulse.start) * (np.arange(100_000) + 0.3137) / 100_000
    slope = np.diff(pulse.shape(phi))
    turns = np.flatnonzero(slope[:-1] * slope[1:] < 0)
    np.testing.assert_allclose(phi[turns + 1], pulse.stationary, atol=2 * (phi[1] - phi[0]))
    assert list(pulse.stationary) == sorted(pulse.stationary)
    for turn in pulse.stationary:
        assert pulse.start < turn < pulse.end
        central = (pulse.shape(turn + 1e-4) - pulse.shape(turn - 1e-4)) / 2e-4
        assert central == pytest.approx(0, abs=1e-7)


@pytest.mark.parametrize("pulse", EVERY, ids=label)
def test_mirror_image(pulse):
    mirrored = pulse.mirrored()
    phi = np.linspace(pulse.start, pulse.end, 101)
    np.testing.assert_array_equal(mirrored.shape(phi), -pulse.shape(phi))
    assert (mirrored.start, mirrored.end, mirrored.stationary) == (pulse.start, pulse.end, pulse.stationary)
    assert mirrored.name == "-" + pulse.name
    assert mirrored.mirrored() == pulse


@pytest.mark.parametrize("pulse", EVERY, ids=label)
def test_acceleration_is_zero_outside_the_window(pulse):
    outside = [pulse.start - 1e-6, pulse.end + 1e-6, -100.0, 100.0]
    np.testing.assert_array_equal(pulse.acceleration(outside), 0)
    inside = np.linspace(pulse.start, pulse.end, 11)
    np.testing.assert_array_equal(pulse.acceleration(inside), pulse.shape(inside))
    assert pulse.acceleration(np.zeros((2, 3))).shape == (2, 3)


@pytest.mark.parametrize("name", ["c1", "c2"])
def test_type_c_has_zero_final_velocity_and_displacement(name):
    pulse = rocking.pulse(name)
    x, w = np.polynomial.legendre.leggauss(60)  # exact for these
    half = (pulse.end - pulse.start) / 2
    phi = pulse.start + half * (x + 1)
    assert half * w @ pulse.shape(phi) == pytest.approx(0, abs=1e-13)
    assert half * w @ ((pulse.end - phi) * pulse.shape(phi)) == pytest.approx(0, abs=1e-12)
    span, x = (2 * int(name[1]) + 1) * math.pi, pulse.start  # its start is stated to all digits
    assert abs(math.cos(span - x) + (span - 2 * x) * math.sin(x) - math.cos(x)) < 1e-15


@pytest.mark.parametrize(
    ("text", "parameters", "name"),
    [
        ("mavroeidis_papageorgiou(cycles=3, phase=90deg)", {"cycles": 3, "phase": np.pi / 2}, "(cycles=3,phase=1.57"),
        ("-mavroeidis_papageorgiou ( phase = -0.5 rad )", {"phase": -0.5}, "(phase=-0.5rad)"),
        ("mavroeidis_papageorgiou(cycles=2)", {}, ""),
    ],
)
def test_a_text_states_the_parameters_of_a_pulse_and_its_name_makes_it_again(text, parameters, name):
    pulse = rocking.pulse(text)
    sign = "-" if "-m" in text else ""
    assert pulse == rocking.pulse(f"{sign}mavroeidis_papageorgiou", **parameters) == rocking.pulse(pulse.name)
    assert pulse.name.startswith(f"{sign}mavroeidis_papageorgiou{name}")
    assert rocking.pulse(np.str_(text)) == pulse


@pytest.mark.parametrize(
    ("text", "parameters", "message"),
    [
        *((name, {}, "`pulse`") for name in ("square", "", "--sine", "Sine", "sine ")),
        ("cosine(cycles=2)", {}, "`cycles` = '2' .* for cosine: no parameters"),
        ("cosine", {"cycles": 2.0}, r"`cycles` = 2\.0 .* for cosine: no parameters"),
        *(("sine", {"cycles": value}, "`cycles`") for value in (0, 1.5, 41)),
        ("mavroeidis_papageorgiou", {"colour": 2.0}, r"`colour`.*mavroeidis_papageorgiou: cycles and phase"),
        *(("mavroeidis_papageorgiou", {"cycles": value}, "`cycles`") for value in (1.0, 21.0)),
        *(("mavroeidis_papageorgiou", {"phase": value}, "`phase`") for value in (7.0, math.nan)),
        ("mavroeidis_papageorgiou(cycles=21)", {}, r"`cycles` = 21.0 .* \(1, 20\]"),
        ("mavroeidis_papageorgiou(phase=1)", {}, "`phase` = '1': missing unit"),
        ("mavroeidis_papageorgiou(cycles=2, cycles=3)", {}, "each parameter once"),
        ("mavroeidis_papageorgiou(3)", {}, "name=value"),
        ("mavroeidis_papageorgiou(cycles=3", {}, "one of sine"),
        ("sine" + "(" * 10_000, {}, "one of sine"),
    ],
)
def test_what_is_no_pulse_or_no_parameter_of_it_is_refused(text, parameters, message):
    with pytest.raises(InvalidArgumentError, match=message):
        rocking.pulse(text, **parameters)


@pytest.mark.parametrize("cycles", [1, 3, 40])
def test_a_harmonic_of_several_cycles_repeats_the_sine(cycles):
    pulse = rocking.pulse("sine", cycles=cycles)
    phase = np.linspace(0.1, 2 * np.pi - 0.1, 50)
    assert pulse.end == pytest.approx(2 * np.pi * cycles)
    np.testing.assert_allclose(pulse.shape(phase + pulse.end - 2 * np.pi), np.sin(phase), atol=1e-12)
    assert len(pulse.stationary) == 2 * cycles
    assert rocking.pulse(pulse.name) == pulse == rocking.pulse(f"sine(cycles={cycles})")


def test_commas_separate_pulses_except_within_brackets():
    assert split_pulses("sine, mavroeidis_papageorgiou(cycles=3,phase=1rad),c1") == [
        "sine", "mavroeidis_papageorgiou(cycles=3,phase=1rad)", "c1",
    ]  # fmt: skip
    assert len(split_pulses("1," * 1_000_000)) == 1_000_001  # in linear time


@pytest.mark.parametrize("pulse", EVERY, ids=label)
def test_stationary_phases_are_computed_if_not_given(pulse):
    coefficients = (pulse.terms,) if isinstance(pulse, SinusoidalPulse) else (pulse.polynomial, pulse.spread)
    copy = type(pulse)(pulse.name, pulse.start, pulse.end, (), *coefficients)
    np.testing.assert_allclose(copy.stationary, pulse.stationary, rtol=0, atol=3e-15 * max(1.0, pulse.end))


def scaled(kind, start, end, coefficients, *parameters):
    """A pulse of that shape, scaled to unit peak."""
    peak = 1.0
    for _ in range(8):  # the maximum lies between two points: the error message gives it
        divided = tuple((c[0] / peak, *c[1:]) if isinstance(c, tuple) else c / peak for c in coefficients)
        try:
            return kind("drawn", start, end, (), divided, *parameters)
        except InvalidArgumentError as error:
            assume(error.parameter == "max |f|" and error.value > 1e-3)
            peak *= error.value
    raise AssertionError(coefficients)


NUMBER = st.floats(-3.0, 3.0)
TERMS = st.lists(st.tuples(st.floats(0.1, 2.0), st.floats(0.0, 5.0), NUMBER), min_size=1, max_size=MAX_SINUSOIDS)
POLYNOMIALS = st.lists(NUMBER.map(lambda x: round(x, 3)), min_size=1, max_size=MAX_POLYNOMIAL)


def assert_monotone_between_turns(pulse):
    for low, high in pulse.monotone_pieces:
        assert low < high
        slope = np.diff(pulse.shape(np.linspace(low, high, 2001)))
        assert (slope > -4e-15).all() or (slope < 4e-15).all()
    assert np.abs(pulse.shape(np.linspace(pulse.start, pulse.end, 2001))).max() <= 1 + 2e-12


@given(terms=TERMS, start=NUMBER, length=st.floats(0.1, 20.0))
def test_all_stationary_phases_of_a_sum_of_sinusoids_are_found(terms, start, length):
    assert_monotone_between_turns(scaled(SinusoidalPulse, start, start + length, tuple(terms)))


@given(polynomial=POLYNOMIALS, spread=st.floats(0.5, 20.0), start=NUMBER, length=st.floats(0.1, 20.0))
def test_all_stationary_phases_of_a_wavelet_are_found(polynomial, spread, start, length):
    assert_monotone_between_turns(scaled(WaveletPulse, start, start + length, tuple(polynomial), spread))


def test_zeros_of_the_slope_of_order_three_count_and_of_order_two_do_not():
    flat = WaveletPulse("flat", -1.0, 1.0, (), (0.0, 0.0, 0.0, math.exp(0.01)), 100.0)  # phi^3: f' touches 0 at 0
    assert flat.stationary == flat.mirrored().stationary == ()
    terms = (4 / 3, 1.0, 0.0), (-1 / 3, 2.0, 0.0)  # f'' = 0 at the maximum too
    assert SinusoidalPulse("flat top", -2.0, 2.0, (), terms).stationary == pytest.approx((0.0,), abs=1e-5)


CONSTANT, SINE = ((1.0, 0.0, 0.0),), ((1.0, 1.0, -pi / 2),)


def sinusoids(terms=CONSTANT, start=0.0, end=1.0, stationary=(), name="x"):
    return lambda: SinusoidalPulse(name, start, end, stationary, terms)


def wavelet(polynomial=(1.0,), spread=4.0, start=-1.0):
    return lambda: WaveletPulse("x", start, 2.0, (), polynomial, spread)


@pytest.mark.parametrize(
    ("parameter", "make"),
    [
        ("name", sinusoids(name="")),
        ("start", sinusoids(start=math.nan)),
        ("end", sinusoids(start=1.0)),
        ("stationary", sinusoids(SINE, end=2 * pi, stationary=(pi / 2,))),
        ("stationary", sinusoids(SINE, end=2 * pi, stationary=(3 * pi / 2, pi / 2))),
        ("stationary", sinusoids(SINE, end=2 * pi, stationary=(pi / 2, 4.0))),
        ("stationary", sinusoids(((1.0, 1.0, 0.0),), end=MAX_PIECES * pi + 0.1)),
        ("max |f|", sinusoids(((2.0, 1.0, -pi / 2),), end=2 * pi)),
        ("max |f|", wavelet(start=1.0)),
        ("terms", sinusoids(())),
        ("terms", sinusoids(((1.0, 0.0),))),
        ("terms", sinusoids(((1.0, -1.0, 0.0),))),
        ("terms", sinusoids(((1 / (MAX_SINUSOIDS + 1), 0.0, 0.0),) * (MAX_SINUSOIDS + 1))),
        ("polynomial", wavelet(())),
        ("polynomial", wavelet((1.0,) + (0.0,) * MAX_POLYNOMIAL)),
        ("spread", wavelet(spread=0.0)),
        ("pulse", sinusoids((*CONSTANT, (0.5, 1.0, 0.0), (-0.5, 1.0, 0.0)))),
    ],
)
def test_pulses_outside_the_limits_of_the_solver_are_rejected(parameter, make):
    with pytest.raises(InvalidArgumentError) as error:
        make()
    assert error.value.parameter == parameter


def test_the_longest_pulse_has_a_response():
    pulse = SinusoidalPulse("long", 0.0, MAX_PIECES * pi, (), ((1.0, 1.0, 0.0),))
    assert len(pulse.monotone_pieces) == MAX_PIECES
    response = rocking.peak_response(pulse, slenderness=0.9, frequency_ratio=8.0, restitution=0.5)
    short = rocking.peak_response("cosine", slenderness=0.9, frequency_ratio=8.0, restitution=0.5)
    assert response.peak_rotation >= short.peak_rotation > 0.0


@pytest.mark.parametrize(
    ("pulse", "largest", "final", "total"),
    [
        ("sine", 2.0, 0.0, 4.0),
        ("cosine", 1.0, 0.0, 4.0),
        ("half_sine", 2.0, 2.0, 2.0),
        ("rectangular", math.pi, math.pi, math.pi),
        ("ricker", math.sqrt(2.0) * math.exp(-0.5), 0.0, 4.0 * math.sqrt(2.0) * math.exp(-0.5)),
    ],
)
def test_integrals_of_shapes_in_closed_form(pulse: str, largest: float, final: float, total: float) -> None:
    impulse = impulse_of(as_pulse(pulse))
    np.testing.assert_allclose([impulse.largest, impulse.final, impulse.total], [largest, final, total], atol=2e-13)


def test_pulses_that_leave_the_ground_moving_are_known_by_their_integral() -> None:
    assert {name for name in PULSE_NAMES if not impulse_of(as_pulse(name)).ends_at_rest} == {"half_sine", "rectangular"}


def test_a_sampled_pulse_is_integrated_exactly() -> None:
    impulse = impulse_of(rocking.SampledPulse([0.0, 1.0, -1.0, 0.5], period=2.0 * math.pi))
    np.testing.assert_allclose([impulse.largest, impulse.final, impulse.total], [0.75, 0.25, 1.0 + 1 / 3 + 1 / 12])
