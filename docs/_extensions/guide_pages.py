"""What the guide has that the files of a checkout have not: titles as the text of links, figures, lists for programs.

A link such as `[fragility.md](fragility.md)`, which names a file for a reader of the checkout, gets the title of that
page. A figure that the table of `figures.md` links to a section, and that the results folder holds, is drawn in that
section. Beside the pages lie `llms.txt`, a list of them, and `openapi.json`, the description of the service.
"""

from __future__ import annotations

import json
import os
import re
from pathlib import Path
from typing import Any

from docutils import nodes
from reference_tables import openapi_document

FIGURES = "figures"
"""Name of the page with the captions."""


def use_titles(app: Any, doctree: nodes.document, _: str) -> None:
    """Replace names of files by titles in the text of links to pages."""
    for link in doctree.findall(nodes.reference):
        if not re.fullmatch(r"[\w./-]+\.md", link.astext()):
            continue
        name = Path(link.astext()).stem
        pages = [page for page in app.env.titles if page == name or page.endswith(f"/{name}")]
        target = link.get("refuri", "").partition("#")[0]
        page = next((page for page in pages if target.endswith(f"{page.rpartition('/')[2]}.html")), None)
        if page is not None:
            link.children = [nodes.Text(app.env.titles[page].astext())]
            link.children[0].parent = link


def draw_figures(app: Any, doctree: nodes.document) -> None:
    """Add the pictures to the sections of the page of figures."""
    if app.env.docname != FIGURES:
        return
    folder = Path(os.environ["ROCKING_RESULTS"]) / "figures"
    sections = {name: section for section in doctree.findall(nodes.section) for name in section["ids"]}
    for link in [*doctree.findall(nodes.reference)]:
        name, section = link.astext(), sections.get(link.get("refid", ""))
        path = folder / f"{name}.svg"
        if section is not None and path.is_file():
            section.append(
                nodes.image(
                    uri=os.path.relpath(path, app.srcdir), alt=f"{name}, described above", classes=["drawn-on-white"]
                )
            )


def omit_aliases(_app: Any, _kind: str, _name: str, member: Any, skip: bool, _options: Any) -> bool | None:
    """Omit the fields of named tuples that have no text of their own; their class states what they are."""
    return True if (getattr(member, "__doc__", None) or "").startswith("Alias for field number") else skip or None


def write_lists(app: Any, exception: Exception | None) -> None:
    """Write `llms.txt` (title, address and first sentence of each page) and `openapi.json` beside the pages."""
    if exception is not None or app.builder.format != "html":
        return
    lines = [f"# {app.config.html_title}", "", "> Whether, and how far, a free-standing block rocks or overturns.", ""]
    for page in sorted(app.env.titles, key=lambda page: (page.count("/"), page)):
        if not page.startswith(("gallery/", "reference/generated/")):
            paragraphs = app.env.get_doctree(page).findall(nodes.paragraph)
            text = " ".join(next((one.astext() for one in paragraphs), "").split())
            first = re.split(r"(?<=[.?]) ", text)[0]
            lines.append(f"- [{app.env.titles[page].astext()}]({app.builder.get_target_uri(page)}): {first}")
    folder = Path(app.outdir)
    (folder / "llms.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "openapi.json").write_text(json.dumps(openapi_document(), indent=1) + "\n", encoding="utf-8")


def setup(app: Any) -> dict[str, bool]:
    """Connect these; the pictures before Sphinx collects the images of a page."""
    app.connect("doctree-read", draw_figures, priority=400)
    app.connect("doctree-resolved", use_titles)
    app.connect("autodoc-skip-member", omit_aliases)
    app.connect("build-finished", write_lists)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
