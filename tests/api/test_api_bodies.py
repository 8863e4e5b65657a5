"""JSON bodies take the parameters that the query takes, and answer the same."""

import pytest

import rocking
from rocking._dimensional.body_kinds import BODIES as KINDS
from tests.api.conftest import assert_problem, texts
from tests.sampling import but_long

RECORD = "time [s],acceleration [g]\n" + "".join(f"{0.05 * k:.2f},{0.3 * ((-1) ** (k // 5)):.1f}\n" for k in range(21))
BLOCK = {"width": 0.4, "height": 1.6}
RECORDS = BLOCK | {"restitution": 0.9, "gravity": 9.8, "name": "a.csv"}
TRACE = {"time": [0.02 * k for k in range(3)], "rotation": [0.1, 0.05, 0.01]}
ROUTES = {
    "/v1/assess": ({"objects": [BLOCK]}, {"pga": 3.0, "pgv": 0.3, "shapes": "sine", "sensitivity": False, "seed": 3}),
    "/v1/blocks/response": (
        {"blocks": [BLOCK | {"peak_acceleration": 4.0, "period": 0.5}]},
        {"pulse": "sine", "restitution": 0.9, "format": "csv"},
    ),
    "/v1/records/response": ({"record": RECORD}, RECORDS | {"scale": 1.5, "thresholds": False}),
    "/v1/records/history": ({"record": RECORD}, RECORDS | {"samples": 20, "contact": True, "format": "csv"}),
    "/v1/records/scales": ({"record": RECORD}, RECORDS | {"points": 5, "scale_max": 3.0}),
    "/v1/records/pulse": ({"record": RECORD}, RECORDS | {"samples": 2}),
    "/v1/response": ({}, {"pulse": "sine", "slenderness": 0.4, "frequency_ratio": 5.0, "restitution": 0.85}),
    "/v1/spectrum": ({}, {"pulse": "sine", "slenderness": 0.4, "restitution": 0.85, "points": 3}),
    "/v1/identify": (TRACE, {"confidence": 0.9, "unit": "deg", "edges": 2}),
}
OTHER = {"pga": 2.0, "width": 0.5, "pulse": "cosine", "confidence": 0.8}


def answer_of(response):
    """The answer without its address; what is asked is the same."""
    if "json" not in response.headers["content-type"]:
        return response.text
    return {name: value for name, value in response.json().items() if name != "url"}


@pytest.mark.parametrize("route", ROUTES)
def test_parameters_in_the_body_and_in_the_query_have_the_same_answer_and_the_same_refusals(client, route):
    content, params = ROUTES[route]
    inside = client.post(route, json=content | params)
    assert inside.status_code == (422 if route == "/v1/identify" else 200), inside.text  # three samples are too few
    if "record" in content:
        assert answer_of(client.post(route, params=texts(params), content=RECORD)) == answer_of(inside)
    name = next(name for name in OTHER if name in params)
    if route != "/v1/spectrum":  # whose POST has no query
        problem = assert_problem(client.post(route, params={name: OTHER[name]}, json=content | params), 422, name)
        assert "JSON body" in problem["allowed"]
    assert_problem(client.post(route, json=content | params | {"colour": 1}), 422, "colour")
    assert_problem(client.post(route, json=content | params | {name: -1.0}), 422, name)
    document = client.get("/openapi.json").json()  # which states the parameters of the body
    operation = document["paths"][route]["post"]
    schema = operation["requestBody"]["content"]["application/json"]["schema"]
    model = document["components"]["schemas"][schema.get("oneOf", [schema])[0]["$ref"].rpartition("/")[2]]
    assert {*content, *params, *(one["name"] for one in operation.get("parameters", []))} <= {*model["properties"]}


def test_what_is_missing_in_both_places_is_named(client):
    assert_problem(client.post("/v1/records/response", json={"record": RECORD, "width": 0.4}), 422, "height")
    assert_problem(client.post("/v1/records/response?width=0.4", content=RECORD), 422, "height")
    assert_problem(client.post("/v1/records/response", json=BLOCK), 422, "record")


BODIES = {
    "hollow": {"width": 0.4, "height": 1.6, "wall": 0.02},
    "cylinder": {"diameter": 0.5, "height": 1.2},
    "two_edges": {"left": 0.12, "right": 0.18, "mass_height": 0.4, "gyration": 0.3},
    "on_pedestal": {"width": 0.4, "height": 1.2, "pedestal_width": 0.5, "pedestal_height": 0.4, "pedestal_mass": 2.0},
    "rectangle": {"width": 0.4, "height": 1.6, "sides": "left", "rebound": 0.4},
    "frame": {"width": 0.6, "height": 4.0, "mass_ratio": 2.0},
    "structure": {"alpha": 0.2, "frequency_parameter": 2.0, "restitution": 0.9, "uplift_acceleration": 0.9},
}
PULSE = {"pulse": "sine", "peak_acceleration": 4.0, "period": 0.5}


@pytest.mark.parametrize("kind", but_long(BODIES, "hollow", "two_edges", "structure"))
def test_every_kind_of_body_is_asked_by_its_parameters_by_a_text_and_by_an_object(client, kind):
    given = BODIES[kind]
    made = rocking.body(kind, **given)
    expected = made.response("sine", peak_acceleration=4.0, period=0.5)
    units = {name: one.unit.strip("-") for name, one in KINDS[kind].fields.items()}
    text = f"{kind}({', '.join(f'{name}={value}{units[name]}' for name, value in given.items())})"
    flat = client.get("/v1/blocks/response", params=given | PULSE).json()
    said = client.get("/v1/blocks/response", params=PULSE | {"body": text}).json()
    assert flat["query"].items() >= given.items()
    for answer in (flat, said):
        assert answer["peak_rotation_deg"] == pytest.approx(expected.summary()["peak_rotation_deg"], rel=1e-9)
        assert answer["uplift_acceleration"] == pytest.approx(float(made.uplift_acceleration), rel=1e-12)
    strength = {"peak_acceleration": 4.0, "period": 0.5}
    rows = [strength | one for one in (given | {"body": kind}, {"body": text}, {"body": {"kind": kind, **given}})]
    many = client.post("/v1/blocks/response", json={"pulse": "sine", "blocks": rows}).json()
    assert many["peak_rotation"] == pytest.approx([expected.peak_rotation] * 3, rel=1e-9)
    assert many["body"] == [made.description] * 3
    asked = [{"body": text}, {"body": {"kind": kind, **given}}, given]
    url, record = "/v1/records/response", {"record": RECORD, "thresholds": False}
    answers = [client.post(url, json=record | one) for one in asked]
    answers.append(client.post(url, params={"body": text, "thresholds": "false"}, content=RECORD))
    assert [one.status_code for one in answers] == [200] * 4, answers[0].text
    assert len({one.json()["peak_rotation_deg"] for one in answers}) == 1
    history = client.post("/v1/records/history", json={"record": RECORD, "body": text, "contact": True})
    assert history.json()["outcome"] == answers[0].json()["outcome"], history.text
    scales = client.post("/v1/records/scales", json={"record": RECORD, "body": text, "points": 5})
    assert scales.status_code == 200, scales.text
    fitted = client.post("/v1/records/pulse", json={"record": RECORD, "body": text})
    assert fitted.status_code == (422 if kind in ("two_edges", "rectangle") else 200)


def test_bodies_that_are_refused_are_named(client):
    for query, name in (
        ({"body": "mesh(path=/etc/hostname)"}, "body"),
        ({"body": "cone(width=1m)"}, "body"),
        ({"body": "hollow(width=40cm, height=1.6m, wall=2cm)", "width": 0.4}, "body"),
        ({"body": "hollow(width=40cm, height=1.6m, wall=1e-9m)"}, "wall"),
        ({"body": "hollow(width=40, height=1.6m, wall=1cm)"}, "width"),
        ({"width": 0.4, "height": 1.6, "wall": 0.2}, "wall"),
        ({"width": 0.4, "height": 1.6, "wall": 1e9}, "wall"),
        ({"width": 0.4}, "height"),
        ({"wall": 0.1}, "width"),
        ({}, "width"),
    ):
        assert_problem(client.get("/v1/blocks/response", params=PULSE | query), 422, name)
    for body, name in (({"kind": "cone"}, "body"), ({"kind": "hollow", "width": 0.4}, "body"), ([1], "body")):
        assert_problem(client.post("/v1/records/pulse", json={"record": RECORD, "body": body}), 422, name)
    outline = {"vertices": [[0, 0], [0.3, 0], [0.3, 1.0], [0.0, 1.2]]}
    found = client.post("/v1/records/response", json={"record": RECORD, "thresholds": False, **outline})
    assert found.status_code == 200, found.text
    assert found.json()["query"]["vertices"] == "0.0 0.0; 0.3 0.0; 0.3 1.0; 0.0 1.2"


def test_the_description_has_the_parameters_of_every_kind(client):
    document = client.get("/openapi.json").json()
    shared = {one["name"] for one in document["paths"]["/v1/blocks/response"]["get"]["parameters"]}
    shown = document["components"]["schemas"]["BodyDescription"]["properties"]
    for kind in KINDS.values():
        assert {*kind.fields} <= shared
        assert {*kind.fields} <= {*shown}
    assert shown["kind"]["anyOf"][0]["enum"] == [*KINDS]
