"""The catalogue hashes each version of a file once."""

import os

import pytest

from rocking._datasets import catalogue


@pytest.fixture
def hashed(monkeypatch):
    """The contents that the catalogue has hashed, in order."""
    contents = []

    def sha256_of(content):
        contents.append(bytes(content))
        return f"digest {len(contents)}"

    monkeypatch.setattr(catalogue, "sha256_of", sha256_of)
    return contents


def write(path, content, seconds):
    """Write a file whose last change lies far enough in the past."""
    path.write_bytes(content)
    os.utime(path, (seconds, seconds))


def test_an_unchanged_file_is_hashed_once(tmp_path, hashed):
    folder = tmp_path / "spectra"
    folder.mkdir()
    write(folder / "one.nc", b"first", 1_000_000_000)
    write(folder / "two.nc", b"other", 1_000_000_000)
    files = catalogue.Catalogue(tmp_path)
    first = files.product("spectra/one")
    assert (first.size, first.sha256) == (5, "digest 1")
    assert files.product("spectra/one") == first
    files.product("spectra/two")
    assert files.product("spectra/one") == first
    assert hashed == [b"first", b"other"]
    write(folder / "one.nc", b"changed", 1_000_000_100)
    assert files.product("spectra/one").sha256 == "digest 3"
    assert hashed == [b"first", b"other", b"changed"]
