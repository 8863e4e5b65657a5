"""docs/service.md: each curl succeeds, and each setting and route is documented."""

import re
from pathlib import Path

import pytest
from rocking_api.settings import Settings

PAGE = (Path(__file__).parents[2] / "docs" / "service.md").read_text()
URLS = re.findall(r"curl (?:-O )?'http://127\.0\.0\.1:8000([^']+)'\n", PAGE)


@pytest.mark.parametrize("url", URLS)
def test_documented_requests_succeed(client, url):
    assert client.get(url).status_code == (422 if "frequency_ratio=40" in url else 200)


def test_there_are_documented_requests():
    assert len(URLS) >= 7


def test_every_route_and_setting_is_documented(client):
    for path in client.get("/openapi.json").json()["paths"]:
        assert path.replace("/{key}", "") in PAGE
    for name in Settings.model_fields:
        assert f"ROCKING_{name.upper()}" in PAGE
