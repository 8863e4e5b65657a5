"""HTTP: errors, encoding, caching, files, request log, metrics."""
