"""Slender blocks under sinusoids that no stage decides: one after the other by exact arcs, from rest.

An entry of its own: most calls leave no block, and do not wait for its compilation.
"""

from __future__ import annotations

from rocking._numba.cancellation import is_stopped
from rocking._numba.compilation import FloatArray, Record, entry
from rocking._solver.kernels.event_loop import advance_by_arc, init_state
from rocking._solver.rules import set_block, write_response
from rocking._solver.stages.batch import LEFT


@entry
def solve_remainder(
    slenderness: FloatArray, omega: FloatArray, eta: FloatArray, pulse: Record, stop: FloatArray, responses: Record
) -> None:
    """Solve the blocks that `rocking._solver.stages.batch.solve_by_arcs` has left.

    Parameters
    ----------
    slenderness, omega, eta : float arrays (cells,)
        1/a > 0, frequency ratio > 0, restitution in [0, 1] [-].
    pulse
        Solver state: a record of `pulse_state`.
    stop : uint8 array (1,)
        Once another thread sets it to 1, the function returns within a flight; responses are missing.
    responses : array (cells,) of `rocking._solver.state.RESPONSE_RECORD`
        As `solve_by_arcs` has filled it; those with the outcome `LEFT` are replaced.
    """
    for cell in range(len(slenderness)):
        if is_stopped(stop):
            return
        response = responses[cell]
        if response.outcome != LEFT:
            continue
        followed = response.impacts
        uplift_time, impact_time = response.uplift_time, response.first_impact_time
        impact_velocity = response.first_impact_velocity
        set_block(pulse, slenderness[cell], eta[cell], 0.0)
        init_state(pulse, omega[cell])
        while advance_by_arc(pulse) and not is_stopped(stop):
            pass
        write_response(pulse, response)
        if followed > 0:  # the same bits for each eta
            response.uplift_time, response.first_impact_time = uplift_time, impact_time
            response.first_impact_velocity = impact_velocity
