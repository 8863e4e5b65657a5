"""Comparison of random cells with another checkout or processor: equal code agrees, and differences are counted."""

import numpy as np

from benchmarks.accuracy.agreement import CODES, ROOT, compare, measure, table


def test_a_checkout_agrees_with_itself() -> None:
    rows = measure(count=50, seed=3, baseline=ROOT, pulses=("cosine",))
    assert [row["way"] for row in rows] == ["baseline"]
    for row in rows:
        assert [row[name] for name in (*CODES, "above_bound", "largest")] == [0, 0, 0, 0, 0.0]
        assert row["cells"] == 50
        assert row["surviving"] > 0
    assert len(table(rows).splitlines()) == 2


def test_differences_are_counted() -> None:
    codes = {name: np.zeros(4, dtype=np.int64) for name in CODES}
    here = codes | {"peak_rotation": np.array([0.0, 0.5, 0.5, np.nan])}
    other = codes | {
        "impacts": np.array([0, 1, 2, 0]),
        "peak_rotation": np.array([0.0, 0.5 + 1e-9, 0.5 + 1e-6, np.nan]),
    }
    found = compare(here, other, bound=np.array([0.0, 1e-8, 1e-8, np.nan]))
    assert (found["outcome"], found["impacts"], found["peak_mode"]) == (0, 2, 0)
    assert (found["cells"], found["surviving"], found["above_bound"], found["without_bound"]) == (4, 3, 1, 0)
    np.testing.assert_allclose([found["median"], found["largest"]], [2e-9, 2e-6], rtol=1e-5)
