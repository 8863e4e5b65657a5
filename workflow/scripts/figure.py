"""Makes one figure: its module in workflow/figures computes the plotted data and draws them."""

import importlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rocking.datasets.cube import describe, write_dataset
from workflow.scripts.job import run


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
    """Compute the plotted data, save them, draw them, save the drawing twice.

    Parameters
    ----------
    figure : str
        Module of the figure. Its `data` takes the input paths and the configured values by name and returns what is
        plotted; its `draw` draws that and nothing else.
    svg, png, nc : path
        Outputs.
    provenance : mapping
        Digests of the code and settings.
    paper, ours : mapping, optional
        Values that the paper prints, and values that it does not print and that we chose.
    **inputs : path or list of paths
        Data sets to read.
    """
    module = importlib.import_module(f"workflow.figures.{figure}")
    dataset = module.data(**inputs, **(paper or {}), **(ours or {}))
    chosen = {"values_chosen_here": ", ".join(ours)} if ours else {}
    write_dataset(describe(dataset, id=nc.stem, history=f"workflow.figures.{figure}", **chosen, **provenance), nc)
    drawing = module.draw(dataset)
    # neither time nor version of the drawing library inside: the same data give the same bytes
    drawing.savefig(svg, metadata={"Date": None, "Creator": None})
    drawing.savefig(png, metadata={"Software": None})


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
