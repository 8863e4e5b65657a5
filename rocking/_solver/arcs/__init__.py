"""Exact arcs of the slender block under sums of sinusoids."""
