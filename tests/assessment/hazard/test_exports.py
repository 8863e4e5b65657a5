"""A fragility for loss programs: NRML 0.5 by the rules of OpenQuake's reader, components of pelicun."""

import csv
import io
import xml.etree.ElementTree as ET

import numpy as np
import pytest
import rocking_assessment
from rocking_assessment._hazard.nrml import write_nrml
from scipy.stats import lognorm, norm

import rocking
from rocking._base.errors import InvalidArgumentError
from tests.suites.motions import noise

BLOCKS = [rocking.Block(0.2, 1.0), rocking.Block(0.3, 1.0)]
LEVELS = np.geomspace(1.0, 60.0, 15)


@pytest.fixture(scope="module")
def fragility():
    return rocking.fragility([noise(k) for k in range(8)], BLOCKS, intensity=LEVELS)


def read(path):
    """Functions by identity as OpenQuake evaluates them (risklib.nrml.ffconvert, risklib.scientific)."""
    space = "{http://openquake.org/xmlns/nrml/0.5}"
    (model,) = ET.parse(path).getroot()
    assert model.tag == f"{space}fragilityModel"
    assert {"id", "assetCategory", "lossCategory"} <= set(model.keys())
    states = model[1].text.split()
    result = {}
    for function in model[2:]:
        imls, *parts = function
        assert [part.get("ls") for part in parts] == states
        curves = {}
        for part in parts:
            none = float(imls.get("noDamageLimit", 1e-10))
            if function.get("format") == "discrete":
                x, poes = (np.array(text.split(), dtype=float) for text in (imls.text, part.text))
                assert x.shape == poes.shape
                assert np.all(np.diff(x) > 0.0)
                assert np.all((poes >= 0.0) & (poes <= 1.0))
                x, poes = np.append(none, x), np.append(0.0, poes)  # FragilityFunctionList.build
                curves[part.get("ls")] = lambda im, x=x, poes=poes: np.interp(im, x, poes)
            else:
                low, high = float(imls.get("minIML")), float(imls.get("maxIML"))
                mean, deviation = float(part.get("mean")), float(part.get("stddev"))
                sigma = np.sqrt(np.log(deviation**2 / mean**2 + 1.0))
                median = mean**2 / np.sqrt(deviation**2 + mean**2)
                curves[part.get("ls")] = lambda im, s=sigma, m=median, ends=(low, high), none=none: np.where(
                    im <= none, 0.0, lognorm.cdf(np.clip(im, *ends), s, scale=m)
                )
        result[function.get("id"), imls.get("imt")] = curves
    return result


def test_discrete_functions_are_the_fractions_over_g(fragility, tmp_path):
    write_nrml(fragility, tmp_path / "model.xml")
    functions = read(tmp_path / "model.xml")
    assert functions.keys() == {("block-1", "PGA"), ("block-2", "PGA")}
    for k in range(2):
        curves = functions[f"block-{k + 1}", "PGA"]
        overturns = curves["overturns"](LEVELS / 9.80665)
        np.testing.assert_allclose(overturns, fragility["fraction"].isel(block=k), atol=1e-8)
        assert curves["overturns"](100.0) == fragility["fraction"].isel(block=k)[-1]
        rocks = curves["rocks"](LEVELS / 9.80665)
        np.testing.assert_allclose(rocks, LEVELS / BLOCKS[k].uplift_acceleration > 1.0, atol=1e-6)
        assert np.all(rocks >= overturns - 1e-6)


def test_lognormal_functions_are_the_fitted_curves(fragility, tmp_path):
    write_nrml(fragility, tmp_path / "model.xml", format="lognormal")
    curves = read(tmp_path / "model.xml")["block-1", "PGA"]
    fit = fragility.sel(model="lognormal").isel(block=0)
    np.testing.assert_allclose(curves["overturns"](LEVELS / 9.80665), fit["fitted"], atol=1e-7)
    rocks = curves["rocks"](LEVELS / 9.80665)
    np.testing.assert_allclose(rocks, LEVELS / BLOCKS[0].uplift_acceleration > 1.0, atol=1e-9)


def test_below_the_lowest_level_a_probability_is_not_cut_off(fragility, tmp_path):
    write_nrml(fragility.isel(intensity=slice(8, None)), tmp_path / "model.xml")
    curve = read(tmp_path / "model.xml")["block-1", "PGA"]["overturns"]
    lowest = LEVELS[8] / 9.80665
    assert curve(0.5 * lowest) == pytest.approx(0.5 * curve(lowest), rel=1e-6)
    assert curve(lowest) > 0.5


def test_components_of_pelicun_are_the_fits_over_g(fragility, tmp_path):
    rocking_assessment.write_pelicun(fragility, tmp_path / "blocks.pelicun.csv")
    with (tmp_path / "blocks.pelicun.csv").open(newline="") as text:
        rows = list(csv.DictReader(text))
    fits = fragility["median_intensity"].sel(model="lognormal").values.ravel() / 9.80665
    assert [row["ID"] for row in rows] == ["block.1", "block.2"]
    assert {(row["Demand-Type"], row["Demand-Unit"]) for row in rows} == {("Peak Floor Acceleration", "g")}
    np.testing.assert_allclose([float(row["LS2-Theta_0"]) for row in rows], fits, rtol=1e-9)
    for row, block in zip(rows, BLOCKS, strict=True):
        uplift = block.uplift_acceleration / 9.80665
        assert float(row["LS1-Theta_0"]) == pytest.approx(uplift, rel=0.2)  # a step between two levels
        assert float(row["LS1-Theta_1"]) == 0.001


def test_refusals(fragility, tmp_path):
    strong = rocking.fragility(noise(1), BLOCKS, intensity=[100.0, 200.0])
    with pytest.raises(InvalidArgumentError, match="below the lowest level"):
        write_nrml(strong, tmp_path / "model.xml", format="lognormal")
    for write in (write_nrml, rocking_assessment.write_pelicun):
        with pytest.raises(InvalidArgumentError, match="pga or pgv"):
            write(fragility.assign_attrs(measure="pga_ratio"), tmp_path / "model.xml")
    with pytest.raises(InvalidArgumentError, match="format"):
        write_nrml(fragility, tmp_path / "model.xml", format="logistic")


def test_a_fitted_curve_that_is_not_small_at_its_lowest_level_warns(fragility):
    weak = fragility.copy(deep=True)
    weak["overturned"][{"record": slice(0, 2), "block": 0}] = 1
    weak["overturned"][{"intensity": 0, "record": 1, "block": 0}] = 0
    with pytest.warns(UserWarning, match="at noDamageLimit, the lowest level, the fitted") as warned:
        write_nrml(weak, io.BytesIO(), format="lognormal")
    assert {str(warning.message).partition(":")[0] for warning in warned} == {"block-1 rocks", "block-1 overturns"}


@pytest.mark.filterwarnings("ignore")
def test_pelicun_damages_the_shares_of_the_curves(fragility, tmp_path):
    """Under a floor whose acceleration has a median of 0.5 g and a dispersion of 0.4."""
    path, median, beta = tmp_path / "blocks.pelicun.csv", 0.5, 0.4
    rocking_assessment.write_pelicun(fragility, path)
    pd = pytest.importorskip("pandas")
    assessment = pytest.importorskip("pelicun.assessment")
    file_io = pytest.importorskip("pelicun.file_io")
    model = assessment.Assessment({"PrintLog": False, "Seed": 1})
    demand = {"Theta_0": [median], "Theta_1": [beta], "Family": ["lognormal"], "Units": ["g"]}
    marginals = pd.DataFrame(demand, index=pd.MultiIndex.from_tuples([("PFA", "0", "1")]))
    model.demand.load_model({"marginals": marginals})
    model.demand.generate_sample({"SampleSize": 20_000})
    model.stories = 1
    component = {"Units": "ea", "Location": "1", "Direction": "1", "Theta_0": 1.0, "Blocks": 1}
    model.asset.load_cmp_model({"marginals": pd.DataFrame([component] * 2, index=["block.1", "block.2"])})
    model.asset.generate_cmp_sample(20_000)
    read = file_io.load_data(str(path), reindex=False, unit_conversion_factors=model.unit_conversion_factors)
    model.damage.load_model_parameters([read], {"block.1", "block.2"})
    model.damage.calculate()
    shares = model.damage.ds_model.probabilities()
    with path.open(newline="") as text:
        for row in csv.DictReader(text):
            ratio, spread = median / float(row["LS2-Theta_0"]), np.hypot(beta, float(row["LS2-Theta_1"]))
            share = shares.loc[(row["ID"], "1", "1", "0", "1"), 2]
            assert share == pytest.approx(norm.cdf(np.log(ratio) / spread), abs=0.015)
