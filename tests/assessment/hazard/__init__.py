"""Tests of `rocking_assessment`."""
