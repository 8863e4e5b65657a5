"""Readers of accelerograms: good, odd and damaged files of each format."""

import pickle
import random
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import rocking
from rocking._numba.cancellation import StopFlag
from rocking.errors import InvalidArgumentError, RecordFileError, StoppedError
from rocking.excitation.records.readers.read_record import parse_record
from rocking.excitation.records.record import UNITS
from tests.excitation.record_files import DAMAGED, GOOD, KNET_HEADER, KNET_ROWS, ODD, File, at2, esm, pairs, rows
from tests.excitation.record_fuzzer import fuzz


def test_there_are_at_least_sixty_files() -> None:
    assert len(GOOD) + len(ODD) + len(DAMAGED) >= 60


@pytest.mark.parametrize("file", [*GOOD.values(), *ODD.values()], ids=[*GOOD, *ODD])
def test_good_and_odd_files_are_read(file: File, tmp_path) -> None:
    path = tmp_path / "motion.dat"  # the suffix says nothing
    path.write_bytes(file.data)
    record = rocking.read_record(path, **file.arguments)
    assert record.time_step == pytest.approx(file.step, rel=1e-4)
    np.testing.assert_allclose(record.acceleration, file.samples * UNITS[file.unit], rtol=1e-12)
    assert "motion.dat" in record.source


@pytest.mark.parametrize("file", DAMAGED.values(), ids=[*DAMAGED])
def test_damaged_files_are_refused_with_place_and_reason(file: File, tmp_path) -> None:
    path = tmp_path / "motion.dat"
    path.write_bytes(file.data)
    with pytest.raises(RecordFileError, match=file.error) as caught:
        rocking.read_record(path, **file.arguments)
    assert str(caught.value).startswith("motion.dat")
    assert "; expected " in str(caught.value)


def test_a_number_of_values_that_the_header_does_not_state_is_a_remark_that_remains() -> None:
    record = parse_record(at2("NPTS= 101, DT= .01 SEC", body=rows(count=100)).encode(), "x.at2")
    assert record.remarks == ("the file holds 100 samples, its header states 101",)
    assert record.source == "x.at2 (PEER AT2)"
    assert record.baseline_corrected().remarks == record.resampled(0.005).remarks == record.remarks
    assert parse_record(at2().encode(), "x.at2").remarks == ()


@pytest.mark.parametrize(
    "file", [at2(), esm(), KNET_HEADER + KNET_ROWS, pairs()], ids=["AT2", "ESM", "K-NET", "columns"]
)
def test_reading_can_be_cancelled(file: str) -> None:
    stop = StopFlag()
    parse_record(file.encode(), "x", stop=stop)
    stop.set()
    with pytest.raises(StoppedError):
        parse_record(file.encode(), "x", stop=stop)


GROWTH = """
import sys
from rocking.excitation.records.readers.read_record import read_record

def most():
    (line,) = [line for line in open("/proc/self/status") if line.startswith("VmHWM")]
    return int(line.split()[1])

before = most()
assert read_record(sys.argv[1]).samples == 400_000
print(most() - before)
"""
"""Prints how much memory reading a file takes [kB]."""


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="needs the memory that Linux tells")
@pytest.mark.parametrize(
    ("header", "row"),
    [
        ("time_s,acceleration_g\n", "{0:.2f},{1:.9f}\n"),
        ("unit: g\ndt: 0.01\n", "{1:.17f}\n"),
        (at2("NPTS= 400000, DT= .01", body=""), "{1:19.10E}\n"),
    ],
    ids=["columns", "one column", "AT2"],
)
def test_reading_takes_at_most_four_times_the_memory_of_the_file(header: str, row: str, tmp_path) -> None:
    path = tmp_path / "motion"
    path.write_text(header + "".join(row.format(0.01 * k, 0.1 + k / 1e9) for k in range(400_000)))
    grown = subprocess.run([sys.executable, "-c", GROWTH, path], check=True, capture_output=True).stdout
    assert 1024 * int(grown) < 4 * path.stat().st_size


def test_a_missing_file_is_an_invalid_argument(tmp_path) -> None:
    with pytest.raises(InvalidArgumentError, match="a file that can be read"):
        rocking.read_record(tmp_path / "none.at2")


@pytest.mark.parametrize("arguments", [{"unit": "ft/s2"}, {"time_step": 0.0}, {"time_step": float("nan")}])
def test_arguments_are_checked(arguments: dict) -> None:
    with pytest.raises(InvalidArgumentError, match=next(iter(arguments))):
        parse_record(at2().encode(), "x.at2", **arguments)


def test_errors_can_be_sent_between_processes() -> None:
    error = RecordFileError("a.at2", 3, "x", "a number")
    copy = pickle.loads(pickle.dumps(error))
    assert str(copy) == str(error) == "a.at2, line 3: found x; expected a number"
    assert (copy.file, copy.line, copy.expected) == ("a.at2", 3, "a number")


def test_seismic_formats_without_obspy_name_the_package(monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "obspy", None)
    with pytest.raises(RecordFileError, match="pip install obspy"):
        parse_record(b"000001D " + b"\x01" * 600, "x.mseed", unit="g")
    sac = np.zeros(700, np.uint8)
    sac[304] = 6
    with pytest.raises(RecordFileError, match="pip install obspy"):
        parse_record(sac.tobytes(), "x.sac", unit="g")


def test_the_south_napa_record_is_read() -> None:
    record = rocking.read_record("workflow/motions/napa_HNE.csv")
    assert (record.samples, record.time_step) == (6997, 0.005)
    assert record.peak_acceleration == pytest.approx(3.656, abs=2e-3)


def test_mutated_files_are_read_or_refused() -> None:
    """A few seconds; `python -m tests.excitation.record_fuzzer --seconds 3600` runs longer."""
    dice = random.Random(0)
    read = sum(fuzz(dice) for _ in range(2000))
    assert 50 < read < 1900
