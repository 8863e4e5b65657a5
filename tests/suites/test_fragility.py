"""Fragility of suites with a known answer, its contracts, margins of records, vertical components."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from scipy.stats import norm

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.equality import equal_values
from rocking._base.errors import InvalidArgumentError
from rocking._boundary.frequency import critical_frequency_ratio
from rocking._dimensional.thresholds import overturning_scale
from rocking.suites.configuration import RecordFiles
from rocking.suites.fits import FitStatus, binomial_interval
from rocking.suites.margins import with_margins
from rocking.suites.outcomes import check_suite, suite_outcomes
from rocking.suites.summary import record_margins
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
        block = {"slenderness": BLOCK.uplift_acceleration / acceleration, "restitution": 0.0, "alpha": BLOCK.alpha}
        critical = critical_frequency_ratio("half_sine", **block, window=(0.01, 100.0))
        records.append(sampled("half_sine", float(critical.frequency_ratio[-1]), name=f"half sine {k}"))
    return records, capacity


@pytest.fixture(scope="module")
def noisy():
    return [noise(seed) for seed in range(6)]


def test_lognormal_answer_is_recovered_within_its_intervals(synthetic):
    records, capacity = synthetic
    fragility = rocking.fragility(records, BLOCK, intensity=LEVELS, restitution=0.0)
    expected = (capacity[:, None] <= LEVELS).sum(axis=0)
    assert np.abs(fragility.exceedances - expected).max() <= 1  # a capacity within the sampling error of a level
    curve = fragility.sel(model="lognormal")
    assert curve.fit_status == FitStatus.FITTED
    assert curve.median_intensity_lower < MEDIAN < curve.median_intensity_upper
    assert curve.dispersion_lower < BETA < curve.dispersion_upper
    assert float(curve.median_intensity) == pytest.approx(np.exp(np.log(capacity).mean()), rel=0.03)
    assert float(curve.dispersion) == pytest.approx(np.log(capacity).std(), rel=0.1)
    true = norm.cdf(np.log(LEVELS / MEDIAN) / BETA)
    assert ((fragility.fraction_lower <= true) & (true <= fragility.fraction_upper)).all()
    assert not fragility.survives_above_first.any()
    np.testing.assert_array_equal(fragility.first_exceedances, fragility.exceedances)


def test_records_that_survive_above_their_first_overturning_are_named():
    records = [sampled("sine", 4.0, name="sine"), sampled("half_sine", 1.0, name="half sine")]
    options = {"measure": "pga_ratio", "demand": ["overturning"]}
    fragility = rocking.fragility(records, [BLOCK], intensity=np.linspace(1.05, 8.0, 100), **options)
    assert fragility.survives_above_first.sel(record="sine").item() == 1
    assert fragility.survives_above_first.sel(record="half sine").item() == 0
    assert fragility.records_surviving_above_first.item() == "sine"
    assert (fragility.first_exceedances >= fragility.exceedances).all()
    assert (fragility.first_exceedances > fragility.exceedances).any()


def test_limit_states_are_nested(noisy):
    fragility = rocking.fragility(noisy, BLOCK, intensity=LEVELS, demand=[0.2, 0.6, "alpha", 1.0, 1.5, "overturning"])
    count = fragility.exceedances
    assert (count.diff("demand") <= 0).all()
    np.testing.assert_array_equal(count.sel(demand="alpha"), count.sel(demand="1 alpha"))
    assert (count.sel(demand="0.2 alpha") > count.sel(demand="overturning")).any()
    np.testing.assert_array_equal(count.sel(demand="alpha"), fragility.exceeded_alpha.sum("record"))


def test_measures_differ_by_the_factor_of_each_record(noisy):
    levels = np.array([1.2, 1.8, 2.5])
    pga_over_pgv = [record.peak_acceleration / record.peak_velocity for record in noisy]
    for measure, factor in (
        ("pga_ratio", [BLOCK.uplift_acceleration] * 6),
        ("pgv_ratio", [BLOCK.uplift_acceleration / BLOCK.frequency_parameter * ratio for ratio in pga_over_pgv]),
        ("pgv", pga_over_pgv),
    ):
        fragility = rocking.fragility(noisy, BLOCK, intensity=levels, measure=measure)
        for k, record in enumerate(noisy):
            alone = rocking.fragility(record, BLOCK, intensity=levels * factor[k], measure="pga")
            np.testing.assert_allclose(fragility.scale[:, k], alone.scale[:, 0])
            np.testing.assert_allclose(fragility.peak_rotation[:, k], alone.peak_rotation[:, 0], rtol=1e-9)


def test_mirrored_record_and_order_of_records_do_not_matter(noisy):
    mirrored = [rocking.Record(-r.acceleration, r.time_step, "m/s2", r.name) for r in noisy[::-1]]
    fragility = rocking.fragility(noisy, BLOCK, intensity=LEVELS)
    of_mirrored = rocking.fragility(mirrored, BLOCK, intensity=LEVELS).isel(record=slice(None, None, -1))
    np.testing.assert_array_equal(fragility.peak_rotation, of_mirrored.peak_rotation)
    np.testing.assert_array_equal(fragility.median_intensity, of_mirrored.median_intensity)


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
    fragility = rocking.fragility([noisy[0], noisy[0], unnamed], BLOCK, intensity=[3.0])
    assert fragility.record.values.tolist() == ["noise 0 (1)", "noise 0 (2)", "record 3"]
    assert set(fragility.digest.values) == {noisy[0].digest}
    assert float(fragility.peak_velocity[2]) == noisy[0].peak_velocity


def test_every_variable_has_unit_and_meaning(noisy):
    fragility = rocking.fragility(noisy, [BLOCK], intensity=LEVELS, demand=["overturning"])
    for name, variable in fragility.variables.items():
        assert variable.attrs["long_name"], name
        assert variable.dtype.kind == "U" or variable.attrs["units"], name
    assert fragility.attrs == {"measure": "pga", "confidence": 0.95}
    assert fragility.median_intensity.attrs["units"] == "m s-2"


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ({"records": []}, "records"),
        ({"records": [1.0]}, "records"),
        ({"blocks": []}, "blocks"),
        ({"blocks": [0.2]}, "blocks"),
        ({"blocks": [BLOCK, 0.2]}, "blocks"),
        ({"blocks": [rocking.RigidBody(0.1, 0.1, 0.8)]}, "blocks"),
        ({"blocks": rocking.RigidBody.from_size(xr.DataArray([0.4, 0.6], dims="record"), 1.6)}, "blocks"),
        ({"blocks": rocking.RigidBody(0.1, 0.2, 0.8), "measure": "pgv_ratio"}, "measure"),
        ({"blocks": rocking.RigidBody(0.1, 0.2, 0.8), "measure": "frequency_ratio"}, "measure"),
        ({"intensity": []}, "intensity"),
        ({"intensity": [2.0, 1.0]}, "intensity"),
        ({"intensity": [0.0, 1.0]}, "intensity"),
        ({"measure": "sa"}, "measure"),
        ({"restitution": "plastic"}, "restitution"),
        ({"demand": "sliding"}, "demand"),
        ({"demand": 0.0}, "demand"),
        ({"demand": []}, "demand"),
        ({"demand": ["alpha", "alpha"]}, "demand"),
        ({"confidence": 1.0}, "confidence"),
    ],
)
def test_invalid_arguments_are_named(noisy, arguments, name):
    values = {"records": noisy[:1], "blocks": BLOCK, "intensity": [3.0]} | arguments
    with pytest.raises(InvalidArgumentError) as error:
        rocking.fragility(values.pop("records"), values.pop("blocks"), **values)
    assert error.value.parameter == name


WIDTH = xr.DataArray([0.4, 0.6], dims="w", coords={"w": [4, 6]})
HEIGHT = xr.DataArray([1.6, 2.0, 2.4], dims="h")
OPTIONS = {"intensity": np.geomspace(1.0, 40.0, 6), "demand": ["overturning", 0.5]}


@pytest.fixture(scope="module")
def by_bodies(noisy):
    return rocking.fragility(noisy[:3], rocking.RigidBody.from_size(WIDTH, HEIGHT), **OPTIONS)


def test_an_array_of_bodies_has_the_fragility_of_each_block(noisy, by_bodies):
    blocks = [rocking.Block(w, h) for w in WIDTH.values for h in HEIGHT.values]
    plain = rocking.fragility(noisy[:3], blocks, **OPTIONS)
    assert by_bodies.fraction.dims == ("demand", "w", "h", "intensity")
    assert by_bodies.w.values.tolist() == [4, 6]
    assert by_bodies.variables.keys() - {"w"} == plain.variables.keys()
    for name, values in plain.variables.items():
        np.testing.assert_array_equal(by_bodies[name].values.reshape(values.shape), values.values, name)
        assert equal_values(by_bodies[name].attrs, values.attrs), name


def test_a_lazy_array_of_bodies_has_the_same_fragility(noisy, by_bodies):
    lazy = rocking.fragility(noisy[:3], rocking.RigidBody.from_size(WIDTH.chunk(w=1), HEIGHT), **OPTIONS)
    assert lazy.fraction.chunks == ((2,), (1, 1), (3,), (6,))
    computed = lazy.compute()
    xr.testing.assert_allclose(
        computed, by_bodies, rtol=1e-11
    )  # bodies of a chunk share the sizes of their Taylor steps
    np.testing.assert_array_equal(computed.overturned, by_bodies.overturned)
    assert all(equal_values(variable.attrs, by_bodies[name].attrs) for name, variable in computed.variables.items())


def test_bodies_of_another_inertia_are_blocks_of_the_same_alpha_and_p(noisy):
    body = rocking.RigidBody(0.2, 0.2, [0.8, 1.0], gyration=0.3)
    of_bodies = rocking.fragility(noisy[:3], body, **OPTIONS)
    edge = body.right
    for k in range(2):
        alpha, p, eta = (float(column[k]) for column in (edge.alpha, edge.frequency_parameter, edge.restitution))
        of_block = rocking.fragility(noisy[:3], rocking.EquivalentBlock(alpha, p, restitution=eta), **OPTIONS)
        np.testing.assert_array_equal(of_bodies.overturned.isel(dim_0=k), of_block.overturned)
        np.testing.assert_allclose(of_bodies.peak_rotation.isel(dim_0=k), of_block.peak_rotation, rtol=1e-9)


def test_bodies_with_two_different_edges_count_each_record_and_its_mirror_image(noisy):
    motions, levels = noisy[:3], OPTIONS["intensity"]
    body = rocking.RigidBody([0.2, 0.3], [0.3, 0.2], 1.0)  # mirror images of each other
    fragility = rocking.fragility(motions, body, intensity=levels, restitution=0.9)
    assert fragility.record.values.tolist()[:2] == [motions[0].name, f"{motions[0].name}, mirrored"]
    for k in range(2):
        single = rocking.RigidBody(*((0.2, 0.3), (0.3, 0.2))[k], 1.0)
        for n, motion in enumerate(motions):
            scale = levels / motion.peak_acceleration
            for mirrored, sign in enumerate((1.0, -1.0)):
                record = rocking.Record(sign * motion.acceleration, motion.time_step, "m/s2")
                outcome = single.response(record, scale=scale, restitution=0.9).outcome
                np.testing.assert_array_equal(fragility.outcome.isel(dim_0=k, record=2 * n + mirrored), outcome)
    # the mirror image of a body under that of a record
    np.testing.assert_array_equal(fragility.overturned[0, :, ::2], fragility.overturned[1, :, 1::2])
    np.testing.assert_allclose(fragility.fraction, fragility.overturned.mean("record"))
    low, high = binomial_interval(0.5 * fragility.exceedances.values, 3, 0.95)  # of three independent records
    np.testing.assert_array_equal((fragility.fraction_lower, fragility.fraction_upper), (low, high))
    assert fragility.uplift_acceleration.values.tolist() == body.uplift_acceleration.tolist()


MOTIONS = [noise(seed) for seed in range(3)]
TWO = [BLOCK, rocking.Block(0.8, 4.0)]


def outcomes_of(levels, measure="pga"):
    suite = check_suite(MOTIONS, TWO, levels, measure, "momentum")
    return with_margins(suite_outcomes(suite), suite)


def test_margins_do_not_depend_on_the_levels_and_lie_below_those_that_overturn():
    coarse, fine = (outcomes_of(np.geomspace(1.0, 40.0, points)) for points in (6, 20))
    exact = [[overturning_scale(record, block) for record in MOTIONS] for block in TWO]
    for outcomes in (coarse, fine):
        overturned = outcomes["overturned"].values.astype(bool)
        levels = np.where(overturned, outcomes["intensity"].values[:, None], np.inf).min(axis=1)
        assert np.isfinite(levels).all()
        assert (outcomes["overturning_intensity"].values < levels).all()
        margins = record_margins(outcomes)
        np.testing.assert_allclose(margins["overturning_scale"], exact, rtol=2e-6)
        stronger = outcomes["intensity"] > outcomes["overturning_intensity"]
        survived = ((outcomes["overturned"] == 0) & stronger).sum("intensity").transpose("block", "record")
        np.testing.assert_array_equal(margins["levels_survived_above"], survived)
        pga = [record.peak_acceleration for record in MOTIONS]
        np.testing.assert_allclose(outcomes["overturning_intensity"], margins["overturning_scale"] * pga, rtol=1e-12)


def test_a_block_that_survives_all_levels_has_no_margin():
    outcomes = outcomes_of([0.5, 1.0])
    assert outcomes["overturning_intensity"].isnull().all()
    margins = record_margins(outcomes)
    assert margins["overturning_scale"].isnull().all()
    assert not margins["levels_survived_above"].any()


def test_the_largest_frequency_ratio_at_which_it_overturns_is_the_mildest():
    outcomes = outcomes_of(np.geomspace(0.3, 30.0, 8), "frequency_ratio")
    margins = record_margins(outcomes)
    mildest, overturned = outcomes["overturning_intensity"].values, outcomes["overturned"].values.astype(bool)
    assert np.isfinite(mildest).any()
    levels = outcomes["intensity"].values
    for k, n in np.argwhere(np.isfinite(mildest)):
        assert mildest[k, n] >= levels[overturned[k, :, n]].max()
        around = mildest[k, n] * np.array([1.0 - 1e-7, 1.0 + 1e-5])
        near = check_suite(MOTIONS[n], TWO[k], around, "frequency_ratio", "momentum")
        assert suite_outcomes(near)["overturned"].values.ravel().tolist() == [1, 0]
        assert margins["overturning_scale"][k, n] == 1.0
        survived = ~overturned[k, :, n] & (levels < mildest[k, n])
        assert margins["levels_survived_above"][k, n] == survived.sum()


BLOCKS = [rocking.Block(0.2, 1.0), rocking.Block(0.2, 1.0, gravity=3.7)]
FEW_LEVELS = np.array([1.0, 2.0, 3.0, 4.0])


def with_vertical(seed: int, share: float = 0.5) -> rocking.Record:
    record = noise(seed)
    a = record.acceleration
    return rocking.Record(a, record.time_step, "m/s2", name=f"noise {seed}", vertical=share * np.roll(a, 7))


@pytest.mark.parametrize("measure", ["pga", "frequency_ratio"])
def test_outcomes_are_those_of_the_single_blocks(measure: str) -> None:
    records = [with_vertical(1), noise(2)]
    fragility = rocking.fragility(records, BLOCKS, intensity=FEW_LEVELS, measure=measure)
    for index in np.ndindex(2, 4, 2):
        body, level, record = BLOCKS[index[0]], FEW_LEVELS[index[1]], records[index[2]]
        eta = body.inelastic_restitution
        if measure == "frequency_ratio":
            ratio = 2.0 * np.pi / (record.mean_period * body.frequency_parameter)
            size = body.half_diagonal * (level / ratio) ** 2
            body = rocking.Block.from_slenderness_angle(body.alpha, size, gravity=body.gravity)
        alone = body.response(record, scale=float(fragility["scale"].values[index]), restitution=eta, thresholds=False)
        assert fragility["overturned"].values[index] == alone.overturned
        assert fragility["peak_rotation"].values[index] == pytest.approx(alone.peak_rotation, rel=1e-6, nan_ok=True)


def test_a_level_at_which_a_body_would_fly_is_refused() -> None:
    record = with_vertical(1, share=-1.0)
    flies = STANDARD_GRAVITY / -float(record.vertical.min()) * record.peak_acceleration
    rocking.fragility(record, BLOCKS[0], intensity=[1.0, 0.999 * flies])
    with pytest.raises(InvalidArgumentError, match=r"`intensity` = .* factor of noise 1 is below .* -g at .* s"):
        rocking.fragility(record, BLOCKS[0], intensity=[1.0, 1.001 * flies])
    with pytest.raises(InvalidArgumentError, match="`intensity`"):
        rocking.suites.suite_sensitivity(record, BLOCKS[0], intensity=[1.001 * flies])


def test_the_vertical_component_is_never_another_file(tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.csv").write_text("time [s],NS [g],up\n0,1,4\n0.05,2,0\n0.1,1,3\n")
    (tmp_path / "up").write_text("time [s],acceleration [g]\n0,7\n0.05,8\n0.1,9\n")
    layout = {"unit": "g", "acceleration": "NS", "vertical": "up"}
    files = RecordFiles(tmp_path, "*.csv", layout, None)
    (path,) = files.paths()
    np.testing.assert_allclose(files.read(path).vertical, STANDARD_GRAVITY * np.array([4.0, 0.0, 3.0]), rtol=1e-15)
    with pytest.raises(InvalidArgumentError, match=r"`vertical` = 'a.csv' .* allowed: a file, or a column of a.csv"):
        replace(files, layout=layout | {"vertical": "a.csv"}).read(path)
    with pytest.raises(InvalidArgumentError, match=r"`path` = .*none.csv.*: no such file"):
        files.read(tmp_path / "none.csv")
