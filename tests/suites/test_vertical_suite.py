"""Suites of records with a vertical component: both components are scaled to each level, flight is refused."""

from dataclasses import replace

import numpy as np
import pytest

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError
from rocking.suites.configuration import RecordFiles
from tests.suites.motions import noise

BLOCKS = [rocking.Block(0.2, 1.0), rocking.Block(0.2, 1.0, gravity=3.7)]
LEVELS = np.array([1.0, 2.0, 3.0, 4.0])


def with_vertical(seed: int, share: float = 0.5) -> rocking.Record:
    record = noise(seed)
    a = record.acceleration
    return rocking.Record(a, record.time_step, "m/s2", name=f"noise {seed}", vertical=share * np.roll(a, 7))


@pytest.mark.parametrize("measure", ["pga", "frequency_ratio"])
def test_outcomes_are_those_of_the_single_blocks(measure: str) -> None:
    records = [with_vertical(1), noise(2)]
    found = rocking.fragility(records, BLOCKS, intensity=LEVELS, measure=measure)
    for k, block in enumerate(BLOCKS):
        for n, level in enumerate(LEVELS):
            for m, record in enumerate(records):
                scale, body = float(found["scale"][k, n, m]), block
                if measure == "frequency_ratio":
                    own = 2.0 * np.pi / (record.mean_period * block.frequency_parameter)
                    size = block.half_diagonal * (level / own) ** 2
                    body = rocking.Block.from_slenderness_angle(block.alpha, size, gravity=block.gravity)
                eta = block.inelastic_restitution
                alone = body.response(record, scale=scale, restitution=eta, thresholds=False)
                assert bool(found["overturned"][k, n, m]) == alone.overturned
                peak = float(found["peak_rotation"][k, n, m])
                assert peak == pytest.approx(alone.peak_rotation, rel=1e-6, nan_ok=True)


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
    (tmp_path / "a.csv").write_text("time_s,NS_g,up\n0,1,4\n0.5,2,5\n1,3,6\n")
    (tmp_path / "up").write_text("unit: g\ndt: 0.5\n7\n8\n9\n")
    files = RecordFiles(tmp_path, "*.csv", "g", None, "NS_g", "up", None)
    (path,) = files.paths()
    np.testing.assert_allclose(files.read(path).vertical, STANDARD_GRAVITY * np.array([4.0, 5.0, 6.0]), rtol=1e-15)
    with pytest.raises(InvalidArgumentError, match=r"`vertical` = 'a.csv' .* allowed: a component of a.csv"):
        replace(files, vertical="a.csv").read(path)
    with pytest.raises(InvalidArgumentError, match=r"`path` = .*none.csv.*: no such file"):
        files.read(tmp_path / "none.csv")
