"""The curves on the control space that separate the outcomes, found with the solver itself.

`Tracer` follows the regions of outcome from one line omega = const to the next; the pieces are put together to chains,
and chords that leave their curve by more than `CHORD` are halved.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rocking._base.errors import integer
from rocking._base.quantities import FREQUENCY_RATIO, RESTITUTION, SLENDERNESS
from rocking._base.units import Scalar
from rocking._boundary.amplitude import one_restraint
from rocking._boundary.chains import Chains, chains_of
from rocking._boundary.chords import refine_chords
from rocking._boundary.columns import THINNEST
from rocking._boundary.search import Floats, Solve, Work, block_solver, classifier, layer_code, region_code
from rocking._boundary.tracer import CHORD, END, Tracer
from rocking._excitation.pulses import AbstractPulse, as_pulse
from rocking._model.checks import check_ends, check_one_alpha, known_restitution
from rocking._model.labelled import variable
from rocking._model.outcome import decode_outcomes
from rocking._numba.cancellation import StopFlag

if TYPE_CHECKING:
    import xarray as xr

MISSED = 2.0
"""Width of regions without a finest layer that no node may show, over the distance of the nodes [-].

Of 112,000 points within 0.001 of curves of c2 and of the cosine at eta = 0.96, 1,650 were in bands that are not drawn,
the widest of 1.06 node distances.
"""

UPLIFTING = SLENDERNESS.restricted(SLENDERNESS.lower, 1.0)  # blocks that the pulse can uplift


def overturning_boundary(
    motion: str | AbstractPulse,
    *,
    restitution: Scalar,
    alpha: Scalar | None = None,
    stiffness: Scalar = 0.0,
    prestress: Scalar = 0.0,
    damping: Scalar = 0.0,
    frequency_ratio: tuple[float, float] = (0.2, 15.0),
    slenderness: tuple[float, float] = (0.02, 1.0),
    nodes: int = 401,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> xr.Dataset:
    """Trace the boundary curves of overturning on a window of the control space.

    Parameters
    ----------
    motion, restitution, alpha, stiffness, prestress, damping
        As for `peak_response`; scalars.
    frequency_ratio : (float, float)
        Window of omega [-], 0 < low < high.
    slenderness : (float, float)
        Window of g tan(alpha)/a_g = 1/a [-], 0 < low < high <= 1: depends on the motion, unlike h/b. Of a block with a
        prestress the window of (1 + sigma)/a; the curves have 1/a.
    nodes : int
        Nodes in each direction on which regions are first looked for, 16 to 4001.
    threads : int, optional
        Number of threads, >= 1; by default all cores.
    stop : StopFlag, optional
        Once another thread sets it, this ends soon with `StoppedError`.

    Returns
    -------
    xarray.Dataset
        Polylines in the contiguous ragged representation of CF: slenderness(point), frequency_ratio(point), each
        vertex good to `RESOLUTION` in 1/a (to `ELASTIC_RESOLUTION` for elastic blocks, where one of the two regions
        has uncounted impacts); row_size(curve); outcome(curve), impacts(curve) of the overturning region
        that the curve bounds; neighbour_outcome(curve), neighbour_impacts(curve) on the other side (RECOVERS, 0, or
        another way of overturning). An outline is cut into curves where its neighbour changes, the point before the
        cut being repeated; outline(curve) numbers it. `impacts` is -1 for overturning after more than `MANY_IMPACTS`
        impacts or after impacts that accumulate to rest: that is one region. Attributes: chord_error [-], the largest
        distance of a chord from its curve, at the middles of the chords; uncounted_chord_error, the same for the
        curves of regions whose `impacts` are -1; thinnest_region [-], the width in 1/a below which a region is not
        resolved and its two neighbours are taken to meet; thinnest_uncounted_region [-], the width below which a region
        whose `impacts` are -1, or a surviving band beside one, may be missing; end_distance [-], the distance in log
        omega within which the ends of these regions are known, and below which they are not resolved (`END` for all
        others); node_distance [-], the largest distance of the nodes in 1/a; unmeasured_chords, the number of chords at
        whose middle the curve was not found; open_ends, the number of ends of regions that are known to a step of the
        nodes only.

    Notes
    -----
    A region is found if a node lies in it, on any line; the nodes are finer by `FINER` where blocks overturn after
    two impacts or more. From there it is followed in both directions. So a region can be missed only if it is narrower
    in 1/a than the distance of the nodes, `node_distance` at most, on all lines omega = const, or lies between two.
    """
    eta = RESTITUTION.number(known_restitution(restitution, alpha))
    angle, pulse = check_one_alpha(alpha), as_pulse(motion)
    restraint = one_restraint(stiffness, prestress, damping)
    if not restraint:
        return boundaries_at_angles(pulse, [(eta, angle, nodes)], frequency_ratio, slenderness, threads, stop)[0]
    threads = None if threads is None else integer("threads", threads, 1, math.inf)
    solver = block_solver(pulse, threads, stop, restraint)
    curves = trace_curves(solver, [(eta, angle, nodes)], frequency_ratio, slenderness)[0]
    curves["slenderness"] = curves["slenderness"] / (1.0 + restraint.get("prestress", 0.0))
    attributes = {"pulse": pulse.name, "restitution": eta, "alpha": angle}
    attributes |= {name: float(value) for name, value in restraint.items()}
    return curves.assign_attrs(attributes | curves.attrs)


def boundaries_at_angles(
    motion: str | AbstractPulse,
    blocks: Sequence[tuple[float, float, int]],
    frequency_ratio: tuple[float, float],
    slenderness: tuple[float, float],
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> list[xr.Dataset]:
    """Trace `overturning_boundary` at several angles together, in less time than one after the other.

    `blocks`: restitution, angle [rad], 0 for the slender limit, and number of nodes, each angle once.
    """
    pulse = as_pulse(motion)
    threads = None if threads is None else integer("threads", threads, 1, math.inf)
    traced = trace_curves(block_solver(pulse, threads, stop), blocks, frequency_ratio, slenderness)
    boundaries = []
    for curves, (eta, alpha, _) in zip(traced, blocks, strict=True):
        attributes = {"pulse": pulse.name, "restitution": eta, "alpha": alpha}
        boundaries.append(curves.assign_attrs(attributes | curves.attrs))
    return boundaries


def trace_curves(
    solve: Solve,
    blocks: Sequence[tuple[float, float, int]],
    frequency_ratio: tuple[float, float],
    slenderness: tuple[float, float],
) -> list[xr.Dataset]:
    """Trace `boundaries_at_angles` by any solver, whose slenderness is 1 at uplift."""
    low, high = check_ends(FREQUENCY_RATIO, frequency_ratio)
    bottom, top = check_ends(UPLIFTING, slenderness)
    points, rows = [], []
    for eta, alpha, count in blocks:
        nodes = integer("nodes", count, 16, 4001)
        log_omega = np.linspace(np.log(low), np.log(high), nodes)
        points.append(np.stack(np.broadcast_arrays(0.0, log_omega, eta, alpha), axis=1))
        rows.append(_rows(bottom, top, nodes, log_omega.size))
    work = Work([alpha for _, alpha, _ in blocks])
    by_layer, by_region = classifier(solve, layer_code, work), classifier(solve, region_code, work)
    tracer = Tracer(np.concatenate(points), by_layer, by_region, work)
    tracer.trace(rows)
    boundaries = []
    for (eta, alpha, _), grid in zip(blocks, rows, strict=True):
        boundaries.append(_traced(tracer, eta, alpha, float(np.diff(grid, axis=0).max())))
    return boundaries


def _traced(tracer: Tracer, eta: float, alpha: float, node_distance: float) -> xr.Dataset:
    """Build the curves of one angle; chords that leave them by too much are halved."""
    block = np.array(eta), np.array(alpha)
    angle = tracer.work.angle(block[1])
    panels = [k for k in tracer.panels if tracer.angle[k] == angle]
    joins = chain.from_iterable(tracer.joins[k] for k in panels)
    chains, error, uncounted_error, unknown = refine_chords(
        chains_of(joins),
        tracer.classify_regions,
        block,
        largest=CHORD,
        uncounted=float(tracer.chord[angle]),
        end=END,
    )
    fine = tracer.thinnest[angle] == THINNEST
    return _as_dataset(chains).assign_attrs(
        restitution=eta,
        chord_error=error,
        uncounted_chord_error=uncounted_error,
        thinnest_region=THINNEST,
        thinnest_uncounted_region=THINNEST if fine else MISSED * node_distance,
        end_distance=float(tracer.end[angle]),
        node_distance=node_distance,
        open_ends=tracer.open_ends(panels),
        unmeasured_chords=unknown,
    )


def _rows(low: float, high: float, nodes: int, columns: int) -> Floats:
    """Return nodes of 1/a (nodes, columns), as dense as half of them uniform and half of them uniform in the logarithm.

    Near onset the regions are thin in 1/a, under strong pulses in a. The nodes between the two ends lie elsewhere in
    each column, so that a thin region that runs along omega meets one of them sooner or later.
    """
    fine = np.linspace(low, high, 16 * nodes)
    density = (fine - low) / (high - low) + np.log(fine / low) / np.log(high / low)
    shift = np.arange(columns) * 0.5 * (math.sqrt(5.0) - 1.0) % 1.0 - 0.5
    position = np.arange(nodes)[:, None] + 0.98 * shift
    position[0], position[-1] = 0.0, nodes - 1.0
    return np.interp(position * 2.0 / (nodes - 1), density, fine)


def _as_dataset(chains: Chains) -> xr.Dataset:
    """Convert chains to curves, cut where the outcome on their other side changes."""
    import xarray as xr  # noqa: PLC0415  # takes longer to load than the solver

    def curve(values: NDArray[np.integer[Any]], long_name: str) -> tuple[object, ...]:
        return variable("curve", values, "1", long_name)

    size = chains.chain.size
    new = np.ones(size, dtype=bool)
    new[1:] = (np.diff(chains.chain) != 0) | (np.diff(chains.neighbour) != 0)
    starts = np.flatnonzero(new)
    # a curve that continues an outline begins with the last point before it, so that no chord is lost
    repeated = starts[1:][np.diff(chains.chain)[starts[1:] - 1] == 0] - 1
    points = np.sort(np.concatenate([np.arange(size), repeated]))
    sizes = np.diff(np.append(starts, size)) + np.isin(starts - 1, repeated)
    outcome, impacts = decode_outcomes(chains.region[starts])
    neighbour_outcome, neighbour_impacts = decode_outcomes(chains.neighbour[starts])
    return xr.Dataset(
        {
            "slenderness": variable("point", chains.slenderness[points], "1", "g tan(alpha)/a_g (3.6)"),
            "frequency_ratio": variable(
                "point", np.exp(chains.log_omega[points]), "1", "frequency ratio omega_g/p (3.6)"
            ),
            "row_size": variable("curve", sizes.astype(np.int32), "1", "points", sample_dimension="point"),
            "outline": curve(chains.chain[starts].astype(np.int32), "number of the outline that holds the curve"),
            "outcome": curve(outcome, "outcome in the region that the curve bounds"),
            "impacts": curve(impacts, "impacts before overturning there"),
            "neighbour_outcome": curve(neighbour_outcome, "outcome on the other side"),
            "neighbour_impacts": curve(neighbour_impacts, "impacts before overturning on the other side"),
        }
    )
