"""Accelerogram files made up for the tests of the readers: good, odd but readable, and damaged ones."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

COUNT = 24
STEP = 0.01


def values(count: int = COUNT) -> NDArray[np.float64]:
    """Return the samples of all files, six digits."""
    k = np.arange(count)
    return np.round(0.2 * np.sin(0.7 * k) * np.exp(-0.05 * k), 6)


@dataclass(frozen=True)
class File:
    """A file, the arguments to read it with, and what is expected: samples, unit and step, or the text of the error."""

    content: str | bytes
    arguments: dict[str, Any] = field(default_factory=dict)
    unit: str = "g"
    samples: NDArray[np.float64] = field(default_factory=values)
    step: float = STEP
    error: str = ""

    @property
    def data(self) -> bytes:
        return self.content if isinstance(self.content, bytes) else self.content.encode()


def rows(width: int = 5, form: str = "{:15.6E}", count: int = COUNT) -> str:
    """Return the samples as rows of numbers."""
    x = values(count)
    return "\n".join("".join(form.format(v) for v in x[k : k + width]) for k in range(0, count, width)) + "\n"


TITLE = "PEER STRONG MOTION DATABASE RECORD\nTEST VALLEY 05/05/90, STATION 1, 090\n"


def at2(header: str = "NPTS=    24, DT=  .01000 SEC", units: str = "G", body: str = rows()) -> str:
    return f"{TITLE}ACCELERATION TIME HISTORY IN UNITS OF {units}\n{header}\n{body}"


ESM_KEYS = {
    "EVENT_NAME": "Test valley", "EVENT_ID": "IT-1990-0001", "NETWORK": "IT", "STATION_CODE": "ABC", "STREAM": "HNE",
    "SAMPLING_INTERVAL_S": "0.010000", "NDATA": "24", "DURATION_S": "0.230000", "UNITS": "cm/s^2",
    "DATA_TYPE": "ACCELERATION", "PROCESSING": "none", "HEADER_FORMAT": "DYNA 1.2",
}  # fmt: skip


def esm(changes: dict[str, str | None] | None = None, body: str = rows(1)) -> str:
    keys: dict[str, str | None] = ESM_KEYS | (changes or {})
    lines = [f"{key}: {value}" for key, value in keys.items() if value is not None]
    lines += [f"USER{k}: " for k in range(64 - len(lines))]
    return "\n".join(lines) + "\n" + body


COUNTS = np.round(values() * 8388608 / 2000 * 980.665)
KNET_HEADER = (
    "Origin Time       1990/05/05 12:00:00\nLat.              37.000\nLong.             138.000\nDepth. (km)       10\n"
    "Mag.              6.0\nStation Code      ABC001\nStation Lat.      37.1\nStation Long.     138.1\n"
    "Station Height(m) 10\nRecord Time       1990/05/05 12:00:10\nSampling Freq(Hz) 100Hz\nDuration Time(s)  0.24\n"
    "Dir.              N-S\nScale Factor      2000(gal)/8388608\nMax. Acc. (gal)   190.0\n"
    "Last Correction   1990/05/05 12:00:00\nMemo.\n"
)
KNET_ROWS = "\n".join("".join(f"{int(v):9d}" for v in COUNTS[k : k + 8]) for k in range(0, COUNT, 8)) + "\n"


def knet(old: str, new: str) -> str:
    return KNET_HEADER.replace(old, new) + KNET_ROWS


KNET_VALUES = (COUNTS - COUNTS.mean()) * 2000 / 8388608


def pairs(separator: str = ",", header: str = "time_s,acceleration_g\n", step: float = STEP, digits: int = 3) -> str:
    lines = (f"{k * step:.{digits}f}{separator}{v:.6f}" for k, v in enumerate(values()))
    return header + "\n".join(lines) + "\n"


def times_in(name: str, per_second: float) -> str:
    lines = (f"{k * STEP * per_second:g},{v:.6f}\n" for k, v in enumerate(values()))
    return f"{name},a_g\n" + "".join(lines)


def single(header: str = "") -> str:
    return header + "\n".join(f"{v:.6f}" for v in values()) + "\n"


def replaced(text: str, old: str, new: str) -> str:
    assert old in text, old
    return text.replace(old, new, 1)


THREE = "time_s,NS_g,EW_g\n" + "".join(f"{k * STEP:.2f},{v:.6f},{-2 * v:.6f}\n" for k, v in enumerate(values()))

THREE_ROWS = THREE.split("\n", 1)[1]
KNOWN, IN_GAL = ({"unit": unit, "time_step": STEP} for unit in ("g", "gal"))


def clock(form: str = "{:06.3f}", header: str = "Time,a [g]\n", before: str = "", start: float = 43200.0) -> str:
    times = (divmod(round(start + k * STEP, 6), 60.0) for k in range(COUNT))
    texts = (f"{before}{int(m) // 60 % 24:02d}:{int(m) % 60:02d}:{form.format(s)}" for m, s in times)
    return header + "".join(f"{text},{v:.6f}\n" for text, v in zip(texts, values(), strict=True))


TRACE = "TIMESERIES XX_ABC__HNE_D, 24 samples, 100 sps, 2019-02-03T12:00:00.000000"


def tspair(unit: str = "M/S**2", count: int = 24) -> str:
    header = f"{TRACE}, TSPAIR, FLOAT, {unit}\n".replace("24", str(count))
    return clock("{:09.6f}", header, "2019-02-03T").replace(",0.", "  0.").replace(",-", "  -")


def rounded(form: str, step: float, count: int = 400) -> str:
    return "t [s],a [g]\n" + "".join(f"{form.format(k * step)},{v:.6f}\n" for k, v in enumerate(values(count)))


GOOD = {
    "at2": File(at2()),
    "at2 of cm/s/s": File(at2(units="CM/S/S"), unit="cm/s2"),
    "at2 of m/s2": File(at2(units="M/S**2"), unit="m/s2"),
    "esm": File(esm(), unit="cm/s2"),
    "esm in m/s^2": File(esm({"UNITS": "m/s^2"}), unit="m/s2"),
    "knet": File(KNET_HEADER + KNET_ROWS, unit="gal", samples=KNET_VALUES),
    "csv": File(pairs()),
    "a square wave": File("a [g]\n" + "0.1\n-0.3\n" * 12, {"time_step": STEP}, samples=np.tile([0.1, -0.3], 12)),
    "csv, unit in brackets": File(pairs(header="Time [s],Acceleration [cm/s2]\n"), unit="cm/s2"),
    "csv, unit as argument": File(pairs(header="t,a\n"), {"unit": "m/s2"}, unit="m/s2"),
    "csv without names": File(pairs(header=""), {"unit": "g"}),
    "csv of three components": File(THREE, {"component": "NS_g"}),
    "another component by its short name": File(THREE, {"component": "ew"}, samples=-2 * values()),
    "blanks": File(pairs(" ", "time acc_gal\n"), unit="gal"),
    "tabs": File(pairs("\t", "time\tacc (m/s^2)\n"), unit="m/s2"),
    "one column": File(single("# unit: g\n# dt = 0.01 s\n")),
    "one column, all as arguments": File(single(), {"unit": "mm/s2", "time_step": 0.01}, unit="mm/s2"),
    "one column with a rate": File(single("acceleration [g]\nsampling rate: 100 Hz\n")),
    "one column with an interval in ms": File(single("unit=gal, dt=10 ms\n"), unit="gal"),
}

ODD = {
    "at2 without comma": File(at2("NPTS=    24 DT=  .01000 SEC")),
    "at2 without SEC": File(at2("NPTS=  24, DT= .01000")),
    "at2 with the comma at the end": File(at2("NPTS=  24, DT= .01000 SEC,")),
    "at2 with the old header": File(at2("   24    0.0100    NPTS, DT")),
    "at2 with the old header without comma": File(at2("24 0.0100 NPTS DT")),
    "at2 with DT first": File(at2("DT= .01 SEC, NPTS= 24")),
    "at2 without equals signs": File(at2("NPTS 24 DT 0.01")),
    "at2 with SEC attached": File(at2("NPTS=24, DT=.01SEC")),
    "at2 in lower case": File(at2("npts=  24, dt= .01 sec").replace("UNITS OF G", "units of g")),
    "at2 named TIME SERIES": File(at2().replace("HISTORY", "SERIES")),
    "at2 with one value less": File(at2("NPTS= 101, DT= .01 SEC", body=rows(count=100)), samples=values(100)),
    "at2 with values that touch": File(at2(body=rows(5, "{:13.6E}"))),
    "at2 with D exponents": File(at2(body=rows().replace("E", "D"))),
    "at2 with CRLF": File(at2().replace("\n", "\r\n")),
    "at2 with old Mac line ends": File(at2().replace("\n", "\r")),
    "at2 with one value a line": File(at2(body=rows(1))),
    "at2 with blank lines at the end": File(at2() + "\n\n  \n"),
    "at2 with another line in the header": File("COMMENT\n" + at2()),
    "at2 with a byte order mark": File(b"\xef\xbb\xbf" + at2().encode()),
    "at2 with Latin-1 text": File(at2().replace("VALLEY", "VALLÉE").encode("latin-1")),
    "at2 that states the unit given": File(at2(), KNOWN),
    "esm with 60 header lines": File(esm().replace("USER0: \nUSER1: \nUSER2: \nUSER3: \n", ""), unit="cm/s2"),
    "esm with CRLF": File(esm().replace("\n", "\r\n"), unit="cm/s2"),
    "esm without data type": File(esm({"DATA_TYPE": None}), unit="cm/s2"),
    "esm without unit": File(esm({"UNITS": ""}), {"unit": "gal"}, unit="gal"),
    "knet with a scale of 3920": File(knet("2000(gal)", "3920(gal)"), unit="gal", samples=KNET_VALUES * 3920 / 2000),
    "csv with semicolons and decimal commas": File(pairs(";", "Zeit (s);a (g)\n").replace(".", ",")),
    "csv with a trailing comma": File(pairs().replace("\n", ",\n").replace("acceleration_g,", "acceleration_g")),
    "csv with comments": File("# station ABC\n# unit: cm/s2\n" + pairs(header="time,acceleration\n"), unit="cm/s2"),
    "csv with a title that begins like SMC": File("2 BLOCKS\n" + pairs()),
    "csv with quotes": File(pairs(header='"sec","acceleration (g)"\n')),
    "times from 10 s": File("t_s,a_g\n" + "".join(f"{10 + k * STEP:.2f},{v:.6f}\n" for k, v in enumerate(values()))),
    "csv with rounded times": File(pairs(step=0.0078125, digits=4), step=0.0078125),
    "csv with times in ms": File("time_ms,a_g\n" + "".join(f"{10 * k},{v:.6f}\n" for k, v in enumerate(values()))),
    "csv with blank lines between the rows": File(pairs().replace("\n", "\n\n")),
    "csv with times in microseconds": File(times_in("time [µs]", 1e6).encode("latin-1")),
    "csv with units after slashes": File(times_in("Zeit / ms", 1e3).replace("a_g", "a/g")),
    "csv with other words before the unit": File(times_in("Time (since trigger) [msec]", 1e3)),
    "csv with a line of units": File("time,acc\n" + times_in("[ms]", 1e3).replace("a_g", "[g]")),
    "blanks before units": File(times_in("t [ms]", 1e3).replace("a_g", "acc (m / s2)").replace(",", " "), unit="m/s2"),
    "tabs and decimal commas": File(pairs("\t", "Zeit\ta (g)\n").replace(".", ",")),
    "UTF-16": File(pairs("\t").encode("utf-16")),
    "UTF-16 of the other order": File(b"\xfe\xff" + at2().encode("utf-16-be")),
    "csv with whole numbers without a name": File(
        "Record\n0,1\n1,-2\n", {"unit": "g", "time_step": 0.5}, samples=np.array([1.0, -2.0]), step=0.5
    ),
    "esm of AFAD, with a blank line below its header": File(esm(body="\n" + rows(1)), unit="cm/s2"),
    "csv with a column named time-history": File(pairs(header="Time [s],Acceleration Time-history [g]\n")),
    "one column named time-history": File(single("Time-history (g)\n"), {"time_step": 0.01}),
    "tspair": File(tspair(), unit="m/s2"),
    "tspair without a unit": File(tspair(""), {"unit": "gal"}, unit="gal"),
    "slist": File(f"{TRACE}, SLIST, FLOAT, M/S**2\n" + rows(6, "{:.6f}\t"), unit="m/s2"),
    "times of day": File(clock()),
    "times of day after midnight": File(clock(start=86399.9)),
    "times of day beside a counter": File(clock(header="no,UTC,a [g]\n", before="1,")),
    "times of day without names": File(clock(header="").replace(",", " "), {"unit": "g"}),
    "times of day with dates": File(clock("{:05.2f}Z", "timestamp,a [g]\n", "2019-02-03T")),
    "day with commas": File(clock("{:07.4f}", "Datum Zeit,a [g]\n", "2019/02/03 ").replace(",", ";").replace(".", ",")),
    "times with an exponent": File(rounded("{:.3E}", 0.00244), samples=values(400), step=0.00244),
    "times of three digits": File(rounded("{:.3e}", 0.0078125), samples=values(400), step=0.0078125),
    "epoch": File("time,a [g]\n" + "".join(f"{1549195200 + k * STEP:.3f},{v:.6f}\n" for k, v in enumerate(values()))),
    "few rounded times and a step": File("dt = 0.0078125 s\n" + pairs(step=0.0078125), step=0.0078125),
    **{
        f"one column with {line}": File(single(f"{line}\n"), {"unit": "g"})
        for line in (
            *("Tasa de muestreo: 100 Hz", "Frecuencia de muestreo: 100 muestras/s", "Período de muestreo: 0,01 s"),
            *("Frequenza di campionamento: 100 Hz", "Passo di campionamento [s]: 0.01", "Taxa de amostragem: 100 Hz"),
            *("Fréquence d'échantillonnage : 100 Hz", "PAS D'ECHANTILLONNAGE: 10 ms", "Pas de temps = 0.01 s"),
            *("Abtastrate: 100 Hz", "Zeitschritt dt: 0.01 s", "Örnekleme aralığı: 0.01 s"),
        )
    },
    "at2 with DT in milliseconds": File(at2("NPTS= 24, DT= 10 MSEC")),
    "at2 with a blank line below its header": File(at2(body="\n" + rows())),
    "at2 with names above count and step": File("shock\nnpts dt\n24 0.01\n" + single(), {"unit": "g"}),
    "csv of E, N, Z": File(THREE.replace("NS_g,EW_g", "N,E"), {"unit": "g", "component": "N"}),
    "csv of T, L": File("T,L\n" + "".join(f"{v:.6f},1\n" for v in values()), KNOWN | {"component": "T"}),
    "azimuths for names": File("time N00E V\n" + THREE_ROWS.replace(",", " "), {"unit": "g", "component": "n00e"}),
    "a, v, d": File("t,a,v,d\n" + "".join(f"{line},0.5\n" for line in THREE.splitlines()[1:]), {"unit": "g"}),
    "csv with a row of units without brackets": File("t,a,v\ns,g,cm/s\n" + THREE_ROWS),
    "pandas": File(",time_s,acc_g\n" + "".join(f"{k},{line}\n" for k, line in enumerate(pairs(header="").split()))),
    "csv of a telephone": File(
        "time,seconds_elapsed,x\n"
        + "".join(f"{10**18 + k * 10**7},{line}\n" for k, line in enumerate(pairs(header="").split())),
        {"unit": "m/s2", "component": "x"},
        unit="m/s2",
    ),
    "tabs of LabVIEW": File(pairs("\t", "X_Dimension\tTime\nX_Value\tAcc [g]\tComment\n")),
    "dates and times of day in two columns": File(clock(header="Date,Time,a [g]\n", before="2019-02-03,")),
    "csv with the end of a DOS file": File(pairs() + "\x1a"),
    "csv with several separators at its ends": File(pairs().replace("\n", ",,\n")),
    "two tabs between the columns": File(pairs("\t\t", "t [s]\t\ta [g]\n")),
    "one column below the title Record": File(single("Record\nunit: g\ndt: 0.01\n")),
    "one column with small decimal commas": File(single("unit: g\ndt: 0,01\n").replace(".", ",")),
    "one column with a rate in samples/second": File(single("unit: g\nsampling rate: 100 [samples/second]\n")),
    "one column in spanish": File(single("UNIDADES DE LOS DATOS: Gal (cm/s/s)\ndt: 0.01\n"), unit="gal"),
    "one column with BHRC in its title": File(single("BHRC, Iran\nunit: g\ndt: 0.01\n")),
    "times in another unit and a step": File(times_in("t (10 ms)", 100.0), {"time_step": 0.01}),
    "times rounded to the same and a step": File(pairs(step=0.005, digits=2), {"time_step": 0.005}, step=0.005),
    "times of day below a title of numbers": File("35.1, 139.2\n" + clock(header=""), {"unit": "g"}),
    "two numbers above rows of two": File("24 0.01\n" + rows(2, "{:10.6f}"), {"unit": "g", "component": "rows"}),
    **{
        f"rows of one series with their {name}": File(
            "".join(form.format(k + 1, line) for k, line in enumerate(rows(4, "{:10.6f}").splitlines())),
            KNOWN | {"component": "rows"},
        )
        for name, form in (("numbers first", "{:5d}{}\n"), ("numbers last", "{1}{0:7d}\n"))
    },
    "csv named like AT2 values": File(pairs(header="time (sec),acceleration (G)\n")),
}

_RANDOM = np.random.default_rng(7)
NOISE = _RANDOM.uniform(0.5, 1.0, (100, 3)) * np.where(_RANDOM.random((100, 3)) < 0.85, -1.0, 1.0).cumprod(axis=0)
"""Components whose samples often change their signs, so that those of a row differ less than those of a column."""

DAMAGED = {
    "nothing": File("", error="an empty file"),
    "blank lines only": File("\n \n", error="an empty file"),
    "a web page": File("<!DOCTYPE html><html></html>", error="line 1: found <!DOCTYPE"),
    "json": File('{"a": 1}', error="web page or JSON"),
    "prose": File("This is no record.\n", error="found This is no record"),
    "zeros in bytes": File(b"1\n2\n\0\0", error="binary content"),
    "at2 cut off": File(at2("NPTS=  4000, DT= .01 SEC"), error="line 4: found 4000 stated, 24 values"),
    "at2 cut short": File(at2("NPTS= 10, DT= .01 SEC", body="0.1 0.2\n"), error="line 4: found 10 stated, 2 values"),
    "at2 with one of 25 values missing": File(at2("NPTS= 25, DT= .01 SEC"), error="line 4: found 25 stated, 24 values"),
    "at2 with header only": File(at2(body=""), error="0 acceleration values"),
    "at2 with a word": File(replaced(at2(), "E-01", "E-0l"), error="expected a number"),
    "at2 with overflowed columns": File(replaced(at2(), rows()[:15], " **************"), error="line 5: found \\*"),
    "at2 with nan": File(replaced(at2(), rows()[:15], "            nan"), error="line 5: found nan"),
    "at2 with a huge number": File(replaced(at2(), rows()[:15], "        1.0E999"), error="beyond the range"),
    "at2 with a fill value": File(replaced(at2(), rows()[:15], "      -9.99E+09"), error="acceleration -9"),
    "at2 with DT zero": File(at2("NPTS= 24, DT= 0.0 SEC"), error="line 4: found 0.0; expected the time step DT"),
    "at2 with DT missing": File(at2("NPTS= 24, DT= SEC"), error="line 4"),
    "at2 with NPTS no integer": File(at2("NPTS= 24.5, DT= .01 SEC"), error="an integer"),
    "at2 with a negative NPTS": File(at2("NPTS= -24, DT= .01 SEC"), error="line 4"),
    "at2 of velocity": File(at2(units="CM/S").replace("ACCELERATION", "VELOCITY"), error="line 3: found VELOCITY"),
    "at2 of an unknown unit": File(at2(units="FURLONGS"), error="line 3: found FURLONGS"),
    "at2 with a blank line inside": File(at2(body=replaced(rows(), "\n", "\n\n")), error="a blank line"),
    "at2 with a component": File(at2(), {"component": "x"}, error="one component"),
    "at2 of zeros": File(at2(body="0.0 " * 24), error="all samples 0"),
    "esm without interval": File(esm({"SAMPLING_INTERVAL_S": None, "UNITS": "cm/s^2"}), error="found"),
    "esm with another number of values": File(esm({"NDATA": "12000"}), error="12000 stated, 24 values"),
    "esm with one of 25 values missing": File(esm({"NDATA": "25"}), error="25 stated, 24 values"),
    "esm of velocity": File(esm({"DATA_TYPE": "VELOCITY", "UNITS": "cm/s"}), error="found VELOCITY"),
    "esm of an unknown unit": File(esm({"UNITS": "cm/s"}), error="found cm/s; expected a unit"),
    "esm without a unit": File(esm({"UNITS": ""}), error="no unit of acceleration"),
    "esm with a word": File(esm(body=rows(1) + "end\n"), error="line 89: found end"),
    "knet cut in the header": File(KNET_HEADER[:300], error="found"),
    "knet without counts": File(KNET_HEADER, error="found"),
    "knet with a damaged scale": File(knet("2000(gal)/8388608", "2000(gal)"), error="line 14: found 2000"),
    "knet with a scale of zero": File(knet("2000(gal)", "0(gal)"), error="line 14: found 0; expected a positive"),
    "knet of infinite length": File(knet("0.24", "1e308"), error="line 12: found 1e308; expected a duration"),
    "knet with an infinite scale": File(knet("2000(gal)/8388608", "1e308(gal)/1e-9"), error="line 14: found 1e308"),
    "knet that is too short": File(knet("0.24", "300"), error="line 12: found 30000 stated, 24 values"),
    "knet with one of 25 values missing": File(knet("0.24", "0.25"), error="line 12: found 25 stated, 24 values"),
    "csv with -999 for a missing value": File(replaced(pairs(), "0.122560", "-999.0"), error="the value -999, as for"),
    "csv with n/a for the first value": File(replaced(pairs(), "0.000000", "n/a"), error="line 2: found 0.000,n/a"),
    "tabs and thousands": File(
        "t [s]\ta [mm/s2]\n0.00\t0\n0.01\t-35\n0.02\t1,104\n", error="found 1,104, whose , may separate thousands"
    ),
    "the count at the end": File(single("unit: g\ndt: 0.01\n") + "24\n", error="24 behind as many values; .*`skip`: 0"),
    "its peak first": File(f"{max(values())}\n" + single(), KNOWN, error="before 0.000000; .*`skip`: 1"),
    "a factor of other decimals": File("1.5\n" + single().replace("0.", "9."), IN_GAL, error="1.5 before .*`skip`: 1"),
    "csv with factors below the names": File(
        "NS,EW\n1.0,1.0\n" + pairs(header=""),
        KNOWN | {"component": "EW"},
        error="1.0 before 0.000000; .*`skip`: 1",
    ),
    "components one below the other": File(
        single("unit: g\ndt: 0.01\nNPTS: 24\n") + single(), error="line 3: found NPTS: 24, and 48 values; .*`skip`"
    ),
    "one column of displacements": File(single("DISPLACEMENT TIME SERIES IN UNITS OF CM\n"), IN_GAL, error="line 1"),
    "a factor of MATLAB": File(single("a =\n\n   1.0e+02 *\n\n"), IN_GAL, error="line 3: found a factor"),
    "one column with a distance named delta": File(single("unit: g\nDelta: 5\n"), error="line 2: found Delta: 5"),
    "one column with the rate of raw data": File(single("unit: g\nsps: 200 (raw)\n"), error="no time step"),
    **{
        f"csv of a spectrum, {names}": File(pairs(header=f"{title}{names}\n"), {"unit": "g"}, error="found a spectrum")
        for title, names in (("", "T (s),Sa (g)"), ("", "T1 (s),Se(T1)"), ("EC8 spectrum\n", "T (s),a (g)"))
    },
    "csv of times named acc": File(pairs(" ", "acc vel\n"), KNOWN, error="acc, which rises"),
    "pairs of times and values in one series": File(
        "\n".join(" ".join(pairs(" ", "").splitlines()[k : k + 2]) for k in range(0, 24, 2)),
        KNOWN | {"component": "rows"},
        error="column 1, column 3, which rise uniformly",
    ),
    "rows of one series with their times": File(
        "".join(f"{k / 25:.2f} {line}\n" for k, line in enumerate(rows(4).splitlines())),
        KNOWN,
        error="column 5; expected the argument `component`: one of them, or rows for one series",
    ),
    "three components of noise": File(
        "".join(f"{a:.4f} {b:.4f} {c:.4f}\n" for a, b, c in NOISE),
        KNOWN,
        error="components|3 columns without names",
    ),
    "csv without unit": File(pairs(header="time,acceleration\n"), error="no unit of acceleration"),
    "counts for times": File("Record\n0,1\n1,-2\n", {"unit": "g"}, error="column 1, a counter or times .*time_step"),
    "csv with two units": File("unit: gal\n" + pairs(), error="the unit g in a column name; expected gal"),
    "csv of velocity": File(pairs(header="time (s),velocity (m/s)\n"), {"unit": "g"}, error="velocity"),
    "csv with a missing row": File(replaced(pairs(), "0.010,0.122560\n", ""), error="uniform steps"),
    **{
        f"csv with the times {name}": File(times_in(name, 1.0), error="line 1: found the column .* s, ms, us, min")
        for name in ("t [foo]", "Time since trigger (cm)", "t/ns", "time h", "time_g")
    },
    "csv with a name too many": File(
        times_in("t [ms],no", 1e3), {"unit": "g"}, error="line 1: found t .*names of 2 columns, as in line 2"
    ),
    "commas": File("a [g]\n0,1\n1,2\n2,5\n", {"unit": "g"}, error="line 2: found 0,1; expected semicolons or tabs"),
    "csv with a comment between the rows": File(
        replaced(pairs(), "0.010,", "# gap\n0.010,"), error="line 3: found the comment # gap; .* above the first row"
    ),
    "UTF-16 cut in a character": File(pairs().encode("utf-16")[:-1], error="UTF-16 with truncated data"),
    "csv with few rounded times": File(
        pairs(step=0.0078125), error="line 2: found times rounded to 0.001 s, about 0.00783 s apart; .*`time_step`"
    ),
    "tspair of velocity": File(tspair("M/S"), {"unit": "g"}, error="line 1: found M/S; expected a trace of acc"),
    "tspair with a gap": File(tspair() + tspair(), error="line 26: found TIMESERIES .* each without gaps"),
    "tspair with one of 25 values missing": File(tspair(count=25), error="24 values, and 25 stated in line 1"),
    "times of day in whole seconds": File(clock("{:02.0f}"), error="times that increase"),
    "times of day with a missing row": File(
        "".join(clock().splitlines(keepends=True)[k] for k in range(25) if k != 9), error="uniform steps"
    ),
    "csv with a repeated row": File(pairs() + pairs(header="").splitlines()[-1] + "\n", error="uniform steps"),
    "csv with falling times": File("t,a_g\n2,1\n1,2\n0,1\n", error="times that increase"),
    "csv with an empty field": File(replaced(pairs(), "0.122560", ""), error="line 3"),
    "csv with a third field": File(replaced(pairs(), "0.122560", "0.122560,1"), error="line 3: found 3 columns"),
    "csv with an infinite number": File(replaced(pairs(), "0.122560", "inf"), error="line 3: found inf"),
    "csv of several components": File(THREE, error="components NS_g, EW_g; expected the argument"),
    "csv without the component": File(THREE, {"component": "UD"}, error="expected component UD"),
    "csv of one row": File("time_s,a_g\n0,1\n", error="one row"),
    "csv of times only": File("time_s\n0.00\n0.01\n", {"unit": "g"}, error="a column of times only"),
    "one column without step": File(single("unit: g\n"), error="no time step"),
    "one column, step zero": File(single("unit: g\ndt: 0\n"), error="line 2: found dt: 0; expected a time step"),
    "an unknown unit": File(single("unit: stones\n"), {"time_step": 0.01}, error="line 1: found unit: stones"),
    "a blank line": File(replaced(single("acceleration_g\n"), "0.122560\n", "\n"), {"time_step": 0.01}, error="line 3"),
    "a header of one long line": File("a" * 9000 + "\n" + pairs(), error="line 1: found aaa.*at most 8192 bytes"),
    "a row of one long line": File(pairs() + "1," * 9000 + "\n", error="line 26: found 1,1.*at most 8192 bytes"),
    "numbers of another alphabet": File(pairs().replace("0", "٠"), error="found"),
    "a damaged miniSEED": File(b"000001D " + b"\x01" * 600, {"unit": "g"}, error="miniSEED"),
}
