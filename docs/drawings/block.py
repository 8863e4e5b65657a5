"""The block at rest and rotated, with its symbols and their names, to scale."""

import math
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, Polygon, Rectangle

from rocking.plot.style import BLUE, GREY, VERMILION

b, h, theta = 0.3, 0.8, 0.16
alpha, R = math.atan2(b, h), math.hypot(b, h)
corners = np.array([[b, 0.0], [b, 2 * h], [-b, 2 * h], [-b, 0.0], [0.0, h]])  # the last one is the centre of mass
turn = np.array([[math.cos(theta), -math.sin(theta)], [math.sin(theta), math.cos(theta)]])
rotated = (corners - corners[0]) @ turn + corners[0]  # clockwise about the right corner

figure, axes = plt.subplots(1, 2, figsize=(7.0, 4.2), sharey=True)
for ax, points, title in zip(axes, (corners, rotated), ("at rest", "rocking about the right corner"), strict=True):
    ax.add_patch(Polygon(points[:4], facecolor="#E4EEF6", edgecolor=BLUE, linewidth=1.3))
    ax.add_patch(Rectangle((-0.9, -0.06), 2.0, 0.06, hatch="////", fill=False, linewidth=0.0))
    ax.plot([-0.9, 1.1], [0.0, 0.0], color="black")
    ax.plot(*points[4], "o", color=BLUE, markersize=4)
    ax.set(title=title, xlim=(-0.9, 1.1), ylim=(-0.4, 1.75), aspect="equal")
    ax.set_axis_off()


def arrow(ax: Axes, start: Any, end: Any, style: str = "<->", color: str = "black") -> None:
    """Draw a line with heads between two points."""
    ax.annotate("", end, start, arrowprops={"arrowstyle": style, "color": color, "shrinkA": 0, "shrinkB": 0})


rest, rocking = axes
arrow(rest, (-b, -0.13), (b, -0.13))
rest.text(0.0, -0.17, "width = $2b$", ha="center", va="top")
arrow(rest, (-b - 0.08, 0.0), (-b - 0.08, 2 * h))
rest.text(-b - 0.11, h, "height = $2h$", ha="right", va="center", rotation=90)
arrow(rest, (b, 0.0), (0.0, h), "-", BLUE)
rest.text(0.06, 0.42, "$R$", color=BLUE, ha="center")
rest.add_patch(Arc((b, 0.0), 0.9, 0.9, theta1=90, theta2=90 + math.degrees(alpha), color=BLUE))
rest.text(b - 0.08, 0.49, r"$\alpha$", color=BLUE, ha="center")
rest.text(b + 0.06, 1.25, "$R$: half_diagonal\n$\\alpha$: $\\tan\\,\\alpha = b/h$\n$p=\\sqrt{3g/(4R)}$", va="center")
arrow(rest, (0.0, h), (0.0, h - 0.3), "-|>")
rest.text(-0.05, h - 0.2, "$mg$", ha="right")
arrow(rest, (0.55, -0.16), (0.95, -0.16), "-|>", VERMILION)
rest.text(0.75, -0.2, "ground\nacceleration > 0", color=VERMILION, ha="center", va="top")

rocking.plot([b, b], [0.0, 1.72], ":", color=GREY)
rocking.add_patch(Arc((b, 0.0), 3.0, 3.0, theta1=90 - math.degrees(theta), theta2=90, color=VERMILION))
rocking.text(b + 0.26, 1.4, r"rotation $\theta > 0$", color=VERMILION, va="center")
rocking.text(b + 0.05, 0.03, "pivot", va="bottom")
arrow(rocking, rotated[0], rotated[4], "-", BLUE)
