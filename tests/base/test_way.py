"""The public interface of numba is used alone where its private names may differ from those that were tried."""

import ast
import re
import tomllib
from pathlib import Path

import pytest

from rocking._numba.way import TRIED

ROOT = Path(__file__).parents[2]

PUBLIC = {"numba": {"njit", "types"}, "numba.extending": None}
"""Modules of numba and what is imported of them, None: anything."""

CALL = """
import warnings
warnings.simplefilter("error")
import numba
{change}
from rocking._numba.compilation import entry, kernel
from rocking._numba.way import INTERNALS

@kernel
def double(x):
    return 2.0 * x

@entry
def fourfold(x):
    return double(double(x))

print(INTERNALS is None, fourfold(1.5))
"""


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    """One for all tests: the digest of the sources takes a second for each new one."""
    return str(tmp_path_factory.mktemp("cache"))


@pytest.mark.parametrize(
    ("change", "plain"),
    [
        ("", False),
        ("numba.version_info = numba.version_info._replace(short=(TRIED[0], TRIED[1] + 1))", True),
        ("numba.version_info = numba.version_info._replace(short=(TRIED[0] + 1, 0))", True),
        ("numba.version_info = numba.version_info._replace(short=(0, None))", True),
        ("import numba.core.codegen; del numba.core.codegen.JITCodeLibrary", True),
        ("import sys; sys.modules['numba.core.targetconfig'] = None", True),
        ("import os; os.environ['ROCKING_PLAIN_NUMBA'] = '1'", True),
        ("import os; os.environ['ROCKING_PLAIN_NUMBA'] = '0'", False),
    ],
)
def test_numba_with_other_private_names_compiles_without_them_and_without_a_warning(
    change, plain, fork, cache, tmp_path
):
    (tmp_path / "small.py").write_text(CALL.format(change=f"TRIED = {TRIED}; {change}"))
    code = f"import runpy; runpy.run_path({str(tmp_path / 'small.py')!r})"
    result = fork(code, NUMBA_CACHE_DIR=cache, ROCKING_PLAIN_NUMBA="")
    assert result.split() == [str(plain), "6.0"]


def test_private_names_of_numba_are_in_one_file():
    for path in (ROOT / "rocking").rglob("*.py"):
        if path.name == "internals.py":
            continue
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names if alias.name.startswith("numba")]
                assert names in ([], ["numba"]), path
            elif isinstance(node, ast.ImportFrom) and str(node.module).split(".")[0] == "numba":
                allowed = PUBLIC[str(node.module)]
                assert allowed is None or {alias.name for alias in node.names} <= allowed, path


def test_the_tried_version_is_stated_at_the_requirement_and_not_older_than_the_lock():
    pyproject = (ROOT / "pyproject.toml").read_text()
    (tried,) = re.findall(r'"numba>=[\d.]+", # up to ([\d.]+) ', pyproject)
    assert tuple(map(int, tried.split("."))) == TRIED
    (least,) = (
        requirement.removeprefix("numba>=")
        for requirement in tomllib.loads(pyproject)["project"]["dependencies"]
        if "numba>" in requirement
    )
    (locked,) = re.findall(r"^numba==(\d+)\.(\d+)", (ROOT / "environment.lock").read_text(), re.M)
    assert tuple(map(int, least.split("."))) <= tuple(map(int, locked)) <= TRIED
