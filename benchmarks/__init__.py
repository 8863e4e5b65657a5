"""Run time and accuracy, measured; run from the root of the checkout: `python -m benchmarks.NAME`."""
