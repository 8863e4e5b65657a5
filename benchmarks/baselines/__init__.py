"""Other integrators under the same event loop, with which the package is compared."""
