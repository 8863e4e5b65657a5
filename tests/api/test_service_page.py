"""docs/service.md: each curl succeeds, and each route is documented."""

import json
import re
from pathlib import Path

import pytest

PAGE = (Path(__file__).parents[2] / "docs" / "service.md").read_text()
URLS = re.findall(r"curl (?:-O )?'http://127\.0\.0\.1:8000([^']+)'\n", PAGE)

ANSWERS = re.findall(r"```bash\ncurl 'http://127\.0\.0\.1:8000([^']+)'([^`]*)```\n[^`]*\n```json\n([^`]*)```", PAGE)
"""Address, other options and answer of the examples with an answer."""


@pytest.mark.parametrize("url", URLS)
def test_documented_requests_succeed(client, url):
    assert client.get(url).status_code == (422 if "frequency_ratio=40" in url else 200)


@pytest.mark.parametrize(("url", "options", "text"), ANSWERS, ids=[url for url, _, _ in ANSWERS])
def test_documented_answers_have_the_fields_of_real_ones(client, url, options, text):
    body = re.search(r"-d '([^']*)'", options)
    json_body = {"content": body[1], "headers": {"Content-Type": "application/json"}} if body else {}
    answer, stated = client.request("POST" if body else "GET", url, **json_body).json(), json.loads(text)
    if "query" in stated:
        assert {*stated} == {*answer}
    for name in ("query", "units", "warnings", "version", "url"):
        assert stated.get(name, answer[name]) == answer[name]
    assert stated.keys() <= answer.keys()


def test_there_are_documented_requests():
    assert len(URLS) >= 7
    assert len(ANSWERS) == 4


def test_every_route_is_documented(client):
    for path in client.get("/openapi.json").json()["paths"]:
        assert path.replace("/{key}", "") in PAGE
