"""A flight of the slender block under a recorded motion, by the exact solution on each sample interval.

Given: the start of the flight, and the samples. Decided: whether it ends with an impact, with the motion, or where
overturning is certain, and its largest rotation. No impact and no peak above the largest so far is missed: an interval
is passed by its end state alone only where the signs of q, z and w exclude an event inside, and otherwise by
`piece.follow_piece` on either side of the zero of q.
"""

from rocking._numba.compilation import FloatArray, Record, kernel
from rocking._solver.records.event_loop import cut_time, ground_on
from rocking._solver.records.piece import follow_piece, hyperbolic
from rocking._solver.records.samples import LATER, SHAPE, interval_length
from rocking._solver.state import IMPACT, OVERTURNS, PULSE_END


@kernel
def follow_interval(
    block: Record, h: float, q0: float, q1: float, s: float, z: float, w: float, at_uplift: bool
) -> tuple[float, float, float]:
    """Follow a flight from time `s` to the end of a sample interval of length `h` with q from `q0` to `q1` at its ends.

    Updates `block.largest_z`. Returns the time of the impact since the left end, -1 if there is none, and z and w there
    or at the right end.
    """
    r = (q1 - q0) / h
    at = 0.0 if at_uplift else (q0 if s == 0.0 else q0 + r * s)
    # q changes its sign inside, and the flight does not start at that very place: two pieces
    if (q0 < 0.0 < q1 or q1 < 0.0 < q0) and not at_uplift:
        cut = cut_time(q0, q1, h)
        if s < cut:
            known = max(block.peak_rotation, block.largest_z)
            impact, z, w, top = follow_piece(z, w, at, r, cut - s, q0 > 0.0, known)
            block.largest_z = max(block.largest_z, top)
            if impact >= 0.0:
                return s + impact, z, w
            s, at = cut, 0.0
    if h - s <= 0.0:  # the flight starts at the right end
        return -1.0, z, w
    restoring = at + q1 > 0.0  # twice q at the middle of the piece
    known = max(block.peak_rotation, block.largest_z)
    impact, z, w, top = follow_piece(z, w, at, r, h - s, restoring, known)
    block.largest_z = max(block.largest_z, top)
    return (s + impact if impact >= 0.0 else -1.0), z, w


@kernel
def flight_by_arcs(block: Record, samples: FloatArray) -> tuple[int, int, float, float, float]:
    """Follow a flight to its end: `IMPACT`, `PULSE_END` or `OVERTURNS`.

    Returns what ended it, the interval and the time since its left end, z and w there.
    """
    f, later, a, sign = samples[SHAPE], samples[LATER], block.a[0], block.sign
    count = len(f) - 1
    k, s = block.interval, block.s
    h = interval_length(block, samples, k)
    q0, q1, _, _ = ground_on(block, samples, k)
    impact, z, w = follow_interval(block, h, q0, q1, s, 0.0, block.w0, block.starts_at_uplift == 1)
    block.stepped += 1
    if impact >= 0.0:
        return IMPACT, k, impact, z, w
    k += 1
    # from here on whole intervals; nearly all hold no event
    known = max(block.peak_rotation, block.largest_z)
    equidistant = block.equidistant == 1
    cosh1, sinh, above = hyperbolic(h)
    above, slope, sagitta = above / h, cosh1 / h, 0.125 * h * h
    while k < count:
        # (z + w)' = (z + w) - q, and q <= 1 + a |f| from here on: z + w grows for ever
        if z + w > 1.0 + a * later[k]:
            return OVERTURNS, k, 0.0, z, w
        if not equidistant:
            h = interval_length(block, samples, k)
            cosh1, sinh, above = hyperbolic(h)
            above, slope, sagitta = above / h, cosh1 / h, 0.125 * h * h
        q0, q1 = q1, 1.0 + sign * a * f[k + 1]
        c, rise = z - q0, q1 - q0
        # grouped so that the chain of operations from one sample to the next is short
        z1 = (z + z * cosh1) + (w * sinh - (q0 * cosh1 + rise * above))
        w1 = (w + w * cosh1) + (z * sinh - (q0 * sinh + rise * slope))
        block.stepped += 1
        plain = False  # whether no event that counts takes place inside
        if q0 >= 0.0 and q1 >= 0.0:
            if z1 > 0.0:  # restored, and above the ground at the end: no impact. A peak needs a zero of w
                # w has one sign at both ends, and its only extremum inside, if there is one, is farther from zero
                plain = (w > 0.0 and w1 > 0.0 and (c >= 0.0 or z1 <= q1)) or (
                    w <= 0.0 and w1 <= 0.0 and (c <= 0.0 or z1 >= q1)
                )
                # or z, which lies above its chord by (largest -z'') h^2/8 at most, stays below the largest so far
                plain = plain or max(z, z1) + sagitta * max(q0, q1) <= known
        else:  # destabilised and rising: neither impact nor peak
            plain = q0 <= 0.0 and q1 <= 0.0 and w >= 0.0
        if plain:
            z, w = z1, w1
        else:
            impact, z, w = follow_interval(block, h, q0, q1, 0.0, z, w, False)
            known = max(known, block.largest_z)
            if impact >= 0.0:
                return IMPACT, k, impact, z, w
        k += 1
    return PULSE_END, count - 1, h, z, w
