"""Load and batches on the HTTP service."""
