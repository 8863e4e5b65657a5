"""Families of f(phi), one module each: fields of the record, value, slope, expansion, exact arcs."""
