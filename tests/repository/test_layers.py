"""Layers, read from the import statements: a module imports from its own folder and from lower layers only."""

import re
from functools import cache
from pathlib import Path

from rocking._base.source_tree import SourceTree, imported_names

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "architecture.md").read_text()

TABLE = PAGE.split("| layer |")[1].split("\n\n")[0].splitlines()[2:]
LAYERS = [
    [name.rstrip("/").removesuffix(".py") for name in re.findall(r"`([^`]+)`", part)]
    for row in TABLE
    for part in row.split("|")[2].split(", above ")
]
"""Those of the page from the top down: folders below the root, or single modules of `rocking`. A folder may import
itself and folders of later rows; folders in one row do not import each other."""

ASSESSMENT_TABLE = PAGE.split("| layer of the assessment |")[1].split("\n\n")[0].splitlines()[2:]
ASSESSMENT = ROOT / "assessment/rocking_assessment"
ASSESSMENT_LAYERS = [re.findall(r"`([^`]+)/`", row.split("|")[2]) for row in ASSESSMENT_TABLE]
"""Folders of the package of the assessment, from the top down; those of one row do not import each other."""

PUBLIC = ("rocking/__init__.py", "rocking/suites/__init__.py", "rocking/paper/__init__.py", "rocking/plot/__init__.py")
"""What the assessment may import of `rocking`, beside its module `extension`."""

LAYER_OF = {folder: row for row, folders in enumerate(LAYERS) for folder in folders}
SOURCES = SourceTree(ROOT)
SEARCH_PATHS = (ROOT, ROOT / "api", ROOT / "assessment")  # where absolute imports are resolved, as in pyproject.toml


def folder_of(path: Path) -> str | None:
    """Return the entry of `LAYERS` that holds a file, None for a file outside of all of them."""
    place = path.relative_to(ROOT).with_suffix("").as_posix()
    return next((folder for folder in LAYER_OF if place == folder or place.startswith(folder + "/")), None)


@cache
def imported_files(path: Path) -> frozenset[Path]:
    names = set()
    for name, base, level in imported_names(SOURCES.syntax(path)):
        assert level == 0, f"{path}: relative import"
        names |= {name} if base is None else {f"{base}.{name}", base}
    places = [start.joinpath(*name.split(".")) for name in names for start in SEARCH_PATHS]
    files = (file for place in places for file in (place.with_suffix(".py"), place / "__init__.py"))
    return frozenset(file for file in files if file.is_file())


MODULES = sorted(path for path in ROOT.rglob("*.py") if folder_of(path) is not None and "__pycache__" not in path.parts)


def test_the_documented_files_exist() -> None:
    section = PAGE.split("## Files to change")[1]
    paths = [name for name in re.findall(r"`([^` ]+)`", section) if "/" in name]
    assert paths
    assert [path for path in paths if not (ROOT / path).exists()] == []


def test_every_module_of_the_package_has_a_layer() -> None:
    paths = [*(ROOT / "rocking").rglob("*.py"), *(ROOT / "api").rglob("*.py"), *(ROOT / "workflow").rglob("*.py")]
    assert {path for path in paths if folder_of(path) is None} == {
        ROOT / "rocking/__init__.py",
        ROOT / "rocking/_base/__init__.py",
    }


def may_import(path: Path, file: Path) -> bool:
    own, other = str(folder_of(path)), folder_of(file)
    if other is not None:
        return own == other or LAYER_OF[own] < LAYER_OF[other]
    if file.is_relative_to(ASSESSMENT):  # its tests and benchmarks
        return own in ("tests", "stress", "benchmarks")
    # the public names, and the independent integrator, which imports nothing of the package
    public = file.relative_to(ROOT).as_posix() in (*PUBLIC, "rocking/extension.py") or file.is_relative_to(
        ROOT / "reference"
    )
    return public and LAYER_OF[own] < LAYER_OF["rocking/_lookup"]


def test_imports_point_to_own_folder_or_lower_layers() -> None:
    assert len(MODULES) > 500
    assert [
        f"{path} imports {file}" for path in MODULES for file in imported_files(path) if not may_import(path, file)
    ] == []


def assessment_layer(path: Path) -> int:
    folder = path.relative_to(ASSESSMENT).parts[0]
    return next(row for row, folders in enumerate(ASSESSMENT_LAYERS) if folder in folders)


def may_import_in_the_assessment(path: Path, file: Path) -> bool:
    if file.is_relative_to(ASSESSMENT):
        if file.parent == ASSESSMENT or file.relative_to(ASSESSMENT).parts[0] == path.relative_to(ASSESSMENT).parts[0]:
            return True
        return assessment_layer(path) < assessment_layer(file)
    if file.is_relative_to(ROOT / "api"):
        return path.is_relative_to(ASSESSMENT / "service")
    return file.relative_to(ROOT).as_posix() in (*PUBLIC, "rocking/extension.py")


def test_the_assessment_imports_public_names_and_its_lower_layers() -> None:
    modules = [path for path in ASSESSMENT.rglob("*.py") if path.parent != ASSESSMENT]
    assert len(modules) > 30
    assert [
        f"{path} imports {file}"
        for path in modules
        for file in imported_files(path)
        if not may_import_in_the_assessment(path, file)
    ] == []


def test_nothing_below_imports_the_assessment() -> None:
    folders = ("rocking", "api", "workflow", "reference")
    assert [
        path
        for folder in folders
        for path in (ROOT / folder).rglob("*.py")
        if any(file.is_relative_to(ASSESSMENT) for file in imported_files(path))
    ] == []


def test_no_circular_imports() -> None:
    edges = {path: imported_files(path) - {path} for path in MODULES}
    while leaves := [path for path, targets in edges.items() if not targets & edges.keys()]:
        for leaf in leaves:
            del edges[leaf]
    assert not edges, f"circle among {sorted(edges)}"


def test_the_reference_shares_no_code_with_the_package() -> None:
    reference = ROOT / "reference"
    assert [
        path for path in reference.rglob("*.py") for file in imported_files(path) if reference not in file.parents
    ] == []


PLOTTING = ("tests/", "rocking/plot/", "workflow/figures/", "benchmarks/figures/", "stress/figure.py")


def test_only_plotting_modules_import_matplotlib() -> None:
    found = [
        path.relative_to(ROOT).as_posix()
        for path in MODULES
        if any((base or name).split(".")[0] == "matplotlib" for name, base, _ in imported_names(SOURCES.syntax(path)))
    ]
    assert any(name.startswith("rocking/plot/") for name in found)
    assert [name for name in found if not name.startswith(PLOTTING)] == []
