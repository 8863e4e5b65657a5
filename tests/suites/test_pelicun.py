"""Components of pelicun: the columns written, and shares of damage by pelicun itself where it is installed."""

import csv

import numpy as np
import pytest
from scipy.stats import norm

import rocking
from rocking._base.errors import InvalidArgumentError
from tests.suites.motions import noise

BLOCKS = [rocking.Block(0.2, 1.0), rocking.Block(0.3, 1.0)]
DEMAND = 0.5, 0.4
"""Median [g] and dispersion of the acceleration of the floor."""


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("pelicun") / "blocks.pelicun.csv"
    levels = np.geomspace(1.0, 60.0, 15)
    found = rocking.fragility([noise(k) for k in range(8)], BLOCKS, intensity=levels)
    rocking.suites.write_fragility(found, path)
    fits = found["median_intensity"].sel(model="lognormal").values.ravel() / 9.80665
    return path, fits


def test_curves_are_the_fits_over_g(file):
    path, fits = file
    with path.open(newline="") as text:
        rows = list(csv.DictReader(text))
    assert [row["ID"] for row in rows] == ["block.1", "block.2"]
    assert {(row["Demand-Type"], row["Demand-Unit"]) for row in rows} == {("Peak Floor Acceleration", "g")}
    np.testing.assert_allclose([float(row["LS2-Theta_0"]) for row in rows], fits, rtol=1e-9)
    for row, block in zip(rows, BLOCKS, strict=True):
        uplift = block.uplift_acceleration / 9.80665
        assert float(row["LS1-Theta_0"]) == pytest.approx(uplift, rel=0.2)  # a step between two levels
        assert float(row["LS1-Theta_1"]) == 0.001


def test_a_measure_without_a_counterpart_is_refused(tmp_path):
    found = rocking.fragility([noise(1)], BLOCKS, intensity=[1.0, 6.0])
    with pytest.raises(InvalidArgumentError, match="pga or pgv"):
        rocking.suites.write_pelicun(found.assign_attrs(measure="arias"), tmp_path / "no.csv")


@pytest.mark.filterwarnings("ignore")
def test_pelicun_damages_the_shares_of_the_curves(file):
    pd = pytest.importorskip("pandas")
    assessment = pytest.importorskip("pelicun.assessment")
    file_io = pytest.importorskip("pelicun.file_io")
    one = assessment.Assessment({"PrintLog": False, "Seed": 1})
    demand = {"Theta_0": [DEMAND[0]], "Theta_1": [DEMAND[1]], "Family": ["lognormal"], "Units": ["g"]}
    marginals = pd.DataFrame(demand, index=pd.MultiIndex.from_tuples([("PFA", "0", "1")]))
    one.demand.load_model({"marginals": marginals})
    one.demand.generate_sample({"SampleSize": 20_000})
    one.stories = 1
    place = {"Units": "ea", "Location": "1", "Direction": "1", "Theta_0": 1.0, "Blocks": 1}
    one.asset.load_cmp_model({"marginals": pd.DataFrame([place] * 2, index=["block.1", "block.2"])})
    one.asset.generate_cmp_sample(20_000)
    read = file_io.load_data(str(file[0]), reindex=False, unit_conversion_factors=one.unit_conversion_factors)
    one.damage.load_model_parameters([read], {"block.1", "block.2"})
    one.damage.calculate()
    shares = one.damage.ds_model.probabilities()
    with file[0].open(newline="") as text:
        for row in csv.DictReader(text):
            median, dispersion = float(row["LS2-Theta_0"]), float(row["LS2-Theta_1"])
            expected = norm.cdf(np.log(DEMAND[0] / median) / np.hypot(DEMAND[1], dispersion))
            found = shares.loc[(row["ID"], "1", "1", "0", "1"), 2]
            assert found == pytest.approx(expected, abs=0.015)
