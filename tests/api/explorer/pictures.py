"""Pictures of the pages in eight states, and their comparison with stored ones.

`python -m tests.api.explorer.pictures` makes the stored ones anew, in `tests/data/pictures`: look at them, and state in
the commit message what changed. They are means over squares of 4 x 4 pixels of a page whose text is in a font of bars
(`plain_font`), without the numbers that a machine may round in another way and without the browser's own controls.
"""

from __future__ import annotations

import io
import os
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from numpy.typing import NDArray
from PIL import Image
from playwright.sync_api import Page

STORED = Path(__file__).parents[2] / "data" / "pictures"
NEW = "ROCKING_NEW_PICTURES"
"""Environment variable: store the pictures in place of comparing them."""

SQUARE = 4  # [px]
WINDOW = {"width": 800, "height": 1200}
MAX_DIFFERENCE = 40  # of a square, in the colour that differs most, of 255
MAX_SQUARES = 8  # that may differ by more, as edges of lines do in another version of the browser

STYLE = """
input, select, button, textarea { appearance: none !important; border-radius: 0 !important; }
input[type=range], input[type=file], summary::marker { visibility: hidden; }
#map-readout, .downloads, #archive, #status { visibility: hidden; }
* { caret-color: transparent !important; animation: none !important; transition: none !important; }
"""


@dataclass(frozen=True)
class State:
    """A page to take a picture of.

    Attributes
    ----------
    path : str
        Its address.
    complete : str
        Function of JavaScript that is true once everything is there.
    part : str
        Selector of what is taken.
    scheme : str
        "light" or "dark".
    """

    path: str
    complete: str
    part: str = "body"
    scheme: str = "light"


def take(page: Page, state: State) -> NDArray[np.float64]:
    """The means over squares of the first window of a part of the page, 0 to 255, shape (rows, columns, 3)."""
    page.wait_for_function(state.complete)
    page.add_style_tag(content=STYLE)
    page.wait_for_load_state("networkidle")
    page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    box = page.locator(state.part).bounding_box()
    clip = {**box, "height": min(box["height"], WINDOW["height"])}
    image = 255 * imread(io.BytesIO(page.screenshot(clip=clip, full_page=True)))[..., :3].astype(float)
    rows, columns = (size // SQUARE for size in image.shape[:2])
    squares = image[: rows * SQUARE, : columns * SQUARE].reshape(rows, SQUARE, columns, SQUARE, 3)
    return squares.mean(axis=(1, 3))


def different_squares(shown: NDArray[np.float64], stored: NDArray[np.float64]) -> int:
    """Number of squares that differ by more than the tolerance; all of them if the sizes differ."""
    if shown.shape != stored.shape:
        return shown.size // 3
    return int(np.count_nonzero(np.abs(shown - stored).max(axis=-1) > MAX_DIFFERENCE))


def store(name: str, shown: NDArray[np.float64]) -> None:
    """Keep a picture under the name of its state."""
    STORED.mkdir(exist_ok=True)
    Image.fromarray(np.rint(shown).astype(np.uint8)).save(STORED / f"{name}.png", optimize=True)


def stored(name: str) -> NDArray[np.float64]:
    """The picture that is kept of a state, 0 to 255, shape (rows, columns, 3)."""
    return np.asarray(Image.open(STORED / f"{name}.png"), dtype=float)


if __name__ == "__main__":
    os.environ[NEW] = "1"
    sys.exit(pytest.main(["-q", "-n0", str(Path(__file__).with_name("test_pictures.py")), "-k", "stored_picture"]))
