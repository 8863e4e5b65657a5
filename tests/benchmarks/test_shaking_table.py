"""The comparison with tests on a shaking table, on a small made-up folder in the format of the data."""

import numpy as np
import pytest

import rocking
from benchmarks.accuracy.shaking_table import main, read_tests

BLOCK = rocking.Block.from_slenderness_angle(0.12, 0.4)
RATE = 800
HEADER = "".join(f"Time [s] - Plot {k}\tAmplitude - Plot {k}\t" for k in range(4))
NAMES = "Experimental Results for response-Specimen {0}", "Specimen {0}-Numerical KN=1 KS=1"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Twelve tests of one cycle; the first discrete-element run says that all stand, the second that all overturn."""
    path = tmp_path_factory.mktemp("table")
    time = np.arange(0, 5 * RATE) / RATE
    lines = [",".join(["Test Number", *(name.format(k) for k in (1, 2) for name in NAMES)])]
    for k, amplitude in enumerate(np.linspace(0.1, 0.9, 12), start=11):
        acceleration = amplitude * np.where(abs(time - 2.0) < 0.5, np.sin(2.0 * np.pi * (time - 2.0)), 0.0)
        rows = (f"{t:g}\t{a + 0.02:g}\t{t:g}\t9\t{t:g}\t9\t{t:g}\t9\t" for t, a in zip(time, acceleration, strict=True))
        (path / f"Test{k:03}.txt").write_text("\n".join([HEADER, *rows]).replace("\t9\t", "\t9        \t", 1))
        record = rocking.Record(acceleration, 1.0 / RATE, "g")
        fell = BLOCK.response(record, restitution=0.8).overturned
        lines.append(f"{k},{fell:d},0,{fell:d},1")
    (path / "Results_Granite.csv").write_text("\n".join([*lines, "99,0,0,0,0"]) + "\n")
    return path


def test_motions_are_in_si_units_without_the_offset(folder):
    motions, outcomes = read_tests(folder)
    assert [one.name for one in motions] == [f"Test{k:03}" for k in range(11, 23)]
    assert motions[0].time_step == 0.005
    assert motions[-1].peak_acceleration == pytest.approx(0.9 * 9.80665, rel=0.03)  # the cycle is filtered
    assert abs(motions[-1].final_velocity) < 0.3  # an offset of 0.02 g would give 1 m/s
    assert outcomes[1, "measured"].any()
    assert not outcomes[1, "KN=1 KS=1"].any()


def test_the_report_and_the_picture(folder, tmp_path, capsys):
    main([str(folder), "--points", "3", "--figure", str(tmp_path / "table.png")])
    words = capsys.readouterr().out.split()
    assert words[:2] == ["12", "tests"]
    measured = read_tests(folder)[1][1, "measured"]
    shares = [float(words[k + 2].rstrip("%")) for k, word in enumerate(words) if word == "KN=1"]
    assert shares == pytest.approx([100.0 * (1.0 - measured.mean()), 100.0 * measured.mean()], abs=0.05)
    assert (tmp_path / "table.png").stat().st_size > 1000
