"""Files of a results folder that are replaced, written to, unreadable, or not files at all."""

import errno
import hashlib
import os
import time

import numpy as np
import pytest

import rocking.datasets.catalogue
from rocking.datasets.catalogue import Catalogue, FileVersion, UnknownDatasetError, version_of
from rocking.datasets.cube import read_spectrum, write_dataset
from rocking.errors import DatasetError
from rocking.lookup.collection import CubeCollection
from rocking.spectra.cubes import spectrum

NAME = "spectra/sine/eta-0.85"
POINT = {"slenderness": 0.7, "frequency_ratio": 7.0, "restitution": 0.85}


@pytest.fixture(scope="module")
def contents(tmp_path_factory):
    """Two versions of a cube, as bytes."""
    made = spectrum(
        "sine", restitution=0.85, slenderness=np.linspace(0.6, 0.8, 21), frequency_ratio=np.geomspace(6.0, 8.0, 21)
    )
    found = []
    for number in (1, 2):
        path = tmp_path_factory.mktemp("made") / "cube.nc"
        write_dataset(made.assign_attrs(version=number), path)
        found.append(path.read_bytes())
    assert len(found[0]) == len(found[1])
    return found


@pytest.fixture
def path(contents, tmp_path):
    """The first version in a results folder, and beside it another data set."""
    path = tmp_path / "results" / f"{NAME}.nc"
    for name in (path, path.parents[1] / "cosine" / "eta-0.90.nc"):
        name.parent.mkdir(parents=True)
        name.write_bytes(contents[0])
    return path


@pytest.fixture
def atlas(path):
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
def test_other_bytes_of_the_same_size_and_time_are_noticed(atlas, path, contents, change):
    times = path.stat().st_atime_ns, path.stat().st_mtime_ns
    answers, versions = [], []
    for content in (*contents, contents[0]):
        change(path, content)
        os.utime(path, ns=times)
        answer, version = atlas.response("sine", **POINT)
        answers.append(str(answer.source))
        versions.append((*version, atlas.catalogue.product(NAME).sha256))
    assert answers == ["cube"] * 3
    assert versions == [(sha256(content),) * 2 for content in (*contents, contents[0])]


def test_a_file_that_has_just_changed_is_given_a_tick(path, monkeypatch):
    """Two writes in one tick of the clock of the file system bear the same time."""
    waited = []
    monkeypatch.setattr(time, "sleep", waited.append)
    path.touch()
    with Catalogue(path.parents[2]).open(NAME):
        assert waited == [rocking.datasets.catalogue.CLOCK_TICK / 1e9]
    assert not version_of(path).is_settled
    assert FileVersion(1, 2, 3, 4, changed=time.time_ns() - 10**9).is_settled


def test_what_is_open_stays_what_it_was(path, contents):
    with Catalogue(path.parents[2]).open(NAME) as file:
        replaced(path, contents[1])
        assert file.content() == contents[0]


def test_a_file_that_changes_while_it_is_read_is_refused(path, monkeypatch):
    with Catalogue(path.parents[2]).open(NAME) as file:
        monkeypatch.setattr(type(file), "is_unchanged", lambda _: False)
        with pytest.raises(DatasetError, match="changes while it is read"):
            file.content()


def test_an_answer_names_the_version_that_gave_it(atlas, path, contents, monkeypatch):
    respond = rocking.lookup.cube.Cube.response

    def replacing(*args, **kwargs):
        answer = respond(*args, **kwargs)
        replaced(path, contents[1])
        return answer

    monkeypatch.setattr(rocking.lookup.cube.Cube, "response", replacing)
    assert atlas.response("sine", **POINT)[1] == (sha256(contents[0]),)


def test_a_cube_that_has_to_be_read_again_is_not_open(atlas, path, contents):
    atlas.response("sine", **POINT)
    assert atlas.is_open("sine", 0.85)
    replaced(path, contents[1])
    assert not atlas.is_open("sine", 0.85)


def loop(path, _):
    path.symlink_to(path)


def folder(path, _):
    path.mkdir()


def pipe(path, _):
    os.mkfifo(path)


def link_to_nothing(path, _):
    path.symlink_to("nothing")


def forbidden(path, monkeypatch):
    """As for anybody but root."""
    path.touch()
    opened = os.open

    def guarded(name, *args, **kwargs):
        if str(name) == str(path):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(name))
        return opened(name, *args, **kwargs)

    monkeypatch.setattr(os, "open", guarded)


UNREADABLE = [loop, folder, pipe, link_to_nothing, forbidden]


@pytest.mark.parametrize("make", UNREADABLE)
def test_an_unreadable_file_is_told_and_the_solver_answers(atlas, path, monkeypatch, make):
    path.unlink()
    make(path, monkeypatch)
    assert atlas.catalogue.names() == ["spectra/cosine/eta-0.90", NAME]
    with pytest.raises(DatasetError, match="cannot be read"):
        atlas.catalogue.product(NAME)
    problem = atlas.problems()[NAME]
    assert problem.startswith(f"{NAME}: cannot be read: ")
    assert str(path.parents[2]) not in problem
    answer, versions = atlas.response("sine", **POINT)
    assert (str(answer.source), versions) == ("solver", ())
    with pytest.raises(DatasetError, match="cannot be read"):
        atlas.response("sine", **POINT, method="cube")


def test_a_file_that_can_be_read_again_is(atlas, path, contents):
    path.unlink()
    path.symlink_to(path)
    assert str(atlas.response("sine", **POINT)[0].source) == "solver"
    replaced(path, contents[0])
    assert str(atlas.response("sine", **POINT)[0].source) == "cube"
    assert NAME not in atlas.problems()


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
def test_an_unreadable_folder_is_told_and_the_solver_answers(atlas, path, monkeypatch, make):
    path.unlink()
    path.parent.rmdir()
    make(path.parent, monkeypatch)
    assert atlas.catalogue.names() == ["spectra/cosine/eta-0.90"]
    assert atlas.problems()["spectra/sine"].startswith("cannot be read: ")
    assert str(atlas.response("sine", **POINT)[0].source) == "solver"


def test_links_that_lead_back_are_followed_once(atlas, path):
    (path.parent / "around").symlink_to(path.parents[2])
    assert atlas.catalogue.names() == ["spectra/cosine/eta-0.90", NAME]
    assert "spectra/sine/around" not in atlas.problems()


@pytest.mark.parametrize(
    "name",
    ["a" * 256, "spectra/" + "a" * 256, "a/" * 2500 + "b", f"{NAME}.nc/x", "spectra/sine/eta-0.99", "x", "../x/y", ""],
)
def test_there_is_no_such_data_set(atlas, name):
    with pytest.raises(UnknownDatasetError):
        atlas.catalogue.product(name)


def test_reading_a_cube_needs_its_file_once(path, monkeypatch):
    """Its values and its digest are of the same bytes."""
    opened = []
    read = type(path).read_bytes
    monkeypatch.setattr(type(path), "read_bytes", lambda self: opened.append(self) or read(self))
    assert read_spectrum(path).attrs["version"] == 1
    assert opened == [path]
