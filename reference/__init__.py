"""Instruments of the tests: slow, plain and independent of the package; not part of the wheel."""
