"""The claims, and the misprints of the paper, as tables in Markdown and HTML."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from markdown_it import MarkdownIt

from workflow.claims.claim import (
    ABOUT,
    CLOSE,
    FAILS,
    FAIR,
    HOLDS,
    IDENTITY,
    IN_RANGE,
    MIXED,
    PART,
    SAME,
    SMALL,
    VERDICTS,
    percent,
)
from workflow.claims.misprints import MISPRINTS

WORDS = f"""\
Each claim has a criterion, stated without looking at the result. The words of the paper are taken to mean, as relative
differences: "exact", "equal", "collapse": {SAME:.0e}; "coincides": {percent(CLOSE)}; "small", "weak", "practically",
"accurate", "excellent": {percent(SMALL)}; "satisfactory": {percent(FAIR)}; "about": {percent(ABOUT)}. Verdict:
"{HOLDS}" if all of what was tested meets the criterion, and "{IDENTITY}" in its place if the claim is algebra or a
change of variables, which can only hold; "{IN_RANGE}" if all does within the range that follows, which covers
{percent(PART)} or more of what was tested; "{MIXED}" if {percent(PART)} or more meets it, but no such range covers as
much; else "{FAILS}". "Could fail if" says what would have contradicted the claim. "Solver" is the event-by-event
solution of this package.
a = a_g/(g alpha), or a_g/(g tan alpha) for blocks that are not slender; omega = omega_g/p; eta: coefficient of
restitution."""

HEAD = """\
<!doctype html>
<html lang="en"><meta charset="utf-8"><title>Claims of the paper</title>
<style>
  body { font: 15px/1.4 sans-serif; margin: 2em }
  table { border-collapse: collapse }
  th, td { border: 1px solid #bbb; padding: .3em .5em; text-align: left; vertical-align: top }
</style>"""

COLUMNS = ("place", "printed", "criterion", "fails_if", "found", "verdict")

INTRODUCTION = """\
These are slips of notation or printing, not of physics; what is said above is said of the right forms. The tests are in
the repository."""


def within(claim: Mapping[str, Any]) -> str:
    """The range in which the claim holds, as text after the verdict."""
    return f"; all of it for {claim['within']}" if claim["within"] else ""


def as_markdown(claims: Sequence[Mapping[str, Any]]) -> str:
    """The table of claims, from their records, with the count of each verdict above it, and the table of misprints."""
    counts = Counter(claim["verdict"] for claim in claims)
    lines = [
        "# Claims of the paper",
        "",
        ", ".join(f"{verdict}: {counts[verdict]}" for verdict in VERDICTS) + ".",
        "",
        *WORDS.splitlines(),
        "",
        "| place | the paper says | criterion | could fail if | found | verdict |",
        "|---|---|---|---|---|---|",
        *(f"| {' | '.join(claim[name] for name in COLUMNS)}{within(claim)} |" for claim in claims),
        "",
        "# Misprints of the paper",
        "",
        *INTRODUCTION.splitlines(),
        "",
        "| place | printed | right | shown by |",
        "|---|---|---|---|",
        *(misprint.row() for misprint in MISPRINTS),
    ]
    return "\n".join(lines) + "\n"


def as_html(claims: Sequence[Mapping[str, Any]]) -> str:
    """`as_markdown` as a page."""
    return f"{HEAD}\n{MarkdownIt().enable('table').render(as_markdown(claims))}"
