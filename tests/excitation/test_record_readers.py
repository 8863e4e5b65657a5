"""Readers of accelerograms: files with their right ends, random layouts, damaged files of each format."""

import pickle
import random
import sys
from pathlib import Path

import numpy as np
import pytest

import rocking
from rocking._base.constants import STANDARD_GRAVITY as G
from rocking._base.errors import InvalidArgumentError, RecordFileError, StoppedError
from rocking._excitation.records.readers.columns import read_rotations
from rocking._excitation.records.readers.read_record import parse_record
from rocking._excitation.records.readers.text_file import TextFile
from rocking._excitation.records.record import UNITS
from rocking._numba.cancellation import StopFlag
from tests.excitation.record_files import KNET_VALUES, STEP, at2, esm, knet, pairs, rows, values
from tests.excitation.record_fuzzer import fuzz
from tests.excitation.record_layouts import check_layout
from tests.sampling import SEED, number

FOLDER = Path(__file__).parents[1] / "data" / "field"

PEAK = 0.29188  # of the 40 values of the first files, in their unit

SECONDS = {"time": 1, "time_unit": "s"}
AS_COLUMNS = {"format": "columns", "acceleration": 2, **SECONDS}
ONE = {"acceleration": 1, "unit": "g"}
GAL = {"unit": "gal"}
TIMED = {"unit": "gal", **SECONDS}
ROWS = {"wrapped": True, "unit": "g", "time_step": 0.02}

READ = [  # file, arguments, PGA [m/s2], time step [s], samples
    ("knet_offset.NS", {}, 0.470458, 0.01, 160),
    ("title_sets_unit.dat", {"skip": 1}, PEAK, 0.01, 40),
    ("title_with_brackets.dat", {"skip": 2, "unit": "m/s2", "acceleration": 2, **SECONDS}, PEAK, 0.01, 40),
    ("names_blank_rows_tab.dat", {"skip": 1}, PEAK * G, 0.01, 40),
    ("corner_frequency_as_rate.txt", ONE | {"skip": 3, "time_step": 0.02}, PEAK * G, 0.02, 40),
    ("frequency_range.dat", {"skip": 2}, PEAK * G, 0.01, 40),
    ("factor_and_step_first.txt", ONE | {"skip": 2, "time_step": 0.01}, PEAK * G, 0.01, 40),
    ("count_and_step_line2.txt", ONE | {"skip": 2, "time_step": 0.01}, PEAK * G, 0.01, 40),
    ("wrapped_no_header.txt", {"wrapped": True, "unit": "g", "time_step": "10 ms"}, PEAK * G, 0.01, 40),
    ("wrapped_interval_stated.dat", ROWS | {"skip": 4, "unit": "gal", "time_step": 0.005}, PEAK / 100, 0.005, 40),
    ("at2_units_are.at2", {"unit": "g"}, PEAK * G, 0.02, 40),
    ("at2_double_cr.at2", {}, PEAK * G, 0.02, 40),
    ("component_underscore.csv", {"acceleration": "acc_NS", "time_unit": "s"}, PEAK, 0.01, 40),
    ("component_underscore.csv", {"acceleration": "acc_EW(gal)", "time_step": 0.01}, 0.6 * PEAK, 0.01, 40),
    ("three_components_no_time.txt", GAL | {"skip": 1, "acceleration": "N-S", "time_step": 0.01}, PEAK, 0.01, 40),
    ("csmip_volume1.v1", {}, PEAK / 10.0 * G, 0.01, 40),
    ("cosmos_volume2.v2", {"time_step": 0.025}, PEAK / 100.0, 0.025, 40),
    ("jma_unit_two_names.csv", GAL | {"skip": 6, "acceleration": "NS", "time_step": 0.01}, 0.27682, 0.01, 13),
    ("sample_counter.csv", {"time_step": 0.01}, 2.86136, 0.01, 120),
    ("time_ms_2khz.csv", {"time_unit": "ms"}, 1.5, 0.0005, 800),
    ("acc_g_x1000.csv", {"acceleration": "Acc (g) x1000", "unit": "mg"}, 1.71, 0.02, 400),
    ("n_and_z.csv", {"acceleration": "N", "unit": "m/s2"}, 1.71, 0.02, 400),
    ("n_and_z.csv", {"acceleration": 3, "unit": "m/s2"}, 0.88, 0.02, 400),
    ("station_velletri.csv", {"acceleration": "Velletri NS"}, 1.71, 0.02, 400),
    ("peak_in_g_data_in_gal.txt", {"skip": 1, "acceleration": 2, "unit": "cm/s2", **SECONDS}, 1.71, 0.02, 400),
    ("quoted_decimal_commas.csv", {"decimal": ","}, 1.71, 0.02, 400),
    ("quoted_decimal_commas.csv", {"decimal": ",", "delimiter": "comma"}, 1.71, 0.02, 400),
    ("volts.csv", {"acceleration": "Accel 1", "unit": "g"}, 1.677, 0.02, 400),
    ("place_above_columns.txt", {"skip": 1, "acceleration": 1, "unit": "gal", "time_step": 0.02}, 3.42, 0.02, 400),
    ("numbered_names.txt", {"skip": 3, "acceleration": "2", "unit": "gal", **SECONDS}, 2.28, 0.02, 400),
    ("numbered_names.txt", {"skip": 3, "acceleration": 2, "unit": "gal", **SECONDS}, 1.71, 0.02, 400),
    ("count_of_all_channels.txt", {"skip": 4, "acceleration": 1, "unit": "gal", "time_step": 0.02}, 1.71, 0.02, 400),
    ("blank_line_above_one_column.txt", GAL | {"skip": 3, "acceleration": 1, "time_step": 0.02}, 1.71, 0.02, 400),
    ("at2_header_two_columns.txt", {**AS_COLUMNS, "skip": 4, "unit": "g"}, 1.71, 0.02, 400),
    ("fixed_width_8f9.6_cards.eq", ROWS | {"skip": 1, "delimiter": "8f9.6"}, 1.71, 0.02, 400),
    ("matched_to_spectrum.txt", {**AS_COLUMNS, "skip": 1, "unit": "m/s2"}, 1.71, 0.02, 400),
    ("phone_uneven.csv", {"acceleration": "x", "unit": "m/s2", "time_step": 0.02}, 1.71, 0.02, 400),
    ("comma_and_tab.txt", TIMED | {"skip": 1, "acceleration": "A2", "delimiter": r"[,\s]+"}, 2.28, 0.02, 400),
    ("comma_and_tab.txt", TIMED | {"skip": 2, "acceleration": 3, "delimiter": ",\t"}, 2.28, 0.02, 400),
    ("lon_lat_count_above.txt", {"skip": 2, "acceleration": 2, "unit": "m/s2", **SECONDS}, 1.71, 0.02, 400),
    ("log_with_serial_numbers.csv", {"skip": 1, "acceleration": 4, "unit": "g", **SECONDS}, 1.71, 0.02, 400),
]  # fmt: skip

REFUSED = [  # file, arguments, what the message names
    ("title_sets_unit.dat", {}, r"`acceleration`.*such as read_record\(.*, skip=1\)"),
    ("frequency_range.dat", {}, r"such as read_record\(.*, skip=2\)"),
    ("factor_and_step_first.txt", {"unit": "g", "time_step": 0.01}, "1 columns without names; .*`acceleration`"),
    ("count_and_step_line2.txt", {"unit": "g"}, "skip=2"),
    ("wrapped_no_header.txt", {"unit": "g", "time_step": 0.01}, "8 columns without names; .*wrapped=True"),
    ("at2_units_are.at2", {}, r"line 3: found The units are \(g\); .*`unit`"),
    ("component_underscore.csv", {"acceleration": "acc_NS"}, "`time_unit` .s, ms, us, min.*time_unit=..."),
    ("cosmos_volume2.v2", {}, "states no time step; .*`time_step`"),
    ("jma_unit_two_names.csv", {"acceleration": "NS"}, "one column NS .*skip=6"),
    ("sample_counter.csv", {}, r"sample, acc \[g\]; .*`time` .a column. or `time_step`"),
    ("time_ms_2khz.csv", {}, "`time_unit`"),
    ("acc_g_x1000.csv", {}, "`acceleration` .*`unit`"),
    ("acc_g_x1000.csv", {"acceleration": 2, "unit": "g"}, "a PGA of 174.4 g; .*allow_unusual=True"),
    ("n_and_z.csv", {"unit": "m/s2"}, r"time \[s\], N, Z; expected the argument `acceleration`"),
    ("station_velletri.csv", {}, r"Velletri NS \(g\), Norma NS \(g\); .*`acceleration`"),
    ("peak_in_g_data_in_gal.txt", {}, "`acceleration` .*`time` .*`unit`"),
    ("quoted_decimal_commas.csv", {}, "line 2: found -0,0299; .*decimal=','"),
    ("quoted_decimal_commas.csv", {"unit": "g", "wrapped": True, "time_step": 0.02}, "decimal=','"),
    ("simulation_velocity.txt", TIMED | {"skip": 6, "acceleration": 2}, "line 5: .*velocity.*columns"),
    ("slist_unknown_counts.ascii", {"unit": "gal"}, "Counts; .*not converted"),
    ("volts.csv", {"unit": "g"}, r"Accel 1 \(V\); .*`acceleration`"),
    ("velocities_below.txt", {"acceleration": "NS", "unit": "gal", "time_step": 0.02}, "line 402: found a blank line"),
    ("timestamps_only.csv", {"unit": "m/s2", "time_step": 0.02}, "Timestamp,X,Y,Z; .*`acceleration`"),
    ("timestamps_only.csv", {"acceleration": 1, "unit": "m/s2", "time_step": 0.02}, "rise uniformly, as times do"),
    ("at2_header_two_columns.txt", {}, "400 stated, 800 values .*format='columns'"),
    ("fixed_width_8f9.6_cards.eq", ROWS, "delimiter='8f9.6'"),
    ("matched_to_spectrum.txt", {"skip": 1, "acceleration": 2, "unit": "m/s2", **SECONDS}, "EC8 .*format='columns'"),
    ("phone_uneven.csv", TIMED | {"acceleration": "x", "time": 2}, "interpolate .*`time_step`"),
    ("comma_and_tab.txt", {"skip": 2, "acceleration": 3, "unit": "gal"}, "`delimiter`"),
    ("lon_lat_count_above.txt", {"unit": "m/s2"}, "skip=2, acceleration=..., time=..."),
    ("log_with_serial_numbers.csv", {}, "skip=2"),
]  # fmt: skip


@pytest.mark.parametrize(("file", "arguments", "peak", "step", "samples"), READ)
def test_what_is_stated_is_read(file, arguments, peak, step, samples) -> None:
    record = rocking.read_record(FOLDER / file, **arguments)
    assert (record.time_step, record.samples) == (step, samples)
    assert record.peak_acceleration == pytest.approx(peak, rel=1e-4)


@pytest.mark.parametrize(("file", "arguments", "message"), REFUSED)
def test_what_is_not_stated_is_asked_for(file, arguments, message) -> None:
    with pytest.raises(RecordFileError, match=f"(?s){message}"):
        rocking.read_record(FOLDER / file, **arguments)


@pytest.mark.parametrize("path", sorted(FOLDER.iterdir()), ids=lambda path: path.name)
def test_without_arguments_only_what_states_itself_is_read(path) -> None:
    self_describing = {file: right for file, arguments, *right in READ if not arguments}
    try:
        record = rocking.read_record(path)
    except RecordFileError:
        assert path.name not in self_describing
    else:
        assert self_describing[path.name] == pytest.approx(
            [record.peak_acceleration, record.time_step, record.samples], rel=1e-4
        )


@pytest.mark.parametrize("seed", [1, SEED], ids=["stored", "drawn"])  # processes of one run draw different seeds
def test_random_layouts_are_read_right_when_stated_and_never_otherwise(seed: int) -> None:
    dice = random.Random(seed)
    for _ in range(number(60, 20_000)):
        check_layout(dice)


def test_mutated_files_are_read_or_refused() -> None:
    dice = random.Random(0)
    count = number(300, 100_000)
    read = sum(fuzz(dice) for _ in range(count))
    assert 0.02 * count < read < 0.5 * count


NAMED = {"AT2": (at2(), values() * G), "ESM": (esm(), values() / 100.0), "K-NET": (knet(), KNET_VALUES / 100.0)}


@pytest.mark.parametrize("kind", NAMED)
def test_named_formats_are_read_by_signature_and_by_name(kind: str) -> None:
    text, expected = NAMED[kind]
    for content in (text.encode(), text.replace("\n", "\r\n").encode(), text.encode("utf-16")):
        for arguments in ({}, {"format": kind.lower()}):
            record = parse_record(content, "motion", **arguments)
            np.testing.assert_allclose(record.acceleration, expected, rtol=1e-12, atol=1e-15)
            assert record.time_step == STEP
    other = parse_record(text.encode(), "motion", unit="mm/s2", time_step=0.02)
    remarks = " ".join(other.remarks)
    assert other.time_step == 0.02
    assert "; mm/s2 is used, as the argument `unit` says" in remarks
    assert "a time step of 0.01 s; 0.02 s is used" in remarks
    stop = StopFlag()
    stop.set()
    with pytest.raises(StoppedError):
        parse_record(text.encode(), "motion", stop=stop)


@pytest.mark.parametrize(
    "line", ["4000 0.0100 NPTS, DT", "NPTS 4000 DT 0.01", "DT=.01SEC, NPTS=4000", "NPTS=4000, DT=1D-2"]
)
def test_forms_of_the_line_of_at2(line: str) -> None:
    record = parse_record(at2(line, body=rows(count=3990)).encode(), "x.at2")
    assert (record.samples, record.time_step) == (3990, 0.01)
    assert record.remarks == ("the file holds 3990 samples, its header states 4000",)
    assert record.baseline_corrected().remarks == record.remarks


@pytest.mark.parametrize(
    ("text", "arguments", "message"),
    [
        (at2("NPTS= 10, DT= .01"), {}, "line 4: found 10 stated, 24 values"),
        (at2("NPTS= 24, DT= 0"), {}, "line 4: found 0; expected the time step DT"),
        (at2("NPTS= 1e400, DT= .01"), {}, "line 4: found 1E400"),
        (at2("NPTS, DT"), {}, "line 4: found IndexError"),
        (at2(units="UNITS OF CM").replace("ACCELERATION", "DISPLACEMENT"), {}, "line 3: .*expected accelerations"),
        (at2(body="0.1 0.2\n\n0.3 0.4\n"), {}, "line 6: found a blank line"),
        (at2(body="0.1 0.2 x\n"), {}, "line 5: found x; expected a number"),
        (at2(), {"acceleration": 1}, "acceleration 1 beside AT2; .*format='columns'"),
        (esm({"UNITS": "counts"}), {}, "found counts; expected a unit"),
        (esm({"NDATA": "-1"}), {}, "found -1; expected the number of values"),
        (esm({"DATA_TYPE": "VELOCITY"}), {}, "line 10: found VELOCITY"),
        (knet("100Hz", "0Hz"), {}, "line 11: found 0"),
        (knet("(gal)", "(counts)"), {}, "line 14: found counts"),
        (knet("0.24", "1e308"), {}, "line 12: found "),
        (knet("2000(gal)/8388608", "1e308(gal)/1e-9"), {}, "a number beyond the range of doubles"),
        (knet("Duration", "duration"), {}, "line 12: found another line"),
        ("<html>\n", {}, "line 1: found a web page"),
        ('{"a": 1}', {}, "line 1: found JSON"),
        ("", {}, "an empty file"),
        ("1\n2\0\n", {}, "binary content"),
        ("1," * 9000 + "\n2\n", {}, "line 1: .*at most 8192 bytes"),
        (pairs().replace("0.122560", "nan"), {}, "line 3: found nan; expected a number"),
        (pairs().replace("0.122560", "1e999"), {}, "line 3: found 1e999"),
        (pairs().replace("0.122560", "1_0"), {}, "line 3: found 1_0"),
        (pairs("").replace("0.000000", "nan", 1), AS_COLUMNS | {"unit": "g"}, "line 1: found nan"),
        (pairs("").replace("0.000000", "ERR", 1), AS_COLUMNS | {"unit": "g"}, "line 1: found 0.000 among names"),
        (pairs("time [s],acceleration [g]\ns,g\n"), {}, "line 2: found s; expected a number, as below it"),
        ("time [s],x [g],acceleration [g]\n0,1,2\n0.1,2,0\n", {}, "`acceleration`"),
        ("time [s],x,acceleration\n0,1,2\n0.1,2,0\n", {"unit": "g"}, "`acceleration`"),
        (pairs().replace("0.122560", ""), {}, "line 3: found an empty cell"),
        (pairs().replace("0.122560", "0.1,2"), {}, "line 3: found 3 cells"),
        (pairs().replace("0.010,0.122560\n", ""), {}, "uniform steps"),
        (pairs().replace("0.010,0.122560\n", '"0.010",0.122560,"\n'), {}, "cells|quotes|pandas"),
        ("time [s],acc [g]\n" + "".join(f"{k / 128:.3f},{k % 7}\n" for k in range(20)), {}, "rounded to 0.001 s"),
        ("time [s],acc [g]\n0,1\n0,2\n", {}, "times that increase"),
        ("time [s],acceleration [g]\n0,0\n0.2,1\n0.4,0\n", {}, "a time step of 0.2 s; .*allow_unusual"),
        ("time [s],acceleration [m/s2]\n" + "".join(f"{k},{3}\n" for k in range(20)), {"time_unit": "ms"}, "^$"),
        ("0,1\n1,2\n2,0\n", {"acceleration": 1, "unit": "g", "time_step": 0.1}, "delimiter=','.*decimal=','"),
        ("0;0\n", {"acceleration": 2, "time": 2, "time_unit": "s", "unit": "g"}, "different columns"),
    ],
)  # fmt: skip
def test_damaged_files_are_refused_with_place_and_reason(text, arguments, message) -> None:
    if message == "^$":  # the argument wins
        assert parse_record(text.encode(), "motion", **arguments).time_step == pytest.approx(1e-3)
        return
    with pytest.raises(RecordFileError, match=f"(?s)^motion.*{message}"):
        parse_record(text.encode(), "motion", **arguments)


@pytest.mark.parametrize(
    ("arguments", "parameter"),
    [
        ({"format": "word"}, "format"),
        ({"acceleration": 0}, "acceleration"),
        ({"acceleration": True}, "acceleration"),
        ({"time": " "}, "time"),
        ({"time": 1, "time_step": 0.1}, "time_step"),
        ({"time_unit": "h"}, "time_unit"),
        ({"unit": "feet"}, "unit"),
        ({"skip": -1}, "skip"),
        ({"delimiter": "x+"}, "delimiter"),
        ({"delimiter": "8f41.6"}, "delimiter"),
        ({"decimal": "?"}, "decimal"),
        ({"wrapped": True, "acceleration": 1}, "wrapped"),
    ],
)
def test_arguments_out_of_range_are_named(arguments, parameter) -> None:
    with pytest.raises(InvalidArgumentError) as caught:
        parse_record(pairs().encode(), "motion", **arguments)
    assert caught.value.parameter == parameter


@pytest.mark.parametrize("unusual", ["1000", "9.9"])
def test_what_is_unusual_is_a_question_with_an_answer(unusual: str) -> None:
    text = pairs().replace("0.122560", unusual)
    with pytest.raises(RecordFileError, match="allow_unusual=True"):
        parse_record(text.encode(), "motion")
    assert parse_record(text.encode(), "motion", allow_unusual=True).peak_acceleration == pytest.approx(
        G * float(unusual)
    )


def test_an_argument_beats_the_file_with_a_remark_that_names_both() -> None:
    title = "velocity of the table\n"
    text = title + pairs("time [s],Accel (V)\n")
    arguments = {"skip": 1, "acceleration": "accel", "unit": "g"}
    with pytest.raises(RecordFileError, match="velocity of the table"):
        parse_record(text.encode(), "motion", **arguments)
    record = parse_record(text.encode(), "motion", format="columns", **arguments)
    assert any("velocity of the table; g is used" in remark for remark in record.remarks)
    record = parse_record(pairs().encode(), "motion", unit="gal", time="time", time_unit="ms", allow_unusual=True)
    assert [remark.partition(";")[0] for remark in record.remarks] == [
        "the file says acceleration [g]",
        "the times are in s, says the file",
    ]
    record = parse_record(text.removeprefix(title).encode(), "motion", **arguments | {"skip": 0})
    assert record.remarks == ("the file says Accel (V); g is used, as the argument `unit` says",)
    assert record.source == "motion (column 2, Accel (V), from line 2)"


def test_errors_can_be_sent_between_processes(tmp_path) -> None:
    with pytest.raises(InvalidArgumentError, match="no such file"):
        rocking.read_record(tmp_path / "none.at2")
    error = RecordFileError("a.at2", 3, "x", "a number; or `skip=2`", ["line 1: `x`"], {"skip": 2, "unit": ...})
    copy = pickle.loads(pickle.dumps(error))
    text = "a.at2, line 3: found x; expected a number; or skip=2\n  line 1: 'x'\n"
    assert str(copy) == str(error) == text + 'such as read_record("a.at2", skip=2, unit=...)'


def test_seismic_formats_without_obspy_name_the_package(monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "obspy", None)
    sac = np.zeros(700, np.uint8)
    sac[304] = 6
    traces = b"TIMESERIES XX_A__HNE_R, 2 samples, 50 sps, 2031-01-01T00:00:00, TSPAIR, FLOAT, M/S**2\n"
    for content in (b"000001D " + b"\x01" * 600, sac.tobytes(), traces, traces.replace(b"TSPAIR", b"SLIST")):
        with pytest.raises(RecordFileError, match="pip install 'rocking"):
            parse_record(content, "x", unit="g")


def test_seismic_formats_with_obspy(tmp_path) -> None:
    obspy = pytest.importorskip("obspy")
    trace = obspy.Trace(values().astype(np.float32), {"delta": STEP, "channel": "HNE", "npts": 24})
    for kind, name in (("SAC", "SAC"), ("miniSEED", "MSEED"), ("TSPAIR", "TSPAIR"), ("SLIST", "SLIST")):
        path = tmp_path / kind
        trace.write(str(path), format=name)
        if kind in ("TSPAIR", "SLIST"):
            path.write_text(path.read_text().replace("Counts", "M/S**2"))
        record = rocking.read_record(path, unit="m/s2")
        assert record.time_step == pytest.approx(STEP, rel=1e-6)
        np.testing.assert_allclose(record.acceleration, values(), atol=1e-6)
    trace.data = np.arange(24, dtype=np.int32)
    trace.write(str(tmp_path / "counts"), format="MSEED")
    with pytest.raises(RecordFileError, match="counts"):
        rocking.read_record(tmp_path / "counts", unit="gal")


UP = "time [s],vertical [gal]\n" + "".join(f"{k * STEP:.2f},{10 * (k % 9)}\n" for k in range(100))
ACROSS = at2("NPTS= 100, DT= .01 SEC", body=rows(count=100))


@pytest.mark.parametrize(("count", "done"), [(100, ""), (95, "continued by zeros"), (104, "cut")])
def test_the_vertical_component_of_a_second_file(count: int, done: str, tmp_path) -> None:
    paths = [tmp_path / name for name in ("h.at2", "up.at2")]
    paths[0].write_text(ACROSS)
    paths[1].write_text(at2(f"NPTS= {count}, DT= .01 SEC", body=rows(count=count)))
    record = rocking.read_record(paths[0], vertical=paths[1])
    expected = np.zeros(100)
    expected[:count] = values(count)[:100] * G
    np.testing.assert_allclose(record.vertical, expected, rtol=1e-12)
    np.testing.assert_array_equal(record.acceleration, rocking.read_record(paths[0]).acceleration)
    assert all(done in remark for remark in record.remarks)
    for wrong in (at2("NPTS= 80, DT= .01 SEC", body=rows(count=80)), at2("NPTS= 100, DT= .02", body=rows(count=100))):
        paths[1].write_text(wrong)
        with pytest.raises(InvalidArgumentError, match="`vertical`"):
            rocking.read_record(paths[0], vertical=paths[1])


def test_the_vertical_component_of_another_column(tmp_path) -> None:
    path = tmp_path / "motion.csv"
    path.write_text(
        "time [s],NS [g],UP [g]\n" + "".join(f"{k * STEP:.2f},{v},{v / 2}\n" for k, v in enumerate(values()))
    )
    record = rocking.read_record(path, acceleration="NS", vertical="up")
    np.testing.assert_allclose(record.vertical, record.acceleration / 2.0)
    assert record == rocking.read_record(path, acceleration=2, vertical=3)
    for vertical in ("east", tmp_path / "none.at2"):
        with pytest.raises(InvalidArgumentError, match=r"`vertical` = .*(one column east|no such file)"):
            rocking.read_record(path, acceleration="NS", vertical=vertical)


@pytest.mark.parametrize(
    ("header", "arguments", "second", "radian"),
    [
        ("time [s],rotation [deg]", {}, 1.0, np.radians(1.0)),
        ("time [ms],rotation [mrad]", {}, 1e-3, 1e-3),
        ("t,roll", {"rotation": "roll", "time": "t", "time_unit": "s", "unit": "deg"}, 1.0, np.radians(1.0)),
        ("frame,rotation [rad]", {"time_step": 1.0 / 50.0}, 1.0 / 250.0, 1.0),
    ],
)
def test_rotations_are_in_the_units_that_are_stated(header, arguments, second, radian) -> None:
    time, rotation = read_rotations(TextFile("trace", f"{header}\n0,1\n5,2\n10,3\n".encode()), 9, **arguments)
    np.testing.assert_allclose(time, second * np.array([0.0, 5.0, 10.0]), rtol=1e-15)
    np.testing.assert_allclose(rotation, radian * np.array([1.0, 2.0, 3.0]), rtol=1e-15)


def test_traces_are_asked_for_what_they_do_not_state() -> None:
    for name, message in (
        ("frame_counter.csv", "`time` .*`time_step`"),
        ("imu_roll_pitch_yaw.csv", "`rotation` .*`unit`"),
    ):
        with pytest.raises(RecordFileError, match=message):
            read_rotations(TextFile(name, (FOLDER / name).read_bytes()), 10_000)
    arguments = {"rotation": "roll_deg", "unit": "deg", "time": "time_s", "time_unit": "s"}
    _, rotation = read_rotations(TextFile("imu", (FOLDER / "imu_roll_pitch_yaw.csv").read_bytes()), 10_000, **arguments)
    assert rotation[0] == pytest.approx(np.radians(8.598))


def test_units_are_those_of_the_table() -> None:
    for unit, value in UNITS.items():
        text = pairs(f"time [s],acceleration [{unit}]\n").encode()
        np.testing.assert_allclose(parse_record(text, "motion").acceleration, values() * value, rtol=1e-12)
