"""Properties of the tree: one version, no paths of a machine, light imports, valid links, short files."""

import importlib.util
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from urllib.parse import unquote

import pytest

import rocking

ROOT = Path(__file__).parents[2]
SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]
VERSION = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]

FOLDERS = (
    ".ci", ".github", "api", "assessment", "benchmarks", "docs", "examples", "profiles", "reference", "rocking",
    "stress", "tests", "workflow",
)  # fmt: skip


GENERATED = ("docs/gallery/", "docs/reference/generated/")
"""Written by `make docs`."""


def texts() -> dict[str, str]:
    """All text files of the tree by relative path, without git, which may be missing where the tests run."""
    paths = [*ROOT.glob("*"), *(path for folder in FOLDERS for path in (ROOT / folder).rglob("*"))]
    contents = {
        path.relative_to(ROOT).as_posix(): path.read_bytes()
        for path in paths
        if path.is_file() and "__pycache__" not in path.parts and path.name not in ("environment.lock", ".git")
    }
    kept = {name: content for name, content in contents.items() if not name.startswith(GENERATED)}
    return {name: content.decode() for name, content in sorted(kept.items()) if b"\0" not in content}


TEXTS = texts()


def test_version_is_stated_once() -> None:
    assert rocking.__version__ == VERSION
    stated = re.compile(rf"(?<![\d.]){re.escape(VERSION)}(?![\d.])")
    folders = ("rocking/", "api/", "workflow/", "docs/", "README.md", "CITATION.cff", "Makefile", "Snakefile")
    # Recorded responses of the service contain the version that wrote them.
    prose = {
        name: text.replace(f'"version":"{VERSION}"', "") for name, text in TEXTS.items() if name.startswith(folders)
    }
    places = [name for name, text in prose.items() if stated.search(text)]
    assert not places, "the version is stated in pyproject.toml; read it from there"


def test_no_machine_path_or_registry_host() -> None:
    # Written in parts, so that this file passes its own test.
    words = ("/root" + "/", "/work" + "/", "/home" + "/", "/tmp" + "/", "pypi" + ".org", "pythonhosted" + ".org")
    found = [(name, word) for name, text in TEXTS.items() for word in words if word in text]
    assert not found


def test_files_have_at_most_600_lines() -> None:
    code = {name: text.count("\n") for name, text in TEXTS.items() if name.endswith((".py", ".smk", "Snakefile"))}
    assert not {name: lines for name, lines in code.items() if lines > 600}


def test_package_import_is_lazy() -> None:
    program = "import sys, rocking; print('numba' in sys.modules or 'xarray' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


@pytest.mark.parametrize(
    "command",
    [
        "response --pulse sine --width 0.4m --height 1.6m --peak-acceleration 0.6g --period 0.5s",
        "record workflow/motions/napa_HNE.csv --width 0.2m --height 1m",
    ],
)
def test_a_response_loads_the_solver_only(command: str) -> None:
    program = (
        "import sys\nfrom rocking._cli.app import app\n"
        f"app({command.split()}, standalone_mode=False)\n"
        "heavy = ('scipy.', 'pint', 'xarray', 'pandas', 'netCDF4', 'matplotlib', 'tomllib')\n"
        "light = ('scipy._', 'scipy.version', 'scipy.linalg')  # which numba imports\n"
        f"light += {('pandas',) * command.startswith('record')}  # which reads columns\n"
        "print(*(one for one in sys.modules if one.startswith(heavy) and not one.startswith(light)), file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stderr.split() == []


def test_every_process_of_a_run_reads_its_rules_without_heavy_imports() -> None:
    modules = re.findall(r"^from ((?:rocking|workflow)[\w.]*) import", TEXTS["workflow/rules/common.smk"], re.MULTILINE)
    assert len(modules) > 4
    program = (
        f"import sys, {', '.join(modules)}; print(*({{'numba', 'scipy', 'xarray', 'matplotlib'}} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


def headings(text: str) -> set[str]:
    titles = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("page", [name for name in TEXTS if name.endswith(".md")])
def test_links_have_a_target(page: str) -> None:
    prose = re.sub(r"```.*?```", "", TEXTS[page], flags=re.DOTALL)
    for link in re.findall(r"\]\(([^)\s]+)\)", prose):
        if link.startswith(("http://", "https://", "mailto:")):
            continue
        target, _, anchor = unquote(link).partition("#")
        path = (ROOT / page).parent / target if target else ROOT / page
        assert path.exists(), f"{page}: {link}"
        if anchor:
            assert anchor in headings(path.read_text()), f"{page}: {link}"


def test_hosted_runs_call_targets_of_make() -> None:
    targets = set(re.findall(r"^([a-z-]+):.*##", TEXTS["Makefile"], re.MULTILINE))
    hosted = [text for name, text in TEXTS.items() if name.startswith(".github/workflows/")]
    commands = [line for text in hosted for line in re.findall(r"^ +(?:- )?run: (.*)$", text, re.MULTILINE)]
    assert (
        {command.split()[1] for command in commands}
        == {
            "test",
            "test-all",
            "test-core",
            "newest",
            "oldest",
            "wheel",
        }
        <= targets
    )
    assert all(command.startswith("make ") for command in commands)
    assert TEXTS[".ci/run"].splitlines()[-1].endswith("exec make --no-print-directory test")


def test_actions_of_hosted_runs_are_named_by_commits() -> None:
    hosted = [text for name, text in TEXTS.items() if name.startswith(".github/workflows/")]
    actions = [line for text in hosted for line in re.findall(r"^ +(?:- )?uses: (.*)$", text, re.MULTILINE)]
    assert len(actions) > 10
    commit_and_version = re.compile(r"[\w-]+/[\w-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+")
    assert [action for action in actions if not commit_and_version.fullmatch(action)] == []
    commits: dict[str, set[str]] = {}
    for action in actions:
        commits.setdefault(action.partition("@")[0], set()).add(action)
    assert [names for names in commits.values() if len(names) > 1] == []


def test_settings_are_for_files_that_exist() -> None:
    modules = [name for one in SETTINGS["mypy"]["overrides"] for name in one["module"]]
    assert [name for name in modules if importlib.util.find_spec(name.removesuffix(".*")) is None] == []
    assert [one for one in SETTINGS["ruff"]["lint"]["per-file-ignores"] if next(ROOT.glob(one), None) is None] == []
