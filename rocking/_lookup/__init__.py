"""Interpolated responses from cubes, each with an error bound."""
