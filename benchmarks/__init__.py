"""Measurements of run time and accuracy; run one from the root of the checkout: `python -m benchmarks.GROUP.NAME`."""
