"""Cost and results with one optimisation of the package turned off at a time."""
