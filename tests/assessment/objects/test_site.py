"""Pairs of components, floors and records of a site, meshes, samples and friction."""

import math
from dataclasses import replace

import numpy as np
import pytest
import rocking_assessment
from rocking_assessment._objects.motions import envelope_of
from rocking_assessment._objects.sensitivity import ETA_CHANGE
from rocking_assessment._objects.site import Motion, static_acceleration
from rocking_assessment._objects.sliding import first_exceedance

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError, StoppedError
from rocking._boundary.scan import RELATIVE_ERROR
from rocking._numba.cancellation import StopFlag

STEP = 0.02
SIZE = 400


def record(seed: int, name: str = "", *, vertical: bool = False) -> rocking.Record:
    rng = np.random.default_rng(seed)
    smooth = np.hanning(11) / np.hanning(11).sum()
    x, z = (np.convolve(rng.normal(size=SIZE) * np.hanning(SIZE), smooth, "same") for _ in range(2))
    return rocking.Record(x, STEP, "m/s2", name, vertical=0.5 * z if vertical else None)


@pytest.fixture(scope="module")
def pair() -> tuple[rocking.Record, rocking.Record]:
    return record(1, "station", vertical=True), record(2)


STATUE = rocking_assessment.Object("statue", width=0.25, depth=0.3, height=1.2, friction=0.5, tolerance=0.01)


def test_a_pair_is_one_record_at_angles_every_15_degrees(pair) -> None:
    site = rocking_assessment.Site(2.5, records=[pair, record(3, "other")])
    assert [motion.group for motion in site.motions] == [0] * 12 + [1]
    scale = 2.5 / max(component.peak_acceleration for component in pair)
    for k, motion in enumerate(site.motions[:12]):
        angle = math.radians(15 * k)
        along = math.cos(angle) * pair[0].acceleration + math.sin(angle) * pair[1].acceleration
        np.testing.assert_allclose(motion.motion.acceleration, along, rtol=1e-12, atol=1e-15)
        np.testing.assert_array_equal(motion.motion.vertical, pair[0].vertical)
        assert motion.peak_acceleration == pytest.approx(scale * np.abs(along).max())
    assessment = rocking_assessment.assess(STATUE, site, sensitivity=False)
    assert set(assessment.columns["share"].tolist()) <= {0.0, 0.5, 1.0}
    for row, factors in zip(assessment.rows, assessment.factors, strict=True):
        events = [(factors[:12] <= 1.0).any(), factors[12] <= 1.0]
        assert row["share"] == np.mean(events)


def test_factors_on_records_are_confirmed_from_both_sides(pair) -> None:
    site = rocking_assessment.Site(2.5, records=[pair])
    assessment = rocking_assessment.assess(STATUE, site, sensitivity=False)
    confirmed = 0
    for row, factors in zip(assessment.rows, assessment.factors, strict=True):
        half = 0.5 * STATUE.planes[row["direction"]].base
        body = rocking.RigidBody(left=half, right=half, height=0.6)
        for motion, factor in zip(site.motions, factors, strict=True):
            unit = motion.peak_acceleration / motion.motion.peak_acceleration
            levels = np.geomspace(0.1, min(0.999 * np.nan_to_num(factor, nan=8.0), 8.0), 400)
            assert not body.response(motion.motion, scale=levels * unit).overturned.any()
            if np.isfinite(factor) and factor < 8.0:
                pair_of = factor * (1.0 + np.array([1e-12, -1.01 * RELATIVE_ERROR])) * unit
                assert body.response(motion.motion, scale=pair_of).overturned.tolist() == [True, False]
                confirmed += 1
    assert confirmed > 10


def test_a_floor_has_the_motion_of_floor_motion_and_factors_are_on_the_ground() -> None:
    ground = record(5, "ground")
    modes = {"periods": [0.5, 0.1], "damping": [0.05, 0.02], "participation": [1.2, -0.2]}
    site = rocking_assessment.Site(2.0, records=[ground], **{f"floor_{name}": value for name, value in modes.items()})
    (motion,) = site.motions
    floor = rocking.floor_motion(ground, **modes)
    assert (motion.motion, motion.ground) == (floor, 2.0)
    scale = 2.0 / ground.peak_acceleration
    assert motion.peak_acceleration == pytest.approx(scale * floor.peak_acceleration, rel=1e-12)
    on_ground, on_floor = (
        rocking_assessment.assess(STATUE, assessed_site, sensitivity=False).columns["factor"][0]
        for assessed_site in (site, rocking_assessment.Site(records=[floor]))
    )
    assert on_ground * scale == pytest.approx(on_floor, rel=0.2)  # the first of other levels, or another range


def test_a_stiff_floor_moves_as_the_ground_under_a_pulse() -> None:
    lamp = rocking_assessment.Object("lamp", width=0.12, height=1.0)
    sites = (rocking_assessment.Site(3.0, 0.3, shapes=["sine"], **floor) for floor in ({}, {"floor_periods": 0.01}))
    expected, on_floor = (rocking_assessment.assess(lamp, site, sensitivity=False).columns["factor"] for site in sites)
    np.testing.assert_allclose(on_floor, expected, rtol=2e-3)


def test_hazard_is_of_the_ground_on_a_floor() -> None:
    curve = [0.2, 1.0, 8.0], [1e-2, 1e-3, 1e-5]
    records = [record(seed) for seed in range(6)]
    lamp = rocking_assessment.Object("lamp", width=0.2, height=1.0)
    plain, weak = (
        rocking_assessment.assess(
            lamp, rocking_assessment.Site(records=records, hazard=curve, **floor), sensitivity=False
        )
        for floor in ({}, {"floor_periods": 0.3, "floor_damping": 0.2, "floor_participation": 2.0})
    )
    assert 1e-5 < plain.columns["annual_rate_lower"][0] < weak.columns["annual_rate_lower"][0] < 1e-2


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ({"records": [(record(1), rocking.Record([1.0, 0.0], 0.5, "m/s2"))]}, "records"),
        ({"records": [record(1)], "hazard": ([1.0], [0.1])}, "hazard"),
        ({"records": [record(1)], "hazard": 1.0}, "hazard"),
        ({"records": [record(1)], "floor_periods": -1.0}, "floor_periods"),
        ({"records": [record(1)], "floor_periods": 0.5, "floor_damping": 2.0}, "floor_damping"),
    ],
)
def test_wrong_records_and_floors_are_refused(arguments, name) -> None:
    with pytest.raises(InvalidArgumentError, match=name):
        rocking_assessment.Site(**arguments).motions  # noqa: B018


@pytest.mark.long
def test_sizes_and_samples_under_records() -> None:
    site = rocking_assessment.Site(3.0, records=[record(1), record(2, vertical=True)])
    (row,) = rocking_assessment.assess(
        rocking_assessment.Object("pier", width=0.32, height=1.2, tolerance=0.02), site, samples=500
    ).rows
    width, height = row["smallest_width"], row["largest_height"]
    for sizes in ([(width, 1.2), (0.998 * width, 1.2)], [(0.32, height), (0.32, height / 0.998)]):
        near = [rocking_assessment.Object(str(k), width=b, height=h) for k, (b, h) in enumerate(sizes)]
        columns = rocking_assessment.assess(near, site, sensitivity=False).columns
        share = dict(zip(columns["object"], columns["share"], strict=True))
        assert share["0"] == 0.0 < share["1"]
    b, h, eta = np.random.default_rng(4).uniform(-1.0, 1.0, (3, 500))
    body = rocking.RigidBody.from_size(0.32 + 0.02 * b, 1.2 + 0.02 * h)
    shifted = np.clip(body.right.restitution + ETA_CHANGE * eta, 0.0, 1.0)
    overturned = np.zeros(500, dtype=bool)
    for motion in site.motions:
        for scale in np.geomspace(0.3, 1.0, 600) * 3.0 / motion.motion.peak_acceleration:
            overturned |= body.response(motion.motion, scale=scale, restitution=shifted).overturned
    share = np.mean(overturned)
    assert 0.02 < share < 0.98
    assert row["sampled_share"] == pytest.approx(share, abs=0.08)


def test_friction_is_exceeded_where_the_motion_says() -> None:
    ramp = rocking.Record([0.0, 4.0, 0.0], 1.0, "m/s2", vertical=[0.0, -2.0, 0.0])
    motion = Motion("ramp", ramp, 4.0, 1.0, 0, 4.0)
    g = rocking.RigidBody(0.1, 0.1, 0.5).gravity
    # 4 t = mu (g - 2 t)
    assert first_exceedance(motion, 0.2) == pytest.approx(0.2 * g / (4.0 + 2.0 * 0.2), rel=1e-12)
    assert math.isnan(first_exceedance(motion, 0.6))
    # at the peak the weight is g - 2: as much as 4 g / (g - 2) on level ground, twice the motion 8 g / (g - 4)
    for factor in (1.0, 2.0):
        expected = 4.0 * factor / (1.0 - 2.0 * factor / STANDARD_GRAVITY)
        stronger = replace(motion, peak_acceleration=4.0 * factor)
        assert static_acceleration(stronger) == pytest.approx(expected, rel=1e-12)
    site = rocking_assessment.Site(4.0, 0.5, shapes=["sine"])
    smooth = rocking_assessment.Object("one", width=0.3, height=1.0, friction=0.2)
    (row,) = rocking_assessment.assess(smooth, site, sensitivity=False).rows
    angle = math.asin(0.2 * g / 4.0)
    assert row["slides_at"] == pytest.approx(angle / (2.0 * math.pi) * site.motions[0].period, rel=1e-4)
    assert row["slides_under"] == f"sine from {row['slides_at']:.3g} s"


@pytest.mark.parametrize("offset", [0.0, 0.04])
def test_friction_that_suffices_for_uplift_is_exceeded_while_it_rocks(offset: float) -> None:
    site = rocking_assessment.Site(4.0, 0.5, shapes=["sine", "ricker"])
    pier = rocking_assessment.Object("one", width=0.3, height=1.0, offset_width=offset, friction=0.31)
    assessment = rocking_assessment.assess(pier, site)
    friction, earliest = assessment.friction(), []
    for motion in site.motions:
        options = {"peak_acceleration": 4.0, "period": motion.period, "samples": 20_001, "contact": True}
        histories = [
            rocking.RigidBody.from_size(0.3, 1.0, offset=side).history(motion.motion, **options)
            for side in {offset, -offset}
        ]
        largest = max(history.attrs["largest_friction_demand"] for history in histories)
        needed, at = (friction[name].sel(motion=motion.name).item() for name in ("friction_needed", "exceeded_at"))
        assert needed == pytest.approx(largest, rel=1e-9)
        over = [history["time"].values[history["friction_demand"].values > 0.31] for history in histories]
        earliest.append(min((times[0] for times in over if times.size), default=math.nan))
        assert at == pytest.approx(earliest[-1], abs=5e-4, nan_ok=True)
    (row,) = assessment.rows
    assert row["slides_first"] is False
    assert row["slides_at"] == pytest.approx(np.nanmin(earliest), abs=5e-4)
    listed = friction["exceeded_at"].to_series().dropna()
    assert row["slides_under"] == "; ".join(f"{name} from {at:.3g} s" for name, at in listed.items())
    assert "may slide while it rocks" in row["warnings"]
    for friction, sensitivity, listed_motions in ((0.31, False, ""), (5.0, True, "none")):
        (row,) = rocking_assessment.assess(replace(pier, friction=friction), site, sensitivity=sensitivity).rows
        assert (row["slides_under"], row["slides_at"]) == (listed_motions, None)


def test_the_history_overturns_where_the_row_does() -> None:
    assessment = rocking_assessment.assess(STATUE, rocking_assessment.Site("0.4 g", "0.6 m/s"), sensitivity=False)
    assert assessment.columns["factor"][0] < 1.0
    assert assessment.history(0).attrs["outcome"].startswith("OVERTURNED")
    assert assessment.worst_motion(0).name == assessment.columns["governing"][0]


def test_an_envelope_has_the_lowest_thresholds_of_one_body() -> None:
    site = rocking_assessment.Site(3.0, 0.3, shapes=["sine", "ricker"])
    periods, lowest = envelope_of([(STATUE, "depth"), (STATUE, "width")], site.motions, 20.0)
    for name in ("sine", "ricker"):
        expected = rocking.RigidBody.from_size(0.25, 1.2).thresholds(name, period=periods[18]).lowest
        assert lowest[name][1, 18] == pytest.approx(float(expected), rel=1e-9)
        assert (lowest[name][0, 18:] > lowest[name][1, 18:]).all()


def test_a_stopped_assessment_stops_and_progress_ascends(pair) -> None:
    shares: list[float] = []
    rocking_assessment.assess(STATUE, rocking_assessment.Site(3.0, 0.3), progress=shares.append)
    assert shares == sorted(shares)
    assert 0.5 < shares[-1] < 1.0
    for site in (rocking_assessment.Site(3.0, 0.3), rocking_assessment.Site(records=[pair])):
        stop = StopFlag()
        stop.set()
        with pytest.raises(StoppedError):
            rocking_assessment.assess(STATUE, site, stop=stop)
