"""The guide: it builds without a warning, its examples and blocks of code run, and its reference names everything."""

import json
import os
import re
import runpy
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
from rocking_api.routers.pages import PAGES as SERVED
from typer.testing import CliRunner

import rocking
from rocking import plot
from rocking._cli.app import app
from rocking._excitation import pulses
from tests.sampling import ALL, but_long, sample

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [
    path
    for path in sorted([*DOCS.glob("*.md"), *DOCS.glob("howto/*.md")])
    if "```python" in path.read_text() and path.stem != "tasks"  # test_tasks.py
]

PRINTED = {
    "ask_a_server": ["meaning: rocks and comes to rest", "OVERTURNED_AFTER_IMPACT", "1.85"],
    "cube_without_package": ["recovers 0.55", " nan]"],
    "does_it_overturn": ["rocks and comes to rest", "overturns above 4.70006 m/s2"],
    "figure_8": [],
    "fragility": ["median 5.40 m/s2"],
    "free_rocking": ["restitution 0.9197"],
    "large_rotations": ["6.06624767 7.45218141"],
    "map_with_boundaries": ["400 never uplift"],
    "own_body": ["crushed by 6 cm: restitution 0.948"],
    "own_family": ["3.08448126"],
    "own_pulse": ["2.02417318"],
    "precarious_rock": ["0 deg         0.07"],
    "record": ["49 changes of the outcome", "overturns above 1.13384"],
    "spectrum": ["rotation", "0.04483"],
}
"""Parts of the output of each example."""

QUICK = ("does_it_overturn", "fragility", "own_family")
"""Examples that run in every run of the tests; the others in that of all."""

PICTURES = {
    **dict.fromkeys(PRINTED, 1), "ask_a_server": 0, "does_it_overturn": 2, "large_rotations": 2,
}  # fmt: skip
"""Pictures that each example draws."""

ABOVE = r'<a [^>]*href="(/[^"]*)"'
"""A link to an address of the host, not of the guide."""

LOADED = re.compile(r'<(?:script|link(?! rel="canonical")|img)[^>]*?(?:src|href)="(https?://[^"]+)"')
"""Addresses of other hosts that a page loads."""


@pytest.fixture(autouse=True)
def figures():
    """Pictures are drawn without a display, and closed."""
    with mpl.rc_context({"backend": "agg"}):
        yield
    plt.close("all")


@pytest.fixture
def coarse(monkeypatch):
    """Boundaries on fewer nodes than by default: what is written shall run, its numbers are not compared."""
    monkeypatch.setitem(rocking.overturning_boundary.__kwdefaults__, "nodes", 61)


def test_every_example_has_an_expected_output():
    assert {path.stem for path in (ROOT / "examples").glob("*.py")} == PRINTED.keys()


def test_examples_and_pages_import_public_names_only():
    """The page for contributors, tasks.md, changes the package itself."""
    sources = {path.name: path.read_text() for path in (ROOT / "examples").glob("*.py")}
    for page in [*PAGES, ROOT / "README.md"]:
        sources[page.name] = "".join(re.findall(r"^```python\n(.*?)^```$", page.read_text(), re.MULTILINE | re.DOTALL))
    private = re.compile(r"\brocking(?:_api)?(?:\.\w+)*\._[a-z]\w*|from rocking[\w.]* import [^\n]*\b_\w+")
    assert len(sources) > 20
    assert {name: found for name, text in sources.items() if (found := private.findall(text))} == {}


@pytest.mark.slow
@pytest.mark.parametrize("name", but_long(sorted(PRINTED.keys() - {"ask_a_server"}), *QUICK))  # test_readme.py
def test_example(name, smoke_results, monkeypatch, capsys):
    monkeypatch.setenv("ROCKING_RESULTS", str(smoke_results))
    monkeypatch.setenv("ROCKING_MOTIONS", str(ROOT / "workflow" / "motions"))
    monkeypatch.setattr(pulses, "_REGISTERED", {})
    runpy.run_path(str(ROOT / "examples" / f"{name}.py"))
    output = capsys.readouterr().out
    assert [text for text in PRINTED[name] if text not in output] == []
    assert len(plt.get_fignums()) == PICTURES[name]
    assert all(ax.has_data() for number in plt.get_fignums() for ax in plt.figure(number).axes if ax.get_label() == "")


@pytest.mark.slow
@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize(
    "page",
    but_long(PAGES, *(path for path in PAGES if path.stem in ("start", "body", "lookup"))),
    ids=lambda path: path.stem,
)
def test_blocks_of_code_run(page, smoke_results, monkeypatch, capsys, tmp_path):
    (tmp_path / "results").symlink_to(smoke_results)
    (tmp_path / "workflow").symlink_to(ROOT / "workflow")
    (tmp_path / "collection.csv").symlink_to(DOCS / "assessment/collection.csv")
    monkeypatch.chdir(tmp_path)
    text, names = page.read_text(), {}
    for block in re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        if "http://127.0.0.1" not in block:  # a running service: the example ask_a_server
            exec(block, names)
    output = capsys.readouterr().out
    if page.stem == "start":
        (printed,) = re.findall(r"^```text\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
        assert output == printed
    assert "nan" not in output


@pytest.mark.long
@pytest.mark.usefixtures("coarse")
def test_commands_of_the_pages_are_accepted(tmp_path, monkeypatch):
    """Each `rocking` command of start and how-to pages runs, apart from the server and long tables."""
    (tmp_path / "workflow").symlink_to(ROOT / "workflow")
    (tmp_path / "collection.csv").symlink_to(DOCS / "assessment/collection.csv")
    monkeypatch.chdir(tmp_path)
    fleet = re.search(r"```text\n(name,.*?)```", (DOCS / "howto/fleet.md").read_text(), re.DOTALL)
    assert fleet
    Path("fleet.csv").write_text(fleet[1])
    hammer = re.search(r"```text\n(time .*?)```", (DOCS / "howto/pulse.md").read_text(), re.DOTALL)
    assert hammer
    Path("hammer.csv").write_text(hammer[1])
    trace: dict[str, Any] = {}
    exec(re.findall(r"```python\n(.*?)```", (DOCS / "assessment/identify.md").read_text(), re.DOTALL)[0], trace)
    rows = np.column_stack([1000.0 * trace["time"], np.degrees(trace["rotation"])])
    np.savetxt("trace.csv", rows, delimiter=",", header="time [ms],rotation [deg]", comments="")
    if ALL:
        exec(re.findall(r"```python\n(.*?)```", (DOCS / "assessment/statue.md").read_text(), re.DOTALL)[0], {})
    pages = [DOCS / "start.md", *sorted(DOCS.glob("howto/*.md"))]
    lines = [line.strip() for page in pages for line in page.read_text().splitlines()]
    commands = [line.split(" > ")[0] for line in lines if line.startswith("rocking ")]
    commands = [line for line in commands if ALL or "--mesh" not in line]  # takes ten seconds, most of this test
    for command in sample(commands, 3):
        done = CliRunner().invoke(app, shlex.split(command)[1:])
        assert done.exit_code == 0, f"{command}: {done.output}"
        if " -o " in command:
            assert Path(command.split()[-1]).stat().st_size > 10_000


def test_reference_names_every_public_name():
    page = "".join((DOCS / "reference" / name).read_text() for name in ("python.md", "paper.rst", "restraint.rst"))
    assert [name for name in rocking.__all__ if not re.search(rf"\b{name}\b", page)] == ["plot"]
    pictures = (DOCS / "reference/plot.md").read_text()
    assert [name for name in plot.__all__ if not re.search(rf"\b{name}\b", pictures)] == []


@pytest.mark.long
def test_guide_builds_without_warning(tmp_path):
    """In a copy, because the build writes beside its sources; the examples are run by the test above."""
    for folder in ("docs", "examples"):
        ignored = shutil.ignore_patterns("gallery", "generated", "__pycache__")
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=ignored)
    shutil.copytree(ROOT / "workflow/report", tmp_path / "workflow/report")  # captions of the figures
    for name in ("CHANGELOG.md", "CONTRIBUTING.md", "results/README.md", "workflow/config/paper.yaml"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    drawn = tmp_path / "results" / "figures" / "figure-05.svg"
    drawn.parent.mkdir()
    drawn.write_text('<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"/>')
    target = tmp_path / "html"
    # a third of the time is a search for garbage among the trees of all pages; without it 1.2 GB are needed, not 0.5
    build = "import gc, sys; gc.disable(); from sphinx.cmd.build import main; sys.exit(main(sys.argv[1:]))"
    options = ["-W", "--keep-going", "-q", "-D", "plot_gallery=0"]
    command = [sys.executable, "-c", build, *options, "docs", str(target)]
    environment = os.environ | {"PYTHONWARNINGS": "ignore", "ROCKING_RESULTS": str(tmp_path / "results")}
    environment["GUIDE_URL"] = "https://guide.example/"
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    index = " ".join(
        re.sub(r"<[^>]+>", "", (target / f"reference/{page}.html").read_text()) for page in ("http", "command")
    )
    for text in ("/v1/blocks/response", "ROCKING_MAX_POINTS", "rocking fragility", "--peak-acceleration"):
        assert text in index, text
    assert "largest_surviving_acceleration number or null m/s2 peak acceleration below which" in " ".join(index.split())
    assert "surviving_from_half_diagonal" in index  # of a part of a response
    assert "restitution_error" in (target / "reference/files.html").read_text()
    assert (target / "reference/generated/rocking.peak_response.html").exists()
    members = (target / "reference/generated/rocking.Block.html").read_text()
    assert members.count('id="rocking.Block.response"') == 1  # in full, not as a row of a table
    assert "Factor of a record" in members
    section = (target / "figures.html").read_text().partition('id="figures-5-and-6"')[2].partition("</section>")[0]
    assert 'src="_images/figure-05.svg"' in section
    assert not [page.name for page in target.rglob("*.html") if re.search(r">[\w./-]+\.md</a>", page.read_text())]
    assert "--format csv" in (target / "reference/command.html").read_text()  # no dash
    loaded = [(page.name, url) for page in target.rglob("*.html") for url in re.findall(LOADED, page.read_text())]
    assert loaded == []  # nothing comes from other hosts
    above = [(page.name, url) for page in target.rglob("*.html") for url in re.findall(ABOVE, page.read_text())]
    assert {url for _, url in above} == {page.path for page in SERVED}  # without the service guide.js leaves them out
    assert [page.name for page in target.rglob("*.html") if "_static/guide.js" not in page.read_text()] == []
    (outside,) = re.findall(r'<link rel="canonical" href="([^"]*)"', (target / "concepts.html").read_text())
    assert outside == f"https://guide.example/{rocking.__version__.rpartition('.')[0]}/concepts.html"
    listed = re.findall(r"^- \[.+\]\((.+)\): \S", (target / "llms.txt").read_text(), re.MULTILINE)
    assert {"start.html", "assessment/assess.html", "performance.html", "reference/http.html"} <= set(listed)
    assert [page for page in listed if not (target / page).is_file()] == []
    assert "/v1/response" in json.loads((target / "openapi.json").read_text())["paths"]
    assert json.loads((target / "searchindex.js").read_text()[len("Search.setIndex(") : -1])["titles"]
