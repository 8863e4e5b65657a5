"""Errors of the solver against its tolerance, of interpolation against the grid size, and checks of error bounds."""
