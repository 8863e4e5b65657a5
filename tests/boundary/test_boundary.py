"""Boundaries between outcomes: the outcome changes at every vertex, and each connected curve is one curve."""

import math

import numpy as np
import pytest

import rocking
from benchmarks.accuracy.boundary_lines import compare
from rocking import Outcome, paper
from rocking._boundary.search import (
    ELASTIC_RESOLUTION,
    MOST_COUNTED,
    RESOLUTION,
    UNCOUNTED,
    Nodes,
    refine_lines,
    region_code,
)
from rocking._boundary.tracer import CHORD, END, UNCOUNTED_CHORD, UNCOUNTED_THINNEST
from rocking._model.outcome import outcome_codes
from tests.sampling import but_long


def curves(boundary):
    """(slenderness, frequency_ratio, code inside, code of the neighbour) of each vertex."""
    sizes = boundary.row_size.values

    def code(prefix: str):
        outcome, impacts = (boundary[prefix + name].values.astype(int) for name in ("outcome", "impacts"))
        return np.repeat(outcome_codes(outcome, impacts), sizes)

    return boundary.slenderness.values, boundary.frequency_ratio.values, code(""), code("neighbour_")


@pytest.mark.parametrize("alpha", [None, 0.3])
@pytest.mark.parametrize("pulse", but_long(["sine", "-cosine", "half_sine", "rectangular", "c1"], "-cosine"))
def test_the_outcome_changes_at_every_vertex(pulse, alpha):
    nodes = 61 if alpha is None else 41
    boundary = rocking.overturning_boundary(pulse, restitution=0.9, alpha=alpha, nodes=nodes)
    s, omega, region, neighbour = curves(boundary)
    assert boundary.row_size.values.sum() == s.size
    assert s.size > 50
    assert (region != neighbour).all()
    # a vertex lies inside its own region, and one step of the resolution along one of the axes beyond it
    at_vertex = region_code(
        rocking.peak_response(pulse, slenderness=s, frequency_ratio=omega, restitution=0.9, alpha=alpha)
    )
    assert (at_vertex == region).mean() > 0.998  # exp(log omega) rounds
    reach = 4 * RESOLUTION
    around = [(s + ds, omega * math.exp(dw)) for ds, dw in ((reach, 0), (-reach, 0), (0, reach), (0, -reach))]
    codes = [
        region_code(rocking.peak_response(pulse, slenderness=x, frequency_ratio=w, restitution=0.9, alpha=alpha))
        for x, w in around
    ]
    changes = np.any([code != at_vertex for code in codes], axis=0)
    # the region of many impacts consists of layers, of which the outermost one can be too thin to be resolved
    assert changes[region != UNCOUNTED].all()
    assert changes.mean() > 0.998
    assert np.any([code == region for code in [at_vertex, *codes]], axis=0).all()
    # the neighbour is next to it, or beyond regions that are too thin to be resolved
    steps = np.array([1.0, -1.0])[:, None, None] * np.array([reach, 1e-9, 1e-8, 1e-7, 3e-7, 1.0e-6, 3e-6])[:, None]
    beside = region_code(
        rocking.peak_response(
            pulse, slenderness=np.maximum(s + steps, 1e-6), frequency_ratio=omega, restitution=0.9, alpha=alpha
        )
    )
    # but for the point that a curve repeats where it continues an outline
    first = np.cumsum(boundary.row_size.values)[:-1][np.diff(boundary.outline.values) == 0]
    is_neighbour = np.delete((beside == neighbour).any(axis=(0, 1)), first)
    assert is_neighbour.mean() > (0.98 if pulse == "c1" else 0.998)  # c1: 0.983 and more, all others 1


def test_sine_against_the_closed_forms():
    boundary = rocking.overturning_boundary(
        "sine", restitution=0.9, frequency_ratio=(1.5, 8.0), slenderness=(0.05, 0.95), nodes=81
    )
    s, omega, region, neighbour = curves(boundary)
    closed = paper.overturning_amplitudes(omega, 0.9)
    directly = (region == Outcome.OVERTURNED_DIRECTLY) & (neighbour == 0)
    assert directly.sum() > 40
    np.testing.assert_allclose(s[directly], 1 / closed.direct[directly], rtol=0, atol=1e-10)
    after_one = (region == Outcome.OVERTURNED_AFTER_IMPACT + 4) & (neighbour == 0)
    assert after_one.sum() > 40
    gap = np.fmin(
        np.abs(s[after_one] - 1 / closed.overturns_from[after_one]),
        np.abs(s[after_one] - 1 / closed.survives_again[after_one]),
    )
    # where the curve turns over in omega, 1/a is a square root of the distance: compare along omega there
    steep = np.abs(closed.survives_again / closed.overturns_from - 1)[after_one] < 0.2
    assert gap[~steep].max() < 1e-10
    assert np.nan_to_num(gap[steep]).max(initial=0) < 1e-5


@pytest.mark.parametrize("alpha", [None, 0.05])
def test_the_thin_band_of_survival_between_two_ways_of_overturning_is_seen(alpha):
    # between case 1.1 or 1.2 and case 2 a slow sine leaves a band of surviving blocks of relative width 1e-3 and less
    boundary = rocking.overturning_boundary(
        "sine", restitution=0.85, alpha=alpha, frequency_ratio=(0.5, 1.0), slenderness=(0.6, 1.0), nodes=61
    )
    s, omega, region, neighbour = curves(boundary)
    directly = (region == Outcome.OVERTURNED_DIRECTLY) & (neighbour == 0)
    after_one = (region == Outcome.OVERTURNED_AFTER_IMPACT + 4) & (neighbour == 0)
    assert directly.sum() > 20
    assert after_one.sum() > 20
    if alpha is None:
        closed = paper.overturning_amplitudes(omega, 0.85)
        np.testing.assert_allclose(s[directly], 1 / closed.direct[directly], rtol=0, atol=1e-10)
        width = 1 / closed.survives_again - 1 / closed.direct
        assert 0 < np.nanmin(width) < 1e-4
        middle = 0.5 * (1 / closed.survives_again + 1 / closed.direct)
        response = rocking.peak_response("sine", slenderness=middle, frequency_ratio=omega, restitution=0.85)
        assert not response.overturned[np.isfinite(middle)].any()


@pytest.mark.parametrize("alpha", [None, np.radians(30.0)])
def test_a_thin_tongue_is_one_curve(alpha):
    # overturning after two impacts under the cosine: 1e-4 wide at omega 1.2 and half a grid step at 1.5
    boundary = rocking.overturning_boundary(
        "cosine", restitution=0.85, alpha=alpha, frequency_ratio=(1.2, 1.6), slenderness=(0.25, 0.6), nodes=61
    )
    after_two = boundary.isel(curve=np.flatnonzero(boundary.impacts == 2))
    assert np.unique(after_two.outline).size == 1
    assert after_two.row_size.min() > 20


@pytest.mark.parametrize(
    ("pulse", "alpha", "restitution"),
    [
        *(("sine", np.radians(20.0), 0.85), ("cosine", None, 0.85)),
        *(pytest.param(*case, marks=pytest.mark.long) for case in (("cosine", 0.3, 0.85), ("cosine", None, 0.94))),
    ],
)
def test_every_threshold_lies_on_a_curve_and_every_crossing_is_a_threshold(pulse, alpha, restitution):
    deviations = compare(pulse, alpha, nodes=201, lines=25, restitution=restitution, ratios=(0.3, 10.0))
    assert deviations["crossings"] > 60
    assert deviations["wrong"] == 0
    # thresholds of regions that the nodes do not show: all after many impacts, narrower than the finer nodes are apart
    assert deviations["few"] == 0
    assert deviations["widest"] < 1.5e-3
    assert deviations["unlisted"] <= (0.05 if restitution < 0.9 else 0.12) * deviations["crossings"]


def test_a_curve_goes_on_to_the_edge_of_the_window():
    # between two lines omega = const the curve of overturning without impact leaves the window at its lower edge
    boundary = rocking.overturning_boundary(
        "sine", restitution=0.85, frequency_ratio=(1.0, 6.0), slenderness=(0.3, 0.95), nodes=31
    )
    s, omega, region, neighbour = curves(boundary)
    directly = (region == Outcome.OVERTURNED_DIRECTLY) & (neighbour == 0)
    edge = omega[directly][np.argmin(s[directly])]
    assert 0.3 <= s[directly].min() < 0.3 + 1e-3
    closed = paper.overturning_amplitudes(edge * math.exp(2 * END), 0.85)
    assert 1 / closed.direct < 0.3


def test_nearly_elastic_blocks_have_no_open_ends():
    boundary = rocking.overturning_boundary(
        "cosine", restitution=0.96, frequency_ratio=(0.45, 0.6), slenderness=(0.7, 1.0), nodes=41
    )
    assert UNCOUNTED in boundary.impacts
    assert boundary.open_ends <= 2
    assert boundary.unmeasured_chords == 0
    # what the search resolves is stated: coarser than for less elastic blocks
    assert boundary.thinnest_region < 3e-4 < boundary.thinnest_uncounted_region == 2.0 * boundary.node_distance
    assert boundary.chord_error <= CHORD
    assert boundary.uncounted_chord_error <= UNCOUNTED_CHORD
    assert boundary.end_distance <= 3e-3
    # half of the nodes are uniform in 1/a, half of them in its logarithm
    assert 0.3 / 40 < boundary.node_distance < 0.3 / 19
    # no outline lies on one line omega = const
    for outline in range(int(boundary.outline.max()) + 1):
        points = np.repeat(boundary.outline.values, boundary.row_size.values) == outline
        assert np.ptp(boundary.frequency_ratio.values[points]) > 0.0


def test_bands_that_are_not_drawn_on_a_line_of_the_grid_are_thin():
    case = {"restitution": 0.85}
    boundary = rocking.overturning_boundary(
        "c2", **case, frequency_ratio=(0.45, 0.6), slenderness=(0.92, 0.96), nodes=41
    )
    s, omega, _, neighbour = curves(boundary)
    thinnest, widest = boundary.thinnest_uncounted_region, 0.0  # between the lines wider ones are missing
    x = np.linspace(0.9201, 0.9599, 20_001)
    for line in np.geomspace(0.45, 0.6, 41)[2:-1:4]:  # of the grid, whose changes of outcome are all vertices
        drawn = np.unique(s[(np.abs(omega / line - 1) < 1e-9) & (neighbour == 0)].round(11))
        falls = rocking.peak_response("c2", slenderness=x, frequency_ratio=line, **case).overturned
        wrong = falls != (falls[0] ^ (np.searchsorted(drawn, x) - np.searchsorted(drawn, x[0])) % 2 == 1)
        ends = np.flatnonzero(np.diff(np.concatenate([[False], wrong, [False]]).astype(int)))
        widest = max(widest, *np.diff(ends)[::2] * (x[1] - x[0]))
    assert 0.0 < widest < UNCOUNTED_THINNEST < thinnest


@pytest.mark.parametrize(("pulse", "thinnest"), [("c2", None), ("cosine", 1e-6)])
def test_layers_without_a_finest_one_are_resolved_less_finely(pulse, thinnest):
    boundary = rocking.overturning_boundary(
        pulse, restitution=0.85, frequency_ratio=(0.45, 0.6), slenderness=(0.92, 0.96), nodes=41
    )
    assert boundary.thinnest_uncounted_region == (thinnest or 2.0 * boundary.node_distance)
    assert boundary.open_ends <= 10


def test_islands_are_drawn():
    boundary = rocking.overturning_boundary(
        "sine", restitution=0.9, frequency_ratio=(0.6, 1.1), slenderness=(0.88, 1.0), nodes=201
    )
    assert {3, 5} <= set(boundary.impacts.values.tolist())
    assert set(boundary.impacts.values.tolist()) <= {UNCOUNTED, 0, 1, 3, 5, 7, 9, 11}  # odd, or directly


@pytest.mark.parametrize("alpha", [None, 0.25])
@pytest.mark.parametrize("pulse", ["sine", "cosine", "c1"])
def test_thresholds_separate_the_outcomes(pulse, alpha):
    for omega in (1.0, 2.5, 5.0):
        thresholds = rocking.thresholds(pulse, frequency_ratio=omega, restitution=0.9, alpha=alpha)
        assert (np.diff(thresholds.amplitude) > 0).all()
        assert (np.diff(thresholds.overturns_above.astype(int)) != 0).all()  # the outcome alternates
        assert thresholds.overturns_above[0]
        s = 1 / thresholds.amplitude
        below, above = (
            rocking.peak_response(pulse, slenderness=s + side * RESOLUTION * 3, frequency_ratio=omega, restitution=0.9,
                                  alpha=alpha)
            for side in (1, -1)
        )  # fmt: skip
        np.testing.assert_array_equal(above.overturned, thresholds.overturns_above)
        np.testing.assert_array_equal(below.overturned, ~thresholds.overturns_above)
        falls = np.where(thresholds.overturns_above, above.outcome, below.outcome)
        np.testing.assert_array_equal(falls, thresholds.outcome)
        impacts = np.where(thresholds.overturns_above, above.impacts, below.impacts)
        np.testing.assert_array_equal(impacts, thresholds.impacts)


@pytest.mark.long
def test_thresholds_of_a_block_that_strikes_thousands_of_times():
    # when each of the thousands of numbers of impacts was a region of its own, this took minutes
    case = {"frequency_ratio": 2.062, "restitution": 1.0}
    thresholds = rocking.thresholds("ricker", **case, highest=2.26)  # that of the block is 2.24
    assert thresholds.impacts.max() > MOST_COUNTED
    assert (thresholds.overturns_above[1:] != thresholds.overturns_above[:-1]).all()
    beyond = np.where(thresholds.overturns_above, 2.0, -2.0) * ELASTIC_RESOLUTION
    inside, outside = (
        rocking.peak_response("ricker", slenderness=1 / thresholds.amplitude + step, **case) for step in (0.0, beyond)
    )
    assert inside.overturned.all()
    assert not outside.overturned.any()


def test_thresholds_up_to_the_highest_only():
    all_of_them = rocking.thresholds("sine", frequency_ratio=4.0, restitution=0.85)
    some = rocking.thresholds("sine", frequency_ratio=4.0, restitution=0.85, highest=5.0)
    np.testing.assert_allclose(some.amplitude, all_of_them.amplitude[:2], rtol=1e-11)
    none = rocking.thresholds("sine", frequency_ratio=100.0, restitution=0.85, highest=2.0)
    assert none.amplitude.size == none.overturns_above.size == none.impacts.size == 0


def test_a_window_without_boundary_gives_no_curves():
    empty = rocking.overturning_boundary(
        "sine", restitution=0.85, frequency_ratio=(50.0, 60.0), slenderness=(0.5, 0.9), nodes=17
    )
    assert empty.sizes["point"] == 0
    assert empty.sizes["curve"] == 0


@pytest.mark.parametrize(
    ("argument", "value"),
    [
        ("nodes", 3),
        ("threads", 0),
        ("frequency_ratio", (0.0, 1.0)),
        ("frequency_ratio", (2.0, 1.0)),
        ("slenderness", (0.5, 0.2)),
        ("slenderness", (0.5, 1.5)),
        ("frequency_ratio", 1.0),
        ("slenderness", (0.1, 0.2, 0.3)),
    ],
)
def test_wrong_windows(argument, value):
    with pytest.raises(rocking.InvalidArgumentError, match=argument):
        rocking.overturning_boundary("sine", **{"restitution": 0.9, "nodes": 17, argument: value})


def test_two_threads_give_the_same_curves():
    case = {"restitution": 0.9, "alpha": 0.2, "nodes": 101}
    single, double = (rocking.overturning_boundary("sine", **case, threads=threads) for threads in (1, 2))
    assert single.identical(double)


@pytest.mark.parametrize(("thinnest", "regions"), [(8e-4, [0, 1, 2, 3, 4]), (2e-3, [0, 1, 3, 4])])
def test_regions_in_a_gap_are_left_out_only_if_it_is_thin(thinnest, regions):
    """Regions 1 to 3 lie in a gap of 0.001 between the two that the nodes show; its ends are exact all the same."""
    ends = np.array([0.4, 0.4002, 0.4004, 0.401])

    def classify(x, *_):
        codes = np.searchsorted(ends, x, side="right")
        return codes, np.where(codes % 2 == 0, 1.0, -1.0) * np.abs(np.subtract.outer(x, ends)).min(axis=1)

    x = np.array([0.0, 1.0])
    nodes = refine_lines(0, np.zeros((1, 4)), Nodes(np.zeros(2, dtype=np.intp), x, *classify(x)), classify, thinnest)
    assert np.unique(nodes.codes).tolist() == regions
    for end, below, above in ((0.4, 0, 1), (0.401, 3, 4)):
        assert end - nodes.x[nodes.codes == below].max() <= 2 * RESOLUTION
        assert nodes.x[nodes.codes == above].min() - end <= 2 * RESOLUTION
