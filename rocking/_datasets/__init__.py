"""Schema, netCDF files, catalogue, checksums and provenance of the data sets."""
