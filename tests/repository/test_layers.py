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

LAYER_OF = {folder: row for row, folders in enumerate(LAYERS) for folder in folders}
SOURCES = SourceTree(ROOT)
SEARCH_PATHS = (ROOT, ROOT / "api")  # where absolute imports are resolved, as in pyproject.toml


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
    # the public names, and the independent integrator, which imports nothing of the package
    public = file == ROOT / "rocking/__init__.py" or file.is_relative_to(ROOT / "reference")
    return public and LAYER_OF[own] < LAYER_OF["rocking/_lookup"]


def test_imports_point_to_own_folder_or_lower_layers() -> None:
    assert len(MODULES) > 500
    assert [
        f"{path} imports {file}" for path in MODULES for file in imported_files(path) if not may_import(path, file)
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
