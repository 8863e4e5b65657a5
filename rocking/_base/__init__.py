"""Tools of every layer: constants, units, errors, equality of results, what a module imports, the version."""
