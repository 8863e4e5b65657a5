"""An offset of a record is part of its PGA: it is removed, or named with both numbers, where the record is scaled."""

import json

import numpy as np
import pytest
import rocking_assessment
from rocking_assessment._evidence.old_rocks import unexceeded
from typer.testing import CliRunner

import rocking
from rocking._cli.app import app
from rocking._excitation.records.processing import OFFSET_SHARE, offset_remark
from tests.excitation.test_record_readers import FOLDER
from tests.suites.motions import noise

KNET = FOLDER / "knet_offset.NS"
TABLE = "name,width [cm],height [cm]\nstele,30,150\n"


def shifted(share: float) -> rocking.Record:
    """A record with an offset, as a share of the largest acceleration about its mean."""
    a = noise(3).acceleration
    shaking = a - a.mean()
    return rocking.Record(shaking + share * np.abs(shaking).max(), 0.01, "m/s2", "S1")


def test_the_numbers_are_those_of_the_record():
    record = shifted(0.4)
    mean, peak = record.acceleration.mean(), record.peak_acceleration
    about_mean = np.abs(record.acceleration - mean).max()
    message = (
        f"its mean of {mean:.4g} m/s2 is part of its PGA of {peak:.4g} m/s2, which is {about_mean:.4g} m/s2 about it"
    )
    assert message in offset_remark(record.acceleration)
    for share, named in ((0.0, False), (0.9 * OFFSET_SHARE, False), (1.1 * OFFSET_SHARE, True), (-5.0, True)):
        assert (offset_remark(shifted(share).acceleration) is not None) == named


def test_the_level_before_the_shaking_counts():
    a = np.concatenate([np.full(200, 0.2), noise(3).acceleration])
    a[200:] -= a[200:].mean() + 40.0 / (a.size - 200)  # the mean is zero
    assert "level before the shaking of 0.2 m/s2" in offset_remark(a)


@pytest.mark.long
def test_a_record_that_is_scaled_by_its_pga_is_named():
    box = rocking_assessment.Object("box", width=0.3, height=1.5)
    for record, named in ((shifted(0.4), True), (shifted(0.4).baseline_corrected(order=0), False)):
        assessment = rocking_assessment.assess(
            box, rocking_assessment.Site(pga=3.0, records=[record, noise(4)]), sensitivity=False
        )
        assert ("S1: its mean" in assessment.rows[0]["warnings"]) == named
        levels = rocking.fragility([record, noise(4)], rocking.Block(0.5, 2.0), intensity=[1.0, 3.0])
        assert ("S1: its mean" in levels.attrs.get("warnings", "")) == named
        motions = [record, *(noise(k) for k in range(4, 9))]
        assert ("S1: its mean" in unexceeded(rocking.Block(0.3, 2.5), motions).attrs.get("warnings", "")) == named
    as_it_is = rocking_assessment.assess(box, rocking_assessment.Site(records=[shifted(0.4)]), sensitivity=False)
    assert "its mean" not in as_it_is.rows[0]["warnings"]


def test_the_removed_offset_of_counts_is_stated_by_the_command(tmp_path):
    (tmp_path / "objects.csv").write_text(TABLE)
    command = ["assess", str(tmp_path / "objects.csv"), "--record", str(KNET), "--pga", "2m/s2", "--no-sensitivity"]
    result = CliRunner().invoke(app, [*command, "--format", "json"])
    (warnings,) = json.loads(result.output)["warnings"]
    assert "mean of 95.002 gal, is removed" in warnings
    assert "part of its PGA" not in warnings
    record = rocking.read_record(KNET)
    expected = rocking_assessment.assess(
        rocking_assessment.Object("stele", width=0.3, height=1.5), rocking_assessment.Site(pga=2.0, records=[record])
    )
    assert json.loads(result.output)["factor"] == [expected.rows[0]["factor"]]


@pytest.mark.parametrize("order", [None, 0, 1])
def test_the_commands_take_the_order_of_a_baseline(order, tmp_path):
    record = shifted(0.4)
    (tmp_path / "objects.csv").write_text(TABLE)
    (tmp_path / "S1.csv").write_text("time [s],acceleration [m/s2]\n" + "".join(
        f"{t:.3f},{a:.12g}\n" for t, a in zip(record.times, record.acceleration, strict=True)))  # fmt: skip
    files = {"folder": ".", "pattern": "S1.csv", "allow_unusual": True}  # its velocity grows with the offset
    suite = {"name": "s", "records": files, "blocks": [{"width": 0.3, "height": 1.5}],
             "intensity": [1.0, 2.0, 4.0], "measure": "pga"}  # fmt: skip
    (tmp_path / "suite.json").write_text(json.dumps(suite))
    option = [] if order is None else ["--baseline-order", str(order)]
    command = ["assess", str(tmp_path / "objects.csv"), "--record", str(tmp_path / "S1.csv"), "--pga", "2m/s2"]
    assert "--allow-unusual" in CliRunner().invoke(app, [*command, *option]).output
    command += ["--allow-unusual", "--no-sensitivity", "--format", "json"]
    result = CliRunner().invoke(app, [*command, *option])
    assert ("part of its PGA" in json.loads(result.output)["warnings"][0]) == (order is None)
    result = CliRunner().invoke(app, ["fragility", str(tmp_path / "suite.json"), *option])
    assert result.exit_code == 0, result.output
    assert ("part of its PGA" in result.stderr) == (order is None)
