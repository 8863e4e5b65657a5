"""Machine code on disk: found again by other processes, made again where it is damaged, done without if need be."""

import os
import platform
import shutil
import subprocess
import sys
from itertools import product
from pathlib import Path

import pytest

import rocking
from rocking import precompile
from rocking._base.source_tree import SourceTree, imported_names
from rocking._numba import kernel_cache
from rocking._numba.way import INTERNALS
from tests.sampling import but_long

ROOT = Path(__file__).parents[2]

WAYS = ["", "1"]
"""Values of ROCKING_PLAIN_NUMBA: the faster way, and the public interface of numba."""

KERNELS = """
from rocking._numba.compilation import kernel

@kernel
def double(x):
    return 2.0 * x

def total(values):
    found = 0.0
    for x in values:
        found += double(x)
    return found

def one(x):
    return x
"""

START = """
import sys
import warnings
said = []
warnings.simplefilter("always")
warnings.showwarning = lambda message, *_: said.append(str(message))
import numpy as np
from rocking._numba import kernel_cache
from rocking._numba.compilation import entry
from small_kernels import one, total

def hits_and_misses(compiled):
    return [sum(compiled.stats.cache_hits.values()), sum(compiled.stats.cache_misses.values())]
"""

CALL = """
compiled = entry(total)
assert compiled(np.ones(3)) == 6.0
sys.stdout.write(" ".join(map(str, [*hits_and_misses(compiled), len(said), *said])) + "\\n")  # in one piece
"""


@pytest.fixture(scope="module", params=but_long(WAYS, ""), ids=["faster", "plain"])
def empty(request, fork, tmp_path_factory):
    """A cache that knows the digest of the sources, which takes a second, and the way of compilation."""
    folder, way = tmp_path_factory.mktemp("empty"), {"ROCKING_PLAIN_NUMBA": request.param}
    fork("from rocking._numba import kernel_cache; kernel_cache.cache_folder()", NUMBA_CACHE_DIR=str(folder), **way)
    return folder, way


@pytest.fixture
def run(empty, fork, tmp_path):
    folder, way = empty
    cache_copy = Path(shutil.copytree(folder, tmp_path / "kept"))
    (tmp_path / "small_kernels.py").write_text(KERNELS)

    def forked(code=CALL):
        path = f"import sys; sys.path.append({str(tmp_path)!r})\n"
        return fork(path + START + code, NUMBA_CACHE_DIR=str(cache_copy), **way)

    def started(code=CALL, *, command=(sys.executable,), cache=cache_copy):
        variables = way | {"PYTHONPATH": f"{ROOT}{os.pathsep}{tmp_path}", "NUMBA_CACHE_DIR": str(cache)}
        done = subprocess.run(
            [*command, "-c", START + code], env=os.environ | variables, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    forked.kept, forked.started, forked.plain = cache_copy, started, bool(way["ROCKING_PLAIN_NUMBA"])
    return forked


def files_of(cache):
    (index,), (code,) = cache.rglob("*.nbi"), cache.rglob("*.nbc")
    return {"index": index, "machine code": code}


def truncated(content, share):
    return content[: int(share * len(content))]


def flipped(content, share):
    position = int(share * (len(content) - 1))
    return content[:position] + bytes([content[position] ^ 1]) + content[position + 1 :]


def test_other_processes_find_the_machine_code(run):
    """Each has its own addresses."""
    assert run().split() == ["0", "1", "0"]
    assert run.started().split() == ["1", "0", "0"]


def test_processes_that_start_together_compile_and_load_without_a_warning(run):
    code = f"import os, time\nfor _ in range(2): os.fork()\n{CALL}"
    assert [line.split()[2] for line in run(code).splitlines()] == ["0"] * 4
    assert run().split() == ["1", "0", "0"]


@pytest.mark.parametrize("named", [True, False])
def test_machine_code_of_a_named_processor_is_found_on_another_machine(run, named, monkeypatch):
    """Without a name another processor compiles again. Both are read when a process starts."""
    level = "x86-64" if platform.machine() == "x86_64" else "generic"
    if named:
        monkeypatch.setenv("NUMBA_CPU_NAME", level)
        monkeypatch.setenv("NUMBA_CPU_FEATURES", "")
    assert (run.started if named else run)().split() == ["0", "1", "0"]
    other = f"from llvmlite import binding\nbinding.get_host_cpu_name = lambda: {level!r}\n"
    (run.kept.parent / "sitecustomize.py").write_text(other)
    assert run.started().split() == (["1", "0", "0"] if named else ["0", "1", "0"])


SHARES = 0.5, 0.0, 0.98, 1.0 - 1e-9
DAMAGE = [*product(SHARES, ("index", "machine code"), (truncated, flipped))]


@pytest.mark.parametrize("case", but_long(DAMAGE, (0.5, "index", truncated), (0.5, "machine code", flipped)))
def test_a_damaged_file_is_made_again_with_one_warning(run, case):
    share, file, damage = case
    run()
    damaged = files_of(run.kept)[file]
    damaged.write_bytes(damage(damaged.read_bytes(), share))
    hits, misses, warned, text = run().split(maxsplit=3)
    assert (hits, misses, warned) == ("0", "1", "1")
    assert str(run.kept) in text
    assert "damaged" in text
    assert run().split() == ["1", "0", "0"]
    assert [path.name for path in run.kept.rglob("*total.*")] == []  # what was damaged is gone


NOT_REMOVED = """
from pathlib import Path
def rename(*_):
    raise PermissionError(13, "Permission denied")
Path.rename = rename
"""
UNWRITABLE = """
from pathlib import Path
import shutil
compiled = entry(total)
folder = Path(kernel_cache.cache_folder())
shutil.rmtree(folder)
folder.write_text("")
"""


@pytest.mark.parametrize("change", [NOT_REMOVED, UNWRITABLE], ids=["damaged", "unwritable"])
def test_a_folder_that_cannot_be_changed_disables_the_cache(run, change):
    run()
    files_of(run.kept)["machine code"].write_bytes(b"")
    compiled = CALL if change is NOT_REMOVED else CALL.replace("compiled = entry(total)\n", "")
    hits, misses, warned, text = run(f"{change}{compiled}assert compiled(np.ones(2)) == 4.0\n").split(maxsplit=3)
    assert (hits, misses, warned) == ("0", "0", "1")
    assert "NUMBA_CACHE_DIR" in text


@pytest.mark.parametrize(("complete", "expected"), [(True, ["1", "0", "0"]), (False, ["0", "1", "1"])])
def test_a_complete_folder_that_can_only_be_read_is_used(run, complete, expected):
    """The other tells why it is not: `precompile` marks what is complete."""
    run()
    if complete:
        (next(run.kept.glob("kernels-*")) / kernel_cache.COMPLETE).touch()
    if run.plain:
        expected = ["0", "1", "1"]  # numba's own cache writes into the folder
    assert run("kernel_cache._is_writable = lambda *_: False\n" + CALL).split()[:3] == expected


LIMITED = """
import resource
resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="there are no limits of processes")
def test_files_that_become_too_large_disable_the_cache(run):
    assert run(LIMITED + CALL).split()[:3] == ["0", "1", "1"]
    assert [*run.kept.rglob("*.nbc")] == []
    assert run().split() == ["0", "1", "0"]


@pytest.mark.skipif(INTERNALS is None, reason="numba's own cache belongs to a place")
def test_a_copy_of_the_package_needs_no_compilation(tmp_path):
    """Also one whose files are newer, such as an installation of the same version."""
    precompile.main()
    package = Path(rocking.__file__).parent
    shutil.copytree(package, tmp_path / "rocking", ignore=shutil.ignore_patterns("__pycache__"))
    for file in (tmp_path / "rocking").rglob("*.py"):
        file.touch()
    code = f"""
import sys
sys.path.insert(0, {str(tmp_path)!r})
import rocking
from rocking._solver.kernels.batch import solve_batch
assert rocking.peak_response("sine", slenderness=0.5, frequency_ratio=3.0, restitution=0.8, alpha=0.3).impacts > 0
print(rocking.__file__, sum(solve_batch.stats.cache_hits.values()), sum(solve_batch.stats.cache_misses.values()))"""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(Path(kernel_cache.cache_folder()).parent)}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True, env=environment
    )
    assert done.stdout.split() == [str(tmp_path / "rocking/__init__.py"), "1", "0"]


@pytest.fixture
def package(tmp_path):
    (tmp_path / "rocking" / "inner").mkdir(parents=True)
    return tmp_path / "rocking"


def digest_of(package):
    return kernel_cache.kernel_digest(SourceTree(package.parent, {"rocking"}))


@pytest.mark.parametrize(
    "statement",
    [
        "from rocking.inner.constants import X",
        "import rocking.inner.constants as known",
    ],
)
def test_the_digest_of_the_folder_depends_on_kernels_and_their_imports(package, statement):
    module, constants = package / "one.py", package / "inner" / "constants.py"
    imports = f"from rocking._numba.compilation import entry, kernel\n{statement}\n\n"
    module.write_text(f"{imports}@kernel\ndef f(x): ...\n")
    constants.write_text("X = 1\n")
    (package / "other.py").write_text('def g(x): ...\n"""\nfrom rocking.one import f\n"""\n')
    first = digest_of(package)
    (package / "other.py").write_text("def g(x): return 1\n")  # holds no kernel
    assert digest_of(package) == first
    module.write_text(f"{imports}@kernel\ndef f(x): return 1\n")
    second = digest_of(package)
    assert second != first
    constants.write_text("X = 2\n")  # a constant of the machine code
    third = digest_of(package)
    assert third not in (first, second)
    (package / "two.py").write_text("from numba.extending import intrinsic\n")
    assert digest_of(package) not in (first, second, third)


def test_modules_with_compiled_code_import_only_what_the_digest_states():
    """Their versions are part of it, and their files are not read."""
    sources = SourceTree(ROOT, {"rocking"})
    compiled = [path for path in sources.package() if kernel_cache._is_compiled(sources, path)]
    names = {
        (base or name).split(".")[0] for path in compiled for name, base, _ in imported_names(sources.syntax(path))
    }
    assert names - sys.stdlib_module_names - {"rocking"} == {package.__name__ for package in kernel_cache.MADE_WITH}


@pytest.mark.parametrize("name", [package.__name__ for package in kernel_cache.MADE_WITH])
def test_the_digest_depends_on_the_versions_of_what_is_imported(package, name, monkeypatch):
    first = digest_of(package)
    monkeypatch.setattr(sys.modules[name], "__version__", "0.0")
    assert digest_of(package) != first


@pytest.fixture
def folder(package, monkeypatch):
    """The cache folder of a process with its own package, user and environment."""
    monkeypatch.setattr(kernel_cache, "PACKAGE", package)
    monkeypatch.setattr(kernel_cache._WARNED, "is_set", lambda: False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(package.parent / "user"))
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    yield kernel_cache.cache_folder.__wrapped__
    kernel_cache.NOT_KEPT.clear()


def closed(path):
    """A path where no folder can be created, not even by the superuser."""
    path.write_text("")


def test_the_cache_is_beside_the_package_or_in_a_writable_folder(folder, package, tmp_path, monkeypatch):
    assert Path(folder()).parent == package / "__pycache__"
    shutil.rmtree(package / "__pycache__")
    closed(package / "__pycache__")
    assert Path(folder()).parent == tmp_path / "user" / "rocking"
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "given"))
    assert Path(folder()).parent == tmp_path / "given"


def test_a_process_without_a_cache_folder_gives_results_after_one_warning(run):
    shutil.rmtree(run.kept)
    closed(run.kept)
    hits, misses, warned, text = run().split(maxsplit=3)
    assert (hits, misses, warned) == ("0", "1", "1")
    assert "NUMBA_CACHE_DIR" in text
