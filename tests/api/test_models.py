"""The written models of the service against the declarations of the fields and of the parameters of bodies."""

import types
from typing import get_args

import pytest
from rocking_api.models import blocks, fields, records, responses
from rocking_api.models.body_params import PARAMETERS, BodyParameters
from rocking_api.models.quantity import unit_of

from rocking._dimensional.fields import SHOWN
from rocking._model.fields import COLUMN_FIELDS


def types_of(annotation):
    """The types that a field may have, those of the entries of a list among them."""
    found = set()
    for part in get_args(annotation) or (annotation,):
        found |= types_of(part) if get_args(part) else {part}
    return found


KIND = {"f": float, "?": bool, "U": str, "i": int}


@pytest.mark.parametrize(
    ("model", "kinds"),
    [
        (blocks.BlockResponse, {"pulse", "block"}),
        (blocks.BodyResponse, {"pulse", "edges"}),
        (records.RecordResponse, {"record", "block"}),
        (records.RecordBodyResponse, {"record", "edges"}),
    ],
)
def test_a_response_has_the_declared_fields_of_its_kind(model, kinds):
    declared = [field for field in SHOWN if field.dtype != "O" and field.kinds >= kinds and field.name != "edge"]
    assert {field.label for field in declared} <= {*model.model_fields}
    for field in declared:
        written = model.model_fields[field.label]
        kind = str if field.name == "outcome" else KIND[field.dtype[0]]
        assert kind in types_of(written.annotation), field.name
        assert (types.NoneType in types_of(written.annotation)) == bool(field.missing) or field.name == "edge", (
            field.name
        )
        assert field.meaning in (written.description or ""), field.name


@pytest.mark.parametrize("model", [fields.LookedUp, fields.ManyLookedUp])
def test_responses_in_groups_have_all_columns(model):
    assert {*model.model_fields} == {field.label for field in COLUMN_FIELDS}
    for field in COLUMN_FIELDS:
        number = field.dtype[0] in "fi" and not field.flags
        assert unit_of(model.model_fields[field.label]) == (field.label_unit if number else ""), field.name
    assert {*model.model_fields} <= {*responses.PointResponse.model_fields, *responses.BatchResponse.model_fields}


def test_every_parameter_of_a_kind_of_body_is_a_parameter():
    apart = {"restitution", "gravity"}  # of every body
    assert {*BodyParameters.model_fields} == PARAMETERS.keys() - apart
    for name, field in BodyParameters.model_fields.items():
        assert unit_of(field) == PARAMETERS[name].unit, name
        assert PARAMETERS[name].meaning.partition(";")[0] in field.description, name
