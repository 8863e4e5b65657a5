"""Configuration of the guide; `make docs` builds it, without a network."""

from __future__ import annotations

import os
import sys
import warnings
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT / "docs" / "_extensions"), str(ROOT), str(ROOT / "api"), str(ROOT / "assessment")]
os.environ.setdefault("ROCKING_RESULTS", str(ROOT / "results"))  # read by the examples
os.environ.setdefault("ROCKING_MOTIONS", str(ROOT / "workflow" / "motions"))

GUIDE_URL = os.environ.get("GUIDE_URL", "").rstrip("/")
"""Address of the site whose folders are the guides of all versions; docs/README.md."""

from rocking_api.routers.pages import PAGES  # noqa: E402  (from this tree)

from rocking._base.installation import __version__  # noqa: E402

project = "rocking"
author = project_copyright = "The rocking developers"
version = release = __version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "matplotlib.sphinxext.plot_directive",
    "sphinx_gallery.gen_gallery",
    "reference_tables",
    "example_server",
    "guide_pages",
]
exclude_patterns = ["README.md", "gallery/README.rst", "_extensions"]
root_doc = "index"

myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 3
smartquotes = False  # it would change options and quoted arguments of commands
myst_url_schemes = ("http", "https")
suppress_warnings = ["config.cache"]  # the settings of the gallery hold functions

autosummary_generate = True
autosummary_imported_members = False
autodoc_typehints = "none"  # numpydoc states types, units and ranges
numpydoc_show_class_members = False  # members follow in full, by _templates/autosummary/class.rst
templates_path = ["_templates"]
# docstrings write absolute values with bars, which would be substitutions
rst_prolog = "\n".join(
    rf".. |{text}| replace:: \|{text}\|"
    for text in ("theta", "f", "a f", "u", "y", "acceleration", "B", "x", "z", "a", "v", "E")
)

plot_html_show_source_link = False
plot_html_show_formats = False
plot_formats = [("svg", 100)]
plot_rcparams = {"figure.figsize": (5.6, 3.4), "figure.constrained_layout.use": True, "svg.hashsalt": "rocking"}
plot_apply_rcparams = True

sphinx_gallery_conf = {
    "examples_dirs": str(ROOT / "examples"),
    "gallery_dirs": "gallery",
    "filename_pattern": r"\.py$",
    "within_subsection_order": "ExampleTitleSortKey",
    "abort_on_example_error": True,
    "download_all_examples": False,
    "remove_config_comments": True,
    "show_signature": False,
    "default_thumb_file": str(ROOT / "docs" / "_static" / "icon.svg"),
    "min_reported_time": 10,
    "write_computation_times": False,
}
warnings.filterwarnings("ignore", message="FigureCanvasAgg is non-interactive")  # plt.show() in the examples

html_theme = "furo"
html_theme_options = {
    "announcement": " ".join(f'<a href="{page.path}">{page.label}</a>' for page in PAGES)
}  # the navigation of the service, which serves the guide; elsewhere guide.js and guide.css leave it out
html_title = f"rocking {release}"
html_baseurl = f"{GUIDE_URL}/{'.'.join(release.split('.')[:2])}/" if GUIDE_URL else ""  # of this version, for ever
html_static_path = ["_static"]
html_favicon = "_static/icon.svg"
html_css_files = ["guide.css"]
html_js_files = ["guide.js"]
html_show_sourcelink = False
html_copy_source = False
