"""The claims, and the misprints of the paper, as tables in Markdown and HTML."""

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from markdown_it import MarkdownIt

from workflow.claims.claim import (
    CLOSE,
    FAILS,
    HOLDS,
    IDENTITY,
    IN_RANGE,
    MEASURED,
    MIXED,
    PART,
    SAME,
    SMALL,
    VERDICTS,
    percent,
)

WORDS = f"""\
Each measure is stated without looking at the result. The words of the paper are taken to mean, as relative
differences: "exact", "equal", "collapse": {SAME:.0e}; "coincides": {percent(CLOSE)}; "small", "excellent":
{percent(SMALL)}. Verdict: "{HOLDS}" if all of what was tested meets the measure, and "{IDENTITY}" in its place if the
claim is algebra or a change of variables, which can only hold; "{IN_RANGE}" if all does within the range that follows,
which covers {percent(PART)} or more of what was tested; "{MIXED}" if {percent(PART)} or more meets it, but no such
range covers as much; else "{FAILS}". "{MEASURED}": the words of the paper name no number. "Measured" begins with the
share of what was tested that meets the measure; shares of the control plane are areas in (1/a, log omega). "Solver" is
the event-by-event solution of this package. a = a_g/(g alpha), or a_g/(g tan alpha) for blocks that are not slender;
omega = omega_g/p; eta: coefficient of restitution."""

HEAD = """\
<!doctype html>
<html lang="en"><meta charset="utf-8"><title>Claims of the paper</title>
<style>
  body { font: 15px/1.4 sans-serif; margin: 2em }
  table { border-collapse: collapse }
  th, td { border: 1px solid #bbb; padding: .3em .5em; text-align: left; vertical-align: top }
</style>"""

INTRODUCTION = """\
These are slips of notation or printing, not of physics; what is said above is said of the right forms. The tests are in
the repository."""


def read_table(page: Path, heading: str) -> list[list[str]]:
    """Cells of the rows of the table below a heading of a Markdown page."""
    section = page.read_text(encoding="utf-8").split(f"# {heading}\n")[1].partition("\n#")[0]
    lines = [line for line in section.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in lines[1:]]


def read_statements(page: Path) -> dict[str, dict[str, str]]:
    """Place, statement of the paper and measure of each claim by its key, in order, from `statements.md`."""
    rows = read_table(page, "Statements of the paper, and how each is measured")
    return {key: {"place": place, "printed": printed, "measure": measure} for key, place, printed, measure in rows}


def read_misprints(page: Path) -> list[dict[str, str]]:
    """Place, printed and right form, and test of each misprint, from docs/equations.md."""
    rows = read_table(page, "Slips in the paper's text")
    return [
        {"place": place, "printed": printed, "right": right, "tests": tests} for _, place, printed, right, tests in rows
    ]


def measured(claim: Mapping[str, Any]) -> str:
    """Share and numbers of a claim as text."""
    parts = [f"{name} {value:.4g}" for name, value in claim["numbers"].items()]
    if claim["share"] is not None:
        parts.insert(0, percent(claim["share"]))
    return "; ".join(parts)


def row(claim: Mapping[str, Any]) -> str:
    """Row of the table of claims."""
    verdict = claim["verdict"]
    if claim["within"]:
        verdict += f"; all of it for {claim['within']}"
    return f"| {claim['place']} | {claim['printed']} | {claim['measure']} | {measured(claim)} | {verdict} |"


def as_markdown(claims: Sequence[Mapping[str, Any]], misprints: Sequence[Mapping[str, str]]) -> str:
    """The table of claims, from their records, with the count of each verdict above it, and the table of misprints."""
    counts = Counter(claim["verdict"] for claim in claims)
    lines = [
        "# Claims of the paper",
        "",
        ", ".join(f"{verdict}: {counts[verdict]}" for verdict in VERDICTS) + ".",
        "",
        *WORDS.splitlines(),
        "",
        "| place | the paper says | measure | measured | verdict |",
        "|---|---|---|---|---|",
        *map(row, claims),
        "",
        "# Misprints of the paper",
        "",
        *INTRODUCTION.splitlines(),
        "",
        "| place | printed | right | shown by |",
        "|---|---|---|---|",
        *(f"| {' | '.join(misprint.values())} |" for misprint in misprints),
    ]
    return "\n".join(lines) + "\n"


def as_html(markdown: str) -> str:
    """The tables in Markdown as a page."""
    return f"{HEAD}\n{MarkdownIt().enable('table').render(markdown)}"
