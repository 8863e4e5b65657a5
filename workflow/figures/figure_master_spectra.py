"""Additional figure: master spectra of blocks with one coefficient of restitution, in the groups of (6.1)."""

from workflow.figures.master_spectra import data, draw

__all__ = ["data", "draw"]
