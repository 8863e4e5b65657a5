"""Factors by direction: those of the solver, of the planes of the table, and the symmetries of the object."""

import math

import numpy as np
import pytest
import rocking_assessment
from rocking_assessment._meshes.mesh import directions_across

import rocking

SITE = rocking_assessment.Site(pga="0.4 g", pgv="0.4 m/s", shapes=["sine", "cosine", "ricker"])
OUTLINE = [(0.0, 0.0), (0.3, 0.0), (0.3, 1.0), (0.1, 1.2), (0.0, 1.0)]


def directions_of(obj, site=SITE):
    return rocking_assessment.assess(obj, site, sensitivity=False).directions()


def factor_at(around, angle):
    return around["factor"].sel(direction=angle).item()


def weakest(around):
    """The direction of the lowest factor [degrees]."""
    return around["direction"].values[np.nanargmin(around["factor"].values)]


def random_object(seed):
    rng = np.random.default_rng(seed)
    width, depth, height = rng.uniform(0.1, 0.5), rng.uniform(0.1, 0.5), rng.uniform(0.6, 1.8)
    shift = rng.uniform(-0.3, 0.3, 2)
    offsets = {"offset_width": shift[0] * width, "offset_depth": shift[1] * depth}
    return rocking_assessment.Object(
        "one", width=width, depth=depth, height=height, mass_height=0.45 * height, **offsets
    )


@pytest.mark.parametrize("seed", range(6))
def test_the_directions_of_width_and_depth_are_the_planes_of_the_table(seed):
    assessment = rocking_assessment.assess(random_object(seed), SITE, sensitivity=False)
    around = assessment.directions()
    for angle, name in ((0, "width"), (90, "depth")):
        expected = next(row["factor"] for row in assessment.rows if row["direction"] == name)
        pair = [factor_at(around, angle), factor_at(around, angle + 180)]
        assert np.fmin(*pair) == pytest.approx(math.nan if expected is None else expected, rel=1e-9, nan_ok=True)
    assert np.nanmin(around["factor"]) == pytest.approx(np.nanmin(assessment.columns["factor"]), rel=1e-9)


def test_each_factor_is_where_the_solver_overturns_the_body_about_a_side():
    obj = random_object(0)
    around = directions_of(obj)
    motions = {motion.name: motion for motion in SITE.motions}
    tried = 0
    for direction, row in around.to_dataframe().dropna().iterrows():
        factor, along = row["factor"], row["along"]
        size, offset = (obj.width, obj.offset_width) if along % 180 == 0 else (obj.depth, obj.offset_depth)
        gyration = math.hypot(size, obj.height) / math.sqrt(12.0)
        way = 1.0 if along < 180 else -1.0
        properties = {"offset": way * offset, "mass_height": obj.mass_height, "gyration": gyration}
        body = rocking.RigidBody.from_size(size, obj.height, **properties)
        motion = motions[row["governing"]]
        component = factor * math.cos(math.radians(direction - along))
        peaks = component * motion.peak_acceleration * (1.0 + np.array([-1e-7, 1e-7]))
        outcomes = body.response(motion.motion, peak_acceleration=peaks, period=motion.period).overturned
        assert outcomes.tolist() == [False, True]
        tried += 1
    assert tried > 12


def test_opposite_directions_differ_only_where_the_mass_is_off_the_middle():
    middle = rocking_assessment.Object("one", width=0.4, depth=0.3, height=1.6)
    around = directions_of(middle)
    assert around["direction"].values.tolist() == [15.0 * k for k in range(24)]
    np.testing.assert_allclose(around["factor"][:12], around["factor"][12:], rtol=1e-12)
    np.testing.assert_allclose(around["factor"][1:12], around["factor"][:0:-1][:11], rtol=1e-12)  # mirrored
    off = directions_of(rocking_assessment.Object("one", width=0.4, depth=0.3, height=1.6, offset_width=0.08))
    assert factor_at(off, 0) != pytest.approx(factor_at(off, 180), rel=0.05)
    mirrored = directions_of(rocking_assessment.Object("one", width=0.4, depth=0.3, height=1.6, offset_width=-0.08))
    np.testing.assert_allclose(off["factor"], np.roll(mirrored["factor"], 12), rtol=1e-12)


def test_a_thin_slab_is_weak_in_all_directions_but_along_it():
    slab = directions_of(rocking_assessment.Object("slab", width=1.0, depth=0.1, height=1.5))
    weakest = factor_at(slab, 90)
    assert weakest == slab["factor"].min()
    for angle in (45, 60, 75):
        assert factor_at(slab, angle) == pytest.approx(weakest / math.sin(math.radians(angle)), rel=1e-12)


def test_a_round_base_has_one_factor_in_all_directions():
    around = directions_of(rocking_assessment.Object("drum", diameter=0.35, height=1.2))
    assert around.sizes["direction"] == 24
    np.testing.assert_allclose(around["factor"], around["factor"][0], rtol=1e-12)
    off = directions_of(rocking_assessment.Object("drum", diameter=0.35, height=1.2, offset_depth=0.05))
    assert weakest(off) in (90.0, 270.0)


def test_a_mesh_that_is_turned_has_the_directions_of_the_object(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    slab = trimesh.creation.box((0.8, 0.2, 1.6))
    slab.apply_transform(trimesh.transformations.rotation_matrix(math.radians(37.3), (0.0, 0.0, 1.0)))
    slab.export(tmp_path / "slab.ply")
    mesh = rocking_assessment.Object.from_mesh(tmp_path / "slab.ply", unit="m")
    table = rocking_assessment.assess(mesh, SITE, sensitivity=False)
    assert table.rows[0]["direction"] == "127.3 deg"
    around = table.directions()
    plain = directions_of(rocking_assessment.Object("slab", width=0.8, depth=0.2, height=1.6))
    assert float(around["factor"].min()) == pytest.approx(float(plain["factor"].min()), rel=1e-6)
    assert weakest(around) in (127.3, 307.3)
    corners = turned_corners(0.8, 0.2, 37.3)
    np.testing.assert_allclose(np.ptp(mesh.footprint, axis=0), np.ptp(corners, axis=0), rtol=1e-6)


def turned_corners(width, depth, degrees):
    """Corners of a rectangle that is turned."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    corners = 0.5 * np.array([(-width, -depth), (width, -depth), (width, depth), (-width, depth)])
    return corners @ np.array([[c, s], [-s, c]])


def test_a_footprint_is_about_the_centre_of_mass():
    box = rocking_assessment.Object("box", width=0.4, depth=0.3, height=1.6, offset_width=0.05)
    np.testing.assert_allclose(box.footprint, turned_corners(0.4, 0.3, 0.0) - (0.05, 0.0))
    drum = rocking_assessment.Object("drum", diameter=0.4, height=1.6)
    np.testing.assert_allclose(np.hypot(*drum.footprint.T), 0.2)


def test_directions_across_long_sides_are_exact_and_others_are_steps():
    assert directions_across(turned_corners(0.4, 0.3, 10.0), 15) == [10.0, 100.0]
    angle = np.radians(np.arange(0.0, 360.0, 0.5))
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    assert directions_across(circle, 15) == [15.0 * k for k in range(12)]


def test_an_outline_rocks_in_its_plane_and_its_mirror_image_the_other_way():
    motion = rocking_assessment.Object.from_outline(OUTLINE, name="headstone")
    table = rocking_assessment.assess(motion, SITE, sensitivity=False)
    around = table.directions()
    assert around["direction"].values.tolist() == [0.0, 180.0]
    for direction, sign in ((0, 1), (180, -1)):
        body = rocking.RigidBody.from_polygon([(sign * x, y) for x, y in OUTLINE])
        lowest = [
            body.thresholds(motion.motion, period=motion.period).lowest / motion.peak_acceleration
            for motion in SITE.motions
        ]
        assert factor_at(around, direction) == pytest.approx(min(lowest), rel=1e-9)
    assert table.rows[0]["factor"] == pytest.approx(around["factor"].min().item(), rel=1e-9)
    assert motion.outline("outline")[:, 1].min() == 0.0
    np.testing.assert_allclose(motion.outline("outline")[:2], [(-0.15, 0.0), (0.15, 0.0)])
    with pytest.raises(rocking.InvalidArgumentError, match="width"):
        rocking_assessment.Object.from_outline(OUTLINE, width=0.3)
    with pytest.raises(rocking.InvalidArgumentError, match="vertices"):
        rocking_assessment.Object.from_outline([(0.0, 0.0), (1.0, 1.0)])


def test_without_a_depth_there_are_two_directions_and_a_strong_object_has_no_factor():
    around = directions_of(rocking_assessment.Object("block", width=3.0, height=0.5))
    assert around["direction"].values.tolist() == [0.0, 180.0]
    assert np.isnan(around["factor"]).all()
    assert around["governing"].values.tolist() == ["", ""]
    with pytest.raises(rocking.InvalidArgumentError, match="row"):
        rocking_assessment.assess(rocking_assessment.Object("block", width=0.3, height=1.0), SITE).directions(1)
