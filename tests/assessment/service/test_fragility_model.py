"""The fragility of a suite as a model of OpenQuake."""

import pytest
from rocking_assessment import write_nrml

from rocking._datasets.cube import read_dataset
from tests.api.conftest import assert_problem


@pytest.mark.parametrize("curves", ["discrete", "lognormal"])
def test_the_model_is_that_of_the_library(client, results, tmp_path, curves):
    outcomes = read_dataset(results / "suites" / "demonstration" / "outcomes.nc")
    write_nrml(outcomes, tmp_path / "model.xml", format=curves, description="demonstration")
    response = client.get("/v1/suites/demonstration/nrml", params={"curves": curves})
    assert response.content == (tmp_path / "model.xml").read_bytes()
    assert response.headers["content-type"].startswith("application/xml")


def test_a_suite_that_does_not_exist(client):
    assert_problem(client.get("/v1/suites/none/nrml"), 404, "name")
