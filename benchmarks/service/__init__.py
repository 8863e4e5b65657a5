"""Load and batch measurements of the HTTP service."""
