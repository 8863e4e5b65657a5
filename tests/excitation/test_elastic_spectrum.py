"""Elastic spectra: against another package, and against an integration with events."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rocking

TIMES = np.arange(0, 4, 0.01)
MOTION = rocking.Record(np.sin(7 * TIMES) * np.sin(2.1 * TIMES**2) * np.exp(-TIMES) * 3, 0.01, "m/s2", vertical=TIMES)

EQSIG = {
    0.02: [7.98787e-05, 0.003289669, 0.06115672, 0.1516137],
    0.2: [7.985389e-05, 0.003261166, 0.0377711, 0.09598325],
}
"""S_D [m] by eqsig 1.2.17 (MIT licence), `eqsig.sdof.pseudo_response_spectra` of the motion, interpolated to steps of
0.5 ms and followed by 10 s of rest, at periods of 0.05, 0.3, 1 and 3 s."""


def test_it_agrees_with_eqsig() -> None:
    """Seven digits."""
    found = rocking.elastic_spectrum(MOTION, [0.05, 0.3, 1.0, 3.0], list(EQSIG))
    assert found.displacement.values == pytest.approx(np.array(list(EQSIG.values())), rel=1e-5)
    omega = 2 * np.pi / found.period
    np.testing.assert_allclose(found.pseudo_acceleration, found.displacement * omega**2)


@pytest.mark.parametrize(("period", "zeta"), [(0.02, 0.05), (0.07, 0.0), (0.7, 0.3), (5.0, 0.05)])
def test_it_is_exact_between_samples_and_after_the_record(period: float, zeta: float) -> None:
    """DOP853 over each step with the times of zero velocity; short periods and the free vibration included."""
    short = rocking.Record(MOTION.acceleration[:60], 0.01, "m/s2")
    omega, a, state, largest = 2 * np.pi / period, short.acceleration, np.zeros(2), 0.0
    for k in range(a.size):
        last = k == a.size - 1
        slope = 0.0 if last else (a[k + 1] - a[k]) / 0.01

        def rate(t, y, k=k, slope=slope, last=last):  # type: ignore[no-untyped-def]
            return [y[1], -2 * zeta * omega * y[1] - omega**2 * y[0] - (0.0 if last else a[k] + slope * t)]

        options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-16, "events": lambda _, y: y[1]}
        way = solve_ivp(rate, (0, period if last else 0.01), state, **options)
        state = way.y[:, -1]
        largest = max([largest, abs(state[0]), *(abs(y[0]) for y in way.y_events[0])])
    assert rocking.elastic_spectrum(short, period, zeta).displacement.item() == pytest.approx(largest, rel=1e-9)


def test_limits_and_errors() -> None:
    """A stiff oscillator follows either component of the ground; a component that is absent is refused."""
    for component, peak in (("horizontal", MOTION.peak_acceleration), ("vertical", TIMES[-1])):
        found = rocking.elastic_spectrum(MOTION, 1e-3, component=component).pseudo_acceleration.item()
        assert found == pytest.approx(peak, rel=1e-3)
    level = rocking.Record(MOTION.acceleration, 0.01, "m/s2")
    with pytest.raises(rocking.InvalidArgumentError, match="no vertical component"):
        rocking.elastic_spectrum(level, 1.0, component="vertical")
    for name, wrong in (("periods", {"periods": [[1.0]]}), ("damping", {"periods": 1.0, "damping": 1.0})):
        with pytest.raises(rocking.InvalidArgumentError, match=name):
            rocking.elastic_spectrum(level, **wrong)
