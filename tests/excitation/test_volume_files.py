"""Made-up files in the layouts of COSMOS, CSMIP and GeoNet: several channels and blocks, numbers that touch."""

import numpy as np
import pytest

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import RecordFileError
from rocking._excitation.records.readers.read_record import parse_record

COUNT = 37
TEXT = "                                                        \n"


def samples(channel: int) -> np.ndarray:
    """Return accelerations [cm/s2] that touch in fields of ten characters, also without a sign between them."""
    k = np.arange(COUNT)
    return np.round(np.maximum((80.0 + 60.0 * channel) * np.sin(0.5 * k) + 0.1 * channel, -99.5), 6)


def rows(values: np.ndarray, form: str, width: int) -> str:
    """Return numbers of a fixed width, some on a line."""
    parts = [form.format(value) for value in values]
    return "".join("".join(parts[k : k + width]) + "\n" for k in range(0, len(parts), width))


def block(kind: str, values: np.ndarray, unit: str) -> str:
    return f"{COUNT:6d} points of {kind} data equally spaced at  .010 sec, in {unit}. (8f10.6)    \n" + rows(
        values, "{:10.6f}", 8
    )


def csmip() -> str:
    """Return Volume 2 with three channels."""
    text = ""
    for channel, name in enumerate(("360 Deg", "Up", "90 Deg"), start=1):
        a = samples(channel)
        text += f"Corrected accelerogram   99999-L0000       Chan {channel:2d}: {name}         from   \n"
        text += "Uncorrected Accelerogram Data             Processed: 01/02/03\n" + TEXT
        text += f"Chan {channel:2d}: {name}                        Location: made up\n"
        text += "Peak acceleration =    27.114    cm/sec/sec  at   32.570   sec.\n" + TEXT
        text += "    1  100    1    3    3  200\n  .0101833  .6400000 75.000000\n"
        text += block("accel", a, "cm/sec2") + block("veloc", a / 9.0, "cm/sec") + block("displ", a / 99.0, "cm")
        text += f"/&  ----------  End of data for channel {channel:2d}  ----------\n"
    return text


def cosmos(real: bool = True) -> str:
    """Return Volume 2 of format 1.20; the step is real value 62, in ms."""
    reals = np.full(100, -999.0)
    reals[33], reals[61] = 0.02, 5.0
    text = "Corrected acceleration    (Format v01.20 with 13 text lines)\nRecord of a made-up event\n"
    text += "Sta Chan   1: 90 deg (Rcrdr Chan  1) Location: none\n"
    text += " 100 Integer-header values follow on  10 lines, Format= (10I8)\n" + rows(np.arange(100), "{:8d}", 10)
    if real:
        text += " 100 Real-header values follow on  20 lines, Format= (5F15.6)\n" + rows(reals, "{:15.6f}", 5)
    text += '   1 Comment line(s) follow, each starting with a "|":\n| 40 acceleration pts, units=g\n'
    text += f"{COUNT:8d} acceleration pts, approx    0 secs, units=cm/sec2(04),Format=(8F10.6)\n"
    return text + rows(samples(2), "{:10.6f}", 8) + "End-of-data for Chan  1 acceleration\n"


def geonet(volume: int) -> str:
    """Return Volume 1 or 2 with three components."""
    text = ""
    for channel, name in enumerate(("N28W", "S62W", "Up"), start=1):
        counts = [COUNT] * 3 if volume == 2 else [COUNT, 0, 0]
        ints = np.zeros(40, dtype=int)
        ints[30:36] = [8 * COUNT, 250, 250, *counts]
        reals = np.zeros(60)
        reals[20:26] = [1.0, 0.0, 0.0, 1.0, 0.005, 0.02]
        text += f"{'Unc' if volume == 1 else 'C'}orrected accelerogram 20010203_040506_XXXX_20 GNS Science\n" + TEXT * 8
        text += f"Number of points  {COUNT}    Duration 0.72 sec\n"
        readings = "Raw readings in units of 1.00 mm/s/s  at intervals of 0.020 s", "Data at 0.020 sec intervals"
        text += readings[volume - 1] + f"\n{TEXT}Component {name}  Longitudinal Accelerometer Axis\n"
        text += "Acceleration:  peak  -9733.1 mm/s/s at 144.88 sec     rms    719.0 mm/s/s\n" + TEXT * 2
        text += rows(ints, "{:8d}", 10) + rows(reals, "{:8.4f}", 10)
        for factor, count in zip((10.0, 1.0, 0.1), counts, strict=True):
            text += rows(factor * samples(channel)[:count], "{:8.1f}", 10)
    return text


TWO_CHANNELS = cosmos().replace("Chan   1:", "Cha:  1:") + cosmos().replace("Chan   1: 90", "Chan   2: 0")


@pytest.mark.parametrize(
    ("text", "component", "channel", "step", "tolerance"),
    [
        (csmip(), "360 Deg", 1, 0.01, 1e-12),
        (csmip(), "chan 3: 90 deg", 3, 0.01, 1e-12),
        (csmip(), "2", 2, 0.01, 1e-12),
        (cosmos(), None, 2, 0.005, 1e-12),
        (TWO_CHANNELS, "90 deg", 2, 0.005, 1e-12),
        (geonet(1), "N28W", 1, 0.02, 0.006),
        (geonet(2), "s62w", 2, 0.02, 0.006),
        (geonet(2), "Up", 3, 0.02, 0.006),
    ],
)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_channels_are_read(text, component, channel, step, tolerance, end):
    record = parse_record(text.replace("\n", end).encode(), "x", acceleration=component)
    assert record.time_step == step
    np.testing.assert_allclose(100.0 * record.acceleration, samples(channel), atol=tolerance)


def test_volume_1_in_g():
    text = "Uncorrected Accelerogram Data\nUnits of uncor data are sec and g .        Max  =   .079 g\n"
    text += f"{COUNT:6d} Accelerogram points at 200 pts/sec in units of g .      Format: (8f9.6)\n"
    record = parse_record((text + rows(samples(0) / 980.0, "{:9.6f}", 8)).encode(), "x")
    assert record.time_step == 0.005
    np.testing.assert_allclose(record.acceleration, samples(0) / 980.0 * STANDARD_GRAVITY, atol=1e-5)


@pytest.mark.parametrize(
    ("text", "arguments", "message"),
    [
        (csmip(), {}, "channels Chan 1: 360 Deg, Chan 2: Up, Chan 3: 90 Deg; .*`acceleration`"),
        (csmip(), {"acceleration": "deg"}, "expected one of them, not deg"),
        (csmip().replace("    37", "    32"), {"acceleration": "1"}, "expected the end of a block, as its number"),
        (csmip()[:3000], {"acceleration": "1"}, "values, and 37 stated in line"),
        (cosmos(real=False), {}, "COSMOS file that states no time step"),
        (cosmos().replace("cm/sec2(04)", "counts(50)"), {"unit": "g"}, "found counts; expected accelerations"),
        (
            geonet(2).replace("at 0.020 sec", "at 0.010 sec"),
            {"acceleration": "Up"},
            "at 0.010 sec intervals; expected an interval of 0.02 s",
        ),
        (
            geonet(2).replace("at 0.020 sec", ""),
            {"acceleration": "Up"},
            "line 11: found Data  intervals; expected an interval",
        ),
        ("Response and Fourier amplitude spectra\n1 2\n", {}, "amplitude spectra; expected accelerations"),
        ("* VOL1DS FILE:  5522/01\nUNITS ARE SECONDS AND G/10\n1 2\n", {}, "a BHRC Volume 1 file"),
        (
            "UNCORRECTED ACCELEROGRAM DATA\n\n\nRENADIC\n0.0 1.0\n",
            {},
            "no block of accelerations; expected a Volume 1 or 2 of CSMIP",
        ),
        (
            "FILE     0 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:\n0.0 1.0\n",
            {},
            "a USC Volume 1 file; expected one of AT2",
        ),
        ("2 CORRECTED ACCELEROGRAM\n*\n", {}, "an SMC file; expected one of AT2"),
        ("CORRECTED ACCELEROGRAM OF SOMEBODY\n1 2 3\n", {}, "no block of accelerations; expected a Volume"),
    ],
)
def test_others_are_refused_by_their_names(text, arguments, message):
    with pytest.raises(RecordFileError, match=message):
        parse_record(text.encode(), "x", **arguments)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (csmip().replace("(8f10.6)", "(1i1000000000)"), "line 9: .*a width of 1 to 40"),
        (csmip().replace("(8f10.6)", "(8f0.6)"), "line 9: .*a width of 1 to 40"),
        (csmip().replace("    37 points", "1" + "0" * 400 + " points"), r"line 9: found 10+.*the number of values"),
        (csmip().replace("    37 points", "999999 points"), "line 9: found 999999; expected .*in a file of this size"),
        (csmip().replace("at  .010 sec", "at 0.000 sec"), "line 1[0-9]: found ValueError: a time step of 0.000 sec"),
        (csmip().replace("at  .010 sec", "at 0 pts/sec"), "line 1[0-9]: found ZeroDivisionError"),
        (cosmos().replace(" 100 Real", "1e9 Real"), "line 15: found 1e9; expected the number of values"),
        (geonet(2).replace("      37      37      37", "    37.5      37      37"), "accelerations"),
        (
            geonet(2).replace("      37      37      37", "99999999      37      37"),
            "their number in a file of this size",
        ),
        *((text[: len(text) // 5], "x") for text in (csmip(), cosmos(), geonet(1), geonet(2))),
    ],
)
def test_hostile_headers_are_refused_with_their_line(text, message):
    with pytest.raises(RecordFileError, match=message):
        parse_record(text.encode(), "x", acceleration=1)
