"""Layers, read from the import statements: a module imports from its own folder and from lower layers only."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "architecture.md").read_text()

# From the top down: folders below the root, or single modules of `rocking`. A folder may import itself and folders of
# later rows; folders in one row do not import each other.
LAYERS = (
    ("tests",),
    ("stress",),
    ("benchmarks",),
    ("api/rocking_api", "rocking/_cli", "workflow"),
    ("rocking/plot",),
    ("rocking/precompile",),
    ("rocking/_lookup", "rocking/suites"),
    ("rocking/_dimensional",),
    ("rocking/_spectra",),
    ("rocking/_datasets",),
    ("rocking/_boundary", "rocking/_history", "rocking/_interpolation"),
    ("rocking/_solver", "rocking/paper"),
    ("rocking/_model", "rocking/_excitation"),
    ("rocking/_numba",),
    ("rocking/_base/errors", "rocking/_base/equality"),
    ("rocking/_base/units",),
    ("rocking/_base/constants", "rocking/_base/version", "rocking/_base/source_tree"),
)
LAYER_OF = {folder: row for row, folders in enumerate(LAYERS) for folder in folders}
SEARCH_PATHS = (ROOT, ROOT / "api")  # where absolute imports are resolved, as in pyproject.toml


def folder_of(path: Path) -> str | None:
    """Return the entry of `LAYERS` that holds a file, None for a file outside of all of them."""
    place = path.relative_to(ROOT).with_suffix("").as_posix()
    return next((folder for folder in LAYER_OF if place == folder or place.startswith(folder + "/")), None)


def imported_files(path: Path) -> Iterator[Path]:
    """Yield the files of the project that a file imports, at any depth of its code."""
    for node in ast.walk(ast.parse(path.read_text())):
        names = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            names = [f"{node.module}.{alias.name}" for alias in node.names] + [str(node.module)]
        for name in names:
            for start in SEARCH_PATHS:
                place = start.joinpath(*name.split("."))
                for file in (place.with_suffix(".py"), place / "__init__.py"):
                    if file.is_file():
                        yield file


MODULES = sorted(path for path in ROOT.rglob("*.py") if folder_of(path) is not None and "__pycache__" not in path.parts)
NAMES = [path.relative_to(ROOT).as_posix() for path in MODULES]


def documented_folders() -> list[str]:
    """Return the folders of the table of layers in docs/architecture.md, from the top down."""
    table = PAGE.split("| layer |")[1].split("\n\n")[0].splitlines()[2:]
    return [
        name.rstrip("/").removesuffix(".py") for row in table for name in re.findall(r"`([^`]+)`", row.split("|")[2])
    ]


def documented_tree() -> set[str]:
    """Return the folders of the tree in docs/architecture.md."""
    found, parents = set(), [""]
    for line in PAGE.split("```text\n")[1].split("```")[0].splitlines():
        name = line.split()[0].rstrip("/")
        depth = (len(line) - len(line.lstrip())) // 2
        parents[depth + 1 :] = [f"{parents[depth]}{name}/"]
        found.add(parents[-1].rstrip("/"))
    return found


def test_the_documented_layers_are_those_of_this_test() -> None:
    folders = documented_folders()
    assert set(folders) == LAYER_OF.keys()
    assert [LAYER_OF[folder] for folder in folders] == sorted(LAYER_OF.values())


def test_the_documented_tree_is_the_real_one() -> None:
    packages = {path.parent for top in ("rocking", "api") for path in (ROOT / top).rglob("__init__.py")}
    grouped = {path.parent for path in (ROOT / "benchmarks").rglob("__init__.py")}
    workflow = {path for path in (ROOT / "workflow").iterdir() if path.is_dir() and path.name != "__pycache__"}
    real = {path.relative_to(ROOT).as_posix() for path in packages | grouped | workflow}
    plain = {"api", "api/rocking_api/static", "workflow", "reference", "stress", "tests", "docs", "examples", "deploy"}
    assert documented_tree() == real | plain


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


@pytest.mark.parametrize("path", MODULES, ids=NAMES)
def test_imports_point_to_own_folder_or_lower_layers(path: Path) -> None:
    own = str(folder_of(path))
    for file in imported_files(path):
        other = folder_of(file)
        if other is None:
            # the public names, and the independent integrator, which imports nothing of the package
            assert file == ROOT / "rocking/__init__.py" or file.is_relative_to(ROOT / "reference")
            assert LAYER_OF[own] < LAYER_OF["rocking/_lookup"], f"{path} imports {file}"
        else:
            assert own == other or LAYER_OF[own] < LAYER_OF[other], f"{path} imports {file}"


def test_no_circular_imports() -> None:
    edges = {path: set(imported_files(path)) - {path} for path in MODULES}
    while leaves := [path for path, targets in edges.items() if not targets & edges.keys()]:
        for leaf in leaves:
            del edges[leaf]
    assert not edges, f"circle among {sorted(edges)}"


@pytest.mark.parametrize("path", sorted((ROOT / "reference").rglob("*.py")), ids=lambda path: path.name)
def test_the_reference_shares_no_code_with_the_package(path: Path) -> None:
    assert all(file.is_relative_to(ROOT / "reference") for file in imported_files(path))


PLOTTING = ("tests", "rocking/plot", "workflow/figures", "benchmarks/figures", "stress/figure.py")


@pytest.mark.parametrize("path", [p for p, name in zip(MODULES, NAMES, strict=True) if not name.startswith(PLOTTING)])
def test_only_plotting_modules_import_matplotlib(path: Path) -> None:
    nodes = list(ast.walk(ast.parse(path.read_text())))
    names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    names |= {str(node.module) for node in nodes if isinstance(node, ast.ImportFrom)}
    assert not any(name.split(".")[0] == "matplotlib" for name in names)
