"""Small files of kinds that were misread, or that no argument could open: each is read, or says what to state."""

from pathlib import Path

import numpy as np
import pytest

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import RecordFileError
from rocking._excitation.records.readers.columns import read_rotations
from rocking._excitation.records.readers.lines import TextFile
from rocking._excitation.records.readers.read_record import parse_record

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
