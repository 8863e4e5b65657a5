"""The documented settings of the service are those it has."""

import json
import re
from pathlib import Path

import pytest
from rocking_api.settings import Settings

PAGE = (Path(__file__).parents[2] / "docs" / "service-operation.md").read_text(encoding="utf-8")
ROWS = dict(re.findall(r"^\| ROCKING_(\w+) \| ([^|]+?) \|", PAGE, flags=re.MULTILINE))


def test_the_table_names_every_setting():
    assert {name.lower() for name in ROWS} == set(Settings.model_fields)


@pytest.mark.parametrize("name", sorted(ROWS))
def test_a_documented_default_is_the_default(name):
    default = Settings.model_fields[name.lower()].default
    documented = ROWS[name]
    if isinstance(default, Path):
        assert documented == str(default)
    else:
        assert json.loads(documented) == (list(default) if isinstance(default, tuple) else default)
