"""Time and memory over the number of cells."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from benchmarks.measure import spread
from rocking.plot.style import BLUE, VERMILION, WIDTH
from workflow.figures.style import panel_letters

KINDS = {"slender": ("slender", BLUE), "rigid": ("rigid, 20°", VERMILION)}
LINES = ("-", "--", "-.", ":")
MARKERS = "osD^"


def draw(record: dict[str, Any], paths: list[Path]) -> None:
    """Write the figure of a record of `benchmarks.cost.growth`: medians, bars from the fastest to the slowest."""
    figure, (total, each, memory) = plt.subplots(1, 3, figsize=(WIDTH, 0.45 * WIDTH))
    threads = sorted({one["threads"] for one in record["sizes"]})
    for kind, (name, color) in KINDS.items():
        for count, line, marker in zip(threads, LINES, MARKERS, strict=False):
            rows = [one for one in record["sizes"] if (one["kind"], one["threads"]) == (kind, count)]
            cells = np.array([one["cells"] for one in rows])
            times = [spread(one["seconds"]) for one in rows]
            middle, fast, slow = (np.array([time[key] for time in times]) for key in ("median", "smallest", "largest"))
            label = f"{name}, {count} thread{'s' if count > 1 else ''}"
            style: dict[str, Any] = {"color": color, "linestyle": line, "marker": marker, "markersize": 3.5}
            bars = np.array([middle - fast, slow - middle])
            total.errorbar(cells, middle, bars, capsize=1.5, elinewidth=0.7, **style)
            each.errorbar(
                cells, 1e6 * middle / cells, 1e6 * bars / cells, label=label, capsize=1.5, elinewidth=0.7, **style
            )
            memory.plot(cells, [one["peak_bytes"] / 1e6 for one in rows], **style)
    total.set(xscale="log", yscale="log", xlabel="cells", ylabel="wall-clock time [s]")
    each.set(xscale="log", yscale="log", xlabel="cells", ylabel="wall-clock time of a cell [µs]")
    each.set_ylim(0.1, 20.0)
    memory.set(xscale="log", xlabel="cells", ylabel="peak memory of the process [MB]")
    memory.set_ylim(bottom=0.0)
    memory.legend(*each.get_legend_handles_labels(), loc="lower center")
    panel_letters([total, each, memory])
    for path in paths:
        figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None)
    plt.close(figure)
