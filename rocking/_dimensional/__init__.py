"""Blocks in metres under pulses in m/s2 and seconds: responses, margins, histories and spectra in SI units."""
