"""Figure 3: overturning after an impact inside the pulse (case 1.1), exact against semi-analytical."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from rocking.paper.approximation import semi_analytical_amplitudes, within_pulse
from rocking.paper.motion import angular_velocity, pulse_end
from rocking.paper.overturning import amplitude_of_impact_time, case_1_1_amplitudes, case_1_1_end, overturning_condition
from rocking.plot.style import BLACK, BLUE, GREY, WIDTH, shades
from workflow.figures.style import panel_letters, plotted

IMPACT_TIMES = 1500  # times of impact among which solutions beyond the pulse are looked for [-]


def data(*, restitution: Sequence[float], frequency_ratio: Mapping[str, float]) -> xr.Dataset:
    """Amplitudes between which case 1.1 overturns, by (3.20) with (3.21) and by (3.30), over frequency ratio.

    `restitution`: eta [-]; `frequency_ratio`: low, high [-] and points of the axis.
    """
    eta = np.array(restitution)
    omega = np.linspace(frequency_ratio["low"], frequency_ratio["high"], int(frequency_ratio["points"]))
    # each curve ends at its own frequency ratio, which is added so that the tip is drawn to its end
    tips = case_1_1_end(eta) * (1 - 1e-9)
    omega = np.union1d(omega, tips[(tips > omega[0]) & (tips < omega[-1])])
    exact = case_1_1_amplitudes(omega, eta[:, None])
    approximate = semi_analytical_amplitudes(omega, eta[:, None]).lower
    known = np.isfinite(approximate)
    valid = known & within_pulse(np.where(known, approximate, 2.0), omega)
    dims = ("restitution", "frequency_ratio")
    no_event = {"comment": "the impact would follow the pulse, which the equations do not describe: no event"}
    return xr.Dataset(
        {
            "lower": plotted(dims, exact.lower, "amplitude a from which case 1.1 overturns", equation="3.20, 3.21"),
            "upper": plotted(dims, exact.upper, "amplitude a up to which case 1.1 overturns", equation="3.31"),
            "semi_analytical": plotted(
                dims, np.where(valid, approximate, np.nan), "smallest solution a inside the pulse", equation="3.30"
            ),
            "difference": plotted(
                dims, np.where(valid, approximate / exact.lower - 1, np.nan), "semi-analytical over exact, less one"
            ),
            "lower_beyond": plotted(
                dims,
                _beyond(omega, eta),
                "solution of the exact equations beyond the pulse",
                equation="3.20, 3.21",
                **no_event,
            ),
        },
        coords={
            "restitution": plotted("restitution", eta, "coefficient of restitution"),
            "frequency_ratio": plotted("frequency_ratio", omega, "frequency ratio omega_g/p"),
        },
        attrs={
            "title": "Overturning after one impact inside the sine pulse (case 1.1)",
            "summary": "Amplitudes a = a_g/(g alpha) by the exact impact time and by the ad hoc approximation of it.",
        },
    )


def _beyond(omega: np.ndarray, eta: np.ndarray) -> np.ndarray:
    """Amplitudes (restitution, omega) that solve (3.20) with (3.21) for an impact after the pulse; nan if none."""
    tau = np.linspace(0.3, 3.0, IMPACT_TIMES)[:, None, None]
    a = amplitude_of_impact_time(tau, omega)
    a, tau = np.broadcast_arrays(a, tau)
    condition = overturning_condition(a, omega, eta[:, None], tau, angular_velocity(a, omega, tau))
    change = (np.diff(np.sign(condition), axis=0) != 0) & (tau > pulse_end(a, omega))[1:]
    first = change.argmax(axis=0)[None]
    low, high = (np.take_along_axis(condition, first + k, axis=0)[0] for k in (0, 1))
    ends = (np.take_along_axis(np.broadcast_to(a, condition.shape), first + k, axis=0)[0] for k in (0, 1))
    left, right = ends
    return np.where(change.any(axis=0), left + (right - left) * low / (low - high), np.nan)


def draw(data: xr.Dataset) -> Figure:
    """Curves on the left, relative difference of the smallest solutions on the right."""
    figure = Figure(figsize=(WIDTH, 3.1))
    left, right = figure.subplots(1, 2, width_ratios=[1.35, 1])
    omega = data.frequency_ratio.values
    exact, approximate = {"color": BLACK, "linewidth": 1.0}, {"color": BLUE, "linewidth": 2.4}
    for colour, eta in zip(shades(data.restitution.size), data.restitution.values, strict=True):
        curve = data.sel(restitution=eta)
        left.plot(omega, curve.semi_analytical, **approximate)
        left.plot(omega, curve.lower, **exact)
        left.plot(omega, curve.lower_beyond, **(exact | {"linewidth": 0.4}))
        end = int(np.flatnonzero(np.isfinite(curve.lower.values))[-1])
        left.annotate(
            f"{eta:.2f}", (omega[end], float(curve.lower[end])), xytext=(-2, 4), textcoords="offset points",
            rotation=60, rotation_mode="anchor", fontsize=6.5,
        )  # fmt: skip
        right.plot(omega, 100 * curve.difference, color=colour, label=rf"$\eta={eta:.2f}$")
    left.plot(omega, data.upper.max("restitution"), color=GREY, linewidth=0.9)
    place = data.upper.max("restitution").sel(frequency_ratio=1.5, method="nearest")
    left.annotate("(3.31)", (float(place.frequency_ratio), float(place)), xytext=(-6, 6),
                  textcoords="offset points", ha="right", color=GREY)  # fmt: skip
    left.annotate(
        "smallest solution:\noverturning begins", (3.1, 1.44), (3.6, 1.08), fontsize=7,
        arrowprops={"arrowstyle": "-", "linewidth": 0.5},
    )  # fmt: skip
    left.plot([], [], label="numerical, (3.20) and (3.21)", **exact)
    left.plot([], [], label="semi-analytical, (3.30)", **approximate)
    left.plot([], [], label="thin: impact beyond the pulse", **(exact | {"linewidth": 0.4}))
    left.text(3.62, 2.68, r"$\eta=$", fontsize=6.5)
    left.legend(loc="upper left", fontsize=6.5)
    left.set_ylim(1.0, 4.6)
    left.set_xlim(omega[0], omega[-1])
    left.set_xlabel(r"frequency ratio $\omega=\omega_g/p$ [-]")
    left.set_ylabel(r"amplitude $a=a_g/(g\alpha)$ [-]")
    right.axhline(0, color=GREY, linewidth=0.5)
    right.set_xlabel(r"frequency ratio $\omega=\omega_g/p$ [-]")
    right.set_ylabel("difference of the smallest solutions [%]")
    right.legend(loc="lower right")
    right.set_xlim(omega[0], omega[-1])
    panel_letters([left, right])
    return figure
