"""On a slow connection and on a phone, a page shows its largest part early and does not move what is read."""

import pytest

from tests.api.explorer.hands import PHONE
from tests.api.explorer.test_object import HEADSTONE, SLAB

NETWORK = {"offline": False, "latency": 150, "downloadThroughput": 1.6e6 / 8, "uploadThroughput": 750e3 / 8}
"""Round trip [ms] and bytes per second of a slow mobile connection, as audits of pages take them."""

MAX_SHIFT = 0.1  # [-], share of the window times share of its height by which parts moved
MAX_PAINT = 1500  # [ms]

OBSERVE = """() => {
    window.vitals = { shift: 0, paint: 0, moved: [], largest: "" };
    new PerformanceObserver((list) => {
        for (const one of list.getEntries()) {
            if (one.hadRecentInput) continue;
            vitals.shift += one.value;
            vitals.moved.push(...one.sources.map(({ node }) => node?.id || node?.parentElement?.id || node?.nodeName));
        }
    }).observe({ type: "layout-shift", buffered: true });
    new PerformanceObserver((list) => {
        for (const one of list.getEntries()) [vitals.paint, vitals.largest] = [one.startTime, one.element?.outerHTML];
    }).observe({ type: "largest-contentful-paint", buffered: true });
}"""

DONE: dict[str, str] = {
    "/": "() => document.querySelector('#spectrum-chart canvas') && document.querySelector('.headline')",
    "/objects?sample=1": "() => document.getElementById('ranking')",
    SLAB: "() => document.querySelector('.dial svg')",
    HEADSTONE: "() => document.querySelector('#drawing circle')",
    "/records": "() => document.querySelector('#rotation canvas')",
    "/datasets": "() => document.querySelector('#groups h3')",
    "/suites": "() => document.querySelector('#suite-report canvas')",
    "/state": "() => document.querySelector('#facts dl')",
}


@pytest.mark.parametrize("width", [390, 1400])
@pytest.mark.parametrize("path", DONE)
def test_a_page_is_seen_early_and_stays_in_place(open_page, path, width):
    options = PHONE if width == 390 else {"viewport": {"width": width, "height": 900}}
    page = open_page("/state", **options)  # the data sets are checked, and the context is there
    session = page.context.new_cdp_session(page)
    session.send("Network.enable")
    session.send("Network.setCacheDisabled", {"cacheDisabled": True})
    session.send("Network.emulateNetworkConditions", NETWORK)
    page.add_init_script(f"({OBSERVE})()")
    page.goto(path)
    page.wait_for_function(DONE[path])
    page.wait_for_function("() => vitals.paint > 0")
    found = page.evaluate("vitals")
    assert found["shift"] <= MAX_SHIFT, found["moved"]
    assert found["paint"] <= MAX_PAINT, found["largest"]
