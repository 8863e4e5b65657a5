"""Figure 5: two blocks of different size and shape under different pulses, in degrees and seconds."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from rocking._model.block import STANDARD_GRAVITY, RectangularBlock
from rocking.plot.style import BLUE, VERMILION, WIDTH
from workflow.figures.dimensional import DimensionalProblem
from workflow.figures.style import panel_letters, plotted


def data(
    *,
    pulse: str,
    restitution: float,
    slenderness: float,
    frequency_ratio: float,
    slenderness_angle: Sequence[float],
    half_diagonal: Sequence[float],
    duration: float,
) -> xr.Dataset:
    """Histories of two blocks with equal groups (4.11), each integrated in SI units.

    `restitution`: eta [-]; `slenderness`, `frequency_ratio`: 1/a and omega [-], the same for both; `slenderness_angle`,
    `half_diagonal`: alpha [rad] and R [m] of each block; `duration`: tau = p t at the end [-].
    """
    blocks = [
        RectangularBlock.from_slenderness_angle(alpha, R)
        for alpha, R in zip(slenderness_angle, half_diagonal, strict=True)
    ]
    groups = slenderness, frequency_ratio, restitution
    problems = [DimensionalProblem.with_groups(pulse, block, *groups) for block in blocks]
    times = np.array([np.linspace(0, duration / block.frequency_parameter, 1201) for block in blocks])
    motions = [one.history(time) for one, time in zip(problems, times, strict=True)]
    ground = [one.ground_acceleration(time) / STANDARD_GRAVITY for one, time in zip(problems, times, strict=True)]
    dims = ("block", "sample")

    def each(values: Sequence[float], long_name: str, units: str = "1") -> xr.Variable:
        return plotted("block", values, long_name, units=units)

    return xr.Dataset(
        {
            "rotation": plotted(dims, [theta for theta, _ in motions], "rotation theta", units="rad"),
            "angular_velocity": plotted(dims, [velocity for _, velocity in motions], "velocity", units="rad s-1"),
            "ground_acceleration": plotted(dims, ground, "ground acceleration in units of g"),
            "alpha": each(slenderness_angle, "slenderness angle", "rad"),
            "half_diagonal": each(half_diagonal, "half diagonal R", "m"),
            "frequency_parameter": each([b.frequency_parameter for b in blocks], "frequency parameter p", "rad s-1"),
            "peak_acceleration": each([s.peak_acceleration for s in problems], "a_g", "m s-2"),
            "period": each([s.period for s in problems], "T_p", "s"),
        },
        coords={"time": plotted(dims, times, "time since the start of the pulse", units="s")},
        attrs={
            "title": "Two rocking blocks of different size and shape with equal groups",
            "summary": "Linearised motion (3.2) integrated in SI units; 1/a, omega and eta are equal.",
            "pulse_name": pulse,
            "restitution": restitution,
            "slenderness": slenderness,
            "frequency_ratio": frequency_ratio,
        },
    )


def draw(data: xr.Dataset) -> Figure:
    """Ground acceleration, rotation and angular velocity over time, both blocks in each panel."""
    figure = Figure(figsize=(WIDTH, 4.6))
    axes = figure.subplots(3, 1, sharex=True, height_ratios=[0.8, 1, 1])
    panels = (
        ("ground_acceleration", 1.0, r"$\ddot{u}_g/g$ [-]"),
        ("rotation", 180 / np.pi, r"rotation $\theta$ [°]"),
        ("angular_velocity", 180 / np.pi, r"velocity $\dot{\theta}$ [°/s]"),
    )
    for ax, (name, scale, label) in zip(axes, panels, strict=True):
        for k, (colour, style) in enumerate(((BLUE, "-"), (VERMILION, "--"))):
            ax.plot(data.time[k], scale * data[name][k], color=colour, linestyle=style, label=_describe(data, k))
        ax.axhline(0, color="black", linewidth=0.5)
        ax.set_ylabel(label)
    axes[0].legend(loc="upper right")
    axes[-1].set_xlabel("time since the start of the pulse [s]")
    axes[-1].set_xlim(0, float(data.time.max()))
    panel_letters(axes)
    return figure


def _describe(data: xr.Dataset, k: int) -> str:
    one = data.isel(block=k)
    return (
        rf"$\alpha={np.degrees(one.alpha):.1f}$°, $R={float(one.half_diagonal):g}$ m, "
        rf"$a_g={float(one.peak_acceleration) / STANDARD_GRAVITY:.2f}\,g$, $T_p={float(one.period):.2f}$ s"
    )
