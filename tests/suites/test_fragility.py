"""Fragility of suites with a known answer, and the contracts of `rocking.fragility`."""

import math

import numpy as np
import pytest
import xarray as xr
from scipy.stats import norm

import rocking
from rocking._base.equality import equal_values
from rocking._base.errors import InvalidArgumentError
from rocking._boundary.frequency import critical_frequency_ratio
from rocking.suites.fits import FitStatus, binomial_interval
from tests.suites.motions import BLOCK, noise, sampled

MEDIAN, BETA = 6.0, 0.35  # PGA [m/s2] at which the synthetic suite overturns the block
LEVELS = np.geomspace(2.0, 18.0, 23)


@pytest.fixture(scope="module")
def synthetic():
    """Half sines whose overturning accelerations are quantiles of a lognormal distribution, and these accelerations."""
    capacity = MEDIAN * np.exp(BETA * norm.ppf((np.arange(40) + 0.5) / 40))
    records = []
    for k, acceleration in enumerate(capacity.tolist()):
        # under a half sine a plastic block (eta = 0) overturns above one acceleration, which falls with the duration
        found = critical_frequency_ratio(
            "half_sine",
            slenderness=BLOCK.uplift_acceleration / acceleration,
            restitution=0.0,
            alpha=BLOCK.alpha,
            window=(0.01, 100.0),
        )
        records.append(sampled("half_sine", float(found.frequency_ratio[-1]), name=f"half sine {k}"))
    return records, capacity


@pytest.fixture(scope="module")
def noisy():
    return [noise(seed) for seed in range(6)]


def test_lognormal_answer_is_recovered_within_its_intervals(synthetic):
    records, capacity = synthetic
    found = rocking.fragility(records, BLOCK, intensity=LEVELS, restitution=0.0)
    expected = (capacity[:, None] <= LEVELS).sum(axis=0)
    assert np.abs(found.exceedances - expected).max() <= 1  # a capacity within the sampling error of a level
    own = found.sel(model="lognormal")
    assert own.fit_status == FitStatus.FITTED
    assert own.median_intensity_lower < MEDIAN < own.median_intensity_upper
    assert own.dispersion_lower < BETA < own.dispersion_upper
    assert float(own.median_intensity) == pytest.approx(np.exp(np.log(capacity).mean()), rel=0.03)
    assert float(own.dispersion) == pytest.approx(np.log(capacity).std(), rel=0.1)
    true = norm.cdf(np.log(LEVELS / MEDIAN) / BETA)
    assert ((found.fraction_lower <= true) & (true <= found.fraction_upper)).all()
    assert not found.survives_above_first.any()
    np.testing.assert_array_equal(found.first_exceedances, found.exceedances)


def test_outcomes_are_those_of_the_pulse():
    # a sine has a surviving band above its first overturning (3.31); the solver for pulses has other steps
    ratios = [3.0, 4.0, 5.0]
    records = [sampled("sine", ratio) for ratio in ratios]
    levels = np.linspace(1.05, 8.0, 60)
    found = rocking.fragility(records, BLOCK, intensity=levels, measure="pga_ratio")
    exact = rocking.peak_response(
        "sine",
        slenderness=1.0 / levels[:, None],
        frequency_ratio=np.array(ratios),
        restitution=BLOCK.inelastic_restitution,
        alpha=BLOCK.alpha,
    )
    agree = found.overturned.values == exact.overturned
    assert agree.mean() > 0.98  # but for levels next to a change of outcome
    survived = ~(found.overturned.values.astype(bool) | exact.overturned)
    np.testing.assert_allclose(
        found.peak_rotation.values[survived], exact.peak_rotation[survived], rtol=2e-3, atol=1e-6
    )


def test_records_that_survive_above_their_first_overturning_are_named():
    records = [sampled("sine", 4.0, name="sine"), sampled("half_sine", 1.0, name="half sine")]
    found = rocking.fragility(
        records, [BLOCK], intensity=np.linspace(1.05, 8.0, 100), measure="pga_ratio", demand=["overturning"]
    )
    assert found.survives_above_first.sel(record="sine").item() == 1
    assert found.survives_above_first.sel(record="half sine").item() == 0
    assert found.records_surviving_above_first.item() == "sine"
    assert (found.first_exceedances >= found.exceedances).all()
    assert (found.first_exceedances > found.exceedances).any()


def test_limit_states_are_nested(noisy):
    found = rocking.fragility(noisy, BLOCK, intensity=LEVELS, demand=[0.2, 0.6, "alpha", 1.0, 1.5, "overturning"])
    count = found.exceedances
    assert (count.diff("demand") <= 0).all()
    np.testing.assert_array_equal(count.sel(demand="alpha"), count.sel(demand="1 alpha"))
    assert (count.sel(demand="0.2 alpha") > count.sel(demand="overturning")).any()
    np.testing.assert_array_equal(count.sel(demand="alpha"), found.exceeded_alpha.sum("record"))


def test_measures_differ_by_the_factor_of_each_record(noisy):
    levels = np.array([1.2, 1.8, 2.5])
    pga_over_pgv = [record.peak_acceleration / record.peak_velocity for record in noisy]
    for measure, factor in (
        ("pga_ratio", [BLOCK.uplift_acceleration] * 6),
        ("pgv_ratio", [BLOCK.uplift_acceleration / BLOCK.frequency_parameter * ratio for ratio in pga_over_pgv]),
        ("pgv", pga_over_pgv),
    ):
        found = rocking.fragility(noisy, BLOCK, intensity=levels, measure=measure)
        for k, record in enumerate(noisy):
            alone = rocking.fragility(record, BLOCK, intensity=levels * factor[k], measure="pga")
            np.testing.assert_allclose(found.scale[:, k], alone.scale[:, 0])
            np.testing.assert_allclose(found.peak_rotation[:, k], alone.peak_rotation[:, 0], rtol=1e-9)


def test_frequency_ratio_changes_the_size_of_the_block(noisy):
    levels = np.array([1.0, 3.0, 9.0])
    found = rocking.fragility(noisy, BLOCK, intensity=levels, measure="frequency_ratio", restitution=0.9)
    assert (found.scale == 1.0).all()
    for k, record in enumerate(noisy):
        for j, level in enumerate(levels.tolist()):
            p = 2.0 * math.pi / record.mean_period / level
            size = 0.75 * BLOCK.gravity / p**2
            block = rocking.Block.from_slenderness_angle(BLOCK.alpha, size)
            same = rocking.fragility(record, block, intensity=record.peak_acceleration, restitution=0.9)
            np.testing.assert_allclose(found.peak_rotation[j, k], same.peak_rotation[0, 0], rtol=1e-9)


def test_suites_without_a_curve_say_why(noisy):
    none = rocking.fragility(noisy, BLOCK, intensity=[0.5, 1.0])
    every = rocking.fragility(
        [sampled("rectangular", 0.5, name=str(k)) for k in range(8)], BLOCK, intensity=[40.0, 60.0]
    )
    equal = [sampled("half_sine", 1.0, name=str(k)) for k in range(8)]
    step = rocking.fragility(equal, BLOCK, intensity=[2.0, 2.5, 20.0], restitution=0.0)
    for found, status in ((none, FitStatus.NONE_REACHES), (every, FitStatus.ALL_REACH), (step, FitStatus.SEPARATED)):
        assert (found.fit_status == status).all()
    assert none.median_intensity.isnull().all()
    assert (none.median_intensity_lower == 1.0).all()
    assert np.isinf(none.median_intensity_upper).all()
    assert (every.median_intensity_upper == 40.0).all()
    assert (step.dispersion == 0.0).all()
    assert (step.median_intensity_lower == 2.5).all()
    assert (step.median_intensity_upper == 20.0).all()


def test_mirrored_record_and_order_of_records_do_not_matter(noisy):
    mirrored = [rocking.Record(-r.acceleration, r.time_step, "m/s2", r.name) for r in noisy[::-1]]
    one = rocking.fragility(noisy, BLOCK, intensity=LEVELS)
    other = rocking.fragility(mirrored, BLOCK, intensity=LEVELS).isel(record=slice(None, None, -1))
    np.testing.assert_array_equal(one.peak_rotation, other.peak_rotation)
    np.testing.assert_array_equal(one.median_intensity, other.median_intensity)


def test_single_block_and_limit_state_have_no_dimension(noisy):
    full = rocking.fragility(noisy, [BLOCK], intensity=LEVELS, demand=["alpha"])
    assert full.exceedances.dims == ("demand", "block", "intensity")
    assert full.median_intensity.dims == ("demand", "block", "model")
    assert full.fitted.dims == ("demand", "block", "model", "intensity")
    short = rocking.fragility(noisy, BLOCK, intensity=LEVELS, demand="alpha")
    assert short.exceedances.dims == ("intensity",)
    assert short.overturned.dims == ("intensity", "record")
    np.testing.assert_array_equal(full.exceedances[0, 0], short.exceedances)
    assert float(short.width) == pytest.approx(BLOCK.width)


def test_records_have_names_digests_and_measures(noisy):
    unnamed = rocking.Record(noisy[0].acceleration, noisy[0].time_step, "m/s2")
    found = rocking.fragility([noisy[0], noisy[0], unnamed], BLOCK, intensity=[3.0])
    assert found.record.values.tolist() == ["noise 0 (1)", "noise 0 (2)", "record 3"]
    assert set(found.digest.values) == {noisy[0].digest}
    assert float(found.peak_velocity[2]) == noisy[0].peak_velocity


def test_every_variable_has_unit_and_meaning(noisy):
    found = rocking.fragility(noisy, [BLOCK], intensity=LEVELS, demand=["overturning"])
    for name, variable in found.variables.items():
        assert variable.attrs["long_name"], name
        assert variable.dtype.kind == "U" or variable.attrs["units"], name
    assert found.attrs == {"measure": "pga", "confidence": 0.95}
    assert found.median_intensity.attrs["units"] == "m s-2"


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ({"records": []}, "records"),
        ({"records": [1.0]}, "records"),
        ({"blocks": []}, "blocks"),
        ({"blocks": [0.2]}, "blocks"),
        ({"blocks": [BLOCK, 0.2]}, "blocks"),
        ({"intensity": []}, "intensity"),
        ({"intensity": [2.0, 1.0]}, "intensity"),
        ({"intensity": [0.0, 1.0]}, "intensity"),
        ({"measure": "sa"}, "measure"),
        ({"restitution": "plastic"}, "restitution"),
        ({"restitution": 1.2}, "restitution"),
        ({"demand": "sliding"}, "demand"),
        ({"demand": 0.0}, "demand"),
        ({"demand": []}, "demand"),
        ({"demand": ["alpha", "alpha"]}, "demand"),
        ({"confidence": 1.0}, "confidence"),
    ],
)
def test_invalid_arguments_are_named(noisy, arguments, name):
    given = {"records": noisy[:1], "blocks": BLOCK, "intensity": [3.0]} | arguments
    with pytest.raises(InvalidArgumentError) as error:
        rocking.fragility(given.pop("records"), given.pop("blocks"), **given)
    assert error.value.parameter == name


WIDTH = xr.DataArray([0.4, 0.6], dims="w", coords={"w": [4, 6]})
HEIGHT = xr.DataArray([1.6, 2.0, 2.4], dims="h")


def test_an_array_of_bodies_has_the_fragility_of_each_block():
    options = {"intensity": np.geomspace(1.0, 40.0, 6), "demand": ["overturning", 0.5]}
    motions = [noise(seed) for seed in range(3)]
    found = rocking.fragility(motions, rocking.RigidBody.from_size(WIDTH, HEIGHT), **options)
    blocks = [rocking.Block(w, h) for w in WIDTH.values for h in HEIGHT.values]
    plain = rocking.fragility(motions, blocks, **options)
    assert found.fraction.dims == ("demand", "w", "h", "intensity")
    assert found.w.values.tolist() == [4, 6]
    assert found.variables.keys() - {"w"} == plain.variables.keys()
    for name, values in plain.variables.items():
        np.testing.assert_array_equal(found[name].values.reshape(values.shape), values.values, name)
        assert equal_values(found[name].attrs, values.attrs), name


def test_a_lazy_array_of_bodies_has_the_same_fragility():
    options = {"intensity": np.geomspace(1.0, 40.0, 6)}
    motions = [noise(seed) for seed in range(3)]
    lazy = rocking.fragility(motions, rocking.RigidBody.from_size(WIDTH.chunk(w=1), HEIGHT), **options)
    assert lazy.fraction.chunks == ((1, 1), (3,), (6,))
    plain = rocking.fragility(motions, rocking.RigidBody.from_size(WIDTH, HEIGHT), **options)
    found = lazy.compute()
    xr.testing.assert_allclose(found, plain, rtol=1e-11)  # bodies of a chunk share the sizes of their Taylor steps
    np.testing.assert_array_equal(found.overturned, plain.overturned)
    assert {name: equal_values(one.attrs, plain[name].attrs) for name, one in found.variables.items()} == dict.fromkeys(
        plain.variables, True
    )


def test_bodies_of_another_inertia_are_blocks_of_the_same_alpha_and_p():
    options = {"intensity": np.geomspace(1.0, 40.0, 6)}
    motions = [noise(seed) for seed in range(3)]
    body = rocking.RigidBody(0.2, 0.2, [0.8, 1.0], gyration=0.3)
    found = rocking.fragility(motions, body, **options)
    for k in range(2):
        edge = body.right
        block = rocking.EquivalentBlock(
            float(edge.alpha[k]), float(edge.frequency_parameter[k]), restitution=float(edge.restitution[k])
        )
        one = rocking.fragility(motions, block, **options)
        np.testing.assert_array_equal(found.overturned.isel(dim_0=k), one.overturned)
        np.testing.assert_allclose(found.peak_rotation.isel(dim_0=k), one.peak_rotation, rtol=1e-9)


def test_bodies_with_two_different_edges_count_each_record_and_its_mirror_image():
    motions, levels = [noise(seed) for seed in range(3)], np.geomspace(1.0, 40.0, 6)
    body = rocking.RigidBody([0.2, 0.3], [0.3, 0.2], 1.0)  # mirror images of each other
    found = rocking.fragility(motions, body, intensity=levels, restitution=0.9)
    assert found.record.values.tolist()[:2] == [motions[0].name, f"{motions[0].name}, mirrored"]
    for k in range(2):
        one = rocking.RigidBody(*((0.2, 0.3), (0.3, 0.2))[k], 1.0)
        for n, motion in enumerate(motions):
            scale = levels / motion.peak_acceleration
            for sign in (0, 1):
                given = motion if sign == 0 else rocking.Record(-motion.acceleration, motion.time_step, "m/s2")
                outcome = one.response(given, scale=scale, restitution=0.9).outcome
                np.testing.assert_array_equal(found.outcome.isel(dim_0=k, record=2 * n + sign), outcome)
    # the mirror image of a body under that of a record
    np.testing.assert_array_equal(found.overturned[0, :, ::2], found.overturned[1, :, 1::2])
    np.testing.assert_allclose(found.fraction, found.overturned.mean("record"))
    low, high = binomial_interval(0.5 * found.exceedances.values, 3, 0.95)  # of three independent records
    np.testing.assert_array_equal((found.fraction_lower, found.fraction_upper), (low, high))
    assert found.uplift_acceleration.values.tolist() == body.uplift_acceleration.tolist()


def test_an_object_has_the_fragility_of_each_of_its_directions():
    motions, levels = [noise(seed) for seed in range(3)], [2.0, 6.0, 18.0]
    box = rocking.Object("box", width=0.4, depth=0.6, height=1.6, restitution=0.8)
    found = rocking.fragility(motions, box, intensity=levels)
    assert found.direction.values.tolist() == ["width", "depth"]
    for direction, width in (("width", 0.4), ("depth", 0.6)):
        block = rocking.fragility(motions, rocking.Block(width, 1.6), intensity=levels, restitution=0.8)
        np.testing.assert_array_equal(found.overturned.sel(direction=direction), block.overturned)
    leaning = rocking.Object("box", width=0.4, height=1.6, offset_width=0.05)
    assert rocking.fragility(motions, leaning, intensity=levels).sizes["record"] == 6


@pytest.mark.parametrize(
    ("body", "allowed"),
    [
        (5, "rocking.Object"),
        ([rocking.RigidBody(0.1, 0.1, 0.8)], "rocking.Object"),
        (rocking.RigidBody.from_size(WIDTH.rename(w="record"), 1.6), "dimensions other than intensity, record"),
    ],
)
def test_bodies_without_a_fragility_are_refused(body, allowed):
    with pytest.raises(InvalidArgumentError, match=allowed):
        rocking.fragility([noise(0)], body, intensity=[1.0, 2.0])


@pytest.mark.parametrize("measure", ["pgv_ratio", "frequency_ratio"])
def test_measures_of_one_slenderness_angle_are_refused_for_two_edges(measure):
    with pytest.raises(InvalidArgumentError, match="two different edges"):
        rocking.fragility([noise(0)], rocking.RigidBody(0.1, 0.2, 0.8), intensity=[1.0], measure=measure)
