"""What every layer uses: constants, units, errors, equality of results, what a module imports, the version."""
