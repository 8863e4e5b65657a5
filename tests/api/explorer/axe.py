"""axe-core, a checker of accessibility, from the npm registry: unpacked into build/axe, and run inside a page.

`python -m tests.api.explorer.axe` fetches it if it is not there.
"""

from __future__ import annotations

import hashlib
import subprocess
import sys
from pathlib import Path

from playwright.sync_api import Page

from tests.api.explorer.chromium import npm_package

PACKAGE = "axe-core@4.10.3"
SHA256 = "880970c081707360e64f34cea25ff91892f5bc95675b0776925b9709dd8a68bb"
SCRIPT = Path(__file__).parents[3] / "build" / "axe" / "axe.min.js"
HOW = "the checks of accessibility need axe-core: have npm on the path, and run `make browser`"

RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]


def fetch() -> bool:
    """Unpack the script; returns whether it is there."""
    if SCRIPT.exists():
        return True
    try:
        with npm_package(PACKAGE) as package:
            content = (package / "axe.min.js").read_bytes()
    except (OSError, subprocess.SubprocessError):
        return False
    if hashlib.sha256(content).hexdigest() != SHA256:
        raise RuntimeError(f"{PACKAGE} is not what was published")
    SCRIPT.parent.mkdir(parents=True, exist_ok=True)
    SCRIPT.write_bytes(content)
    return True


def violations(page: Page) -> list[str]:
    """Rule, and elements that violate it, of everything that the page shows."""
    if not page.evaluate("() => 'axe' in window"):
        page.evaluate(SCRIPT.read_text())
    found = page.evaluate("rules => axe.run({ runOnly: rules, rules: { 'target-size': { enabled: true } } })", RULES)
    return [f"{one['id']}: {[node['target'] for node in one['nodes']]}: {one['help']}" for one in found["violations"]]


if __name__ == "__main__":
    if not fetch():
        sys.stderr.write(f"{HOW}\n")
