"""The response models and the CSV columns have the fields that `rocking._model.fields` declares."""

import pytest
from rocking_api.models.responses import BatchResponse, PointResponse, SpectrumResponse

from rocking._model.fields import COLUMN_FIELDS

NAMES = [field.name for field in COLUMN_FIELDS]


@pytest.mark.parametrize("model", [PointResponse, BatchResponse, SpectrumResponse])
def test_models_have_the_declared_fields_in_order(model):
    assert [name for name in model.model_fields if name in NAMES] == NAMES
    for field in COLUMN_FIELDS:
        assert field.meaning in model.model_fields[field.name].description


def test_csv_has_the_declared_columns(client):
    body = {"pulse": "sine", "slenderness": [0.6], "frequency_ratio": 6.0, "restitution": 0.85}
    text = client.post("/v1/response", json=body, headers={"Accept": "text/csv"}).text
    assert text.splitlines()[0].split(",") == ["slenderness", "frequency_ratio", "restitution", *NAMES]
