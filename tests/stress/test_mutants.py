"""The mutation trial: which changes are drawn, which tests run for each, and that these notice a change."""

import sqlite3
import subprocess
from pathlib import Path

import pytest

from stress.mutants import ImportGraph, ordered_tests, run_tests, sample

ROOT = Path(__file__).parents[2]


def test_changes_are_drawn_from_a_seed_one_at_each_place(tmp_path: Path) -> None:
    """`<<` for `+` and changes of other folders are not drawn."""
    kept = []
    for k in range(2):
        session = tmp_path / f"{k}.sqlite"
        with sqlite3.connect(session) as database:
            database.execute("CREATE TABLE work_items (job_id)")
            columns = "module_path, operator_name, occurrence, start_pos_row, start_pos_col, job_id"
            database.execute(f"CREATE TABLE mutation_specs ({columns})")
            for row in range(40):
                place = f"build/mutants/{'rocking' if row % 2 else 'api'}/a.py"
                for operator in ("Add_Sub", "Add_Mul", "Add_LShift"):
                    job = f"{row} {operator}"
                    specification = (place, f"core/ReplaceBinaryOperator_{operator}", row, row, 5, job)
                    database.execute("INSERT INTO mutation_specs VALUES (?, ?, ?, ?, ?, ?)", specification)
                    database.execute("INSERT INTO work_items VALUES (?)", [job])
        sample(session, count=10, seed=3, folders=["rocking"])
        with sqlite3.connect(session) as database:
            tables = ("mutation_specs", "work_items")
            one, other = ({job for (job,) in database.execute(f"SELECT job_id FROM {table}")} for table in tables)
            assert one == other
            kept.append(one)
    assert kept[0] == kept[1]
    assert len({job.split()[0] for job in kept[0]}) == len(kept[0]) == 10
    assert all(int(job.split()[0]) % 2 and not job.endswith("LShift") for job in kept[0])


TREE = {
    "rocking/__init__.py": "",
    "rocking/__init__.pyi": "from .inner.a import f as f\nfrom . import inner as inner\n",
    "rocking/inner/__init__.py": "",
    "rocking/inner/a.py": "from rocking.inner.b import g",
    "rocking/inner/b.py": "g = 1",
    "api/service/app.py": "import rocking.inner.b",
    "tests/helper.py": "from rocking.inner import a as one\none.x",
    "tests/test_public.py": "import rocking\nrocking.f",
    "tests/test_helper.py": "import numpy as np\nfrom tests.helper import cell",
    "tests/api/conftest.py": "from service import app",
    "tests/api/test_service.py": "",
}


def test_imports_are_counted_through_public_names_helpers_and_fixtures(tmp_path: Path) -> None:
    write(tmp_path, TREE)
    graph = ImportGraph(tmp_path)
    a, b = tmp_path / "rocking/inner/a.py", tmp_path / "rocking/inner/b.py"
    found = [
        graph.distances(tmp_path / f"tests/{name}.py") for name in ("test_public", "test_helper", "api/test_service")
    ]
    assert [one.get(a) for one in found] == [1, 2, None]
    assert [one.get(b) for one in found] == [2, 3, 3]


def write(tree: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        (tree / name).write_text(text)


def test_tests_of_each_module_are_those_that_import_it() -> None:
    graph = ImportGraph(ROOT)
    assert graph.distances(ROOT / "tests/model/test_masonry_arch.py")[ROOT / "rocking/_model/linkage.py"] == 1
    known = {module for test in ROOT.glob("tests/**/test_*.py") for module in graph.distances(test)}
    missing = {path for name in ("rocking", "api/rocking_api") for path in (ROOT / name).rglob("*.py")} - known
    by_name = {
        "__main__.py",
        "mesh_process.py",
        "sheet_process.py",
        "server.py",
        "zarr_store.py",
        "distribution.py",  # a picture that tests ask for by name
        "table_preview.py",  # used by a page of the assessment
    }  # of processes that tests start
    assert {path.name for path in missing} <= {"__init__.py", *by_name}  # docstrings


@pytest.mark.long  # starts pytest four times
def test_a_change_is_noticed_if_a_test_that_imports_the_module_fails(tmp_path: Path) -> None:
    files = {"rocking/__init__.py": "", "rocking/a.py": "g = 1", "rocking/b.py": "from rocking.a import g"}
    tests = {name: f"from rocking.{name} import g\ndef test_g():\n    assert g > 0" for name in "ab"}
    write(tmp_path, files | {f"tests/test_{name}.py": text for name, text in tests.items()})
    assert [path.stem for path in ordered_tests(tmp_path / "rocking/a.py", tmp_path)] == ["test_a", "test_b"]
    for command in (["init"], ["add", "."]):
        subprocess.run(["git", *command], cwd=tmp_path, capture_output=True, check=True)
    for text, status in (("g = 2", 0), ("g = -1", 1)):
        (tmp_path / "rocking/a.py").write_text(text)
        assert run_tests(tmp_path) == status
