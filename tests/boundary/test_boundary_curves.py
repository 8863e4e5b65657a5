"""Curves of several angles in one data set: what goes in comes out, angle by angle."""

import numpy as np
import pytest
import xarray as xr

from rocking._base.errors import InvalidArgumentError
from rocking._boundary.curves import curves_at, join_curves
from rocking._boundary.tracing import overturning_boundary

ANGLES_DEG = (0.0, 10.0, 20.0)


@pytest.fixture(scope="module")
def parts() -> list[xr.Dataset]:
    boundaries = []
    for alpha in np.radians(ANGLES_DEG):
        curves = overturning_boundary("sine", restitution=0.85, alpha=alpha or None, nodes=21)
        boundaries.append(curves.assign(alpha=("curve", np.full(curves.sizes["curve"], alpha))))
    return boundaries


def test_joined_curves_come_out_again_as_they_went_in(parts: list[xr.Dataset]) -> None:
    joined = join_curves(parts)
    assert joined.row_size.sum() == joined.sizes["point"] == sum(part.sizes["point"] for part in parts)
    for angle, part in zip(ANGLES_DEG, parts, strict=True):
        xr.testing.assert_equal(curves_at(joined, np.radians(angle)), part)


def test_an_angle_without_curves_has_none(parts: list[xr.Dataset]) -> None:
    none = curves_at(join_curves(parts), np.radians(15))
    assert none.sizes == {"curve": 0, "point": 0}


@pytest.mark.parametrize("alpha", [-0.1, np.pi / 2, np.nan])
def test_an_impossible_angle_is_refused(parts: list[xr.Dataset], alpha: float) -> None:
    with pytest.raises(InvalidArgumentError, match="alpha"):
        curves_at(parts[0], alpha)
