"""A small results folder, and the service over it."""

import shutil

import numpy as np
import pytest
from fastapi.testclient import TestClient
from rocking_api.app import create_app
from rocking_api.settings import Settings

from rocking.boundary.tracing import overturning_boundary
from rocking.datasets.cube import describe, scalar_coordinates, write_dataset
from rocking.spectra.cubes import spectrum

CUBES = {("sine", 0.85), ("cosine", 0.90)}


@pytest.fixture(scope="session")
def results(tmp_path_factory):
    """Two cubes and one set of boundary curves, as the workflow writes them."""
    folder = tmp_path_factory.mktemp("results")
    for pulse, eta in CUBES:
        cube = spectrum(
            pulse,
            restitution=eta,
            slenderness=np.linspace(0.05, 0.95, 91),
            frequency_ratio=np.geomspace(0.5, 12.0, 91),
        )
        write_dataset(cube, folder / "spectra" / pulse / f"eta-{eta:.2f}.nc")
    curves = overturning_boundary("sine", restitution=0.85, nodes=101)
    curves["alpha"] = "curve", np.zeros(curves.sizes["curve"])
    curves = curves.drop_attrs(deep=False).assign_coords(scalar_coordinates("sine", 0.85))
    write_dataset(describe(curves), folder / "overturning" / "sine" / "eta-0.85.nc")
    return folder


@pytest.fixture(scope="session")
def client(results):
    """A client of the service over the results; internal exceptions become responses."""
    with TestClient(create_app(Settings(results=results)), raise_server_exceptions=False) as client:
        yield client


@pytest.fixture
def own_results(results, tmp_path):
    """A copy of the results that a test may change."""
    return shutil.copytree(results, tmp_path / "results")


def client_of(results, **settings):
    """A client of another service."""
    return TestClient(create_app(Settings(results=results, **settings)), raise_server_exceptions=False)


def assert_problem(response, status, parameter=None):
    """Assert a problem+json response with status, parameter and allowed values."""
    assert response.status_code == status, response.text
    assert response.headers["content-type"] == "application/problem+json"
    problem = response.json()
    assert problem["status"] == status
    assert problem["title"]
    assert problem["detail"]
    if parameter is not None:
        assert problem["parameter"] == parameter
        assert problem["allowed"]
    return problem
