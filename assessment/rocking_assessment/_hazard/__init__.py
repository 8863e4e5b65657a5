"""Hazard curves and their files, annual rates of limit states, and files of fragilities for loss programs."""
