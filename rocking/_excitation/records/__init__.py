"""Recorded ground motions: the record, its measures, its processing, and the readers of files."""
