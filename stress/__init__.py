"""Stress tests of numerical stability: `python -m stress`, or `make stress`; see docs/stress.md."""
