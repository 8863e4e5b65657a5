"""Makes figures: the module of each in workflow/figures computes the plotted data and draws them."""

import importlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rocking._datasets.cube import describe, write_dataset
from rocking.plot.output import save_figure
from workflow.scripts.job import attributes_of, run


def main(*, figures: Mapping[str, Mapping[str, Any]]) -> None:
    """Make figures, each from its name and the arguments of `draw_figure`."""
    for name, arguments in figures.items():
        draw_figure(name, **arguments)
        print(name)


def draw_figure(
    name: str,
    *,
    files: Mapping[str, str],
    inputs: Mapping[str, Any],
    provenance: dict[str, str],
    paper: Mapping[str, Any] | None = None,
    ours: Mapping[str, Any] | None = None,
) -> None:
    """Compute and save the plotted data of a figure, draw them, and save the drawing in two formats.

    `name`: its module has a function `data` that takes the configured values and the paths of `inputs` by name,
    which replace names of files among the values, and returns the plotted data; its function `draw` draws only
    these. `files`: paths of the `svg`, the `png` and the `nc`. `paper`, `ours`: values that the paper prints, and
    values chosen here because it does not.
    """
    module = importlib.import_module(f"workflow.figures.{name.replace('-', '_')}")
    arguments = {**(paper or {}), **(ours or {})}
    arguments |= {key: _paths(value) for key, value in inputs.items()}
    dataset = module.data(**arguments)
    stem = Path(files["nc"]).stem
    attributes = {"id": stem, **attributes_of(f"figures/{stem}", provenance)}
    if ours:
        attributes["values_chosen_here"] = ", ".join(ours)
    write_dataset(describe(dataset, **attributes), files["nc"])
    drawing = module.draw(dataset)
    save_figure(drawing, files["svg"])
    save_figure(drawing, files["png"])


def _paths(value: str | list[str]) -> Path | list[Path]:
    if isinstance(value, str):
        return Path(value)
    return [Path(path) for path in value]


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
