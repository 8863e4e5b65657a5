"""Machine code of the kernels: kept on disk under a name that changes with their source, free of the interpreter."""

import os
import re
import subprocess
import sys
from pathlib import Path

import rocking.compilation
from rocking.compilation import kernel
from rocking.rock_many import rock_many
from rocking.slender_arcs import hyperbolic

ROOT = Path(__file__).parents[1]


def folder_with(package: Path, monkeypatch) -> str:
    monkeypatch.setattr(rocking.compilation, "_PACKAGE", package)
    return rocking.compilation._cache_folder.__wrapped__()


def test_the_cache_folder_follows_every_kernel_source(tmp_path, monkeypatch):
    (tmp_path / "one.py").write_text("\n@kernel\ndef f(x): ...\n")
    (tmp_path / "other.py").write_text("def g(x): ...\n")
    first = folder_with(tmp_path, monkeypatch)
    assert folder_with(tmp_path, monkeypatch) == first
    (tmp_path / "other.py").write_text("def g(x): return 1\n")  # holds no kernel
    assert folder_with(tmp_path, monkeypatch) == first
    (tmp_path / "one.py").write_text("\n@kernel\ndef f(x): return 1\n")
    second = folder_with(tmp_path, monkeypatch)
    assert second != first
    (tmp_path / "two.py").write_text("\n@kernel\ndef h(x): ...\n")
    assert folder_with(tmp_path, monkeypatch) not in (first, second)


def test_an_installation_that_cannot_be_written_to_uses_the_users_cache(tmp_path, monkeypatch):
    (tmp_path / "one.py").write_text("\n@kernel\ndef f(x): ...\n")
    assert folder_with(tmp_path, monkeypatch).startswith(str(tmp_path))
    monkeypatch.setattr(os, "access", lambda *_: False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    assert folder_with(tmp_path, monkeypatch).startswith(str(tmp_path / "home" / "rocking"))


def test_kernels_release_the_interpreter_and_do_not_reorder_sums():
    for compiled in (rock_many, hyperbolic):
        options = compiled.targetoptions
        assert options["nogil"]
        assert options["fastmath"] == {"contract"}  # nothing that would assume away nan or rounding
    assert rock_many.nopython_signatures is not None


def test_division_by_zero_is_arithmetic_and_no_exception():
    @kernel
    def divide(x, y):
        return x / y

    assert divide(1.0, 0.0) == float("inf")


def test_a_second_process_finds_the_machine_code():
    script = (
        "import rocking; rocking.peak_response('sine', slenderness=0.4, frequency_ratio=5.0, restitution=0.85);"
        "from rocking.rock_many import rock_many; print(sum(rock_many.stats.cache_hits.values()),"
        " sum(rock_many.stats.cache_misses.values()))"
    )
    for _ in range(2):  # the first may compile
        run = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True)
    assert re.fullmatch(r"[1-9]\d* 0", run.stdout.strip())
