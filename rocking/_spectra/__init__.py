"""Filling spectrum cubes and measuring their interpolation errors."""
