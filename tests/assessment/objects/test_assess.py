"""Assessments: each factor is confirmed by the solver, and the answers follow from the motions of the site."""

import itertools
import math

import numpy as np
import pytest
from rocking_assessment._objects.assess import assess
from rocking_assessment._objects.columns import OUTPUTS, VERDICTS
from rocking_assessment._objects.objects import Object
from rocking_assessment._objects.search import HIGHEST_FACTOR
from rocking_assessment._objects.sensitivity import SIZE_ERROR
from rocking_assessment._objects.site import Site

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking._dimensional.rigid_body import RigidBody
from rocking._excitation.impulse import impulse_of
from rocking._excitation.records.record import Record
from tests.sampling import sample

SITE = Site(pga="0.35 g", pgv="0.5 m/s", shapes=["sine", "cosine", "ricker"])


def random_objects(count: int) -> list[Object]:
    rng = np.random.default_rng(17)
    height, width = np.exp(rng.uniform(np.log(0.3), np.log(2.5), count)), rng.uniform(0.12, 0.5, (count, 2))
    return [
        Object(f"object {k}", width=h * w, depth=h * d, height=h, mass_height=0.45 * h, offset_width=0.05 * h * w)
        for k, (h, (w, d)) in enumerate(zip(height, width, strict=True))
    ]


def test_each_factor_is_confirmed_from_both_sides_and_no_range_of_weaker_motions_overturns() -> None:
    rng = np.random.default_rng(200)
    cases = [(obj, Site(pga=rng.uniform(1.5, 6.0), pgv=rng.uniform(0.1, 1.0))) for obj in random_objects(200)]
    drawn = sample(cases, 8)
    overturning = 0
    for obj, site in drawn:
        for row in assess(obj, site, sensitivity=False).rows:
            overturning += row["factor"] is not None
            top = HIGHEST_FACTOR if row["factor"] is None else row["factor"]
            below = top * np.linspace(0.05, 0.997, 60)
            tried = np.concatenate([below, below * 1.0021, top * (1.0 + np.array([-1e-8, 0.0, 1e-12, 1e-10, 1e-8]))])
            plane = obj.planes[row["direction"]]
            width, offset = plane.base, plane.offset
            gyration = math.hypot(width, obj.height) / math.sqrt(12.0)
            hit = set()
            for motion, side in itertools.product(site.motions, (offset, -offset)):
                left, right = width / 2 + side, width / 2 - side
                body = RigidBody(left=left, right=right, height=obj.mass_height, gyration=gyration)
                peaks = tried * motion.peak_acceleration
                overturned = body.response(motion.motion, peak_acceleration=peaks, period=motion.period).overturned
                # a range narrower than the distance of the factors tried, 0.2 %, may be missed
                assert not (overturned[:60] & overturned[60:120]).any(), (row, motion.name)
                assert not overturned[120], (row, motion.name)
                hit |= {motion.name} if overturned[121:].any() else set()  # the range above may be as thin
            assert row["factor"] is None or row["governing"] in hit
    assert overturning > len(drawn)


def test_rows_come_worst_first_with_verdicts_of_the_share() -> None:
    assessment = assess(random_objects(20), SITE, sensitivity=False)
    share = assessment.columns["share"]
    assert (np.diff(share) <= 0.0).all()
    assert share[0] > 0.5
    assert share[-1] == 0.0
    for row in assessment.rows:
        expected = 4 if row["share"] > 0.5 else 3 if row["share"] > 0.0 else int(row["uplifts"])
        assert row["verdict"] == VERDICTS[expected]
        assert (row["factor"] is not None and row["factor"] <= 1.0) == (row["share"] > 0.0)
        assert (row["rotation"] is None) == (row["share"] == 1.0)


def test_the_smallest_width_and_the_largest_height_are_where_the_outcome_changes() -> None:
    (row,) = assess(Object("pier", width=0.4, height=1.6), SITE).rows
    for change, overturns in ((1.0, False), (1.0 - 2.0 * SIZE_ERROR, True)):
        sizes = (row["smallest_width"] * change, 1.6), (0.4, row["largest_height"] / change)
        for changed in assess([Object("pier", width=b, height=h) for b, h in sizes], SITE, sensitivity=False).rows:
            assert (changed["share"] > 0.0) == overturns


def test_each_shape_reaches_the_ground_velocity_and_moving_ground_only_if_asked() -> None:
    motions = Site(pga=3.0, pgv=0.4).motions
    assert {motion.name for motion in motions}.isdisjoint({"half_sine", "rectangular"})
    assert len(motions) == 7
    for motion in motions:
        largest = impulse_of(motion.motion).largest * motion.peak_acceleration * motion.period / (2.0 * math.pi)
        assert largest == pytest.approx(0.4, rel=1e-12)
    assert len(Site(pga=3.0, pgv=0.4, moving_ground=True).motions) == 9


def test_suite_of_records_with_hazard() -> None:
    rng = np.random.default_rng(2)
    records = [Record(rng.normal(size=300) * np.hanning(300), 0.05, "m/s2", name=f"r{k}") for k in range(6)]
    site = Site(pga=4.0, records=records, hazard=([0.5, 20.0], [0.1, 1e-4]))
    slender, stocky = Object("slender", width=0.1, height=0.8), Object("stocky", width=2.0, height=0.8)
    worst, best = assess([stocky, slender], site, sensitivity=False).rows
    assert (worst["object"], best["object"]) == ("slender", "stocky")
    assert worst["share_lower"] < worst["share"] <= worst["share_upper"]
    assert 1e-4 < worst["annual_rate"] < 0.1
    assert worst["annual_rate_lower"] <= worst["annual_rate"] <= worst["annual_rate_upper"]
    assert (best["annual_rate"], best["annual_rate_lower"]) == (None, 0.0)
    assert best["annual_rate_upper"] == pytest.approx(1e-4)
    assert "the annual rate of overturning is at least 0, at most 0.0001" in best["warnings"]
    body = rocking.Block(0.1, 0.8)
    hit = {record.name for record in records if body.response(record, scale=4.0 / record.peak_acceleration).overturned}
    assert hit <= {*worst["overturned_by"].split("; ")}


def test_friction_less_than_the_slope_slides_first() -> None:
    friction = {"rough": 0.5, "smooth": 0.1, "unknown": None}
    rows = assess([Object(name, width=0.3, height=1.0, friction=mu) for name, mu in friction.items()], SITE).rows
    by_name = {row["object"]: row for row in rows}
    assert [by_name[name]["slides_first"] for name in friction] == [False, True, None]
    assert by_name["rough"]["sliding"] is None
    assert by_name["smooth"]["sliding"] > 0.0
    assert "sliding is not assessed" in by_name["unknown"]["warnings"]


def test_result_as_table(tmp_path) -> None:
    assessment = assess([Object("a", width=0.3, height=1.2), Object("b", diameter="30 cm", height=1.0)], SITE)
    text = assessment.to_csv(tmp_path / "table.csv")
    assert (tmp_path / "table.csv").read_text() == text
    assert "uplift_acceleration [m/s2]" in text.splitlines()[0]
    assert (
        list(assessment.to_pandas().columns)
        == [quantity.name for quantity in OUTPUTS]
        == list(assessment.to_xarray().data_vars)
    )
    assert len(repr(assessment).splitlines()) == 2
    assert "objects and directions under 3 motions" in repr(assessment)
    assert "wobbling" in next(row for row in assessment.rows if row["object"] == "b")["warnings"]


@pytest.mark.parametrize(
    "arguments",
    [{"pga": 3.0}, {"pgv": 0.3}, {"pga": 3.0, "pgv": 0.3, "periods": (0.1, 1.0)}, {"pga": 3.0, "periods": 0.5},
     {"pga": 3.0, "periods": (0.5, 0.6, 0.7)}],
)  # fmt: skip
def test_incomplete_sites_are_refused(arguments) -> None:
    with pytest.raises(InvalidArgumentError):
        Site(**arguments)


@pytest.mark.parametrize(
    "arguments",
    [{"height": 1.0}, {"width": 0.4}, {"width": 0.4, "diameter": 0.4, "height": 1.0},
     {"width": 0.4, "height": 1.0, "offset_width": 0.2}, {"width": 0.4, "height": 1.0, "offset_depth": 0.1},
     {"diameter": 0.4, "height": 1.0, "offset_width": 0.19, "offset_depth": 0.19},
     {"width": 0.4, "height": 1.0, "mass_height": 1.1}],
)  # fmt: skip
def test_incomplete_objects_are_refused(arguments) -> None:
    with pytest.raises(InvalidArgumentError):
        Object("one", **arguments)


def test_an_object_that_the_vertical_component_presses_down_does_not_uplift() -> None:
    ground = np.array([0.0, 0.2, 0.5, 1.0, 0.5, -0.2, -0.6, -0.2, 0.0, 0.0])
    pressing = [0.0, 0.3, 0.6, 0.9, 0.6, 0.3, 0.3, 0.0, 0.0, 0.0]
    motion = rocking.Record(0.3 * ground, 0.1, "g", vertical=pressing)
    assert motion.peak_acceleration > 9.80665 * 0.25  # alone it would uplift the object
    assert rocking.Block(0.4, 1.6).response(motion).outcome == rocking.Outcome.NO_UPLIFT
    pier = Object("one", width=0.4, depth=0.4, height=1.6)
    assessment = assess(pier, Site(records=motion))
    assert assessment.columns["verdict"].tolist() == ["stays", "stays"]
    assert assessment.columns["uplifts"].tolist() == [False, False]
    assert assessment == assess(pier, Site(records=[motion]))
    with pytest.raises(InvalidArgumentError, match="row"):
        assessment.friction(0.5)
    assert assessment.friction(0.0).identical(assessment.friction(0))
