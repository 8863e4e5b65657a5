"""Ground motions: pulses and wavelets."""
