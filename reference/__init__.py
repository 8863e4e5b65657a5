"""Multi-precision integrator for tests: slow, simple and independent of the package; not part of the wheel."""
