"""One block under excitations of all amplitudes: where its response lies, and how far the other outcome is."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from rocking._base.errors import InvalidArgumentError
from rocking._boundary.amplitude import thresholds
from rocking._dimensional.response import BodyResponse
from rocking._excitation.pulses import AbstractPulse
from rocking._model.outcome import Outcome
from rocking._model.response import Response
from rocking._solver.peak_response import peak_response
from rocking.plot.pictures.spectrum import shade_overturned
from rocking.plot.style import BLUE, GREY, LABELS, VERMILION, axes_of

SAMPLES = 600  # amplitudes at which the curve is computed, beside the thresholds [-]
BESIDE = 1e-7  # relative distance from a threshold of the points on either side of it [-]


def response(found: BodyResponse | Response, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw the peak rotation against the amplitude of the pulse, and the response in question as a point on it.

    The curve ranges from zero to twice the amplitude in question, or to the lowest one at which the block overturns if
    that is higher. The ranges in which the block overturns are shaded; their ends are searched with
    `rocking.thresholds`, so that narrow ones are not missed.

    Parameters
    ----------
    found : BodyResponse or Response
        Result of `rocking.Block.response` under a pulse, drawn in SI units and degrees, or of `rocking.peak_response`
        for one block.
    ax, **style
        As of `rocking.plot`.
    """
    groups: dict[str, Any]
    pulse: str | AbstractPulse
    if isinstance(found, BodyResponse) and found.problem.kinds == {"pulse", "block"}:
        pulse, groups = found.problem.pulse, dict(found.problem.groups)
        # in m/s2 and degrees
        unit, angle = found.block.uplift_acceleration, np.degrees(found.block.alpha)
        labels = f"{LABELS['peak_acceleration']} [m/s$^2$]", "peak rotation [deg]"
        outcome = found.outcome
    elif isinstance(found, Response) and found.shape == () and found.pulse:
        pulse, groups = found.pulse, {name: value.item() for name, value in found.groups.items()}
        unit, angle = 1.0, 1.0
        labels = f"{LABELS['amplitude']} [-]", r"peak rotation $\theta_{\max}/\alpha$ [-]"
        outcome = Outcome(int(found.outcome))
    else:
        raise InvalidArgumentError(
            "found", repr(found), "the response of one block to a pulse (of a record: rocking.plot.history)"
        )
    ax = axes_of(ax)
    groups["alpha"] = groups.get("alpha") or None
    slenderness = groups.pop("slenderness")
    amplitude = 1.0 / slenderness
    edges = thresholds(pulse, **groups, highest=max(12.0, 2.0 * amplitude)).amplitude
    top = max(2.0 * amplitude, 1.1 * edges[0] if edges.size else 0.0, 1.2)
    beside = (edges[:, None] * (1.0 + BESIDE * np.array([-1.0, 1.0]))).ravel()
    a = np.union1d(np.linspace(top / SAMPLES, top, SAMPLES), beside[beside < top])
    curve = peak_response(pulse, slenderness=1.0 / a, **groups)
    ax.plot(unit * a, angle * curve.peak_rotation, **({"color": BLUE, "label": "survives"} | style))
    shade_overturned(ax, unit * a, curve.overturned)
    ax.axhline(angle, color=GREY, linewidth=0.5)
    across = ax.get_yaxis_transform()
    ax.text(0.995, angle, r"$\theta_{\max}=\alpha$", transform=across, ha="right", va="bottom", color=GREY)
    ax.axvline(unit * amplitude, color=VERMILION, linewidth=0.8, linestyle=(0, (4, 2)), label="this block")
    peak = float(peak_response(pulse, slenderness=slenderness, **groups).peak_rotation)
    ax.plot([unit * amplitude], [angle * peak], "o", color=VERMILION)  # none if it overturns
    ax.set_xlim(0.0, unit * top)
    ax.set_ylim(0.0, 1.35 * angle * max(1.0, float(np.nanmax(curve.peak_rotation))))  # room for the legend
    ax.set_xlabel(labels[0])
    ax.set_ylabel(labels[1])
    ax.set_title(outcome.sentence, loc="right")
    ax.legend(loc="upper left")
    return ax
