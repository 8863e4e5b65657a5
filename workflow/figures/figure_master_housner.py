"""Additional figure: master spectra of rectangular blocks with the restitution of Housner, (2.4)."""

from workflow.figures.master_spectra import data, draw

__all__ = ["data", "draw"]
