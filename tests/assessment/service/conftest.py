"""The service of the tests of the API, with the routes and pages of the assessment."""

from tests.api.conftest import client, own_results, results  # noqa: F401
