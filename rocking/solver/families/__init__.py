"""Families of f(phi) in the solver, one module each; `rocking.solver.excitation` selects the one of a pulse."""
