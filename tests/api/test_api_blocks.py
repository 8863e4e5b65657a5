"""GET /v1/blocks/response: SI units in, degrees and metres out."""

import csv
import io
import re

import pytest
from rocking_api.routers import blocks

import rocking
from tests.api.conftest import BLOCK, CSV, assert_problem, post


def get_response(client, **changes):
    return client.get("/v1/blocks/response", params=BLOCK | changes)


LIFTS = {"width": 1.6, "peak_acceleration": 60.0, "period": 0.1, "restitution": 0.9}


@pytest.mark.parametrize(
    ("changes", "words", "overturned"),
    [
        ({}, "", False),
        ({"peak_acceleration": 30.0}, "may slide: pure", True),
        (LIFTS, "lifts off", False),
        ({"width": 1.62, "peak_acceleration": 5.0, "restitution": 0.5}, "wider than high", False),
        ({"peak_acceleration": 4.8}, "changes within 5 % of this peak acceleration: at 4.7", True),
        ({"peak_acceleration": 2.6, "restitution": 0.5}, "impacts accumulate", False),
        ({"pulse": "-cosine", "gravity": 3.71}, "", False),
    ],
)
def test_numbers_warnings_and_margins_are_those_of_the_package(client, changes, words, overturned):
    given = BLOCK | changes
    block = rocking.Block(given["width"], given["height"], **{k: given[k] for k in ("gravity",) if k in given})
    motion = {name: given[name] for name in ("peak_acceleration", "period", "restitution") if name in given}
    expected = block.response(given["pulse"], **motion)
    found = get_response(client, method="solver", **changes).json()
    assert found["overturned"] is overturned
    assert words in " ".join(found["warnings"])
    if not found["rocking_model_applies"]:  # the meaning ends with what a block that is held would do
        first = "would lift off" if words == "lifts off" else "would slide: "
        assert re.match(first + ".*the rocking model does not apply.*" + found["response"]["meaning"], found["meaning"])
    summary = expected.summary()
    assert (summary["friction_demand"] is None) is (words == "lifts off")
    for name in {*summary} & {*found} - {"notes"}:
        assert found[name] == summary[name], name
    for name in {*summary} & {*found["response"]} - {"notes", "meaning", "warnings"}:
        assert found["response"][name] == pytest.approx(summary[name]), name
    assert [one["peak_acceleration"] for one in found["thresholds"]] == [one.value for one in expected.thresholds]
    for name in ("nearest_acceleration", "acceleration_factor", "nearest_period", "period_factor"):
        assert found["margins"][name] == getattr(expected.margins, name), name
    assert client.get(found["url"]).json() == found


def test_a_body_whose_mass_is_not_in_the_middle(client):
    expected = rocking.RigidBody.from_size(0.4, 1.6, offset=0.03, mass_height=0.7, gravity=9.8).response(
        "sine", peak_acceleration=4.0, period=0.5, restitution=0.9
    )
    changes = {"offset": 0.03, "mass_height": 0.7, "gravity": 9.8, "restitution": 0.9}
    response = get_response(client, **changes).json()
    assert {name: response[name] for name in expected.summary()} == expected.summary()
    assert [one["peak_acceleration"] for one in response["thresholds"]] == expected.thresholds.value.tolist()
    assert client.get(response["url"]).json()["edge"] == response["edge"]
    middle = get_response(client, offset=0.0).json()
    del middle["query"]["offset"]
    assert get_response(client).json() == middle | {"url": middle["url"].removesuffix("&offset=0.0")}
    assert_problem(get_response(client, offset=0.03, method="cube"), 422, "method")
    problem = assert_problem(get_response(client, offset=0.2), 422, "offset")
    assert "less than half the width to either side, 0.2 m" in problem["detail"]


def test_a_search_beyond_its_time_limit_leaves_the_rest_of_the_response(client, monkeypatch):
    whole = get_response(client).json()
    monkeypatch.setattr(blocks, "SEARCH_SHARE", 0.0)
    response = get_response(client).json()
    assert response["thresholds"] is response["largest_surviving_acceleration"] is response["margins"] is None
    assert [text for text in response["warnings"] if "not found in time" in text] == response["warnings"][-2:]
    for name in ("response", "peak_rotation_deg", "friction_demand"):
        assert response[name] == whole[name]


ROWS = [
    {"name": "vase", "width": 0.2, "height": 0.8, "peak_acceleration": 4.0, "period": 0.5},
    {"width": 0.4, "height": 1.6, "peak_acceleration": 4.0, "period": 0.5, "restitution": 0.9},
    {"width": 0.4, "height": 1.6, "peak_acceleration": 8.0, "period": 0.5},
]
TABLE = """name,width [m],height [cm],peak_acceleration [m/s2],period [ms],restitution
vase,0.2,80,4,500,
,0.4,160,4,500,0.9
,0.4,160,8,500,momentum
"""


def test_many_blocks_as_json_and_csv(client):
    found = client.post("/v1/blocks/response", json={"pulse": "sine", "blocks": ROWS}).json()
    for k, row in enumerate(ROWS):
        query = {name: value for name, value in row.items() if name != "name"} | {"pulse": "sine", "method": "solver"}
        single = client.get("/v1/blocks/response", params=query).json()
        for name in ("peak_rotation_deg", "displacement", "overturned", "restitution", "alpha_deg"):
            assert found[name][k] == (None if single[name] is None else pytest.approx(single[name], rel=1e-9)), name
    assert found["name"] == ["vase", "", ""]
    assert found["overturned"] == [True, False, True]
    assert found["metadata"]["assumptions"]
    url = "/v1/blocks/response?pulse=sine"
    text = post(client, url, TABLE, CSV).text.splitlines()
    columns = dict(zip(text[0].split(","), zip(*(line.split(",") for line in text[1:]), strict=True), strict=True))
    assert columns["overturned"] == ("true", "false", "true")
    assert float(columns["peak_rotation"][1]) == pytest.approx(found["peak_rotation"][1], rel=1e-9)
    assert post(client, url, TABLE, CSV, format="json").json()["outcome"] == found["outcome"]
    wide = "Breite (cm);height [cm];thickness [cm];peak_acceleration [g];period [s]\n60,5;160;12;0,4;0,5\n"
    refused = assert_problem(post(client, url, wide, CSV), 422, "blocks")
    assert "columns" in refused["detail"]
    assert "line 2: 60,5;160" in refused["detail"]
    stated = post(client, f"{url}&columns=Breite (cm)=width&decimal=,", wide, CSV, format="json").json()
    assert (stated["skipped"], stated["columns"]["Breite (cm)"]) == (["thickness [cm]"], "width [cm]")
    assert stated["width"] == [pytest.approx(0.605)]


def test_a_text_may_state_another_unit(client):
    stated = {"width": "40 cm", "height": "1600mm", "peak_acceleration": "0.5 g", "period": "500 ms"}
    found = client.get("/v1/blocks/response", params={"pulse": "sine", "mass_height": "80 cm"} | stated).json()
    same = {"width": 0.4, "height": 1.6, "peak_acceleration": 0.5 * 9.80665, "period": 0.5}
    plain = client.get("/v1/blocks/response", params={"pulse": "sine", "mass_height": 0.8} | same).json()
    assert found["query"] == plain["query"]
    many = client.post("/v1/blocks/response", json={"pulse": "sine", "blocks": [stated]}).json()
    assert many["width"] == [0.4]


def test_names_come_out_as_they_went_in_but_for_formulas(client):
    names = ["vase, blue", 'say "no"', "two\nlines", "a\rb", "=1+1", "+1", "@SUM(A1)", "-2+3"]
    sent = io.StringIO(newline="")
    csv.writer(sent).writerows([TABLE.splitlines()[0].split(","), *([name, 0.2, 80, 4, 500, 0.9] for name in names)])
    url = "/v1/blocks/response?pulse=sine"
    response = post(client, url, sent.getvalue(), CSV)
    assert response.status_code == 200
    rows = list(csv.DictReader(io.StringIO(response.text, newline=""), strict=True))
    assert [row["name"] for row in rows] == [*names[:4], *(f"'{name}" for name in names[4:])]
    assert {row["restitution"] for row in rows} == {"0.9"}
    assert post(client, url, sent.getvalue(), CSV, format="json").json()["name"] == names
