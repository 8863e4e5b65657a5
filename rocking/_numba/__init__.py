"""Compilation of the kernels, their cache on disk, and vectors of several cells."""
