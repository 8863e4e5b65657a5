"""Other integrators with which the package is compared; all of them use the same event loop."""
