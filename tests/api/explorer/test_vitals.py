"""On a slow connection and on a phone, a page shows its largest part early and does not move what is read."""

import pytest

from tests.api.explorer.hands import PHONE
from tests.api.explorer.reading import COMPLETE
from tests.api.explorer.test_object import HEADSTONE, SLAB
from tests.sampling import but_long

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

SHOWN = COMPLETE | {
    SLAB: "() => document.querySelector('.dial svg')",
    HEADSTONE: "() => document.querySelector('#drawing circle')",
}
del SHOWN["/docs"]  # by swagger-ui


@pytest.mark.parametrize("width", but_long([390, 1400], 390))
@pytest.mark.parametrize("path", but_long(SHOWN, "/", "/objects"))
def test_a_page_is_seen_early_and_stays_in_place(open_page, service, path, width):
    options = PHONE if width == 390 else {"viewport": {"width": width, "height": 900}}
    page = open_page("/state", **options)  # the data sets are checked, and the context is there
    session = page.context.new_cdp_session(page)
    session.send("Network.enable")
    session.send("Network.setCacheDisabled", {"cacheDisabled": True})
    session.send("Network.emulateNetworkConditions", NETWORK)
    page.add_init_script(f"({OBSERVE})()")
    service.seconds = 1000.0
    page.goto(path)
    if path in COMPLETE:
        page.wait_for_timeout(1100)  # a page says after a second what it waits for
    service.seconds = 0.0
    page.wait_for_function(SHOWN[path])
    page.wait_for_function("() => vitals.paint > 0")
    found = page.evaluate("vitals")
    assert found["shift"] <= MAX_SHIFT, found["moved"]
    assert found["paint"] <= MAX_PAINT, found["largest"]
