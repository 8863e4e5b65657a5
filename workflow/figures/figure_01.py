"""Figure 1: the block, drawn to scale, and the pulse that moves its base."""

import matplotlib.patches as patches
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rocking._excitation.pulses import as_pulse
from rocking._model.block import RectangularBlock
from rocking.plot.style import BLUE, GREY, VERMILION, WIDTH
from workflow.figures.style import panel_letters, plotted


def data(
    *, pulse: str, width: float, height: float, rotation: float, peak_acceleration: float, period: float
) -> xr.Dataset:
    """Corners of the block at rest and rotated about its right corner, and the ground acceleration.

    `width`, `height`: b and h [m]; `rotation`: theta/alpha of the rotated block [-]; `peak_acceleration`: a_g [g];
    `period`: T_p [s].
    """
    block = RectangularBlock(width, height)
    theta = rotation * block.alpha
    b, h = 0.5 * width, 0.5 * height
    corners = np.array([[b, 0], [b, 2 * h], [-b, 2 * h], [-b, 0], [0, h]])  # the last one is the centre of mass
    turn = np.array([[np.cos(theta), np.sin(theta)], [-np.sin(theta), np.cos(theta)]])  # clockwise, about (b, 0)
    rotated = (corners - [b, 0]) @ turn.T + [b, 0]
    shape = as_pulse(pulse)
    time = np.linspace(0.0, (shape.end - shape.start) / (2 * np.pi) * period, 201)
    acceleration = peak_acceleration * shape.acceleration(shape.start + 2 * np.pi * time / period)
    return xr.Dataset(
        {
            "at_rest": plotted(("corner", "axis"), corners, "corners and centre of the block at rest", units="m"),
            "rotated": plotted(("corner", "axis"), rotated, "the same, rotated about the right corner", units="m"),
            "ground_acceleration": plotted("sample", acceleration, "ground acceleration in units of g", equation="3.2"),
        },
        coords={"time": plotted("sample", time, "time", units="s")},
        attrs={
            "title": "Geometry of the rigid rocking block and the pulse",
            "summary": "Block of the given half width and half height, drawn to scale, and the pulse under it.",
            "width": width,
            "height": height,
            "alpha": block.alpha,
            "rotation": theta,
            "pulse_name": pulse,
            "peak_acceleration": peak_acceleration,
            "period": period,
        },
    )


def draw(data: xr.Dataset) -> Figure:
    """The block on the left, the pulse on the right."""
    figure = Figure(figsize=(WIDTH, 3.1))
    left, right = figure.subplots(1, 2, width_ratios=[1, 1.3])
    _draw_block(left, data)
    _draw_pulse(right, data)
    panel_letters([left, right])
    return figure


def _draw_block(ax: Axes, data: xr.Dataset) -> None:
    rest, turned = data.at_rest.values, data.rotated.values
    b, h = 0.5 * data.attrs["width"], 0.5 * data.attrs["height"]
    pivot, centre = turned[0], turned[4]
    R = np.hypot(b, h)
    ax.set_aspect("equal")
    ax.set_axis_off()
    ax.add_patch(patches.Polygon(rest[:4], fill=False, linestyle="--", linewidth=0.8, edgecolor=GREY))
    ax.add_patch(patches.Polygon(turned[:4], facecolor="#E4EEF6", edgecolor=BLUE, linewidth=1.3))
    ax.plot([-2.6 * b, 3.6 * b], [0, 0], color="black", linewidth=1.2)
    ax.add_patch(patches.Rectangle((-2.6 * b, -0.1 * h), 6.2 * b, 0.1 * h, hatch="////", fill=False, linewidth=0))
    ax.plot(*centre, "o", color=BLUE, markersize=4)
    ax.plot(*np.transpose([centre, pivot]), color=BLUE, linewidth=1.0)
    ax.annotate("$R$", 0.25 * centre + 0.75 * pivot, xytext=(-11, -5), textcoords="offset points", color=BLUE)

    # the angle between the diagonal and the side that ends in the pivot is alpha, the side leans by theta
    side = turned[1] - pivot
    diagonal_angle = np.degrees(np.arctan2(*(centre - pivot)[::-1]))
    side_angle = np.degrees(np.arctan2(*side[::-1]))
    ax.plot([b, b], [1.35 * h, 2.25 * h], color=GREY, linewidth=0.6, linestyle=":")
    ax.add_patch(patches.Arc(pivot, 1.5 * R, 1.5 * R, theta1=side_angle, theta2=diagonal_angle, color=BLUE))
    _label_on_arc(ax, pivot, 0.84 * R, (side_angle + diagonal_angle) / 2, r"$\alpha$", BLUE)
    ax.add_patch(patches.Arc(pivot, 3.7 * R, 3.7 * R, theta1=side_angle, theta2=90, color=VERMILION))
    _label_on_arc(ax, pivot, 2.02 * R, side_angle - 1.0, r"$\theta > 0$", VERMILION)

    beside = np.array([-0.28 * h, 0.0])
    _dimension(ax, rest[3] + beside, rest[2] + beside)
    ax.annotate("$2h$", (rest[2] + rest[3]) / 2 + beside, xytext=(-10, 0), textcoords="offset points", ha="center")
    _dimension(ax, np.array([-b, -0.2 * h]), np.array([b, -0.2 * h]))
    ax.text(0, -0.24 * h, "$2b$", ha="center", va="top")
    ax.annotate("", (3.4 * b, -0.22 * h), (2.0 * b, -0.22 * h), arrowprops={"arrowstyle": "-|>", "color": VERMILION})
    ax.text(2.7 * b, -0.27 * h, r"$\ddot{u}_g(t) > 0$", ha="center", va="top", color=VERMILION)
    ax.annotate("", centre - [0, 0.42 * h], centre, arrowprops={"arrowstyle": "-|>", "shrinkA": 3})
    ax.annotate("$mg$", centre - [0, 0.36 * h], xytext=(-12, 0), textcoords="offset points", ha="center")
    for x, name, side in ((-b - 0.03 * h, "$O$", "right"), (b + 0.04 * h, "$O'$", "left")):
        ax.text(x, 0.02 * h, name, ha=side, va="bottom")
    _draw_axes(ax, np.array([2.6 * b, 1.0 * h]), 0.3 * h)
    ax.set_xlim(-2.7 * b, 3.9 * b)
    ax.set_ylim(-0.5 * h, 2.45 * h)


def _draw_axes(ax: Axes, origin: np.ndarray, length: float) -> None:
    """The axes whose unit orientations table 1 multiplies: x, y in the plane of the page, z out of it."""
    for name, direction in (("$x$", [1, 0]), ("$y$", [0, 1])):
        end = origin + length * np.array(direction)
        ax.annotate("", end, origin, arrowprops={"arrowstyle": "-|>", "color": GREY, "shrinkA": 3, "shrinkB": 0})
        ax.text(*(end + 0.25 * length * np.array(direction)), name, color=GREY, ha="center", va="center")
    ax.plot(*origin, "o", markersize=6, markerfacecolor="none", color=GREY, markeredgewidth=0.8)
    ax.plot(*origin, "o", markersize=1.5, color=GREY)
    ax.text(*(origin - 0.25 * length), "$z$", color=GREY, ha="center", va="center")


def _dimension(ax: Axes, start: np.ndarray, end: np.ndarray) -> None:
    ax.annotate("", end, start, arrowprops={"arrowstyle": "<->", "shrinkA": 0, "shrinkB": 0, "lw": 0.7})


def _label_on_arc(ax: Axes, centre: np.ndarray, radius: float, angle: float, text: str, color: str) -> None:
    place = centre + radius * np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    ax.text(*place, text, color=color, ha="center", va="center")


def _draw_pulse(ax: Axes, data: xr.Dataset) -> None:
    T, a = data.attrs["period"], data.attrs["peak_acceleration"]
    ax.plot(data.time, data.ground_acceleration, color=VERMILION)
    ax.axhline(0, color="black", linewidth=0.6)
    uplift = np.tan(data.attrs["alpha"])
    start = np.arcsin(uplift / a) * T / (2 * np.pi)
    ax.axhline(uplift, color=GREY, linewidth=0.7, linestyle="--")
    ax.annotate(r"$\tan\alpha$", (T, uplift), xytext=(0, 3), textcoords="offset points", ha="right", color=GREY)
    ax.plot(start, uplift, "o", color=BLUE, markersize=4)
    ax.annotate(f"uplift\n{start:.2f} s", (start, uplift), xytext=(8, -26), textcoords="offset points", color=BLUE)
    _dimension(ax, np.array([T / 4, 0]), np.array([T / 4, a]))
    ax.annotate("$a_g/g$", (T / 4, a * 0.2), xytext=(4, 0), textcoords="offset points")
    _dimension(ax, np.array([0, -1.2 * a]), np.array([T, -1.2 * a]))
    ax.text(T / 2, -1.18 * a, r"$T_p = 2\pi/\omega_g$", ha="center", va="bottom")
    ax.set_ylim(-1.35 * a, 1.2 * a)
    ax.set_xlabel("time since the start of the pulse [s]")
    ax.set_ylabel(r"ground acceleration $\ddot{u}_g/g$ [-]")
