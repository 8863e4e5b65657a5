"""Tables of cubes in files that processes share: equal responses; made again after damage and for other cubes."""

import hashlib
import io
import logging
import os
import shutil
import threading
import time
import weakref
from collections import namedtuple

import numpy as np
import pytest

import rocking._datasets.shared_cache
import rocking._lookup.collection
import rocking._lookup.packed_tables
from rocking._datasets.catalogue import DataFile
from rocking._datasets.cube import AXES, DIMENSIONS, VARIABLES, build_spectrum_dataset, write_dataset
from rocking._datasets.shared_cache import MAX_WRITE_SECONDS
from rocking._lookup.collection import CubeCollection
from rocking._lookup.packed_tables import LAYOUT, write_tables
from rocking._spectra.cubes import spectra

NAMES = ["spectra/sine/eta-0.85", "spectra/sine/eta-0.86"]
GRID = {"slenderness": np.linspace(0.6, 0.8, 21), "frequency_ratio": np.geomspace(6.0, 8.0, 21)}
POINTS = {"slenderness": np.linspace(0.61, 0.79, 50), "frequency_ratio": np.linspace(6.1, 7.9, 50)}


@pytest.fixture(scope="module")
def contents(tmp_path_factory):
    """The bytes of two cubes, and of another version of the first."""
    cubes = [*spectra("sine", restitution=[0.85, 0.86], alpha=[0.0, 0.1], **GRID)]
    found = []
    for cube in (*cubes, cubes[0].assign_attrs(version=2)):
        path = tmp_path_factory.mktemp("made") / "cube.nc"
        write_dataset(cube, path)
        found.append(path.read_bytes())
    return found


@pytest.fixture
def results(contents, tmp_path):
    for name, content in zip(NAMES, contents, strict=False):
        path = tmp_path / "results" / f"{name}.nc"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    return tmp_path / "results"


def collection(results):
    """A collection as another process would have it."""
    return CubeCollection(results, results.with_name("cache"))


def tables_of(results):
    return sorted(results.with_name("cache").rglob("*.npy"))


def respond(cubes):
    response, versions = cubes.response("sine", restitution=0.85, **POINTS)
    assert "cube" in response.source
    return response.peak_rotation, versions


@pytest.fixture
def reads(monkeypatch):
    """Names of the data sets whose content is read."""
    names, content = [], DataFile.content

    def counted(file):
        names.append(file.name)
        return content(file)

    monkeypatch.setattr(DataFile, "content", counted)
    return names


def test_responses_are_equal_and_the_tables_read_only(results):
    own, shared = CubeCollection(results), collection(results)
    for eta in (0.85, 0.86, 0.853):
        expected, found = (
            cubes.response("sine", restitution=eta, alpha=0.1, absolute_tolerance=1e-2, **POINTS)
            for cubes in (own, shared)
        )
        assert found[1] == expected[1]
        for name in ("peak_rotation", "outcome", "impacts", "error_bound", "source"):
            np.testing.assert_array_equal(getattr(found[0], name), getattr(expected[0], name))
    private, mapped = (cubes.slice_at("sine", 0.85) for cubes in (own, shared))
    for name in (*AXES, "restitutions", "restitution", "pulse", "sha256"):
        np.testing.assert_array_equal(getattr(mapped, name), getattr(private, name))
    for name in ("peaks", "cells"):
        assert getattr(mapped, name).tobytes() == getattr(private, name).tobytes()
        assert not getattr(mapped, name).flags.writeable
        assert not getattr(mapped, name).flags.owndata


def test_another_process_reads_no_data_set_again(results, reads):
    first = collection(results)
    expected = respond(first)
    assert first.problems() == {}
    assert set(reads) == set(NAMES)
    reads.clear()
    other = collection(results)
    np.testing.assert_array_equal(respond(other)[0], expected[0])
    assert respond(other)[1] == expected[1]
    assert other.problems() == {}
    assert (other.catalogue.product(NAMES[0]).sha256,) == expected[1]
    assert reads == []


def test_processes_that_start_together_read_a_data_set_once(results, reads):
    respond(collection(results))  # the digest is known
    tables_of(results)[0].unlink()
    reads.clear()
    threads = [threading.Thread(target=respond, args=(collection(results),)) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert reads == NAMES[:1]


def truncated(path):
    path.write_bytes(path.read_bytes()[:-1])


def cut_in_half(path):
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def emptied(path):
    path.write_bytes(b"")


def with_zeros(path):
    path.write_bytes(bytes(path.stat().st_size))


def with_another_byte(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


def of_another_cube(path):
    (other,) = (one for one in tables_of(path.parents[3] / "results") if one != path)
    shutil.copy(other, path)


@pytest.mark.parametrize("damage", [truncated, cut_in_half, emptied, with_zeros, with_another_byte, of_another_cube])
def test_damaged_tables_are_rebuilt(results, damage):
    cubes = collection(results)
    expected = respond(cubes)
    cubes.slice_at("sine", 0.86)
    (path,) = (one for one in tables_of(results) if one.name.startswith(expected[1][0]))
    whole = path.read_bytes()
    damage(path)
    found = respond(collection(results))
    np.testing.assert_array_equal(found[0], expected[0])
    assert found[1] == expected[1]
    assert path.read_bytes() == whole


def test_tables_of_a_replaced_cube_are_deleted(results, contents):
    cubes = collection(results)
    respond(cubes)
    (old,) = tables_of(results)
    (old.parent / "killed.partial").touch()  # of a process that may still write
    new = results / "new"
    new.write_bytes(contents[2])
    new.replace(results / f"{NAMES[0]}.nc")
    assert respond(cubes)[1] == (hashlib.sha256(contents[2]).hexdigest(),)
    (path,) = tables_of(results)
    assert path != old
    assert path.name == f"{hashlib.sha256(contents[2]).hexdigest()}-{LAYOUT}.npy"
    assert sorted(one.name for one in path.parent.iterdir()) == sorted([path.name, "killed.partial", "version.json"])
    (results / f"{NAMES[0]}.nc").unlink()
    assert collection(results).problems() == {}
    assert not path.parent.exists()


def test_what_a_killed_process_left_is_deleted_but_not_what_another_one_writes(results, contents):
    respond(collection(results))
    folder = tables_of(results)[0].parent
    left, new = folder / "left.partial", folder / "new.partial"
    for path, age in ((left, 2 * MAX_WRITE_SECONDS), (new, 0.5 * MAX_WRITE_SECONDS)):
        path.touch()
        os.utime(path, (time.time() - age,) * 2)
    (results / f"{NAMES[0]}.nc").write_bytes(contents[2])
    respond(collection(results))
    assert not left.exists()
    assert new.exists()


def test_a_problem_is_remembered_until_the_file_changes(results, contents, reads):
    path = results / f"{NAMES[0]}.nc"
    path.write_bytes(contents[0][:-1])
    for _ in range(2):
        assert "damaged" in collection(results).problems()[NAMES[0]]
    assert reads.count(NAMES[0]) == 1
    path.write_bytes(contents[0])
    assert collection(results).problems() == {}
    record = next(results.with_name("cache").rglob("*0.85/version.json"))
    record.write_text('{"version": 1}')
    assert collection(results).problems() == {}
    assert reads.count(NAMES[0]) == 3


def folder_is_a_file(results, _):
    results.with_name("cache").touch()


def disk_is_full(_, monkeypatch):
    usage = namedtuple("usage", "total used free")(10**12, 10**12, 1000)
    monkeypatch.setattr(rocking._datasets.shared_cache.shutil, "disk_usage", lambda _: usage)


def writing_fails(_, monkeypatch):
    def write(file, *_):
        file.write(b"a part of it")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(rocking._lookup.packed_tables, "write_tables", write)


@pytest.mark.parametrize("fail", [folder_is_a_file, disk_is_full, writing_fails])
def test_without_a_cache_the_tables_are_in_memory(results, monkeypatch, caplog, fail):
    expected = respond(CubeCollection(results))
    fail(results, monkeypatch)
    with caplog.at_level(logging.WARNING, "rocking"):
        cubes = collection(results)
        found = respond(cubes)
        assert cubes.slice_at("sine", 0.86).peaks.flags.writeable
    np.testing.assert_array_equal(found[0], expected[0])
    assert cubes.problems() == {}
    assert len(caplog.records) == 1
    assert "private memory" in caplog.text
    assert [*results.with_name("cache").rglob("*.partial"), *tables_of(results)] == []


def test_tables_in_private_memory_are_limited(results, monkeypatch, reads):
    folder_is_a_file(results, monkeypatch)
    cubes = collection(results)
    monkeypatch.setattr(rocking._lookup.collection, "MAX_PRIVATE_BYTES", cubes.slice_at("sine", 0.85).private_bytes)
    kept = cubes.slice_at("sine", 0.86)
    assert not cubes.is_open("sine", 0.85)
    assert cubes.slice_at("sine", 0.86) is kept
    reads.clear()
    respond(cubes)
    assert set(reads) == {NAMES[0]}


def test_a_replaced_cube_is_not_kept_by_its_neighbour(results, contents):
    cubes = CubeCollection(results)
    between = POINTS | {"restitution": 0.855}
    cubes.response("sine", **between)
    old = weakref.ref(cubes.slice_at("sine", 0.86))
    assert cubes.slice_at("sine", 0.85)._windows
    (results / f"{NAMES[1]}.nc").write_bytes(contents[1])
    cubes.response("sine", **between)
    assert old() is None


def test_the_layout_has_a_version_of_its_own():
    """If this fails, another LAYOUT is needed: files made before would be read as if they were made now."""
    shape = (1, 4, 4)
    values = np.arange(16).reshape(shape)
    variables = dict.fromkeys(VARIABLES, values) | {
        "stencil": values % 4,
        "outcome": values % 5,
        "impacts": values // 8,
    }
    axes = dict(zip(DIMENSIONS, ([0.0], np.linspace(0.2, 0.8, 4), np.geomspace(1.0, 8.0, 4)), strict=True))
    cube = build_spectrum_dataset(variables, pulse="sine", restitution=0.85, axes=axes)
    file = io.BytesIO()
    write_tables(file, cube, "0" * 64)
    assert (LAYOUT, hashlib.sha256(file.getvalue()).hexdigest()[:16]) == (2, "b8763b0787b64078")
