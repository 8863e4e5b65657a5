"""Interpolation of cubes between nodes and between levels."""
