"""Suites of recorded motions: outcomes, fragility, annual rates, and pulses fitted to records."""
