"""Objects against a wall: an assessment beside responses and thresholds of the bodies themselves."""

import json
import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import rocking_assessment
from rocking_assessment import Object
from rocking_assessment._objects.tables import objects_of_csv, objects_of_json
from typer.testing import CliRunner

import rocking
from rocking import InvalidArgumentError, RigidBody
from rocking._cli.app import app
from rocking.suites.configuration import suite_configuration
from tests.suites.motions import noise

WALLS = {
    "facade": RigidBody.from_size(0.6, 6.0, offset=0.05).one_sided("right", 0.4),
    "shelf": RigidBody.from_size(0.3, 2.0).one_sided("left"),
    "quiet": RigidBody(0.5, 0.4, 0.6, 0.5).one_sided("left", 0.7),
}
OBJECTS = [*(Object.from_body(body, name=name) for name, body in WALLS.items()), Object("vase", 0.3, 1.2, 0.4)]


def mirrored(body: RigidBody) -> RigidBody:
    parameters = body.parameters
    other = {"left": "right", "right": "left"}[body.sides]
    return RigidBody(**{**parameters, "left": parameters["right"], "right": parameters["left"]}, sides=other)


def test_under_pulses_they_are_as_the_bodies_themselves() -> None:
    site = rocking_assessment.Site(pga=4.0, pgv=0.6, shapes=["sine", "ricker", "c1"])
    table = rocking_assessment.assess(OBJECTS, site, sensitivity=False).to_pandas().set_index("object")
    for name, body in WALLS.items():
        factors, survived = [], []
        for motion in site.motions:
            both = body, mirrored(body)
            options = {"peak_acceleration": 4.0, "period": motion.period, "thresholds": False}
            responses = [side.response(motion.motion, **options) for side in both]
            thresholds = []
            for side in both:
                thresholds += side.thresholds(motion.motion, period=motion.period, highest=40.0)
            factors.append(min((threshold.value / 4.0 for threshold in thresholds), default=math.inf))
            if not any(response.overturned for response in responses):
                survived.append(max(float(response.rotation) for response in responses))
        row = table.loc[name]
        assert row.uplift_acceleration == pytest.approx(float(body.uplift_acceleration), rel=1e-12)
        assert row.factor == pytest.approx(min(factors), rel=2e-3) or (math.isnan(row.factor) and min(factors) > 10.0)
        assert row.share == pytest.approx(np.mean([factor <= 1.0 for factor in factors]))
        if row.share == 1.0 - len(survived) / 3.0 and survived:
            assert row.rotation == pytest.approx(max(survived), rel=1e-6)
        assert "against a wall" in row.warnings
    alone = rocking_assessment.assess(OBJECTS[-1], site, sensitivity=False).to_pandas().iloc[0]
    pd.testing.assert_series_equal(table.loc["vase"].iloc[0], alone.drop("object"), check_names=False)


def test_under_a_record_with_a_vertical_component() -> None:
    random = np.random.default_rng(3)
    shape = np.convolve(random.standard_normal(600), np.ones(5), "same")
    record = rocking.Record(shape, 0.02, "m/s2", "one", vertical=0.3 * shape[::-1])
    site = rocking_assessment.Site(records=[record], pga=3.0)
    table = rocking_assessment.assess(OBJECTS[:3], site, sensitivity=False).to_pandas().set_index("object")
    unit = 3.0 / record.peak_acceleration
    for name, body in WALLS.items():
        thresholds = []
        for side in (body, mirrored(body)):
            thresholds += side.thresholds(record, highest=10.0 * unit)
        lowest = min((threshold.value for threshold in thresholds), default=math.nan) / unit
        assert table.factor[name] == pytest.approx(lowest, rel=2e-6, nan_ok=True)
    assert table.factor.notna().any()
    size = float(rocking_assessment.assess(OBJECTS[1], site).to_pandas().smallest_width[0])
    assert size < 0.3
    wider = RigidBody.from_size(1.001 * size, 2.0).one_sided("left")
    assert not any(side.response(record, scale=unit).overturned for side in (wider, mirrored(wider)))
    history = rocking_assessment.assess(OBJECTS[1], site, sensitivity=False).history()
    assert history["rotation"].min() == 0.0 or history["rotation"].max() == 0.0


def test_fragility_of_the_object_is_that_of_the_body() -> None:
    motions, levels = [noise(k, 300, 0.02) for k in range(2)], np.geomspace(1.0, 10.0, 6)
    of_object, of_body = (rocking.fragility(motions, wall, intensity=levels) for wall in (OBJECTS[0], WALLS["facade"]))
    np.testing.assert_array_equal(of_object["outcome"].values.ravel(), of_body["outcome"].values.ravel())


def test_rows_of_tables_and_of_json() -> None:
    text = "name,width [cm],height [cm],depth [cm],sides,rebound\nfacade,60,600,,right,0.4\nvase,30,120,40,,\n"
    text += "free,30,120,40,both,\ndeep,30,120,40,left,\nwrong,30,120,,up,\nnone,30,120,,both,0.4\n"
    table = objects_of_csv(text)
    (facade,), free_standing = [table.objects[:1], table.objects[1:]]
    assert facade.body.sides == "right"
    assert float(facade.body.parameters["rebound"].item()) == 0.4
    assert [len(obj.planes) for obj in free_standing] == [2, 2]
    assert [bad.columns for bad in table.bad_rows] == [["depth"], ["sides"], ["rebound"]]
    (read,) = objects_of_json('[{"name": "a", "width": 0.6, "height": 6.0, "sides": "right", "rebound": 0.4}]').objects
    assert read.planes == facade.planes
    with pytest.raises(InvalidArgumentError, match="against a wall"):
        Object.from_body(WALLS["facade"], restitution="kalliontzis(k=0.5)")


def test_the_command_and_a_configuration_take_them(tmp_path: Path) -> None:
    options = ["--pulse", "cosine", "--peak-acceleration", "0.2g", "--period", "1.5s", "--format", "json"]
    wall = RigidBody.from_size(0.6, 9.0).one_sided("right", 0.4)
    response = wall.response("cosine", peak_acceleration="0.2 g", period=1.5)
    body = ["--body", "rectangle(width=60cm, height=9m, sides=right, rebound=0.4)"]
    printed = json.loads(CliRunner().invoke(app, ["response", *body, *options]).stdout)
    assert printed["rotation_right_deg"] == pytest.approx(math.degrees(response.rotation_right), rel=1e-12)
    (tmp_path / "motion.csv").write_text("\n".join(map(str, noise(3, 300, 0.02).acceleration)))
    records = {"folder": str(tmp_path), "pattern": "*.csv", "unit": "m/s2", "time_step": 0.02}
    blocks = ["rectangle(width=60cm, height=6m, sides=right)", {"width": 0.5, "height": 4.0, "sides": "right"}]
    suite = {"name": "s", "records": records, "measure": "pga", "intensity": [1.0, 3.0, 9.0], "blocks": blocks}
    walls = RigidBody.from_size([0.6, 0.5], [6.0, 4.0]).one_sided("right")
    blocks_of_suite = suite_configuration(suite, tmp_path).blocks
    assert blocks_of_suite.sides == "right"
    for name, values in walls.parameters.items():
        np.testing.assert_allclose(blocks_of_suite.parameters[name], values, rtol=1e-15)
