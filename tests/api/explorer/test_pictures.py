"""The pages look as they did, in eight states; a wrong unit, a wrong colour or a reversed axis is noticed."""

import json
import os
import sys

import pytest

from tests.api.explorer import plain_font
from tests.api.explorer.pictures import MAX_SQUARES, NEW, WINDOW, State, different_squares, store, stored, take
from tests.api.explorer.reading import BLOCK, COMPLETE, POINT
from tests.sampling import but_long

if sys.platform != "linux":
    pytest.skip("the font of the pictures is set by fontconfig", allow_module_level=True)

MAP = """() => {
    const { drawn, curves } = document.getElementById("map").dataset;
    return drawn && curves && JSON.parse(drawn).columns === 400;
}"""
ANSWERS = "() => document.querySelector('.headline') && document.querySelector('.verdict')"
SECTION = "section:has(#map)"

STATES = {
    "map": State(BLOCK, MAP, SECTION),
    "map-dark": State(POINT, MAP, SECTION, "dark"),
    "spectrum": State(POINT, "() => document.querySelector('#spectrum-chart canvas')", "#spectrum"),
    "own-pulse": State(BLOCK + "&pulse=0+1+0", ANSWERS),
    "objects": State("/objects", COMPLETE["/objects"]),
    "records": State("/records", COMPLETE["/records"]),
    "datasets": State("/datasets", COMPLETE["/datasets"]),
    "not-found": State("/nowhere", "() => true"),
}


@pytest.fixture(scope="module")
def browser(launch, tmp_path_factory):
    """A browser whose only font has bars for letters."""
    browser = launch(FONTCONFIG_FILE=str(plain_font.install(tmp_path_factory.mktemp("font"))))
    yield browser
    browser.close()


@pytest.fixture
def picture(open_page):
    def taken(state, prepare=None):
        options = {"color_scheme": state.scheme, "viewport": WINDOW, "bypass_csp": True, "failing": True}
        page = open_page("about:blank", **options)
        if prepare is not None:
            prepare(page)
        page.goto(state.path)
        return take(page, state)

    return taken


@pytest.mark.parametrize("name", but_long(STATES, "map", "objects"))
def test_a_page_is_its_stored_picture(picture, name):
    shown = picture(STATES[name])
    if os.environ.get(NEW):
        store(name, shown)
    assert different_squares(shown, stored(name)) <= MAX_SQUARES


def replacing(file, old, new):
    """A change of a text in a file of the pages."""

    def answer(route):
        found = route.fetch()
        text = found.text()
        assert old in text
        route.fulfill(response=found, body=text.replace(old, new))

    return lambda page: page.route(f"**/{file}", answer)


def reversed_axis(page):
    """The rows of the map in the other order."""

    def answer(route):
        found = route.fetch()
        grid = found.json()
        columns = len(grid["frequency_ratio"])
        for name in ("outcome", "peak_rotation"):
            rows = [grid[name][at : at + columns] for at in range(0, len(grid[name]), columns)]
            grid[name] = [value for row in reversed(rows) for value in row]
        route.fulfill(response=found, body=json.dumps(grid))

    page.route("**/v1/map?*", answer)


WRONG = {
    "value of a unit": ("map", replacing("units.js", "g: 9.80665", "g: 9.0")),
    "label of a unit": ("map", replacing("map_frame.js", "[${written(shown.acceleration)}]", "[m/s²]")),
    "colour of a curve": ("spectrum", replacing("site.css", "--accent: #0b6b78", "--accent: #b3261e")),
    "axis of the map": ("map", reversed_axis),
}


@pytest.mark.parametrize("wrong", but_long(WRONG, "axis of the map"))
def test_a_wrong_picture_is_noticed(picture, wrong):
    name, change = WRONG[wrong]
    assert different_squares(picture(STATES[name], change), stored(name)) > 2 * MAX_SQUARES
