"""Boundaries between outcomes, and thresholds along lines."""
