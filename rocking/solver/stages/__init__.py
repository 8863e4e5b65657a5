"""Slender blocks by exact arcs, `LANES` at a time: uplift, flights, impacts and the end of the pulse in stages."""
