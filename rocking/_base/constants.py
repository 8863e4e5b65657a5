"""Physical constants."""

STANDARD_GRAVITY = 9.80665  # standard acceleration of gravity [m/s2] (ISO 80000-3)
