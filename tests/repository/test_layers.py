"""Layers, read from the import statements: a module imports from its own folder and from lower layers only."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

# From the top down: folders below the root, or single modules of `rocking`. A folder may import itself and folders of
# later rows; folders in one row do not import each other.
LAYERS = (
    ("tests",),
    ("stress",),
    ("benchmarks",),
    ("api/rocking_api", "rocking/cli", "workflow"),
    ("rocking/precompile",),
    ("rocking/lookup",),
    ("rocking/spectra",),
    ("rocking/datasets",),
    ("rocking/boundary", "rocking/history", "rocking/interpolation"),
    ("rocking/solver", "rocking/closed_form", "rocking/groups"),
    ("rocking/model", "rocking/excitation", "rocking/orientation"),
    ("rocking/_numba",),
    ("rocking/errors", "rocking/version"),
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


def test_every_module_of_the_package_has_a_layer() -> None:
    paths = [*(ROOT / "rocking").rglob("*.py"), *(ROOT / "api").rglob("*.py"), *(ROOT / "workflow").rglob("*.py")]
    assert {path for path in paths if folder_of(path) is None} == {ROOT / "rocking/__init__.py"}


@pytest.mark.parametrize("path", MODULES, ids=NAMES)
def test_imports_point_to_own_folder_or_lower_layers(path: Path) -> None:
    own = str(folder_of(path))
    for file in imported_files(path):
        other = folder_of(file)
        if other is None:
            # the public names, and the independent integrator, which imports nothing of the package
            assert file == ROOT / "rocking/__init__.py" or file.is_relative_to(ROOT / "reference")
            assert LAYER_OF[own] < LAYER_OF["rocking/lookup"], f"{path} imports {file}"
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
