"""Slender blocks under sinusoids, `LANES` at a time: uplift, flights, impacts and the end of the pulse in stages."""
