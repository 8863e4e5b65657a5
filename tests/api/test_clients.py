"""Clients that two generators make of the OpenAPI document: no numbered copies of a class, and their calls.

The benchmark of the service is one more client.

The generators are looked for on the path and below `build/clients`, where `make test-all` installs them.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.api.conftest import POINT, parts_of
from tests.api.servers import ROOT, serving

PATH = f"{ROOT / 'build' / 'clients' / 'bin'}{os.pathsep}{os.environ.get('PATH', '')}"

CALLS = """
import sys
from client import Client
from client.api.datasets import get_datasets_v1_datasets_get as datasets
from client.api.response import get_response_v1_response_get as one, get_block_v1_blocks_response_get as block
from client.models import Method, PointResponse, Problem, PulseName
with Client(sys.argv[1], timeout=120.0) as service:
    groups = dict(pulse=PulseName.SINE, frequency_ratio=6.0, restitution=0.85)
    found = one.sync(client=service, slenderness=0.6, method=Method.CUBE, **groups)
    assert isinstance(found, PointResponse) and found.source == "cube" and found.peak_rotation > 0, found
    assert isinstance(one.sync(client=service, slenderness=-0.6, **groups), Problem)
    body = dict(width=0.4, height=1.6, peak_acceleration=4.0, period=0.5)
    found = block.sync(client=service, pulse="mavroeidis_papageorgiou(cycles=2)", **body)
    assert found.response.query.pulse == "mavroeidis_papageorgiou(cycles=2)", found
    part = datasets.sync(client=service, limit=1)
    assert len(part.datasets) == 1 and datasets.sync(client=service, cursor=part.next_cursor).datasets, part
"""

PARSED = """
import json, sys
import models
model = models.PointResponse.model_validate(json.loads(sys.argv[1]))
assert model.query.restitution == 0.85 and model.units.root["query.restitution"] == "1", model
"""


@pytest.fixture(scope="module")
def document(client, tmp_path_factory):
    path = tmp_path_factory.mktemp("openapi") / "openapi.json"
    path.write_text(client.get("/openapi.json").text)
    return path


def test_sets_of_words_and_objects_are_named_and_every_content_has_a_schema(document):
    """What generators would number: an enumeration or an object within another schema."""
    found = json.loads(document.read_text())

    schemas = found["components"]["schemas"]
    assert [name for name in schemas if name[-1].isdigit()] == []
    for name, schema in schemas.items():
        within = parts_of(schema.get("properties", {}), {}, {*schemas})
        assert [one for one in within if "enum" in one or one.get("type") == "object"] == [], name
    for path, methods in found["paths"].items():
        for operation in methods.values():
            assert all("enum" not in one["schema"] for one in operation.get("parameters", ())), path
            for answer in (operation.get("requestBody", {}), *operation["responses"].values()):
                assert all(content["schema"] for content in answer.get("content", {}).values()), path


def assert_names(folder):
    """The classes of generated modules are many, and none is a numbered copy."""
    names = [name for path in folder.rglob("*.py") for name in re.findall(r"^class (\w+)", path.read_text(), re.M)]
    assert len(names) > 100
    assert [name for name in names if name[-1].isdigit()] == []


def generated(program, *arguments):
    """The Python of a generator that has made a client; the test is skipped if it is not installed."""
    found = shutil.which(program, path=PATH)
    if found is None:
        pytest.skip(f"no {program}")
    subprocess.run([found, *map(str, arguments)], check=True, capture_output=True, env=os.environ | {"PATH": PATH})
    return Path(found).with_name("python")


def test_a_client_of_openapi_python_client_is_called(document, results, tmp_path):
    client = tmp_path / "client"
    python = generated(
        "openapi-python-client", "generate", "--path", document, "--output-path", client, "--meta", "none"
    )
    assert_names(client / "models")
    with serving(results, tmp_path / "log") as server:
        subprocess.run([python, "-c", CALLS, server.address], cwd=tmp_path, check=True)


def test_models_of_datamodel_code_generator_read_an_answer(client, document, tmp_path):
    options = ("--input-file-type", "openapi", "--output-model-type", "pydantic_v2.BaseModel")
    generated("datamodel-codegen", "--input", document, "--output", tmp_path / "models.py", *options)
    assert_names(tmp_path)
    answer = client.get("/v1/response", params=POINT).text
    subprocess.run([sys.executable, "-c", PARSED, answer], cwd=tmp_path, check=True)


@pytest.mark.long
def test_the_benchmark_measures_a_worker(results, tmp_path):
    out = tmp_path / "service.json"
    few = ["--seconds", "1", "--points", "2000", "--rounds", "1"]
    command = [sys.executable, "-m", "benchmarks.cost.service", "--results", str(results), *few, "--out", str(out)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    record = json.loads(out.read_text())
    assert record["points"]["questions"] > 50
    assert 0 < record["points"]["median_ms"] <= record["points"]["p99_ms"]
    assert [one["points"] for one in record["batches"]] == [2000]
    assert 0 < record["share_by_data_sets"] < 1
    assert record["memory"]["after batches"]["now_MB"] > 50
    assert "the rest by the solver" in done.stdout
