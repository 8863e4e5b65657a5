"""Distributions of peak rotations: against counts and SciPy, and how often their bands hold."""

import io
import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from scipy import stats
from typer.testing import CliRunner

import rocking
from rocking._cli.app import app
from rocking.suites import distribution
from tests.suites.motions import noise

MOTIONS = [noise(k, 400, 0.02) for k in range(8)]


def test_of_a_suite_is_what_counting_gives() -> None:
    blocks = [rocking.Block(0.4, 1.6), rocking.Block(0.3, 1.8)]
    suite = rocking.fragility(MOTIONS, blocks, intensity=[3.0, 5.0])
    shares = distribution(suite, rotation=[0.0, 0.2, 0.5, 1.0])
    peaks = suite["peak_rotation"].where(suite["overturned"] == 0, np.inf)
    count = (peaks <= shares["rotation"]).sum("record")
    for name, end in (("probability", lambda _: 0), ("probability_lower", min), ("probability_upper", max)):
        for index, k in np.ndenumerate(count.transpose(*shares[name].dims).values):
            ends = stats.binomtest(int(k), 8).proportion_ci(0.95, "exact")
            assert shares[name].values[index] == pytest.approx(k / 8 if name == "probability" else end(ends))
    assert (shares["overturned"].values == suite["fraction"].values).all()
    assert (shares["overturned_upper"].values == suite["fraction_upper"].values).all()
    half = np.sqrt(np.log(2.0 / 0.05) / 16.0)
    np.testing.assert_allclose(shares["band_upper"], np.minimum(shares["probability"] + half, 1.0))
    single = distribution(rocking.fragility(MOTIONS[0], blocks[0], intensity=[3.0]), rotation=[0.5])
    assert single.attrs["members"] == 1


@pytest.mark.parametrize("members", [5, 40])
def test_how_often_the_band_holds(members: int) -> None:
    """Of samples of a known distribution the band contains all of it in at least the stated share."""
    peak = np.random.default_rng(7).random((2000, members))
    data = xr.Dataset({"peak_rotation": (("sample", "record"), peak), "overturned": (("sample", "record"), peak > 0.9)})
    shares = distribution(data, confidence=0.9)
    x = shares["rotation"]
    true = x.where(x < 0.9, 0.9)
    holds = ((shares["band_lower"] <= true + 1e-12) & (true <= shares["band_upper"] + 1e-12)).all("rotation").mean()
    at = shares.sel(rotation=0.5)
    covers = ((at["probability_lower"] <= 0.5) & (at["probability_upper"] >= 0.5)).mean()
    assert holds.item() > 0.89
    assert 0.89 < covers.item() < 0.99


def test_of_restitutions_and_of_mirrored_records() -> None:
    wall = rocking.RigidBody.from_size(0.3, 2.0).one_sided("right")
    eta = np.random.default_rng(1).uniform(0.3, 0.6, 50)
    shares = distribution(wall.response(MOTIONS[0], scale=1.5, restitution=eta), over="restitution")
    assert shares.attrs["members"] == 50
    assert np.ptp(shares["probability"].values) > 0.0
    block = rocking.Block(0.4, 1.6).response(MOTIONS[0], scale=1.5, restitution=eta)
    assert distribution(block, over="restitution").attrs["members"] == block.peak_rotation.size == 50
    both = distribution(rocking.fragility(MOTIONS, wall, intensity=[3.0]))
    assert both.attrs["members"] == 8
    assert both["probability"].dims == ("intensity", "rotation")


def test_command(tmp_path: Path) -> None:
    for motion in MOTIONS[:3]:
        (tmp_path / f"{motion.name}.csv").write_text("\n".join(["acceleration [m/s2]", *map(str, motion.acceleration)]))
    records = {"folder": ".", "pattern": "*.csv", "unit": "m/s2", "time_step": 0.02}
    suite = {"name": "s", "records": records, "measure": "pga", "intensity": [2.0, 4.0]}
    path = tmp_path / "suite.json"
    path.write_text(json.dumps(suite | {"blocks": [{"width": 0.4, "height": 1.6}]}))
    out = CliRunner().invoke(app, ["fragility", str(path), "--table", "distribution", "--format", "csv"])
    assert out.exit_code == 0, out.output
    table = pd.read_csv(io.StringIO(out.stdout))
    assert len(table) == 2 * 21
    assert table["probability"].between(table["band_lower"], table["band_upper"]).all()


def test_refused() -> None:
    block = rocking.Block(0.4, 1.6)
    suite = rocking.fragility(MOTIONS[:2], block, intensity=[3.0])
    for data, wrong, argument in (
        (suite, {"over": "block"}, "over"),
        (suite, {"rotation": [0.5, 0.1]}, "rotation"),
        (suite, {"rotation": [-1.0]}, "rotation"),
        (suite, {"confidence": 1.0}, "confidence"),
        (suite[["fraction"]], {}, "ensemble"),
        (block.response(MOTIONS[0]), {"over": "dim_0"}, "over"),
    ):
        with pytest.raises(rocking.InvalidArgumentError, match=argument):
            distribution(data, **wrong)
    with pytest.raises(rocking.InvalidArgumentError, match="data"):
        rocking.plot.distribution(distribution(suite))
