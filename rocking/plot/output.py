"""Figures that are saved to files, or shown in a window."""

from __future__ import annotations

from contextlib import AbstractContextManager
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
from matplotlib.backends.registry import BackendFilter, backend_registry
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from rocking._base.errors import InvalidArgumentError
from rocking._base.output_file import output_errors, replacement_of
from rocking.plot.style import STYLE

FORMATS = {".png": {"Software": None}, ".svg": {"Date": None, "Creator": None}}
"""Endings of files, and the metadata that are left out, so that equal pictures are equal files."""


POSITION_DIGITS = 9  # digits of the positions of axes, as fractions of the size of the figure


def style() -> AbstractContextManager[None]:
    """The settings of `STYLE` while a figure is made, drawn and saved."""
    return mpl.rc_context(STYLE)  # type: ignore[arg-type]  # names of settings are not text in the stubs


def new_figure(path: str | None, size: tuple[float, float]) -> Figure:
    """A figure of a size [in] for the file `path`, or for a window.

    Raises
    ------
    InvalidArgumentError
        If the ending of the name is not known, or there is no file and no display.
    """
    if path is not None:
        _metadata(path)
        return Figure(figsize=size)
    if plt.get_backend().lower() not in backend_registry.list_builtin(BackendFilter.INTERACTIVE):  # type: ignore[no-untyped-call]
        raise InvalidArgumentError("output", None, "a file, such as picture.png or picture.svg: there is no display")
    return plt.figure(figsize=size)


def save_figure(figure: Figure, path: str | Path) -> None:
    """Lay out a figure, unless that was done before, and write it; equal pictures give equal bytes.

    Raises
    ------
    InvalidArgumentError
        If the ending of the name is not known, or the file cannot be written.
    """
    metadata = _metadata(path)
    _lay_out(figure)
    with output_errors("output", path), replacement_of(path) as temporary:
        figure.savefig(temporary, format=Path(path).suffix.lower().removeprefix("."), metadata=metadata)


def _lay_out(figure: Figure) -> None:
    """Place the parts of a figure for good, at rounded positions.

    The solver of the constrained layout adds numbers in the order of addresses in memory, so that the last digits of
    the positions differ between processes. An SVG file names its clip paths by a digest of all of their digits.
    """
    engine = figure.get_layout_engine()
    if engine is None:
        return
    engine.execute(figure)
    figure.set_layout_engine("none")  # a second format needs no second layout
    for part in figure.subfigs:
        part.bbox_relative.set_points(part.bbox_relative.get_points().round(POSITION_DIGITS))
    for ax in figure.axes:
        ax.set_position(Bbox(ax.get_position(original=True).get_points().round(POSITION_DIGITS)))


def show_figure(figure: Figure) -> None:
    """Show a figure of `new_figure(None, size)` in a window until it is closed."""
    plt.figure(figure)
    plt.show()


def _metadata(path: str | Path) -> dict[str, None]:
    ending = Path(path).suffix.lower()
    if ending not in FORMATS:
        raise InvalidArgumentError("output", str(path), f"a name that ends in {' or '.join(FORMATS)}")
    return FORMATS[ending]
