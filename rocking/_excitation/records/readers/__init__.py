"""Readers of accelerogram files: `read_record.py` first, then a module for each format, `columns.py` for all others."""
