"""Checks by standards beside the outcome: against the clauses themselves, in table, report and command."""

import json
import re

import numpy as np
import pytest
import rocking_assessment
from rocking_assessment import standards
from rocking_assessment._objects.columns import CLAUSES
from rocking_assessment._objects.report import Project, report_html
from typer.testing import CliRunner

import rocking
from rocking._cli.app import app

TIMES = 0.02 * np.arange(200)
RECORD = rocking.Record(3 * np.sin(7 * TIMES), 0.02, "m/s2", "A", vertical=2 * np.cos(11 * TIMES))
WEAK = rocking.Record(RECORD.acceleration / 3, 0.02, "m/s2", "B")
OBJECT = rocking_assessment.Object("bust", width=0.3, height=1.6, offset_width=0.03)
SITE = rocking_assessment.Site(pga=4.0, records=[RECORD, WEAK])


@pytest.fixture(scope="module")
def assessment():
    return rocking_assessment.assess(OBJECT, SITE, sensitivity=False, standards="all")


def test_ratios_are_those_of_the_clauses_with_the_nearer_edge(assessment):
    """Without a table of spectra in between; both motions have the PGA of the site."""
    row, (b, h), r = assessment.rows[0], (0.12, 0.8), np.hypot(0.3, 1.6) / np.sqrt(12)
    tilt = 4.0 / standards.west_acceleration(b, h)
    assert row["static_ratio"] == pytest.approx(tilt)
    assert row["circolare_linear_ratio"] == pytest.approx(tilt / 2)
    scale = 4.0 / RECORD.peak_acceleration
    pgv = scale * RECORD.peak_velocity
    assert row["ishiyama_ratio"] == pytest.approx(min(tilt, pgv / standards.ishiyama_velocity(b, h, r)), rel=1e-3)

    def spectral(period, damping, component="horizontal"):
        return scale * rocking.elastic_spectrum(RECORD, period, damping, component=component)

    demand = spectral(standards.circolare2009_secant_period(b, h), 0.05).displacement.item()
    assert row["circolare_nonlinear_ratio"] == pytest.approx(demand / (0.4 * b))
    periods = np.linspace(0.05, float(standards.circolare2019_period(b, h)), 200)
    demand = spectral(periods, 0.08).displacement.max().item()
    assert row["circolare2019_nonlinear_ratio"] == pytest.approx(min(tilt, demand / (0.4 * b)), rel=1e-3)
    alpha, damping = np.arctan2(b, h), standards.asce43_effective_damping(b, h, r)
    period = 1 / standards.asce43_effective_frequency(alpha, b, h, r)
    across = spectral(period, damping).pseudo_acceleration.item()
    up = spectral(period, damping, "vertical").pseudo_acceleration.item()
    expected = across / standards.asce43_capacity(alpha, b, h, up / across)
    assert row["asce43_ratio"] == pytest.approx(min(tilt, expected))


def test_by_the_circolare_a_body_on_a_floor_passes_at_the_ground_too():
    """The first mode has a node at this floor, which isolates it from half of the motion."""
    names = ["circolare_linear", "circolare_nonlinear", "circolare2019_nonlinear"]
    floor = rocking_assessment.Site(pga=4.0, records=[RECORD], floor_periods=3.0, floor_participation=0.8)
    ground = rocking_assessment.Site(pga=4.0, records=[RECORD])
    on_floor, at_ground = (
        rocking_assessment.assess(OBJECT, site, sensitivity=False, standards=["static", *names]).rows[0]
        for site in (floor, ground)
    )
    assert on_floor["static_ratio"] < 0.7 * at_ground["static_ratio"]
    for name in names:
        assert on_floor[f"{name}_ratio"] >= at_ground[f"{name}_ratio"]
    assert on_floor["circolare_linear_ratio"] == at_ground["circolare_linear_ratio"]


def test_the_largest_spectral_displacement_does_not_depend_on_the_other_objects():
    small = rocking_assessment.Object("cup", width=0.05, height=0.12)
    alone = rocking_assessment.assess(small, SITE, sensitivity=False, standards="circolare2019_nonlinear").rows[0]
    among = rocking_assessment.assess(
        [OBJECT, small], SITE, sensitivity=False, standards="circolare2019_nonlinear"
    ).rows
    assert among[-1]["circolare2019_nonlinear_ratio"] == alone["circolare2019_nonlinear_ratio"]


def test_only_what_is_asked_for_is_stated():
    none = rocking_assessment.assess(OBJECT, SITE, sensitivity=False).rows[0]
    assert all(none[f"{name}_ratio"] is None for name in CLAUSES)
    some = rocking_assessment.assess(OBJECT, SITE, sensitivity=False, standards=["static", "asce43"]).rows[0]
    assert [name for name in CLAUSES if some[f"{name}_ratio"] is not None] == ["static", "asce43"]
    assert all(some[name] == none[name] for name in none if not name.endswith("_ratio"))
    for wrong in ("eurocode", 3, ["static", 1]):
        with pytest.raises(rocking.InvalidArgumentError, match="standards"):
            rocking_assessment.assess(OBJECT, SITE, standards=wrong)


def test_report_and_command_state_them(assessment, tmp_path):
    """Passes or fails beside the verdict; columns of the printed table."""
    text = report_html(assessment, Project("", "", "", "", ""))
    for name, meaning in CLAUSES.items():
        verdict = "passes" if assessment.rows[0][f"{name}_ratio"] < 1 else "fails"
        row = rf"<td>{re.escape(meaning)}</td><td class=\"n\">[^<]+</td><td>{verdict}</td>"
        assert re.search(row, " ".join(text.split()))
    plain = rocking_assessment.assess(OBJECT, SITE, sensitivity=False)
    assert "demand over capacity" not in report_html(plain, Project("", "", "", "", ""))
    file = tmp_path / "one.csv"
    file.write_text("name,width [m],height [m],offset width [m]\nbust,0.3,1.6,0.03\n")
    command = ["assess", str(file), "--pga", "3m/s2", "--pgv", "0.4m/s", "--no-sensitivity"]
    command += ["--standards", "static,ishiyama"]
    assert "static ratio" in CliRunner().invoke(app, command).stdout
    printed = json.loads(CliRunner().invoke(app, [*command, "--format=json"]).stdout)
    assert printed["static_ratio"] == [pytest.approx(3.0 / standards.west_acceleration(0.12, 0.8))]
