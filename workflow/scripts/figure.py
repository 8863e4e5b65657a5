"""Makes one figure: its module in workflow/figures computes the plotted data and draws them."""

import importlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rocking._datasets.cube import describe, write_dataset
from rocking.plot.output import save_figure
from workflow.scripts.job import command_of, run


def main(
    *,
    figure: str,
    svg: Path,
    png: Path,
    nc: Path,
    provenance: Mapping[str, str],
    paper: Mapping[str, Any] | None = None,
    ours: Mapping[str, Any] | None = None,
    **inputs: Any,
) -> None:
    """Compute and save the plotted data, draw them, and save the drawing in two formats.

    `figure`: module whose `data` takes the input paths and the configured values by name and returns the plotted data;
    its `draw` draws only these. `paper`, `ours`: values that the paper prints, and values chosen here because it does
    not.
    """
    module = importlib.import_module(f"workflow.figures.{figure}")
    dataset = module.data(**inputs, **(paper or {}), **(ours or {}))
    chosen = {"values_chosen_here": ", ".join(ours)} if ours else {}
    about = {"id": nc.stem, "history": command_of(f"figures/{nc.stem}"), **chosen, **provenance}
    write_dataset(describe(dataset, **about), nc)
    drawing = module.draw(dataset)
    save_figure(drawing, svg)
    save_figure(drawing, png)


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
