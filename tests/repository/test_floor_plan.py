"""The floor plan of docs/architecture.md, read from the import statements: an import may only point down."""

import ast
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

# From the ground up. A room is one idea, in one module or in several with a common stem; rooms of one floor are
# independent of each other.
FLOORS = (
    ("errors", "compilation", "provenance", "version", "lanes", "seal"),
    ("block", "pulse*", "orientation", "response", "cancellation"),
    ("scratch",),
    ("free_rocking", "fate_margin", "lane_sines", "contact", "cuts", "groups", "cube", "interpolation", "scale_law"),
    ("chatter", "stencil_choice"),
    ("slender*", "taylor*", "closed_form*"),
    ("rock",),
    ("rock_many",),
    ("solve*", "sampling"),
    ("sweep*", "boundary*", "history*", "bounded_response"),
    ("lookup*",),
    ("units", "precompile"),
    ("cli*",),
)
FRONT_DOORS = ("rocking.cli.app", "api", "workflow", "tests", "benchmarks", "stress")
# What the service may use: it asks for answers and opens no solver.
OF_THE_SERVICE = (
    *("lookup*", "cube", "boundary*", "history*", "bounded_response", "solve*"),
    *("errors", "block", "pulses", "response", "groups", "provenance", "cancellation", "precompile"),
)

MODULES = {
    ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): path
    for folder in ("rocking", "api", "workflow", "benchmarks", "stress")
    for path in sorted((ROOT / folder).rglob("*.py"))
}
INSIDE = [name for name in MODULES if name.startswith("rocking.")]


def imported(path: Path) -> Iterator[str]:
    """Dotted names of everything that a file imports, at any depth of its code."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                yield inner if inner in MODULES else str(node.module)


def room(module: str) -> tuple[int, str]:
    """Floor number and room of a module `rocking.NAME` or `rocking.NAME.PART`."""
    name = module.split(".")[1]
    places = [(n, r) for n, floor in enumerate(FLOORS) for r in floor if fnmatch(name, r)]
    assert len(places) == 1, f"{module} has no place, or several, in the floor plan: {places}"
    return places[0]


def matches(module: str, patterns: tuple[str, ...]) -> bool:
    return any(fnmatch(module.split(".")[1], pattern) for pattern in patterns)


@pytest.mark.parametrize("module", INSIDE)
def test_imports_point_down(module: str) -> None:
    floor, own = room(module)
    for name in imported(MODULES[module]):
        if name == "rocking" or name.startswith(FRONT_DOORS[1:]):
            # Only the command line, on the roof, may take the front doors.
            assert own == "cli*", f"{module} imports {name}"
        elif name.startswith("rocking."):
            target, other = room(name)
            assert target < floor or other == own, f"{module} (floor {floor}) imports {name} (floor {target})"


def test_no_circle_inside_a_room() -> None:
    edges = {m: {n for n in imported(MODULES[m]) if n in INSIDE and n != m} for m in INSIDE}
    while leaves := [m for m, targets in edges.items() if not targets & edges.keys()]:
        for leaf in leaves:
            del edges[leaf]
    assert not edges, f"circle among {sorted(edges)}"


@pytest.mark.parametrize("module", [m for m in MODULES if m.split(".")[0] == "api"])
def test_the_service_opens_no_solver(module: str) -> None:
    for name in imported(MODULES[module]):
        assert not name.startswith(("workflow", "tests", "benchmarks", "stress"))
        if name.startswith("rocking."):
            assert matches(name, OF_THE_SERVICE), f"{module} imports {name}"


@pytest.mark.parametrize("module", [m for m in MODULES if m.split(".")[0] == "workflow"])
def test_the_workflow_knows_no_service(module: str) -> None:
    assert not any(
        name.startswith(("api", "rocking.cli.app", "rocking.lookup.cube")) for name in imported(MODULES[module])
    )


PLOTTERS = ("workflow.figures", "benchmarks.figures", "stress.figure")


@pytest.mark.parametrize("module", [m for m in MODULES if not m.startswith(PLOTTERS)])
def test_only_figures_plot(module: str) -> None:
    assert not any(name.split(".")[0] == "matplotlib" for name in imported(MODULES[module]))
