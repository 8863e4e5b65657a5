"""Readers of accelerograms: good, odd and damaged files of each format."""

import pickle
import random
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import rocking
from rocking._base.errors import InvalidArgumentError, RecordFileError, StoppedError
from rocking._base.units import STANDARD_GRAVITY
from rocking._excitation.records.readers import layout
from rocking._excitation.records.readers.columns import read_rotations
from rocking._excitation.records.readers.lines import TextFile
from rocking._excitation.records.readers.read_record import parse_record
from rocking._excitation.records.record import UNITS
from rocking._numba.cancellation import StopFlag
from tests.excitation import dialects
from tests.excitation.record_files import DAMAGED, GOOD, KNET_HEADER, KNET_ROWS, ODD, THREE, File, at2, esm, pairs, rows
from tests.excitation.record_fuzzer import fuzz
from tests.sampling import SEED, number


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
    assert parse_record(f"NPTS: 20\n{pairs()}".encode(), "x").remarks == (
        "the file holds 24 samples, its header states NPTS: 20",
    )


@pytest.mark.parametrize(
    ("file", "stated"),
    [
        (at2(), "the unit g"),
        (esm(), "the unit cm/s2"),
        (pairs(), "the unit g"),
        (KNET_HEADER + KNET_ROWS, "the unit gal"),
        ("unit: g\nunit: gal\ndt: 0.01 s\n0.1\n0.2\n-0.1\n", ""),
        ("unit: counts\ndt: 0.01 s\n0.1\n0.2\n-0.1\n", "unit: counts"),
    ],
    ids=["AT2", "ESM", "columns", "K-NET", "two units", "counts"],
)
def test_an_argument_beats_the_file_with_a_remark_that_names_both(file: str, stated: str) -> None:
    """What is ambiguous in the file alone is settled by the argument without one."""
    record = parse_record(file.encode(), "x", unit="mm/s2", time_step=0.02)
    own = parse_record(file.encode(), "x", unit="g")
    assert record.time_step == 0.02
    assert "a time step of 0.01 s; 0.02 s is used, as the argument `time_step` says" in " ".join(record.remarks)
    ratio = UNITS["mm/s2"] / UNITS["g"]
    np.testing.assert_allclose(record.acceleration, own.acceleration * ratio, rtol=1e-12)
    assert (f"the file states {stated};" in " ".join(record.remarks)) == bool(stated)


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
from rocking._excitation.records.readers.read_record import read_record

def most():
    (line,) = [line for line in open("/proc/self/status") if line.startswith("VmHWM")]
    return int(line.split()[1])

before = most()
assert read_record(sys.argv[1]).samples == 600_000
print(most() - before)
"""
"""Prints how much memory reading a file takes [kB]."""


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="needs the memory that Linux tells")
@pytest.mark.parametrize(
    ("header", "row"),
    [
        ("time_s,acceleration_g\n", "{0:.2f},{1:.9f}\n"),
        ("unit: g\ndt: 0.01\n", "{1:.17f}\n"),
        (at2("NPTS= 600000, DT= .01", body=""), "{1:19.10E}\n"),
    ],
    ids=["columns", "one column", "AT2"],
)
def test_reading_takes_at_most_four_times_the_memory_of_the_file(header: str, row: str, tmp_path) -> None:
    path = tmp_path / "motion"
    path.write_text(header + "".join(row.format(0.01 * k, 0.1 + k / 1e9) for k in range(600_000)))
    grown = subprocess.run([sys.executable, "-c", GROWTH, path], check=True, capture_output=True).stdout
    assert 1024 * int(grown) < 4 * path.stat().st_size


def test_errors_can_be_sent_between_processes(tmp_path) -> None:
    with pytest.raises(InvalidArgumentError, match="no such file"):
        rocking.read_record(tmp_path / "none.at2")
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


@pytest.mark.parametrize(
    ("missing", "decimals", "read"), [(400, 3, True), (200, 3, False), (398, 3, False), (400, 2, False)]
)
def test_times_are_uniform_as_far_as_their_last_decimal_says(missing: int, decimals: int, read: bool) -> None:
    lines = [f"{k / 128:.{decimals}f},{np.sin(k):.4f}\n" for k in range(401) if k != missing]
    text = ("time [s],acc [g]\n" + "".join(lines)).encode()
    if read:
        assert parse_record(text, "rounded").time_step == pytest.approx(1 / 128, rel=1e-3)
    else:
        with pytest.raises(RecordFileError, match="uniform steps"):
            parse_record(text, "rounded")


@pytest.mark.parametrize("rows", ["0.1\n0.2\n", "1 " * 4000])
def test_words_of_long_lines_are_not_looked_up(rows: str, monkeypatch) -> None:
    words: list[str] = []
    for name in ("quantities_of", "unit_name"):
        looked_up = getattr(layout, name)
        monkeypatch.setattr(layout, name, lambda text, *given, of=looked_up: words.append(text) or of(text, *given))
    with pytest.raises(RecordFileError):
        parse_record((("a " * 4000 + "\n") * 3 + rows).encode(), "long")
    assert len(words) < 100


@pytest.mark.parametrize("seed", [1, SEED], ids=["stored", "drawn"])  # processes of one run draw different seeds
def test_no_random_layout_is_read_as_another_motion(seed: int) -> None:
    """With all that a person who knows the file may state, most are read; the seed is in a failure."""
    count = number(100, 10_000)
    assert dialects.run(count, seed) > 0.9 * count


def test_mutated_files_are_read_or_refused() -> None:
    count, dice = number(500, 100_000), random.Random(0)
    read = sum(fuzz(dice) for _ in range(count))
    assert 0.02 * count < read < 0.95 * count


def test_the_vertical_component_of_a_second_file(tmp_path) -> None:
    paths = [tmp_path / name for name in ("h.at2", "up.csv")]
    paths[0].write_text(at2("NPTS= 101, DT= .01 SEC", body=rows(count=100)))
    paths[1].write_text("unit: gal\ndt: 0.01\n" + "".join(f"{10.0 * k}\n" for k in range(100)))
    found = rocking.read_record(paths[0], vertical=paths[1])
    horizontal = rocking.read_record(paths[0])
    np.testing.assert_array_equal(found.acceleration, horizontal.acceleration)
    np.testing.assert_allclose(found.vertical, 0.1 * np.arange(100.0), rtol=1e-14)
    assert found.remarks == horizontal.remarks != ()
    assert (found.name, found.source) == (horizontal.name, f"{horizontal.source}; vertical: up, up.csv (columns)")


@pytest.mark.parametrize(("count", "done", "at_95"), [(95, "continued by zeros", 0.0), (104, "cut", 0.96)])
def test_a_vertical_component_of_another_length_never_changes_the_horizontal_one(count, done, at_95, tmp_path) -> None:
    paths = [tmp_path / name for name in ("h.csv", "up.csv")]
    for path, size in zip(paths, (100, count), strict=True):
        path.write_text("unit: gal\ndt: 0.01\n" + "".join(f"{1 + k}\n" for k in range(size)))
    found = rocking.read_record(paths[0], vertical=paths[1])
    assert found.samples == found.vertical.size == 100
    np.testing.assert_allclose(found.vertical[:96], [*found.acceleration[:95], at_95], rtol=1e-14)
    said = f"the vertical component has {count} samples and the horizontal one 100: it is {done}"
    assert found.remarks == (said,)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("unit: g\ndt: 0.02\n" + "1\n" * 100, r"`vertical` = 'a time step of 0.02 s' .* 0\.01 s"),
        ("unit: g\ndt: 0.01\n" + "1\n" * 80, "`vertical` = '80 samples' .* 100"),
        ("unit: g\ndt: 0.01\n" + "1\n" * 120, "`vertical` = '120 samples' .* 100"),
        ("unit: g\n" + "1\n" * 100, "up.csv: .*time_step"),
        ("<html>", "up.csv, line 1"),
    ],
)
def test_a_second_file_that_does_not_belong_is_refused(text: str, said: str, tmp_path) -> None:
    paths = [tmp_path / name for name in ("h.csv", "up.csv")]
    paths[0].write_text("unit: g\ndt: 0.01\n" + "1\n" * 100)
    paths[1].write_text(text)
    with pytest.raises(InvalidArgumentError, match=said):
        rocking.read_record(paths[0], vertical=paths[1])


def test_the_vertical_component_of_another_column(tmp_path) -> None:
    path = tmp_path / "motion.csv"
    path.write_text(THREE)
    found = rocking.read_record(path, component="NS_g", vertical="ew")
    np.testing.assert_array_equal(found.vertical, rocking.read_record(path, component="ew").acceleration)
    assert found == parse_record(THREE.encode(), "motion.csv", component="NS_g", vertical="EW_g")
    for given, said in (
        ({"component": "NS_g", "vertical": "up"}, r"`vertical` = 'up' .* a component of motion.csv .*NS_g, EW_g"),
        ({"vertical": "EW_g"}, "argument `component`"),
        ({"component": "NS_g", "vertical": tmp_path / "none.at2"}, r"`vertical` = .*: no such file"),
    ):
        with pytest.raises(InvalidArgumentError, match=said):
            rocking.read_record(path, **given)
    path.write_text(at2())
    with pytest.raises(InvalidArgumentError, match=r"`vertical` = 'up' .* a file with one component"):
        rocking.read_record(path, vertical="up")


@pytest.mark.parametrize(
    ("header", "degrees", "second", "radian"),
    [
        ("time/s,rotation", None, 1.0, 1.0),
        ("sec,angle in degrees", None, 1.0, np.radians(1.0)),
        ("time [s],rotation", True, 1.0, np.radians(1.0)),
        ("time [ms],rotation [deg]", None, 1e-3, np.radians(1.0)),
        ("time [ms],rotation [deg]", True, 1e-3, np.radians(1.0)),
        ("t/min,theta / mrad", None, 60.0, 1e-3),
        ("time_s,theta (°)", None, 1.0, np.radians(1.0)),
    ],
)
def test_rotations_are_in_the_units_of_the_header(header: str, degrees: bool | None, second: float, radian: float):
    file = TextFile("trace", f"{header}\n0,1\n5,2\n10,3\n".encode())
    time, rotation = read_rotations(file, 9, degrees)
    np.testing.assert_allclose(time, second * np.array([0.0, 5.0, 10.0]), rtol=1e-15)
    np.testing.assert_allclose(rotation, radian * np.array([1.0, 2.0, 3.0]), rtol=1e-15)
    swapped = ",".join(reversed(header.split(",")))
    found = read_rotations(TextFile("trace", f"{swapped}\n1,0\n2,5\n3,10\n".encode()), 9, degrees)
    np.testing.assert_array_equal(found, (time, rotation))


@pytest.mark.parametrize(
    ("header", "degrees", "said"),
    [
        ("t,rotation [rad]", True, "rotation .rad.; expected rotations in deg, as `degrees` says"),
        ("t,rotation_deg", False, "rotation_deg; expected rotations in rad"),
        ("t,rotation [mrad]", True, "expected rotations in deg"),
        ("t,rotation [rad/s]", None, "a column of rotations"),
        ("t,top [mm]", None, "a column of rotations"),
        ("t,acceleration", None, "a column of rotations"),
        ("t,theta x 1e3", None, "a column of rotations"),
        ("t,angleDeg", None, "units rad, deg, mrad"),
        ("t [foo],rotation", None, "one of the units s, ms, us, min"),
    ],
)
def test_rotations_in_other_units_are_refused(header: str, degrees: bool | None, said: str) -> None:
    with pytest.raises(RecordFileError, match=f"trace, line 1: found the column .*{said}"):
        read_rotations(TextFile("trace", f"{header}\n0,1\n5,2\n".encode()), 9, degrees)


FOLDER = Path(__file__).parents[1] / "data" / "field"

PEAK = 0.29188
"""Of the 40 values of most files, in their unit."""

READ = [  # file, arguments, samples, time step [s], PGA [m/s2]
    ("knet_offset.NS", {}, 160, 0.01, 0.470458),
    ("title_sets_unit.dat", {}, 40, 0.01, PEAK),
    ("title_with_brackets.dat", {}, 40, 0.01, PEAK),
    ("names_blank_rows_tab.dat", {}, 40, 0.01, PEAK * STANDARD_GRAVITY),
    ("corner_frequency_as_rate.txt", {"time_step": 0.02}, 40, 0.02, PEAK * STANDARD_GRAVITY),
    ("frequency_range.dat", {}, 40, 0.01, PEAK * STANDARD_GRAVITY),
    ("factor_and_step_first.txt", {"unit": "g", "skip": 2, "time_step": 0.01}, 40, 0.01, PEAK * STANDARD_GRAVITY),
    ("factor_and_step_first.txt", {"unit": "g", "skip": 0, "time_step": 0.01}, 42, 0.01, STANDARD_GRAVITY),
    ("count_and_step_line2.txt", {"unit": "g"}, 40, 0.01, PEAK * STANDARD_GRAVITY),
    ("wrapped_no_header.txt", {"unit": "g", "time_step": 0.01}, 40, 0.01, PEAK * STANDARD_GRAVITY),
    ("wrapped_interval_stated.dat", {}, 40, 0.005, PEAK / 100.0),
    ("at2_units_are.at2", {}, 40, 0.02, PEAK * STANDARD_GRAVITY),
    ("at2_double_cr.at2", {}, 40, 0.02, PEAK * STANDARD_GRAVITY),
    ("component_underscore.csv", {"component": "acc_NS"}, 40, 0.01, PEAK),
    ("component_underscore.csv", {"component": "EW"}, 40, 0.01, 0.6 * PEAK),
    ("three_components_no_time.txt", {"unit": "gal", "component": "N-S"}, 40, 0.01, PEAK),
    ("csmip_volume1.v1", {}, 40, 0.01, PEAK / 10.0 * STANDARD_GRAVITY),
    ("cosmos_volume2.v2", {"time_step": 0.025}, 40, 0.025, PEAK / 100.0),
    ("jma_unit_two_names.csv", {"component": "NS"}, 13, 0.01, 0.27682),
    ("jma_unit_two_names.csv", {"component": "NS", "unit": "gal"}, 13, 0.01, 0.27682),
    ("sample_counter.csv", {"time_step": 0.01}, 120, 0.01, 2.861360),
]

REFUSED = [  # file, arguments, what the message names
    ("corner_frequency_as_rate.txt", {}, "no time step; .*`time_step`"),
    ("factor_and_step_first.txt", {"unit": "g"}, "line 1: found 1, 0.01 before 6.159000e-02; .*`skip`: 2"),
    ("component_underscore.csv", {}, r"components acc_NS\(gal\), acc_EW\(gal\); .*`component`"),
    ("three_components_no_time.txt", {"unit": "gal"}, "components N-S, E-W, U-D; .*`component`"),
    ("cosmos_volume2.v2", {}, "COSMOS file that states no time step; .*`time_step`"),
    ("jma_unit_two_names.csv", {}, "components NS, EW, UD; .*`component`"),
    ("sample_counter.csv", {}, "the column sample, a counter.*`time_step`"),
]


@pytest.mark.parametrize(("file", "arguments", "samples", "step", "peak"), READ)
def test_records_are_read(file, arguments, samples, step, peak):
    found = parse_record((FOLDER / file).read_bytes(), file, **arguments)
    assert (found.samples, found.time_step) == (samples, step)
    assert found.peak_acceleration == pytest.approx(peak, rel=1e-5)


@pytest.mark.parametrize(("file", "arguments", "said"), REFUSED)
def test_what_is_not_stated_is_asked_for(file, arguments, said):
    with pytest.raises(RecordFileError, match=said):
        parse_record((FOLDER / file).read_bytes(), file, **arguments)


def test_frames_are_no_seconds():
    trace = TextFile("frame_counter.csv", (FOLDER / "frame_counter.csv").read_bytes())
    with pytest.raises(RecordFileError, match=r"the column frame, a counter.*`time_step`"):
        read_rotations(trace, 10_000, None)
    time, rotation = read_rotations(trace, 10_000, None, 1.0 / 60.0)
    np.testing.assert_allclose(time[:3], [0.0, 1.0 / 60.0, 2.0 / 60.0])
    assert rotation[0] == pytest.approx(0.15, abs=1e-6)


def test_the_offset_that_is_removed_is_stated():
    found = parse_record((FOLDER / "knet_offset.NS").read_bytes(), "knet_offset.NS")
    (remark,) = found.remarks
    assert "mean of 95.002 gal, is removed" in remark
    assert "largest acceleration about it is 47.046 gal" in remark  # Max. Acc. of the header
    assert "95.002 gal, is removed" in found.source
