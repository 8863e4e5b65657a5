"""Files of a results folder that are replaced, overwritten, unreadable or not regular files."""

import errno
import hashlib
import os
import time

import numpy as np
import pytest

import rocking._datasets.catalogue
from rocking._base.errors import DatasetError
from rocking._datasets.catalogue import Catalogue, FileVersion, UnknownDatasetError, version_of
from rocking._datasets.cube import write_dataset
from rocking._lookup.collection import CubeCollection
from rocking._lookup.cube import Points, UnreadError
from rocking._spectra.cubes import spectrum

NAME = "spectra/sine/eta-0.85"
POINT = {"slenderness": 0.7, "frequency_ratio": 7.0, "restitution": 0.85}


@pytest.fixture(scope="module")
def contents(tmp_path_factory):
    cube = spectrum(
        "sine", restitution=0.85, slenderness=np.linspace(0.6, 0.8, 21), frequency_ratio=np.geomspace(6.0, 8.0, 21)
    )
    files = []
    for number in (1, 2):
        path = tmp_path_factory.mktemp("made") / "cube.nc"
        write_dataset(cube.assign_attrs(version=number), path)
        files.append(path.read_bytes())
    assert len(files[0]) == len(files[1])
    return files


@pytest.fixture
def path(contents, tmp_path):
    """The first version in a results folder that also holds another data set."""
    path = tmp_path / "results" / f"{NAME}.nc"
    for name in (path, path.parents[1] / "cosine" / "eta-0.90.nc"):
        name.parent.mkdir(parents=True)
        name.write_bytes(contents[0])
    return path


@pytest.fixture
def cubes(path):
    return CubeCollection(path.parents[2])


def written(path, content):
    path.write_bytes(content)


def replaced(path, content):
    new = path.with_name("new")
    new.write_bytes(content)
    new.replace(path)


def sha256(content):
    return hashlib.sha256(content).hexdigest()


@pytest.mark.parametrize("change", [written, replaced])
def test_changed_content_of_equal_size_and_time_is_detected(cubes, path, contents, change):
    times = path.stat().st_atime_ns, path.stat().st_mtime_ns
    sources, versions = [], []
    for content in (*contents, contents[0]):
        change(path, content)
        os.utime(path, ns=times)
        response, version = cubes.response("sine", **POINT)
        sources.append(str(response.source))
        versions.append((*version, cubes.catalogue.product(NAME).sha256))
    assert sources == ["cube"] * 3
    assert versions == [(sha256(content),) * 2 for content in (*contents, contents[0])]


def test_opening_a_recently_changed_file_waits_one_clock_tick(path, monkeypatch):
    """Two writes within one tick of the file system clock have the same time stamp."""
    waited = []
    monkeypatch.setattr(time, "sleep", waited.append)
    path.touch()
    with Catalogue(path.parents[2]).open(NAME):
        assert waited == [rocking._datasets.catalogue.CLOCK_TICK / 1e9]
    assert not version_of(path).is_settled
    assert FileVersion(1, 2, 3, 4, changed=time.time_ns() - 10**9).is_settled


def test_open_file_is_not_affected_by_replacement(path, contents):
    with Catalogue(path.parents[2]).open(NAME) as file:
        replaced(path, contents[1])
        assert file.content() == contents[0]


def test_file_that_changes_while_it_is_read_is_refused(path, monkeypatch):
    with Catalogue(path.parents[2]).open(NAME) as file:
        monkeypatch.setattr(type(file), "is_unchanged", lambda _: False)
        with pytest.raises(DatasetError, match="changes while it is read"):
            file.content()


def test_response_names_the_version_it_was_read_from(cubes, path, contents, monkeypatch):
    respond = rocking._lookup.cube.Cube.response

    def replacing(*args, **kwargs):
        response = respond(*args, **kwargs)
        replaced(path, contents[1])
        return response

    monkeypatch.setattr(rocking._lookup.cube.Cube, "response", replacing)
    assert cubes.response("sine", **POINT)[1] == (sha256(contents[0]),)


def is_open(cubes, restitution=0.85):
    try:
        points = Points.of(*(POINT | {"restitution": restitution}).values(), None)[0]
        cubes.cube("sine", may_read=False).evaluate(points, 1e-4, "auto")
    except UnreadError:
        return False
    return True


def test_an_angle_is_read_when_it_is_needed_and_from_the_version_that_was_opened(tmp_path, monkeypatch):
    angles = np.linspace(0.1, 0.5, 6)
    axes = {"slenderness": np.linspace(0.3, 0.8, 9), "frequency_ratio": np.linspace(5.0, 9.0, 8), "alpha": angles}
    path = tmp_path / "spectra" / "sine" / "eta-0.85.nc"
    write_dataset(spectrum("sine", restitution=0.85, **axes), path, chunks={"alpha": 1})
    read, layer = [], rocking._lookup.cube_slice._layer_of_file
    monkeypatch.setattr(
        rocking._lookup.cube_slice, "_layer_of_file", lambda *arguments: read.append(arguments[-1]) or layer(*arguments)
    )
    cube = rocking.open_cube(path)
    assert read == []
    assert cube.response(**POINT, alpha=0.1).from_cube
    assert read == [0]
    between = cube.response(**POINT, alpha=[0.31, 0.15, 0.6], method="auto")
    assert read == [0, 1, 2, 3, 4]
    monkeypatch.setattr(rocking._lookup.cube_slice, "MAX_LAYER_BYTES", 4 * cube.slice_at(0).layers.at([0])[0].nbytes)
    assert cube.response(**POINT, alpha=0.5).from_cube
    assert read[5:] == [5]  # the others are forgotten
    again = cube.response(**POINT, alpha=[0.31, 0.15, 0.6])
    np.testing.assert_array_equal(again.peak_rotation, between.peak_rotation)
    cube.response(**POINT, alpha=0.2)
    replaced(path, path.read_bytes())
    assert not cube.response(**POINT, alpha=0.5).from_cube  # by the solver
    with pytest.raises(DatasetError, match="was replaced after it was opened"):
        cube.response(**POINT, alpha=0.5, method="cube")


def test_a_cube_that_is_replaced_between_two_angles_is_named_without_its_folder(cubes, path):
    angles = np.linspace(0.1, 0.5, 6)
    axes = {"slenderness": np.linspace(0.3, 0.8, 9), "frequency_ratio": np.linspace(5.0, 9.0, 8), "alpha": angles}
    write_dataset(spectrum("sine", restitution=0.85, **axes), path, chunks={"alpha": 1})
    opened = cubes.cube("sine", "cube")
    points = Points.of(*POINT.values(), 0.1)[0]
    opened.evaluate(points, 1e-4, "cube")
    path.unlink()
    with pytest.raises(DatasetError) as error:
        opened.evaluate(Points.of(*POINT.values(), 0.5)[0], 1e-4, "cube")
    assert NAME in str(error.value)
    assert str(path.parents[2]) not in str(error.value)


def test_a_sparse_file_of_any_size_is_refused_before_it_is_read(cubes, path):
    with path.open("wb") as file:
        file.truncate(50 * 1024**3)
    assert "has 53687091200 bytes" in cubes.problems()[NAME]
    assert str(cubes.response("sine", **POINT)[0].source) == "solver"
    with pytest.raises(DatasetError, match="a data set has at most"):
        rocking.open_cube(path)


def loop(path, _):
    path.symlink_to(path)


def folder(path, _):
    path.mkdir()


def pipe(path, _):
    os.mkfifo(path)


def link_to_nothing(path, _):
    path.symlink_to("nothing")


def forbidden(path, monkeypatch):
    """A file without permission to read; root could read it, so `os.open` is patched."""
    path.touch()
    opened = os.open

    def guarded(name, *args, **kwargs):
        if str(name) == str(path):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(name))
        return opened(name, *args, **kwargs)

    monkeypatch.setattr(os, "open", guarded)


UNREADABLE = [loop, folder, pipe, link_to_nothing, forbidden]


@pytest.mark.parametrize("make", UNREADABLE)
def test_unreadable_file_is_reported_and_the_solver_is_used(cubes, path, monkeypatch, make):
    path.unlink()
    make(path, monkeypatch)
    assert cubes.catalogue.names() == ["spectra/cosine/eta-0.90", NAME]
    with pytest.raises(DatasetError, match="cannot be read"):
        cubes.catalogue.product(NAME)
    problem = cubes.problems()[NAME]
    assert problem.startswith(f"{NAME}: cannot be read: ")
    assert str(path.parents[2]) not in problem
    response, versions = cubes.response("sine", **POINT)
    assert (str(response.source), versions) == ("solver", ())
    with pytest.raises(DatasetError, match="cannot be read"):
        cubes.response("sine", **POINT, method="cube")


def test_file_is_read_once_it_becomes_readable(cubes, path, contents):
    path.unlink()
    path.symlink_to(path)
    assert str(cubes.response("sine", **POINT)[0].source) == "solver"
    replaced(path, contents[0])
    assert str(cubes.response("sine", **POINT)[0].source) == "cube"
    assert NAME not in cubes.problems()


def folder_loop(folder, _):
    folder.symlink_to(folder)


def folder_forbidden(folder, monkeypatch):
    folder.mkdir()
    scanned = os.scandir

    def guarded(name):
        if str(name) == str(folder):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(name))
        return scanned(name)

    monkeypatch.setattr(os, "scandir", guarded)


@pytest.mark.parametrize("make", [folder_loop, folder_forbidden])
def test_unreadable_folder_is_reported_and_the_solver_is_used(cubes, path, monkeypatch, make):
    path.unlink()
    path.parent.rmdir()
    make(path.parent, monkeypatch)
    assert cubes.catalogue.names() == ["spectra/cosine/eta-0.90"]
    assert cubes.problems()["spectra/sine"].startswith("cannot be read: ")
    assert str(cubes.response("sine", **POINT)[0].source) == "solver"


def test_links_to_parent_folders_are_followed_once(cubes, path):
    (path.parent / "around").symlink_to(path.parents[2])
    assert cubes.catalogue.names() == ["spectra/cosine/eta-0.90", NAME]
    assert "spectra/sine/around" not in cubes.problems()


@pytest.mark.parametrize(
    "name",
    ["a" * 256, "spectra/" + "a" * 256, "a/" * 2500 + "b", f"{NAME}.nc/x", "spectra/sine/eta-0.99", "x", "../x/y", ""],
)
def test_unknown_names_raise(cubes, name):
    with pytest.raises(UnknownDatasetError):
        cubes.catalogue.product(name)


def test_memory_is_limited_to_the_cubes_that_were_used_last(cubes, path, monkeypatch):
    for eta in (0.86, 0.87):
        other = spectrum("sine", restitution=eta, slenderness=np.linspace(0.6, 0.8, 5), frequency_ratio=[6, 7, 8, 9])
        write_dataset(other, path.with_name(f"eta-{eta:.2f}.nc"))
    sizes = {eta: cubes.slice_at("sine", eta).layers.nbytes for eta in (0.86, 0.85, 0.86)}
    monkeypatch.setattr(rocking._lookup.collection, "MAX_BYTES", sum(sizes.values()))
    last_used = cubes.slice_at("sine", 0.86)  # used after that of 0.85
    cubes.slice_at("sine", 0.87)
    assert not is_open(cubes)
    assert cubes.slice_at("sine", 0.86) is last_used
