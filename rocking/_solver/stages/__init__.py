"""Slender blocks by exact arcs, `LANES` at a time: uplift, flights, impacts and the end of the pulse in stages.

A stage is one step of the event loop for many blocks at once: the blocks wait in lists for their next flight, `LANES`
of a list are followed to its end, and each is put into the list of what comes next. Start with `batch.py`, which has
the loop, and follows what no stage decides, one block after the other. Data pass from `cuts.py` (when a block uplifts)
through `lists.py` (which blocks are followed next) to `flight.py` (one flight, with its decisions and a worked example;
`cuts.py`, `arcs.py` and `roots.py` serve it) or `short_flights.py` (flights within one series), then to `events.py`
(impact, rest, outcome, response). `excitation.py` and `wavelets.py` evaluate the pulse, `state.py` holds the vectors.
"""
