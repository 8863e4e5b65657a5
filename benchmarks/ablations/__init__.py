"""Work and results of the package with one optimisation disabled at a time."""
