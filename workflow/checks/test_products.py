"""The finished products: all there, whole, and saying what they should. Run by `rule check_results`."""

import json
import os
from pathlib import Path

import pytest

from rocking._datasets.cube import read_dataset
from workflow.scripts.manifest import digest_of

RESULTS = Path(os.environ["ROCKING_RESULTS"])

PRODUCTS = json.loads((RESULTS / "manifest.json").read_text(encoding="utf-8"))["products"]


@pytest.mark.parametrize("name", PRODUCTS)
def test_product_is_the_one_listed(name: str) -> None:
    digest = digest_of(RESULTS / name)
    assert {key: PRODUCTS[name][key] for key in digest} == digest


@pytest.mark.parametrize("name", [name for name in PRODUCTS if name.startswith("figures/") and name.endswith(".png")])
def test_figure_comes_with_its_data_and_a_scalable_drawing(name: str) -> None:
    stem = RESULTS / name.removesuffix(".png")
    assert (RESULTS / name).read_bytes().startswith(b"\x89PNG")
    svg = stem.with_name(stem.name + ".svg").read_text(encoding="utf-8")
    assert "<svg" in svg
    assert "dc:date" not in svg
    data = read_dataset(stem.with_name(stem.name + ".nc"))
    assert data.attrs["title"]
    assert data.data_vars


@pytest.mark.skipif("claims.json" not in PRODUCTS, reason="data sets only")
def test_every_claim_has_a_verdict() -> None:
    claims = json.loads((RESULTS / "claims.json").read_text(encoding="utf-8"))["claims"]
    keys = [claim["key"] for claim in claims]
    assert len(set(keys)) == len(keys) > 20
    assert all(claim["verdict"] and claim["printed"] and claim["measure"] for claim in claims)
    verdicts = {claim["key"]: claim["verdict"] for claim in claims}
    for key in ("table-1", "collapse", "similar-blocks", "uplift"):
        assert verdicts[key] == "identity"
    for key in ("curve-case-2", "curve-case-1.2", "curve-case-1.1", "no-real-root", "slender-limit"):
        assert verdicts[key] == "holds"
    for key in ("complete", "limit-0.4", "plots-agree", "no-case-1.1-above-5"):
        assert verdicts[key] == "holds within stated range"
